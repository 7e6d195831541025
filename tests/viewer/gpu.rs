//! Tests of the overlay in slices and on a GPU with small buffers.

use crate::harness::{app_on, gpu, press, wait};
use eframe::egui_wgpu::{WgpuSetup, WgpuSetupExisting};
use egui::Key;
use glam::{DVec3, UVec2, Vec3};
use hitscope::gpu::GpuError;
use hitscope::gpu::depth::DepthMesh;
use hitscope::gpu::drawing::{Canvas, Drawing, DrawingState, DrawnLines, Overlay, Paces, Targets};
use hitscope::gpu::lines::{Line, LineOcclusion, LineSet, StyleUniform};
use hitscope::gpu::slices::Pace;
use hitscope::gpu::view::ViewUniform;
use hitscope::offscreen::read_back;
use hitscope::overlay::wireframe::{self, WIREFRAME, WireframeEdges};
use hitscope_core::camera::{Camera, Projection};
use hitscope_core::mesh::shapes::{Placement, flat_grid, sphere};
use hitscope_core::scene::Scene;
use hitscope_core::scene::scene;
use std::cell::Cell;
use std::fmt::Write as _;
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Duration;

const STYLE: StyleUniform = StyleUniform {
    colour: [0.9, 0.4, 0.1, 0.7],
    half_width_px: 0.8,
    stretch: 1.0,
    fade: 1.0,
    is_cut: 1.0,
};

/// A device of the shared adapter with this limit on buffer sizes. It is never closed.
fn small_device(max_buffer_size: u64) -> Option<(wgpu::Device, wgpu::Queue)> {
    let limits = wgpu::Limits {
        max_buffer_size,
        ..wgpu::Limits::default()
    };
    let descriptor = wgpu::DeviceDescriptor {
        required_limits: limits,
        ..wgpu::DeviceDescriptor::default()
    };
    let made = pollster::block_on(gpu()?.adapter.request_device(&descriptor));
    let (device, queue) = made.expect("the adapter gives another device");
    std::mem::forget((device.clone(), queue.clone()));
    Some((device, queue))
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
        occlusion,
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
        targets: Arc::new(Targets::new(device, drawing.view.size())),
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
fn lines_are_split_across_buffers_and_a_mesh_that_needs_a_larger_buffer_is_refused() {
    const GRANTED: u64 = 128 << 10;
    let Some((device, queue)) = small_device(GRANTED) else {
        return;
    };
    // The vertices fit into one buffer, the lines don't.
    let small = scene(sphere(24, Placement::UNIT));
    let lines = wireframe::lines(&small, WireframeEdges::Triangles);
    assert!(size_of_val(lines.as_slice()) as u64 > 2 * GRANTED);
    let cut = drawing(&device, &queue, &small, &lines).expect("in several buffers");
    let shared = gpu().expect("there is one");
    let whole = drawing(&shared.device, &shared.queue, &small, &lines).expect("in one buffer");
    let (cut, _) = draw(&device, &queue, &cut, Paces::UNLIMITED);
    let (whole, _) = draw(&shared.device, &shared.queue, &whole, Paces::UNLIMITED);
    assert!(cut == whole);

    let large = scene(flat_grid(110, Placement::UNIT));
    let needed = size_of_val(large.mesh().positions()) as u64;
    let refused = DepthMesh::new(&device, &queue, &large).err();
    assert!(
        matches!(refused, Some(GpuError::TooLarge { needed: n, granted: GRANTED }) if n == needed),
        "{refused:?}"
    );
    let none = small_device(32).expect("there is a GPU");
    let line = Line {
        start: Vec3::ZERO,
        end: Vec3::X,
        gap: Vec3::ZERO,
    };
    let refused = LineSet::new(&none.0, &none.1, &[line]).err();
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
fn a_mesh_too_large_for_the_gpu_is_traced_with_a_message_that_there_is_no_overlay() {
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
    press(&mut window, Key::W);
    let refusal = "the overlay needs a buffer of 2126892 bytes; this GPU allows 2097152";
    wait(&mut window, "the refusal", |app| {
        app.notice() == Some(refusal)
    });
    assert!(!window.state().settings().overlays.is_on(&WIREFRAME));
    press(&mut window, Key::Escape);
    wait(&mut window, "the picture", |app| app.film().samples() > 0);
    assert_eq!(window.state().notice(), None, "shown once");
}
