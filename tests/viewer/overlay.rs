//! Tests of the overlay's lines, their places and colours.

use crate::harness::{gpu, shared_setup};
use eframe::egui_wgpu::{RenderState, RendererOptions};
use egui_kittest::wgpu::create_render_state;
use glam::{DVec3, UVec2, Vec3};
use hitscope::gpu::adapter::Gpu;
use hitscope::offscreen::read_back;
use hitscope::overlay::elements::ELEMENTS;
use hitscope::overlay::face_normals::FACE_NORMALS;
use hitscope::overlay::normals::LENGTH;
use hitscope::overlay::wireframe::{DIAGONALS, WIREFRAME};
use hitscope::overlay::{
    Marks, OverlayError, OverlayInput, OverlayLayer, OverlaySpec, OverlayState, Overlays, switches,
};
use hitscope_core::TriangleMesh;
use hitscope_core::camera::{Camera, Projection, UpAxis};
use hitscope_core::mesh::{Attributes, Faces, Flaw, Health, Runs};
use hitscope_core::progress::Progress;
use hitscope_core::scene::{Scene, SceneOptions, scene};
use hitscope_core::shape::Sphere;
use std::sync::Arc;
use std::time::{Duration, Instant};

const SIZE: UVec2 = UVec2::new(200, 200);
const BACKGROUND: [u8; 4] = [0; 4];
const WIRE: [u8; 3] = [200, 100, 50];

/// A camera with 50 pixels per unit, (0, 0) in the middle of the picture, and y upwards.
fn camera() -> Camera {
    camera_at(0.0)
}

/// The same camera, moved to the right.
fn camera_at(x: f64) -> Camera {
    let (eye, target) = (DVec3::new(x, 0.0, 5.0), DVec3::new(x, 0.0, 0.0));
    let projection = Projection::Orthographic { height: 4.0 };
    Camera::look_at(eye, target, DVec3::Y, projection, SIZE).expect("a camera")
}

/// A scene seen by a camera, with nothing selected.
pub fn input(scene: &Arc<Scene>, camera: Camera) -> OverlayInput {
    OverlayInput {
        scene: Arc::clone(scene),
        camera,
        lines_camera: camera,
        up_axis: UpAxis::Y,
        pivot: DVec3::ZERO,
        marks: Marks::default(),
        scale: 1.0,
    }
}

/// No overlay except marks of what is selected.
pub fn none() -> Overlays {
    let mut overlays = Overlays::default();
    switches().for_each(|overlay| overlays.set_on(overlay, false));
    overlays
}

/// A single overlay in a state.
pub fn only(overlay: &OverlaySpec, change: impl FnOnce(&mut OverlayState)) -> Overlays {
    let mut overlays = none();
    let state = overlays.state_mut(overlay);
    state.is_on = true;
    change(state);
    overlays
}

/// A square, a triangle behind it, an edge-on triangle to its right, and a line in front of it. Vertical and horizontal
/// edges run through the centres of pixels.
///
/// ```text
///   3───────────2   8      The square's left edge is at x = 50.5 pixels, its right one at 150.5,
///   │  9─────10 │   │      its upper one at y = 50.5, its lower one at 150.5.
///   │   6       │   │      The triangle behind has its left edge at x = 80.5, from y = 80.5 to 120.5.
///   │   4──5    │   7      The edge-on one is at x = 170.5, and its normal points to the right.
///   0───────────1          The line is at y = 60.5, from x = 70.5 to 130.5.
/// ```
pub fn marked_scene() -> Arc<Scene> {
    Arc::new(scene(marked_mesh()))
}

fn marked_mesh() -> TriangleMesh {
    let at = |x: f32, y: f32, z: f32| Vec3::new((x - 100.0) / 50.0, (100.0 - y) / 50.0, z);
    let corners = vec![
        at(50.5, 150.5, 0.0),
        at(150.5, 150.5, 0.0),
        at(150.5, 50.5, 0.0),
        at(50.5, 50.5, 0.0),
        at(80.5, 120.5, -1.0),
        at(110.5, 120.5, -1.0),
        at(80.5, 80.5, -1.0),
        at(170.5, 130.5, 0.0),
        at(170.5, 70.5, 0.0),
        at(70.5, 60.5, 1.0),
        at(130.5, 60.5, 1.0),
    ];
    let mut corners_and_edge_on = corners;
    corners_and_edge_on.push(at(170.5, 100.5, -1.0));
    let mesh = TriangleMesh::new(
        corners_and_edge_on,
        vec![[0, 1, 2], [0, 2, 3], [4, 5, 6], [7, 11, 8]],
    );
    // The square is one face.
    let mut faces = Faces::default();
    faces.push(0, 0, 0b011);
    faces.push(1, 0, 0b110);
    mesh.with_attributes(Attributes {
        faces,
        lines: vec![[9, 10]],
        ..Attributes::default()
    })
}

const BEHIND: u32 = 2;

/// Draws until the overlay is complete.
pub fn drawn(
    layer: &mut OverlayLayer,
    gpu: &Gpu,
    input: &OverlayInput,
    overlays: &Overlays,
) -> Vec<[u8; 4]> {
    drawn_by(layer, gpu, |layer, ctx| layer.draw(input, overlays, ctx))
}

/// Calls `draw` until the overlay is complete.
fn drawn_by(
    layer: &mut OverlayLayer,
    gpu: &Gpu,
    draw: impl Fn(&mut OverlayLayer, &egui::Context) -> Result<Option<wgpu::Texture>, OverlayError>,
) -> Vec<[u8; 4]> {
    let start = Instant::now();
    loop {
        let texture = draw(layer, &egui::Context::default()).expect("drawn");
        if layer.is_complete() {
            let texture = texture.expect("something is drawn");
            return read_back(&gpu.device, &gpu.queue, &texture).expect("read back");
        }
        assert!(start.elapsed() < Duration::from_secs(300), "timed out");
        std::thread::sleep(Duration::from_millis(1));
    }
}

pub fn layer() -> Option<(OverlayLayer, &'static Gpu)> {
    layer_on(wgpu::DeviceType::Cpu)
}

/// A layer that draws as on an adapter of this type.
fn layer_on(adapter: wgpu::DeviceType) -> Option<(OverlayLayer, &'static Gpu)> {
    let gpu = gpu()?;
    let state: RenderState = create_render_state(shared_setup(gpu), RendererOptions::PREDICTABLE);
    Some((OverlayLayer::new(&state, adapter), gpu))
}

/// A colour with premultiplied alpha, as in the texture.
fn premultiplied(colour: [f32; 3], alpha: f32) -> [u8; 4] {
    let byte = |x: f32| (255.0 * x).round() as u8;
    [
        colour[0] * alpha,
        colour[1] * alpha,
        colour[2] * alpha,
        alpha,
    ]
    .map(byte)
}

/// Each blend rounds to a byte; two of them, and the byte expected here, are off by 1/2 each.
fn assert_is(pixels: &[[u8; 4]], [x, y]: [u32; 2], expected: [u8; 4], what: &str) {
    let found = pixels[(y * SIZE.x + x) as usize];
    let off = (0..4).map(|k| found[k].abs_diff(expected[k])).max();
    assert!(
        off <= Some(2),
        "{what} at {x}, {y}: {found:?} for {expected:?}"
    );
}

const ON_THE_SQUARES_EDGE: [u32; 2] = [50, 110];
const ON_ITS_DIAGONAL: [u32; 2] = [130, 70];
const ON_THE_EDGE_BEHIND: [u32; 2] = [80, 100];
const ON_THE_LINE: [u32; 2] = [100, 60];
const ON_THE_NORMAL: [u32; 2] = [180, 100];

#[test]
fn the_wireframe_shows_visible_edges_of_polygons_or_of_triangles() {
    let Some((mut layer, gpu)) = layer() else {
        return;
    };
    let input = input(&marked_scene(), camera());
    let wire = premultiplied(WIRE.map(|c| f32::from(c) / 255.0), 0.85);
    for (has_diagonals, diagonal) in [(0.0, BACKGROUND), (1.0, wire)] {
        let overlays = only(&WIREFRAME, |state| {
            state.colour = WIRE;
            state.set(&DIAGONALS, has_diagonals);
        });
        let pixels = drawn(&mut layer, gpu, &input, &overlays);
        assert_is(&pixels, ON_THE_SQUARES_EDGE, wire, "the square's edge");
        assert_is(&pixels, ON_ITS_DIAGONAL, diagonal, "its diagonal");
        assert_is(&pixels, ON_THE_EDGE_BEHIND, BACKGROUND, "the edge behind");
        assert_is(&pixels, ON_THE_LINE, BACKGROUND, "the file's line");
    }
}

#[test]
fn lines_of_the_file_and_normals_are_drawn_in_their_colours() {
    let Some((mut layer, gpu)) = layer() else {
        return;
    };
    let input = input(&marked_scene(), camera());
    let pixels = drawn(&mut layer, gpu, &input, &only(&ELEMENTS, |_| ()));
    let element = premultiplied([0.10, 0.75, 0.62], 0.95);
    assert_is(&pixels, ON_THE_LINE, element, "the file's line");
    assert_is(&pixels, ON_THE_SQUARES_EDGE, BACKGROUND, "no wireframe");
    let overlays = only(&FACE_NORMALS, |state| state.set(&LENGTH, 0.3));
    let pixels = drawn(&mut layer, gpu, &input, &overlays);
    let normal = premultiplied([0.16, 0.55, 0.95], 0.8);
    assert_is(
        &pixels,
        ON_THE_NORMAL,
        normal,
        "the edge-on triangle's normal",
    );
    assert_is(&pixels, ON_THE_LINE, BACKGROUND, "no lines");
}

#[test]
fn width_colour_and_opacity_are_those_of_the_state() {
    let Some((mut layer, gpu)) = layer() else {
        return;
    };
    let mut input = input(&marked_scene(), camera());
    let overlays = only(&WIREFRAME, |state| {
        (state.colour, state.opacity, state.width_px) = (WIRE, 0.5, 5.0);
    });
    let wire = premultiplied(WIRE.map(|c| f32::from(c) / 255.0), 0.5);
    // The edge's centre is at 50.5 pixels: a line of 5 pixels ends at 53, one of 10 pixels at 55.5.
    for (scale, reach) in [(1.0, 2), (2.0, 4)] {
        input.scale = scale;
        let pixels = drawn(&mut layer, gpu, &input, &overlays);
        let [x, y] = ON_THE_SQUARES_EDGE;
        assert_is(&pixels, [x - reach, y], wire, "inside the line");
        assert_is(&pixels, [x - reach - 2, y], BACKGROUND, "beside the line");
    }
}

#[test]
fn marks_are_strong_on_the_mesh_and_faint_behind_it() {
    let Some((mut layer, gpu)) = layer() else {
        return;
    };
    let scene = marked_scene();
    let health = Arc::new(Health::of(scene.mesh()));
    let mut input = input(&scene, camera());
    input.marks.flaw = Some((Flaw::OpenEdge, health));
    let pixels = drawn(&mut layer, gpu, &input, &none());
    let flaw = |alpha| premultiplied([0.95, 0.15, 0.20], alpha);
    assert_is(&pixels, ON_THE_SQUARES_EDGE, flaw(1.0), "an open edge");
    assert_is(
        &pixels,
        ON_THE_EDGE_BEHIND,
        flaw(0.3),
        "an open edge behind",
    );
    assert_is(&pixels, ON_ITS_DIAGONAL, BACKGROUND, "a closed edge");

    input.marks.flaw = None;
    let picked = |alpha| premultiplied([1.0, 0.55, 0.0], alpha);
    for (triangle, edge, behind) in [
        (1, picked(1.0), BACKGROUND),
        (BEHIND, BACKGROUND, picked(0.3)),
    ] {
        input.marks.picked = Some(triangle);
        let pixels = drawn(&mut layer, gpu, &input, &none());
        assert_is(&pixels, ON_THE_SQUARES_EDGE, edge, "the square's edge");
        assert_is(&pixels, ON_THE_EDGE_BEHIND, behind, "the edge behind");
    }
}

#[test]
fn the_last_overlay_stays_until_the_next_is_drawn_unless_the_camera_changes() {
    let Some((mut layer, gpu)) = layer() else {
        return;
    };
    let scene = marked_scene();
    let overlays = |width_px| {
        only(&WIREFRAME, |state| {
            (state.colour, state.width_px) = (WIRE, width_px);
        })
    };
    drawn(&mut layer, gpu, &input(&scene, camera()), &overlays(1.0));
    let ctx = egui::Context::default();
    let mut draw = |camera: Camera, width| {
        let drawn = layer.draw(&input(&scene, camera), &overlays(width), &ctx);
        drawn.expect("drawn")
    };
    assert!(draw(camera(), 3.0).is_some(), "a frame without lines");
    // Ten pixels to the left.
    if let Some(texture) = draw(camera_at(0.2), 3.0) {
        let pixels = read_back(&gpu.device, &gpu.queue, &texture).expect("read back");
        assert_is(
            &pixels,
            ON_THE_SQUARES_EDGE,
            BACKGROUND,
            "the edge's old place",
        );
    }
}

#[test]
fn lines_of_meshes_and_shapes_are_drawn_while_the_camera_moves_except_by_a_software_gpu() {
    let mut with_ball = scene(marked_mesh());
    // In front of the square's left edge, which none of its lines covers.
    let ball = Sphere {
        centre: Vec3::new(-0.85, -0.2, 2.0),
        radius: 0.9,
    };
    let (options, progress) = (SceneOptions::default(), Progress::default());
    let added = with_ball.add_group(vec![ball], Runs::default(), options, &progress);
    added.expect("nobody cancels");
    let input = input(&Arc::new(with_ball), camera());
    let overlays = only(&WIREFRAME, |state| state.colour = WIRE);
    let Some((mut layer, gpu)) = layer_on(wgpu::DeviceType::DiscreteGpu) else {
        return;
    };
    let moving = drawn_by(&mut layer, gpu, |layer, ctx| {
        layer.draw_moving(&input, &overlays, ctx)
    });
    let still = drawn(&mut layer, gpu, &input, &overlays);
    let wire = premultiplied(WIRE.map(|c| f32::from(c) / 255.0), 0.85);
    for pixels in [&moving, &still] {
        assert_is(pixels, [130, 150], wire, "the square's lower edge");
    }
    // Within the ball's outline.
    let count = |pixels: &[[u8; 4]]| {
        let inside = (90..130).flat_map(|y| (30..70).map(move |x| y * 200 + x));
        inside.filter(|&i| pixels[i] != BACKGROUND).count()
    };
    let (moving, still) = (count(&moving), count(&still));
    // It hides the edge only while the camera rests.
    assert!(moving > still && still > 0, "{moving} {still}");

    let (mut layer, _) = layer_on(wgpu::DeviceType::Cpu).expect("a graphics adapter");
    let drawn = layer.draw_moving(&input, &overlays, &egui::Context::default());
    assert!(drawn.expect("drawn").is_none() && layer.is_complete());
}
