//! The list of picked pixels, and the hits of their rays.

use crate::comparison::Side;
use glam::{DVec3, UVec2};
use hitscope_core::measure::{SnapReach, SnapTarget, snap};
use hitscope_core::obj::LineRuns;
use hitscope_core::scene::{Scene, Shading};
use hitscope_core::{Camera, Intersector};
use hitscope_lab::inspection::HitReport;
use hitscope_lab::json;
use serde::{Deserialize, Serialize};

/// What a pick's point snaps to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Snapping {
    /// The face that was hit: the point is the hit.
    #[serde(alias = "off")]
    Face,
    /// The nearest vertex or edge of the face that was hit, if the picture shows one near the click.
    #[default]
    Automatic,
    /// The nearest vertex of the triangle that was hit.
    Vertex,
    /// The nearest edge of the face that was hit.
    Edge,
}

impl Snapping {
    /// All modes with their titles and descriptions.
    pub const ALL: [(Self, &'static str, &'static str); 4] = [
        (
            Self::Face,
            "Face",
            "Picks the point on the face that the ray hits",
        ),
        (
            Self::Automatic,
            "Automatic",
            "Picks a vertex or an edge if the picture shows one near the click, else the point that the ray hits",
        ),
        (
            Self::Vertex,
            "Vertex",
            "Picks the nearest vertex of the triangle that the ray hits",
        ),
        (
            Self::Edge,
            "Edge",
            "Picks the nearest point of an edge of the face that the ray hits",
        ),
    ];

    fn reach(self) -> SnapReach {
        /// As near as a pointer is aimed without care, in pixels.
        const NEAR_PX: f64 = 8.0;
        match self {
            Self::Face => SnapReach::NONE,
            Self::Automatic => SnapReach::within(NEAR_PX),
            Self::Vertex => SnapReach::VERTEX,
            Self::Edge => SnapReach::EDGE,
        }
    }
}

/// A pixel that was picked.
#[derive(Clone, Debug, PartialEq)]
pub struct PickedPixel {
    /// Its number, which no other pick of the list ever had.
    pub number: u32,
    /// The name that the user gave it.
    pub name: String,
    /// Whether it stays when another pixel is picked.
    pub is_pinned: bool,
    /// The side of a comparison whose picture was clicked.
    pub side: Side,
    /// The camera of the picture, in the coordinates of the open scene.
    pub camera: Camera,
    /// The pixel.
    pub pixel: UVec2,
}

/// What the ray of a picked pixel hits. Positions are in the file's coordinates.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PickedPoint {
    /// The kernel.
    pub kernel: &'static str,
    /// The shape that was hit.
    pub shape: &'static str,
    /// Index of the primitive in the scene, counted from 0; triangles come first.
    pub primitive: u32,
    /// Index of the face in the file, counted from 0, if it is a triangle.
    pub face: Option<u32>,
    /// The face's line in the file, counted from 1.
    pub line: Option<usize>,
    /// Distance in units of the ray's direction.
    pub t: f32,
    /// Barycentric coordinates of a triangle.
    pub barycentric: Option<[f32; 3]>,
    /// The hit.
    pub position: [f64; 3],
    /// `vertex`, `edge` or `face`: what the point snapped to.
    pub snapped_to: &'static str,
    /// The point, which is measured.
    pub point: [f64; 3],
    /// Unit length, by the right-hand rule.
    pub geometric_normal: [f32; 3],
    /// Unit length; the geometric one in flat shading.
    pub shading_normal: [f32; 3],
    /// The point in the scene's coordinates.
    #[serde(skip)]
    pub in_scene: DVec3,
}

impl PickedPoint {
    /// Traces the ray through a pixel's centre; `None` if it hits nothing.
    pub fn of_pixel(
        scene: &Scene,
        intersector: &dyn Intersector,
        shading: Shading,
        (camera, pixel): (&Camera, UVec2),
        snapping: Snapping,
    ) -> Option<Self> {
        let at = pixel.as_dvec2() + 0.5;
        let ray = camera.ray_through(at);
        let hit = intersector.closest_hit(&ray)?;
        let snapped = snap(scene, camera, at, (&ray, &hit), snapping.reach());
        let report = HitReport::new(scene, &ray, hit, shading);
        let triangle = report.triangle.as_ref();
        Some(Self {
            kernel: intersector.kernel().name,
            shape: report.shape,
            primitive: report.primitive,
            face: triangle.map(|triangle| triangle.face),
            line: None,
            t: report.t,
            barycentric: triangle.map(|triangle| triangle.barycentric),
            position: report.position,
            snapped_to: match snapped.target {
                SnapTarget::Vertex(_) => "vertex",
                SnapTarget::Edge(_) => "edge",
                SnapTarget::Face => "face",
            },
            point: match snapped.target {
                // The kernel's own hit.
                SnapTarget::Face => report.position,
                _ => snapped.position_in_file(scene.mesh()).to_array(),
            },
            geometric_normal: report.geometric_normal,
            shading_normal: report.shading_normal,
            in_scene: snapped.position,
        })
    }

    /// Finds the face's line in the file.
    pub fn find_line(&mut self, face_lines: &LineRuns) {
        let line = self.face.map(|face| face_lines.line(face as usize));
        self.line = line.filter(|&line| line > 0);
    }
}

/// A pick as it is exported.
#[derive(Serialize)]
struct Exported<'p> {
    number: u32,
    name: &'p str,
    side: Side,
    pixel: [u32; 2],
    hit: Option<&'p PickedPoint>,
}

/// The file and its picks as they are exported.
#[derive(Serialize)]
struct Export<'p> {
    file: &'p str,
    picks: Vec<Exported<'p>>,
}

/// Picks of a file with their hits as JSON.
pub fn to_json(file: &str, picks: &[(&PickedPixel, Option<&PickedPoint>)]) -> String {
    let picks = picks.iter().map(|(pick, hit)| Exported {
        number: pick.number,
        name: &pick.name,
        side: pick.side,
        pixel: pick.pixel.to_array(),
        hit: *hit,
    });
    json::to_pretty(&Export {
        file,
        picks: picks.collect(),
    })
}

/// The columns of [`to_csv`].
const COLUMNS: &str = "file,number,name,side,pixel_x,pixel_y,kernel,shape,primitive,face,line,t,l1,l2,l3,\
    hit_x,hit_y,hit_z,snapped_to,x,y,z,ng_x,ng_y,ng_z,ns_x,ns_y,ns_z";

/// Picks of a file with their hits as a table: comma-separated values with a row of names. The cells of a miss are
/// empty.
pub fn to_csv(file: &str, picks: &[(&PickedPixel, Option<&PickedPoint>)]) -> String {
    let mut text = format!("{COLUMNS}\n");
    let file = quoted(file);
    for (pick, hit) in picks {
        let (name, [x, y]) = (quoted(&pick.name), pick.pixel.to_array());
        let mut cells = vec![file.clone(), pick.number.to_string(), name];
        cells.push(format!("{:?}", pick.side));
        cells.extend([x, y].map(|x| x.to_string()));
        match hit {
            Some(hit) => cells.extend(hit_cells(hit)),
            None => cells.resize(COLUMNS.split(',').count(), String::new()),
        }
        text += &cells.join(",");
        text.push('\n');
    }
    text
}

fn hit_cells(hit: &PickedPoint) -> Vec<String> {
    let PickedPoint {
        kernel,
        shape,
        primitive,
        ..
    } = hit;
    let optional = |number: Option<String>| number.unwrap_or_default();
    let mut cells = vec![
        quoted(kernel),
        quoted(shape),
        primitive.to_string(),
        optional(hit.face.map(|face| face.to_string())),
        optional(hit.line.map(|line| line.to_string())),
        hit.t.to_string(),
    ];
    let weights = hit.barycentric.map(|weights| weights.map(Some));
    cells.extend(
        weights
            .unwrap_or_default()
            .map(|l| optional(l.map(|l| l.to_string()))),
    );
    cells.extend(hit.position.map(|x| x.to_string()));
    cells.push(hit.snapped_to.to_owned());
    cells.extend(hit.point.map(|x| x.to_string()));
    let normals = [hit.geometric_normal, hit.shading_normal];
    cells.extend(normals.concat().iter().map(f32::to_string));
    cells
}

/// A text as a cell.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hitscope_core::camera::Projection;
    use hitscope_core::kernel::exact_triangle_kernel;
    use hitscope_core::mesh::shapes::soup;
    use hitscope_core::scene::scene;

    fn picked() -> (PickedPixel, PickedPoint) {
        let corners = [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]];
        let scene = scene(soup(&[corners.map(|[x, y]| glam::Vec3::new(x, y, 0.0))]));
        let (eye, target) = (DVec3::new(1.0, 1.0, 9.0), DVec3::new(1.0, 1.0, 0.0));
        let projection = Projection::Orthographic { height: 10.0 };
        let camera = Camera::look_at(eye, target, DVec3::Y, projection, UVec2::splat(100));
        let camera = camera.expect("a camera");
        let pixel = camera.pixel_of(DVec3::new(0.25, 0.25, 0.0)).expect("seen");
        let pick = PickedPixel {
            number: 7,
            name: "left, \"low\"".to_owned(),
            is_pinned: false,
            side: Side::B,
            camera,
            pixel: pixel.as_uvec2(),
        };
        let intersector = scene.intersector(exact_triangle_kernel());
        let place = (&camera, pick.pixel);
        let of = |snapping| {
            PickedPoint::of_pixel(&scene, &*intersector, Shading::Flat, place, snapping)
                .expect("a hit")
        };
        assert_eq!(of(Snapping::Face).snapped_to, "face");
        assert_eq!(of(Snapping::Edge).snapped_to, "edge");
        let vertex = of(Snapping::Vertex);
        assert_eq!(of(Snapping::Automatic), vertex);
        (pick, vertex)
    }

    #[test]
    fn a_pick_near_a_vertex_is_the_vertex_and_is_exported_with_its_hit() {
        let (pick, hit) = picked();
        assert_eq!((hit.snapped_to, hit.point), ("vertex", [0.0; 3]));
        assert_eq!(hit.t, 9.0);
        let picks = [(&pick, Some(&hit)), (&pick, None)];
        let text = to_json("a.obj", &picks);
        let value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        assert_eq!(value["file"], "a.obj");
        assert_eq!(value["picks"][0]["name"], pick.name);
        assert_eq!(value["picks"][0]["side"], "B");
        assert_eq!(value["picks"][0]["hit"]["snapped_to"], "vertex");
        assert_eq!(value["picks"][0]["hit"]["geometric_normal"][2], 1.0);
        assert!(value["picks"][1]["hit"].is_null());
        let table = to_csv("a.obj", &picks);
        let lines: Vec<&str> = table.lines().collect();
        assert_eq!(lines.len(), 3);
        let cells = lines[0].split(',').count();
        // The name holds a comma.
        assert_eq!(lines[1].split(',').count(), cells + 1);
        assert_eq!(lines[2].split(',').count(), cells + 1);
        assert!(lines[1].starts_with("a.obj,7,\"left, \"\"low\"\"\",B,"));
    }
}
