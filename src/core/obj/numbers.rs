//! Gathers the numbers that corners refer to.
//!
//! tobj returns a list per 16 384 faces; this module merges them for the whole file.

use super::corner::List;
use super::error::Problem;
use super::facts::Facts;
use crate::mesh::NO_INDEX;
use crate::progress::Progress;
use glam::{DVec3, Vec2, Vec3};
use std::ops::Range;

/// The numbers that elements refer to, and the elements' indices.
#[derive(Default)]
pub(super) struct Numbers {
    pub positions: Vec<DVec3>,
    /// Vertex colours; empty if there are none.
    pub colours: Vec<Vec3>,
    pub textures: Vec<Vec2>,
    pub normals: Vec<Vec3>,
    /// For each corner of each element, its index in the lists above, or [`NO_INDEX`]; the second and third
    /// may be empty.
    pub corners: [Vec<u32>; 3],
    /// Number of corners of each element; empty if all have three.
    pub arities: Vec<u32>,
}

impl Numbers {
    /// Places each number at its index in the file, then removes unused numbers.
    pub(super) fn gather(
        models: Vec<tobj::Model>,
        facts: &mut Facts,
        progress: &Progress,
    ) -> Result<Self, Problem> {
        let [vertices, textures, normals] = std::mem::take(&mut facts.corners);
        let mut positions = Sparse::new(DVec3::ZERO, facts.counts[0]);
        let textured = if textures.is_empty() {
            0
        } else {
            facts.counts[1]
        };
        let mut texture_list = Sparse::new(Vec2::ZERO, textured);
        let with_normal = if normals.is_empty() {
            0
        } else {
            facts.counts[2]
        };
        let mut normal_list = Sparse::new(Vec3::ZERO, with_normal);
        let mut arities = Vec::new();
        let (mut first, mut elements) = (0, 0);
        for model in models {
            progress.check()?;
            let mesh = model.mesh;
            let range = first..first + mesh.indices.len();
            first = range.end;
            let part = |list| part_of(list, &range);
            let three = |values: &[f64], k: u32| DVec3::from_slice(&values[3 * k as usize..]);
            positions.put(part(&vertices), &mesh.indices, |k| {
                three(&mesh.positions, k)
            });
            normal_list.put(part(&normals), &mesh.normal_indices, |k| {
                three(&mesh.normals, k).as_vec3()
            });
            texture_list.put(part(&textures), &mesh.texcoord_indices, |k| {
                let k = 2 * k as usize;
                Vec2::new(mesh.texcoords[k] as f32, mesh.texcoords[k + 1] as f32)
            });
            // tobj lists them only if not all are three.
            let count = match mesh.face_arities.len() {
                0 => mesh.indices.len() / 3,
                count => count,
            };
            if !mesh.face_arities.is_empty() || !arities.is_empty() {
                arities.resize(elements, 3);
                arities.extend(mesh.face_arities);
                arities.resize(elements + count, 3);
            }
            elements += count;
        }
        if (first, elements) != (vertices.len(), facts.element_count) {
            let message = "reading failed unexpectedly: faces are missing".to_owned();
            return Err(Problem::Content(message));
        }
        progress.check()?;
        let mut numbers = Self {
            corners: [vertices, textures, normals],
            arities,
            ..Self::default()
        };
        numbers.colours = facts.take_colours();
        if let Some(new) = positions.numbering() {
            renumber(&mut numbers.corners[0], &new);
            keep_used(&mut numbers.colours, &positions.is_used);
        }
        progress.check()?;
        let [_, texture_corners, normal_corners] = &mut numbers.corners;
        for (corners, new) in [
            (texture_corners, texture_list.numbering()),
            (normal_corners, normal_list.numbering()),
        ] {
            if let Some(new) = new {
                renumber(corners, &new);
            }
        }
        progress.check()?;
        numbers.positions = positions.used();
        numbers.textures = texture_list.used();
        numbers.normals = normal_list.used();
        numbers.forget_useless_normals(facts);
        Ok(numbers)
    }

    /// Removes normals that are zero or not finite.
    fn forget_useless_normals(&mut self, facts: &mut Facts) {
        let is_useless = |n: &Vec3| !n.is_finite() || *n == Vec3::ZERO;
        let useless: Vec<bool> = self.normals.iter().map(is_useless).collect();
        facts.useless_normals = useless.iter().filter(|&&is_useless| is_useless).count();
        if facts.useless_normals > 0 {
            for index in &mut self.corners[List::Normal as usize] {
                if useless.get(*index as usize) == Some(&true) {
                    *index = NO_INDEX;
                }
            }
        }
    }
}

/// The part of a list, or an empty slice if the list is empty.
fn part_of<'l>(list: &'l [u32], range: &Range<usize>) -> &'l [u32] {
    list.get(range.clone()).unwrap_or_default()
}

/// A list indexed as in the file, filled piece by piece.
struct Sparse<T> {
    values: Vec<T>,
    is_used: Vec<bool>,
}

impl<T: Copy> Sparse<T> {
    fn new(value: T, count: usize) -> Self {
        Self {
            values: vec![value; count],
            is_used: vec![false; count],
        }
    }

    /// `in_file` and `in_piece` are the indices of the same corners in either list.
    fn put(&mut self, in_file: &[u32], in_piece: &[u32], value: impl Fn(u32) -> T) {
        for (&to, &from) in in_file.iter().zip(in_piece) {
            if to != NO_INDEX {
                self.values[to as usize] = value(from);
                self.is_used[to as usize] = true;
            }
        }
    }

    /// The new index of each entry, if some are unused.
    fn numbering(&self) -> Option<Vec<u32>> {
        if !self.is_used.contains(&false) {
            return None;
        }
        let next = |next: &mut u32, &is_used: &bool| {
            let index = *next;
            *next += u32::from(is_used);
            Some(index)
        };
        Some(self.is_used.iter().scan(0, next).collect())
    }

    fn used(mut self) -> Vec<T> {
        keep_used(&mut self.values, &self.is_used);
        self.values
    }
}

fn renumber(corners: &mut [u32], new: &[u32]) {
    for index in corners {
        if *index != NO_INDEX {
            *index = new[*index as usize];
        }
    }
}

fn keep_used<T>(values: &mut Vec<T>, is_used: &[bool]) {
    let mut is_used = is_used.iter();
    values.retain(|_| is_used.next() == Some(&true));
}
