//! The list of picks, and the results of tracing their rays.

use crate::comparison::Side;
use crate::measuring::{MeasuredPoint, Measurements};
use crate::picks::{PickedPixel, PickedPoint, Snapping};
use crate::task::{KeyedTask, Task};
use glam::{DVec3, UVec2};
use hitscope_core::bvh::OpenedBox;
use hitscope_core::scene::Shading;
use hitscope_core::{Aabb, Camera, Intersector, Scene};
use hitscope_lab::inspection::ThicknessReport;
use std::path::PathBuf;
use std::sync::Arc;

/// The picks, and what is known about them.
#[derive(Default)]
pub(crate) struct Picks {
    pub list: Vec<PickedPixel>,
    last_number: u32,
    /// The number of the pick that is inspected.
    pub selected: Option<u32>,
    pub snapping: Snapping,
    /// What the rays hit, by the picks' numbers, and what that depends on.
    pub found: Option<(Basis, Hits)>,
    pub task: KeyedTask<Basis, Hits>,
    pub measures_thickness: bool,
    pub shows_walk: bool,
    /// The selected box of the walk, counted from 0.
    pub step: usize,
    pub detail: Option<(DetailBasis, Detail)>,
    pub detail_task: KeyedTask<DetailBasis, Detail>,
    /// The file that is being written.
    pub writing: Option<(PathBuf, Task<Result<(), String>>)>,
}

/// What the rays of picks hit, by the picks' numbers.
pub(crate) type Hits = Vec<(u32, Option<PickedPoint>)>;

/// The scene of a side, and how its rays are traced and shaded.
#[derive(Clone)]
pub(crate) struct SideBasis {
    pub scene: Arc<Scene>,
    pub intersector: Arc<dyn Intersector>,
    pub shading: Shading,
    /// The origin of the scene relative to that of the open scene, in whose coordinates picks are kept.
    pub offset: DVec3,
}

impl PartialEq for SideBasis {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.scene, &other.scene)
            && Arc::ptr_eq(&self.intersector, &other.intersector)
            && (self.shading, self.offset) == (other.shading, other.offset)
    }
}

impl SideBasis {
    /// A camera of the open scene in the coordinates of this one. An offset of 0 changes no bit.
    fn camera(&self, camera: &Camera) -> Camera {
        if self.offset == DVec3::ZERO {
            *camera
        } else {
            camera.moved(-self.offset)
        }
    }

    /// The hit of a pick's ray.
    fn hit(&self, camera: &Camera, pixel: UVec2, snapping: Snapping) -> Option<PickedPoint> {
        let (scene, intersector) = (&self.scene, &*self.intersector);
        let place = (&self.camera(camera), pixel);
        let mut hit = PickedPoint::of_pixel(scene, intersector, self.shading, place, snapping)?;
        hit.in_scene += self.offset;
        Some(hit)
    }
}

/// The inputs that determine the hits of all picks.
#[derive(Clone, PartialEq)]
pub(crate) struct Basis {
    /// Side A and side B; `None` if the side isn't traced or has no picks.
    pub sides: [Option<SideBasis>; 2],
    pub snapping: Snapping,
    pub picks: Vec<(u32, Side, Camera, UVec2)>,
}

impl Basis {
    /// Traces the rays of all picks.
    pub fn hits(&self) -> Hits {
        let hit = |&(number, side, camera, pixel): &(u32, Side, Camera, UVec2)| {
            let side = self.sides[side as usize].as_ref();
            let hit = side.and_then(|side| side.hit(&camera, pixel, self.snapping));
            (number, hit)
        };
        self.picks.iter().map(hit).collect()
    }
}

/// The inputs that determine the details of the selected pick.
#[derive(Clone, PartialEq)]
pub(crate) struct DetailBasis {
    pub side: SideBasis,
    pub has_last_tree: bool,
    pub place: (Camera, UVec2),
    /// Whether thickness and walk are wanted.
    pub wants: [bool; 2],
}

impl DetailBasis {
    /// Finds the details. Boxes are in the coordinates of the open scene.
    pub fn detail(&self) -> Detail {
        let (side, [wants_thickness, wants_walk]) = (&self.side, self.wants);
        let (camera, pixel) = self.place;
        let camera = side.camera(&camera);
        let thickness = || ThicknessReport::of_pixel(&side.scene, &camera, pixel);
        let mut walk = if wants_walk {
            let ray = camera.ray_through(pixel.as_dvec2() + 0.5);
            side.intersector.opened_boxes(&ray)
        } else {
            Vec::new()
        };
        if side.offset != DVec3::ZERO {
            let by = side.offset.as_vec3();
            for opened in &mut walk {
                let Aabb { min, max } = opened.bounds;
                (opened.bounds.min, opened.bounds.max) = (min + by, max + by);
            }
        }
        Detail {
            thickness: wants_thickness.then(thickness).flatten(),
            walk,
        }
    }
}

/// More about the selected pick.
pub(crate) struct Detail {
    pub thickness: Option<ThicknessReport>,
    pub walk: Vec<OpenedBox>,
}

impl Picks {
    /// Adds a pixel and selects it. Unless `keeps_others`, the picks that aren't pinned are removed.
    pub fn add(&mut self, side: Side, camera: Camera, pixel: UVec2, keeps_others: bool) {
        if !keeps_others {
            self.list.retain(|pick| pick.is_pinned);
        }
        self.last_number += 1;
        self.list.push(PickedPixel {
            number: self.last_number,
            name: String::new(),
            is_pinned: false,
            side,
            camera,
            pixel,
        });
        self.selected = Some(self.last_number);
        self.step = 0;
    }

    /// Removes the picks that aren't pinned.
    pub fn clear_unpinned(&mut self) {
        self.list.retain(|pick| pick.is_pinned);
    }

    /// Replaces the list. Picks whose number is 0 or already taken get new numbers.
    pub fn restore(&mut self, picks: impl IntoIterator<Item = PickedPixel>) {
        self.clear();
        let mut unnumbered = Vec::new();
        for pick in picks {
            let is_taken = self.list.iter().any(|other| other.number == pick.number);
            if pick.number == 0 || is_taken {
                unnumbered.push(self.list.len());
            }
            self.last_number = self.last_number.max(pick.number);
            self.list.push(pick);
        }
        for index in unnumbered {
            self.last_number += 1;
            self.list[index].number = self.last_number;
        }
        // The hits of the old list have the same numbers.
        self.found = None;
    }

    /// Removes all picks; the next one has the number 1.
    pub fn clear(&mut self) {
        (self.list, self.selected, self.last_number) = (Vec::new(), None, 0);
        self.found = None;
    }

    /// Moves the cameras to the place where they see the same in a scene whose origin has moved.
    pub fn shift(&mut self, by: DVec3) {
        for pick in &mut self.list {
            pick.camera = pick.camera.moved(by);
        }
    }

    pub fn selected(&self) -> Option<&PickedPixel> {
        let number = self.selected?;
        self.list.iter().find(|pick| pick.number == number)
    }

    /// The hit of a pick's ray; `None` for a miss, and until the ray is traced.
    pub fn hit(&self, number: u32) -> Option<&PickedPoint> {
        self.result(number)?
    }

    /// Whether a pick's ray has been traced.
    pub fn is_traced(&self, number: u32) -> bool {
        self.result(number).is_some()
    }

    /// The result of a pick's ray, once it is traced: a hit or a miss.
    fn result(&self, number: u32) -> Option<Option<&PickedPoint>> {
        let (_, found) = self.found.as_ref()?;
        let of_pick = found.iter().find(|(of, _)| *of == number);
        of_pick.map(|(_, hit)| hit.as_ref())
    }

    pub fn with_hits(&self) -> Vec<(&PickedPixel, Option<&PickedPoint>)> {
        let picks = self.list.iter();
        picks.map(|pick| (pick, self.hit(pick.number))).collect()
    }

    /// The points with their numbers and names, in the scene's coordinates.
    pub fn points(&self) -> Vec<(DVec3, String)> {
        let text = |pick: &PickedPixel| match pick.name.as_str() {
            "" => format!("#{}", pick.number),
            name => format!("#{} {name}", pick.number),
        };
        let point = |pick: &PickedPixel| Some((self.hit(pick.number)?.in_scene, text(pick)));
        self.list.iter().filter_map(point).collect()
    }

    /// The measurements between the picks, and at the selected one.
    pub fn measurements(&self) -> Measurements {
        let points = self.with_hits().into_iter().filter_map(|(pick, hit)| {
            let hit = hit?;
            Some(MeasuredPoint {
                number: pick.number,
                in_file: DVec3::from_array(hit.point),
                in_scene: hit.in_scene,
                normal: glam::Vec3::from_array(hit.geometric_normal).as_dvec3(),
            })
        });
        let points: Vec<MeasuredPoint> = points.collect();
        let mut all = Measurements::between(&points);
        let hit = self.selected().and_then(|pick| self.hit(pick.number));
        if let (Some((basis, detail)), Some(hit)) = (&self.detail, hit)
            && let Some(thickness) = &detail.thickness
        {
            let origin = basis.side.scene.mesh().origin() - basis.side.offset;
            let from = DVec3::from_array(hit.position) - origin;
            all.add_thickness(thickness, from, origin);
        }
        all
    }

    pub fn walk(&self) -> &[OpenedBox] {
        let detail = self.detail.as_ref().filter(|_| self.shows_walk);
        detail.map_or(&[], |(_, detail)| &detail.walk)
    }

    /// The selected box of the walk.
    pub fn opened(&self) -> Option<Aabb> {
        let walk = self.walk();
        let last = walk.len().checked_sub(1)?;
        Some(walk[self.step.min(last)].bounds)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hitscope_core::camera::Turntable;

    #[test]
    fn a_pick_counts_as_traced_when_its_hit_or_miss_is_known() {
        let size = UVec2::new(40, 30);
        let camera = Turntable::framing(Aabb::EMPTY, size).camera(size);
        let mut picks = Picks::default();
        picks.add(Side::A, camera, UVec2::ZERO, true);
        assert!(!picks.is_traced(1));
        let basis = Basis {
            sides: [None, None],
            snapping: picks.snapping,
            picks: vec![(1, Side::A, camera, UVec2::ZERO)],
        };
        let hits = basis.hits();
        picks.found = Some((basis, hits));
        assert!(picks.is_traced(1) && picks.hit(1).is_none());
        let list = std::mem::take(&mut picks.list);
        picks.restore(list);
        assert!(!picks.is_traced(1));
    }
}
