//! Tests of the overlay in slices and on a GPU with small buffers.

use crate::harness::{app_on, gpu, limited_device, press, wait};
use crate::overlay::{input, none};
use eframe::egui_wgpu::{WgpuSetup, WgpuSetupExisting};
use egui::Key;
use glam::{DVec3, UVec2, Vec3};
use hitscope::app::App;
use hitscope::document::Document;
use hitscope::gpu::GpuError;
use hitscope::gpu::depth::DepthMesh;
use hitscope::gpu::drawing::{Canvas, Drawing, DrawingState, DrawnLines, Overlay, Paces, Targets};
use hitscope::gpu::lines::{Fade, Line, LineKind, LineOcclusion, LineSet, StyleUniform};
use hitscope::gpu::slices::Pace;
use hitscope::gpu::view::ViewUniform;
use hitscope::offscreen::{self, OverlayTiles, read_back};
use hitscope::overlay::wireframe::{self, WIREFRAME, WireframeEdges};
use hitscope_core::camera::{Camera, Projection};
use hitscope_core::kernel::default_triangle_kernel;
use hitscope_core::mesh::shapes::{Placement, flat_grid, sphere};
use hitscope_core::obj::LoadOptions;
use hitscope_core::progress::Progress;
use hitscope_core::scene::{Scene, SceneOptions, scene};
use std::cell::Cell;
use std::fmt::Write as _;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

const STYLE: StyleUniform = StyleUniform::new([0.9, 0.4, 0.1, 0.7], 0.8, 1.0);

/// A device of the shared adapter with this limit on buffer sizes. It is never closed.
fn small_device(max_buffer_size: u64) -> Option<(wgpu::Device, wgpu::Queue)> {
    limited_device(wgpu::Limits {
        max_buffer_size,
        ..wgpu::Limits::default()
    })
}

/// A drawing of a scene with its lines, hidden and through the mesh.
fn drawing(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    scene: &Scene,
    lines: &[Line],
) -> Result<Drawing, GpuError> {
    let projection = Projection::Perspective { fov_y_radians: 0.7 };
    let (eye, size) = (DVec3::new(1.0, 2.0, 3.0), UVec2::new(160, 120));
    let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, projection, size).expect("a camera");
    let lines = Arc::new(LineSet::new(device, queue, lines)?);
    let set = |occlusion| DrawnLines {
        lines: Arc::clone(&lines),
        style: STYLE,
        kind: LineKind {
            occlusion,
            fade: Fade::ShortOrDense,
            is_cut: true,
        },
    };
    Ok(Drawing {
        traced: None,
        outline: None,
        view: ViewUniform::new(&camera, &scene.bounds()),
        mesh: Arc::new(DepthMesh::new(device, queue, scene)?),
        sets: vec![set(LineOcclusion::Hidden), set(LineOcclusion::Through)],
    })
}

/// Returns the pixels and the number of slices of lines.
fn draw(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    drawing: &Drawing,
    mut paces: Paces,
) -> (Vec<[u8; 4]>, u32) {
    let canvas = canvas(device, drawing);
    let (state, slices) = (DrawingState::default(), Cell::new(0));
    let overlay = Overlay::new(device, queue);
    let count = || slices.set(slices.get() + 1);
    assert!(overlay.draw(drawing, &canvas, &mut paces, &state, count));
    let texture = canvas.targets.colour(canvas.colour);
    let pixels = read_back(device, queue, texture).expect("read back");
    (pixels, slices.get())
}

fn canvas(device: &wgpu::Device, drawing: &Drawing) -> Canvas {
    Canvas {
        targets: Arc::new(Targets::new(device, drawing.view.size()).expect("memory")),
        colour: 1,
        has_depth: false,
    }
}

/// Paces with the smallest slices.
fn slowest() -> Paces {
    let mut pace = Pace::default();
    (0..40).for_each(|_| pace.adapt(Duration::from_secs(1)));
    Paces {
        triangles: pace,
        lines: pace,
    }
}

#[test]
fn an_overlay_in_slices_is_identical_to_one_drawn_at_once() {
    let Some(gpu) = gpu() else { return };
    let (device, queue) = (&gpu.device, &gpu.queue);
    let scene = scene(sphere(24, Placement::UNIT));
    let lines = wireframe::lines(&scene, WireframeEdges::Triangles);
    let drawing = drawing(device, queue, &scene, &lines).expect("small");
    let (at_once, one) = draw(device, queue, &drawing, Paces::UNLIMITED);
    let (in_slices, many) = draw(device, queue, &drawing, slowest());
    assert!(at_once.iter().any(|pixel| pixel[3] > 0));
    assert_eq!(one, 1);
    // Two sets; the pace may grow by half from slice to slice.
    assert!(many > 3, "{many} slices of {} lines", lines.len());
    assert!(at_once == in_slices);
}

#[test]
fn a_cancelled_drawing_ends_after_its_slice() {
    let Some(gpu) = gpu() else { return };
    let (device, queue) = (&gpu.device, &gpu.queue);
    let scene = scene(sphere(24, Placement::UNIT));
    let lines = wireframe::lines(&scene, WireframeEdges::Triangles);
    let drawing = drawing(device, queue, &scene, &lines).expect("small");
    let overlay = Overlay::new(device, queue);
    let state = DrawingState::default();
    let slices = Cell::new(0);
    let cancel = || {
        slices.set(slices.get() + 1);
        state.is_cancelled.store(true, Ordering::Relaxed);
    };
    let canvas = canvas(device, &drawing);
    assert!(!overlay.draw(&drawing, &canvas, &mut slowest(), &state, cancel));
    assert_eq!(slices.get(), 1);
}

#[test]
fn lines_and_meshes_larger_than_a_buffer_are_split_and_drawn_the_same() {
    const GRANTED: u64 = 128 << 10;
    let Some((device, queue)) = small_device(GRANTED) else {
        return;
    };
    let shared = gpu().expect("there is one");
    for mesh in [sphere(24, Placement::UNIT), flat_grid(110, Placement::UNIT)] {
        let scene = scene(mesh);
        let lines = wireframe::lines(&scene, WireframeEdges::Triangles);
        assert!(size_of_val(lines.as_slice()) as u64 > 2 * GRANTED);
        let cut = drawing(&device, &queue, &scene, &lines).expect("in several buffers");
        let whole = drawing(&shared.device, &shared.queue, &scene, &lines).expect("in one buffer");
        let (cut, _) = draw(&device, &queue, &cut, Paces::UNLIMITED);
        let (whole, _) = draw(&shared.device, &shared.queue, &whole, Paces::UNLIMITED);
        assert!(whole.iter().any(|pixel| pixel[3] > 0));
        assert!(cut == whole);
    }
    // The positions of the second mesh need more than one buffer.
    let positions = size_of_val(flat_grid(110, Placement::UNIT).positions()) as u64;
    assert!(positions > GRANTED);
}

#[test]
fn a_device_without_buffers_for_a_line_or_a_triangle_is_refused() {
    let Some((device, queue)) = small_device(32) else {
        return;
    };
    let line = Line::between(Vec3::ZERO, Vec3::X);
    let refused = LineSet::new(&device, &queue, &[line]).err();
    assert!(
        matches!(
            refused,
            Some(GpuError::TooLarge {
                needed: 36,
                granted: 32
            })
        ),
        "{refused:?}"
    );
    let scene = scene(flat_grid(2, Placement::UNIT));
    let refused = DepthMesh::new(&device, &queue, &scene).err();
    assert!(
        matches!(refused, Some(GpuError::TooLarge { .. })),
        "{refused:?}"
    );
}

#[test]
fn an_overlay_in_tiles_is_the_same_picture() {
    let size = UVec2::new(300, 170);
    let small = wgpu::Limits {
        max_texture_dimension_2d: 64,
        max_texture_dimension_1d: 64,
        ..wgpu::Limits::default()
    };
    let Some((device, queue)) = limited_device(small) else {
        return;
    };
    let shared = gpu().expect("there is one");
    let text = r#"<scene version="3.0.0"><shape type="sphere"/><shape type="cube"><transform name="to_world"><translate x="2"/></transform></shape></scene>"#;
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("scene.xml");
    std::fs::write(&path, text).expect("written");
    let document = Document::load(
        &path,
        default_triangle_kernel().into(),
        LoadOptions::default(),
        SceneOptions::default(),
        &Progress::default(),
    );
    let solid = Arc::clone(&document.expect("loaded").loaded.scene);
    let mesh = Arc::new(scene(sphere(24, Placement::UNIT)));
    for (scene, projection) in [
        (&mesh, Projection::Perspective { fov_y_radians: 0.7 }),
        (&mesh, Projection::Orthographic { height: 2.5 }),
        // Mesa's software renderer draws long lines in perspective differently where a border clips them.
        (&solid, Projection::Orthographic { height: 3.5 }),
    ] {
        let eye = DVec3::new(1.0, 2.0, 3.0);
        let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, projection, size);
        let input = input(scene, camera.expect("a camera"));
        let mut overlays = none();
        overlays.set_on(&WIREFRAME, true);
        let pixels = |device: &wgpu::Device, queue: &wgpu::Queue| {
            let mut pixels = vec![[100, 150, 200, 255]; size.element_product() as usize];
            offscreen::draw_onto(&mut pixels, (device, queue), &input, &overlays).expect("drawn");
            pixels
        };
        let tiled = pixels(&device, &queue);
        // Strips that end inside of tiles.
        let mut in_strips = vec![[100, 150, 200, 255]; size.element_product() as usize];
        let mut tiles = OverlayTiles::new((&device, &queue), &input, &overlays).expect("ready");
        for (strip, first_row) in in_strips.chunks_mut(300 * 48).zip((0..).step_by(48)) {
            tiles.draw_onto(strip, first_row, || true).expect("drawn");
        }
        assert!(in_strips == tiled);
        let whole = pixels(&shared.device, &shared.queue);
        assert!(whole.iter().any(|pixel| *pixel != whole[0]));
        // The corners of lines are rounded by another matrix: by some 1e-4 pixels, a part of a step of colour. Where a
        // line touches a surface, it may be hidden in one picture.
        let differs = |(a, b): (&[u8; 4], &[u8; 4])| (0..4).any(|k| a[k].abs_diff(b[k]) > 2);
        let pairs = tiled.iter().zip(&whole);
        let count = pairs.filter(|pair| differs(*pair)).count();
        assert!(count * 2000 < whole.len(), "{count} pixels differ");
    }
}

/// An OBJ file of a square with this many quads per side.
fn grid(folder: &tempfile::TempDir, side: u32) -> std::path::PathBuf {
    let mut text = String::new();
    for y in 0..=side {
        for x in 0..=side {
            writeln!(text, "v {x} {y} 0").expect("to a string");
        }
    }
    let at = |x: u32, y: u32| y * (side + 1) + x + 1;
    for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
        let quad = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
        writeln!(text, "f {} {} {} {}", quad[0], quad[1], quad[2], quad[3]).expect("to a string");
    }
    let path = folder.path().join("grid.obj");
    std::fs::write(&path, text).expect("written");
    path
}

#[test]
fn a_mesh_larger_than_a_buffer_has_lines_in_the_window() {
    /// Enough for the window itself.
    const GRANTED: u64 = 2 << 20;
    let Some((device, queue)) = small_device(GRANTED) else {
        return;
    };
    let gpu = gpu().expect("there is one");
    let folder = tempfile::tempdir().expect("a folder");
    let file = grid(&folder, 420);
    let setup = WgpuSetup::Existing(WgpuSetupExisting {
        instance: gpu.instance.clone(),
        adapter: gpu.adapter.clone(),
        device,
        queue,
    });
    let mut window = app_on(setup, Some(file), egui::vec2(800.0, 600.0), 1.0);
    wait(&mut window, "the file", |app| {
        app.document().name() == "grid.obj"
    });
    let positions = window
        .state()
        .document()
        .loaded
        .scene
        .mesh()
        .positions()
        .len();
    assert!((12 * positions) as u64 > GRANTED);
    press(&mut window, Key::W);
    wait(&mut window, "the lines", App::is_settled);
    assert!(window.state().settings().overlays.is_on(&WIREFRAME));
    assert_eq!(window.state().notice(), None);
    assert_eq!(window.state().graphics_errors(), 0);
}
