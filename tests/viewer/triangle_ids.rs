//! Comparison of rasterized and traced triangles, pixel by pixel.
//!
//! Triangle numbers are rasterized with the overlay's view and compared with the triangles that the
//! renderer's rays hit. They may differ only where a pixel's centre lies on an edge: GPUs snap
//! vertices to a grid of 1/256 pixel.

use crate::harness::{gpu, say};
use glam::{DVec2, DVec3, UVec2, Vec2, Vec3};
use hitscope::document::embedded_scene;
use hitscope::gpu::adapter::Gpu;
use hitscope::gpu::texture;
use hitscope::gpu::view::{self, ViewBinding, ViewUniform};
use hitscope::offscreen::read_back;
use hitscope_core::Scene;
use hitscope_core::camera::{Camera, Projection};
use hitscope_core::kernel::triangle_kernel;
use hitscope_core::obj::{LoadOptions, parse};
use hitscope_core::progress::Progress;
use std::path::Path;
use wgpu::util::DeviceExt as _;

const SIZE: UVec2 = UVec2::new(768, 480);
/// Vertices snap to 1/256 pixel on each axis; an edge moves by up to twice that, plus rounding in f32.
const ON_EDGE_PX: f64 = 4.0 / 256.0;

/// Appended to the overlay's view shader: draws each triangle in the colour of its number.
const SHADER: &str = "
struct Fragment { @builtin(position) position: vec4f, @location(0) @interpolate(flat) id: u32 };
@vertex fn vs_main(@location(0) position: vec3f, @builtin(vertex_index) index: u32) -> Fragment {
    return Fragment(clip_from_position(position), index / 3u + 1u);
}
@fragment fn fs_main(fragment: Fragment) -> @location(0) u32 { return fragment.id; }
";

/// A bumpy closed surface far from the origin.
fn far_blob() -> Scene {
    const RINGS: u32 = 60;
    let mut text = String::new();
    for i in 0..RINGS {
        for k in 0..RINGS {
            let (u, v) = (f64::from(i) * 0.1047, f64::from(k) * 0.1047);
            let r = 1.0 + 0.35 * v.cos() + 0.08 * (5.0 * u).sin() * (4.0 * v).cos();
            let p = [2e6 + r * u.cos(), -7e5 + r * u.sin(), 0.4 * v.sin()];
            text += &format!("v {} {} {}\n", p[0], p[1], p[2]);
        }
    }
    let at = |i: u32, k: u32| i % RINGS * RINGS + k % RINGS + 1;
    for i in 0..RINGS {
        for k in 0..RINGS {
            let quad = [at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)];
            text += &format!("f {} {} {} {}\n", quad[0], quad[1], quad[2], quad[3]);
        }
    }
    let progress = Progress::default();
    let library = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    let loaded = parse(
        text.as_bytes(),
        Path::new("blob"),
        LoadOptions::default(),
        &library,
        &progress,
    );
    Scene::new(loaded.expect("good").mesh, &progress).expect("never cancelled")
}

/// A camera for an overview, one close to the surface, and an orthographic one.
fn cameras(scene: &Scene) -> [Camera; 3] {
    let (middle, r) = (scene.bounds().centre().as_dvec3(), scene.bounds().radius());
    let perspective = Projection::Perspective { fov_y_radians: 0.7 };
    let orthographic = Projection::Orthographic { height: 1.7 * r };
    [
        (DVec3::new(1.3, 1.1, 2.4), DVec3::ZERO, perspective),
        (
            DVec3::new(-0.7, 0.5, 0.9),
            DVec3::new(0.1, 0.1, 0.0),
            perspective,
        ),
        (DVec3::new(2.0, 1.5, -1.7), DVec3::ZERO, orthographic),
    ]
    .map(|(eye, target, projection)| {
        let (eye, target) = (middle + r * eye, middle + r * target);
        Camera::look_at(eye, target, DVec3::Y, projection, SIZE).expect("good")
    })
}

/// The number of the triangle drawn at each pixel, counted from 1; 0 for none.
fn rasterized(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    scene: &Scene,
    camera: &Camera,
) -> Vec<u32> {
    let mesh = scene.mesh();
    let corners: Vec<Vec3> = (0..mesh.triangles().len() as u32)
        .flat_map(|t| mesh.corners(t))
        .collect();
    let vertices = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: None,
        contents: bytemuck::cast_slice(&corners),
        usage: wgpu::BufferUsages::VERTEX,
    });
    let view = ViewBinding::new(device);
    view.upload(queue, &ViewUniform::new(camera, &scene.bounds()));
    let target = |format, usage| {
        let usage = usage | wgpu::TextureUsages::RENDER_ATTACHMENT;
        texture(device, "ids", SIZE, format, usage)
    };
    let ids = target(wgpu::TextureFormat::R32Uint, wgpu::TextureUsages::COPY_SRC);
    let depth = target(
        wgpu::TextureFormat::Depth32Float,
        wgpu::TextureUsages::empty(),
    );
    let pipeline = pipeline(device, &view);
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let ids = ids.create_view(&wgpu::TextureViewDescriptor::default());
        let depth = depth.create_view(&wgpu::TextureViewDescriptor::default());
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &ids,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: wgpu::StoreOp::Discard,
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        });
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, view.group(), &[]);
        pass.set_vertex_buffer(0, vertices.slice(..));
        pass.draw(0..corners.len() as u32, 0..1);
    }
    queue.submit([encoder.finish()]);
    let pixels = read_back(device, queue, &ids).expect("read back");
    pixels.into_iter().map(u32::from_le_bytes).collect()
}

fn pipeline(device: &wgpu::Device, view: &ViewBinding) -> wgpu::RenderPipeline {
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(format!("{}\n{SHADER}", view::SHADER).into()),
    });
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(view.layout())],
        immediate_size: 0,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: None,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("vs_main"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            buffers: &[Some(wgpu::VertexBufferLayout {
                array_stride: size_of::<Vec3>() as u64,
                step_mode: wgpu::VertexStepMode::Vertex,
                attributes: &wgpu::vertex_attr_array![0 => Float32x3],
            })],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: wgpu::TextureFormat::Depth32Float,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("fs_main"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            targets: &[Some(wgpu::TextureFormat::R32Uint.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// The smallest distance from a pixel's centre to an edge of a triangle (counted from 1).
fn distance_to_edge(scene: &Scene, camera: &Camera, pixel: UVec2, id: u32) -> f64 {
    let Some(triangle) = id.checked_sub(1) else {
        return f64::INFINITY;
    };
    let corners = scene
        .mesh()
        .corners(triangle)
        .map(|p| camera.pixel_of(p.as_dvec3()));
    let [Some(a), Some(b), Some(c)] = corners else {
        return f64::INFINITY;
    };
    let centre = pixel.as_dvec2() + 0.5;
    let to_segment = |(p, q): (DVec2, DVec2)| {
        let along = q - p;
        let part = ((centre - p).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        (centre - p - part * along).length()
    };
    [(a, b), (b, c), (c, a)]
        .into_iter()
        .map(to_segment)
        .fold(f64::INFINITY, f64::min)
}

#[test]
fn rasterized_triangles_are_the_triangles_that_rays_hit() {
    let Some(Gpu { device, queue, .. }) = gpu() else {
        return;
    };
    let embedded = embedded_scene().scene;
    let blob = far_blob();
    for (name, scene) in [("embedded", &*embedded), ("far blob", &blob)] {
        let intersector = scene.intersector(triangle_kernel("watertight").expect("in the table"));
        for (view, camera) in cameras(scene).into_iter().enumerate() {
            let drawn = rasterized(device, queue, scene, &camera);
            let (mut covered, mut different) = (0, 0);
            for (i, drawn) in drawn.into_iter().enumerate() {
                let pixel = UVec2::new(i as u32 % SIZE.x, i as u32 / SIZE.x);
                let ray = camera.ray(pixel, Vec2::splat(0.5));
                let traced = intersector
                    .closest_hit(&ray)
                    .map_or(0, |hit| hit.primitive + 1);
                covered += u32::from(drawn != 0 || traced != 0);
                if drawn != traced {
                    different += 1;
                    let near = |id| distance_to_edge(scene, &camera, pixel, id);
                    let distance = near(drawn).min(near(traced));
                    assert!(
                        distance < ON_EDGE_PX,
                        "{name}, view {view}, pixel {pixel}: {drawn} drawn, {traced} traced, {distance} px from an edge"
                    );
                }
            }
            say(&format!(
                "{name}, view {view}: {different} of {covered} covered pixels differ"
            ));
            assert!(
                covered > SIZE.element_product() / 10,
                "{name}, view {view}: {covered}"
            );
            assert!(
                different * 1000 <= covered,
                "{name}, view {view}: {different} of {covered}"
            );
        }
    }
}
