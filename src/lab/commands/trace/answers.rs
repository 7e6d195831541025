//! Parses lines of text into rays and formats hits as lines of JSON.

use super::lines::{LONGEST_LINE, Line};
use crate::formula;
use crate::frames::{Frames, GivenRay, PlacedRay};
use crate::inspection::{OperandName, Parameters, SolidReport, weights};
use crate::json;
use crate::surface::SurfacePoint;
use glam::DVec3;
use hitscope_core::{Hit, Scene};
use serde::Serialize;

/// Maximum number of characters of a word that an error message quotes.
const SHOWN: usize = 40;

/// The query for each ray.
#[derive(Clone, Copy)]
pub(super) enum RayQuery {
    Closest,
    Any,
    All,
}

/// A line that isn't blank: its ray, or an error message.
pub(super) struct Request {
    pub line: u64,
    pub ray: Result<PlacedRay, String>,
}

#[derive(Serialize)]
struct ClosestAnswer {
    hit: bool,
    #[serde(flatten)]
    found: Option<HitEntry>,
    line: u64,
    ray_rounding: f64,
}

#[derive(Serialize)]
struct AllAnswer {
    hits: Vec<HitEntry>,
    line: u64,
    ray_rounding: f64,
}

#[derive(Serialize)]
struct ErrorAnswer<'e> {
    error: &'e str,
    line: u64,
}

#[derive(Serialize)]
struct HitEntry {
    t: f64,
    #[serde(flatten)]
    triangle: Option<TriangleEntry>,
    #[serde(flatten)]
    shape: Option<ShapeEntry>,
    position: [f64; 3],
    normal: [f64; 3],
    #[serde(skip_serializing_if = "Option::is_none")]
    also: Option<Vec<u32>>,
    #[serde(flatten)]
    explanation: Option<Explanation>,
}

/// A hit of a triangle.
#[derive(Serialize)]
struct TriangleEntry {
    barycentric: [f32; 3],
    triangle: u32,
    face: u32,
}

/// A hit of another shape.
#[derive(Serialize)]
struct ShapeEntry {
    shape: &'static str,
    primitive: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    operand: Option<OperandName>,
}

/// The derivation of a hit.
#[derive(Serialize)]
struct Explanation {
    #[serde(skip_serializing_if = "Option::is_none")]
    parameters: Option<Parameters>,
    /// Whether the normal of a shape other than a triangle is reversed.
    #[serde(skip_serializing_if = "Option::is_none")]
    is_reversed: Option<bool>,
    #[serde(skip_serializing_if = "Option::is_none")]
    solid: Option<SolidReport>,
    formula: Vec<String>,
}

impl Request {
    /// `None` for a line that is blank or a comment.
    pub(super) fn of(line: Line<'_>, frames: &Frames<'_>) -> Option<Self> {
        let comment = line.bytes.iter().position(|&b| b == b'#');
        let statement = &line.bytes[..comment.unwrap_or(line.bytes.len())];
        let statement = String::from_utf8_lossy(statement);
        let statement = statement.trim_start_matches('\u{feff}').trim();
        let ray = if line.is_cut && comment.is_none() {
            Err(format!("the line is longer than {LONGEST_LINE} bytes"))
        } else if statement.is_empty() {
            return None;
        } else {
            ray(statement).and_then(|given| frames.place(&given).map_err(|e| e.to_string()))
        };
        Some(Self {
            line: line.number,
            ray,
        })
    }
}

/// Parses a ray.
fn ray(statement: &str) -> Result<GivenRay, String> {
    let mut numbers = [0.0; 8];
    let mut count = 0;
    for word in statement.split_whitespace() {
        let number: f64 = word.parse().map_err(|_| not_a_number(word))?;
        if let Some(place) = numbers.get_mut(count) {
            *place = number;
        }
        count += 1;
    }
    let [t_min, t_max] = match count {
        6 => [0.0, f64::INFINITY],
        8 => [numbers[6], numbers[7]],
        _ => return Err(format!("expected 6 or 8 numbers, found {count}")),
    };
    Ok(GivenRay {
        origin: DVec3::from_slice(&numbers),
        dir: DVec3::from_slice(&numbers[3..]),
        t_min,
        t_max,
    })
}

fn not_a_number(word: &str) -> String {
    let mut rest = word.chars();
    let beginning: String = rest.by_ref().take(SHOWN).collect();
    let more = if rest.next().is_some() { "…" } else { "" };
    format!("“{beginning}{more}” is not a number")
}

/// Traces rays through one scene and formats the answers.
pub(super) struct RayAnswerer<'a> {
    pub scene: &'a Scene,
    pub frames: &'a Frames<'a>,
    pub query: RayQuery,
    /// Whether hits are explained.
    pub is_explaining: bool,
}

impl RayAnswerer<'_> {
    /// Whether the ray hits anything. Traces as for an answer, without formatting one.
    pub(super) fn is_hit(&self, placed: &PlacedRay) -> bool {
        let (intersector, ray) = (self.frames.intersector(placed), &placed.ray);
        match self.query {
            RayQuery::Closest => intersector.closest_hit(ray).is_some(),
            RayQuery::Any => intersector.any_hit(ray),
            RayQuery::All => !intersector.all_hits(ray).is_empty(),
        }
    }

    /// Appends a line of JSON; returns whether the ray hits anything.
    pub(super) fn answer(&self, request: &Request, text: &mut Vec<u8>) -> bool {
        let placed = match &request.ray {
            Ok(placed) => placed,
            Err(error) => {
                let line = request.line;
                json::append_line(text, &ErrorAnswer { error, line });
                return false;
            }
        };
        let (intersector, ray) = (self.frames.intersector(placed), &placed.ray);
        let mut closest = |hit: bool, found: Option<HitEntry>| {
            let answer = ClosestAnswer {
                hit,
                found,
                line: request.line,
                ray_rounding: placed.rounding,
            };
            json::append_line(text, &answer);
            hit
        };
        match self.query {
            RayQuery::Any => closest(intersector.any_hit(ray), None),
            RayQuery::Closest => {
                let hit = intersector.closest_hit(ray);
                closest(hit.is_some(), hit.map(|hit| self.entry(placed, &hit, None)))
            }
            RayQuery::All => {
                let crossings = intersector.all_hits(ray).into_iter();
                let entry = |c: hitscope_core::intersector::Crossing| {
                    self.entry(placed, &c.hit, Some(c.also))
                };
                let answer = AllAnswer {
                    hits: crossings.map(entry).collect(),
                    line: request.line,
                    ray_rounding: placed.rounding,
                };
                json::append_line(text, &answer);
                !answer.hits.is_empty()
            }
        }
    }

    fn formula(&self, placed: &PlacedRay, hit: &Hit) -> Vec<String> {
        let origin = self.frames.origin(placed);
        let mut lines = formula::lines(self.scene, origin, &placed.ray, hit);
        let start = placed.t_as_given(0.0);
        if start != 0.0 {
            let (scale, t) = (placed.t_as_given(1.0) - start, placed.t_as_given(hit.t));
            lines.push(formula::t_of_given_ray(start, scale, t));
        }
        lines
    }

    fn entry(&self, placed: &PlacedRay, hit: &Hit, also: Option<Vec<u32>>) -> HitEntry {
        let (scene, primitive) = (self.scene, hit.primitive);
        let is_triangle = scene.is_triangle(primitive);
        let surface = SurfacePoint::in_file(scene, &placed.ray, hit);
        HitEntry {
            t: placed.t_as_given(hit.t),
            triangle: is_triangle.then(|| TriangleEntry {
                barycentric: weights(hit),
                triangle: primitive,
                face: scene.mesh().face_of(primitive),
            }),
            shape: (!is_triangle).then(|| ShapeEntry {
                shape: scene.group_of(primitive).0.shape().name,
                primitive,
                operand: OperandName::of_hit(scene, hit),
            }),
            position: surface.position,
            normal: surface.normal,
            also,
            explanation: self.is_explaining.then(|| Explanation {
                parameters: Parameters::of_primitive(scene, primitive),
                is_reversed: (!is_triangle).then(|| {
                    let (group, index) = scene.group_of(primitive);
                    group.is_flipped(index)
                }),
                solid: SolidReport::new(scene, &placed.ray, hit, |t| placed.t_as_given(t)),
                formula: self.formula(placed, hit),
            }),
        }
    }
}
