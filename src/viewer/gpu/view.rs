//! The camera as a uniform of the shaders.

use super::{uniform_group, uniform_layout};
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, DVec4, Mat4, UVec2, Vec2, Vec3};
use hitscope_core::camera::Projection;
use hitscope_core::plan::PixelRect;
use hitscope_core::{Aabb, Camera, Clip};
use hitscope_lab::commands::MAX_OVERLAY_PLANES;

/// The part that all shaders share.
pub const SHADER: &str = include_str!("../../../shaders/view.wgsl");

/// A plane that keeps every point: no normal, and the largest offset.
const KEEPS_ALL: [f32; 4] = [0.0, 0.0, 0.0, f32::MAX];

/// Twin of `View` in shaders/view.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct ViewUniform {
    clip_from_eye: [[f32; 4]; 4],
    eye: [f32; 3],
    near_w: f32,
    viewport: [f32; 2],
    padding: [f32; 2],
    /// Normal and offset of each half-space of the clip, then [`KEEPS_ALL`].
    planes: [[f32; 4]; MAX_OVERLAY_PLANES],
}

impl ViewUniform {
    /// Offsets of the members, for the test that compares them with WGSL's.
    #[cfg(test)]
    pub(super) const OFFSETS: [usize; 5] = [
        std::mem::offset_of!(Self, clip_from_eye),
        std::mem::offset_of!(Self, eye),
        std::mem::offset_of!(Self, near_w),
        std::mem::offset_of!(Self, viewport),
        std::mem::offset_of!(Self, planes),
    ];

    /// The uniform for a camera and a scene with these bounds.
    pub fn new(camera: &Camera, bounds: &Aabb) -> Self {
        Self::with_lines(camera, bounds, &Aabb::EMPTY)
    }

    /// The uniform for a camera, a scene with these bounds, and lines that leave them for other bounds.
    ///
    /// A scene without bounds, such as a plane alone, counts as the unit sphere about the origin.
    pub fn with_lines(camera: &Camera, bounds: &Aabb, lines: &Aabb) -> Self {
        let eye = camera.eye().as_dvec3();
        let reach_of = |bounds: &Aabb| {
            (!bounds.is_empty())
                .then(|| (bounds.centre().as_dvec3() - eye).length() + bounds.radius())
        };
        let reach = reach_of(bounds).unwrap_or_else(|| eye.length() + 1.0);
        let far = reach_of(lines).map_or(reach, |lines| reach.max(lines));
        // Reversed float depth stays precise for any near plane. This plane is so near that an f32 can't
        // distinguish a nearer point from the eye. Orthographic rays start at the eye's plane.
        let (near, near_w) = match camera.projection() {
            Projection::Perspective { .. } => (1e-6 * reach, 1e-6 * reach),
            Projection::Orthographic { .. } => (0.0, 0.0),
        };
        let clip_from_eye = camera.clip_from_eye(near, far);
        Self {
            clip_from_eye: clip_from_eye.as_mat4().to_cols_array_2d(),
            eye: camera.eye().to_array(),
            near_w: near_w as f32,
            viewport: camera.resolution().as_vec2().to_array(),
            padding: [0.0; 2],
            planes: [KEEPS_ALL; MAX_OVERLAY_PLANES],
        }
    }

    /// The same uniform with a clip in the scene's coordinates, of which the first [`MAX_OVERLAY_PLANES`] planes count.
    #[must_use]
    pub fn clipped(mut self, clip: Option<&Clip>) -> Self {
        let half_spaces = clip.map_or(&[][..], Clip::half_spaces);
        let eye = Vec3::from_array(self.eye).as_dvec3();
        self.planes = [KEEPS_ALL; MAX_OVERLAY_PLANES];
        for (plane, half_space) in self.planes.iter_mut().zip(half_spaces) {
            /// Rounding of f32 in the shader, relative to the products that it adds.
            const ROUNDING: f64 = 8.0 / (1 << 24) as f64;
            let size = half_space.normal().abs().dot(eye.abs()) + half_space.offset().abs();
            let rounding = ROUNDING * size;
            let normal = half_space.normal().as_vec3();
            *plane = normal
                .extend((half_space.offset_near(eye) + rounding) as f32)
                .to_array();
        }
        self
    }

    /// The view of a part of the picture, as a picture of its own.
    #[must_use]
    pub fn of_part(mut self, part: PixelRect) -> Self {
        let whole = Vec2::from_array(self.viewport).as_dvec2();
        let (min, size) = (part.min.as_dvec2(), (part.max - part.min).as_dvec2());
        let scale = whole / size;
        // Clip coordinates of the part are those of the whole picture, scaled and shifted. y points up, pixel rows
        // down.
        let shift_x = (whole.x - 2.0 * min.x - size.x) / size.x;
        let shift_y = (size.y - whole.y + 2.0 * min.y) / size.y;
        for column in &mut self.clip_from_eye {
            let [x, y, _, w] = column.map(f64::from);
            column[0] = (x * scale.x + w * shift_x) as f32;
            column[1] = (y * scale.y + w * shift_y) as f32;
        }
        self.viewport = size.as_vec2().to_array();
        self
    }

    /// Whether there is a clip.
    pub fn is_clipped(&self) -> bool {
        self.planes[0] != KEEPS_ALL
    }

    /// The reversed depth of a point.
    pub fn depth_of(&self, position: DVec3) -> f32 {
        let from_eye = position - Vec3::from_array(self.eye).as_dvec3();
        let clip = Mat4::from_cols_array_2d(&self.clip_from_eye).as_dmat4();
        let DVec4 { z, w, .. } = clip * from_eye.extend(1.0);
        (z / w) as f32
    }

    /// Width and height of the picture.
    pub fn size(&self) -> UVec2 {
        UVec2::from_array(self.viewport.map(|x| x as u32))
    }
}

/// The uniform on the GPU, as group 0 of every pipeline.
pub struct ViewBinding {
    layout: wgpu::BindGroupLayout,
    buffer: wgpu::Buffer,
    group: wgpu::BindGroup,
}

impl ViewBinding {
    /// Creates the buffer; [`upload`](Self::upload) fills it.
    pub fn new(device: &wgpu::Device) -> Self {
        let layout = uniform_layout(device, "view");
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("view"),
            size: size_of::<ViewUniform>() as u64,
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let group = uniform_group(device, "view", &layout, &buffer);
        Self {
            layout,
            buffer,
            group,
        }
    }

    /// Sets the view for later submissions.
    pub fn upload(&self, queue: &wgpu::Queue, view: &ViewUniform) {
        queue.write_buffer(&self.buffer, 0, bytemuck::bytes_of(view));
    }

    /// The bind group's layout.
    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    /// The bind group.
    pub fn group(&self) -> &wgpu::BindGroup {
        &self.group
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(projection: Projection) -> Camera {
        let (eye, size) = (DVec3::new(0.0, 0.0, 10.0), UVec2::new(64, 48));
        Camera::look_at(eye, DVec3::ZERO, DVec3::Y, projection, size).expect("a camera")
    }

    #[test]
    fn lines_far_behind_the_scene_have_a_depth_and_do_not_move_the_near_plane() {
        let perspective = camera(Projection::Perspective { fov_y_radians: 0.7 });
        let orthographic = camera(Projection::Orthographic { height: 4.0 });
        let scene = Aabb::around([Vec3::NEG_ONE, Vec3::ONE]);
        let far = Vec3::new(0.0, 0.0, -500.0);
        let lines = Aabb::around([far, Vec3::ZERO]);
        let without = ViewUniform::new(&orthographic, &scene);
        assert!(
            without.depth_of(far.as_dvec3()) < 0.0,
            "behind the far plane"
        );
        let with = ViewUniform::with_lines(&orthographic, &scene, &lines);
        assert!(with.depth_of(0.98 * far.as_dvec3()) > 0.0);
        assert_eq!(with.near_w, without.near_w);
        let with = ViewUniform::with_lines(&perspective, &scene, &lines);
        assert_eq!(with, ViewUniform::new(&perspective, &scene));
    }

    #[test]
    fn a_scene_without_bounds_has_a_view() {
        for projection in [
            Projection::Perspective { fov_y_radians: 0.7 },
            Projection::Orthographic { height: 4.0 },
        ] {
            let view = ViewUniform::new(&camera(projection), &Aabb::EMPTY);
            let depth = view.depth_of(DVec3::ZERO);
            assert!(depth > 0.0 && depth < 1.0, "{depth}");
        }
    }
}
