//! Normals as lines. Their length is the mesh's radius; the style shortens them.

use super::shapes;
use crate::gpu::lines::Line;
use glam::Vec3;
use hitscope_core::Scene;
use hitscope_core::scene::Shading;

/// Normals of the faces for flat shading, of the vertices for smooth shading.
pub fn lines(scene: &Scene, shading: Shading) -> Vec<Line> {
    let length = scene.bounds().radius() as f32;
    let line = |start: Vec3, normal: Vec3, gap: Vec3| Line {
        start,
        end: start + normal * length,
        gap,
    };
    let mut all = of_mesh(scene, shading, line);
    all.extend(shapes::normals(scene));
    all
}

fn of_mesh(scene: &Scene, shading: Shading, line: impl Fn(Vec3, Vec3, Vec3) -> Line) -> Vec<Line> {
    let mesh = scene.mesh();
    match shading {
        Shading::Flat => (0..mesh.triangles().len() as u32)
            .map(|triangle| {
                let [a, b, c] = mesh.corners(triangle);
                let middle = a / 3.0 + b / 3.0 + c / 3.0;
                line(middle, mesh.geometric_normal(triangle), 0.5 * (b - a))
            })
            .collect(),
        Shading::Smooth | Shading::Spherical => {
            let normals = scene.vertex_normals();
            let mut corners: Vec<(u32, [u32; 3], u32, usize)> = Vec::new();
            for (triangle, vertices) in mesh.triangles().iter().enumerate() {
                let normal = normals.of_triangle(mesh, triangle as u32);
                for k in 0..3 {
                    let bits = normal[k].to_array().map(f32::to_bits);
                    corners.push((vertices[k], bits, triangle as u32, k));
                }
            }
            // One line per distinct normal of a vertex.
            corners.sort_unstable();
            corners.dedup_by_key(|(vertex, normal, ..)| (*vertex, *normal));
            let from_corner = |&(_, normal, triangle, k): &(u32, [u32; 3], u32, usize)| {
                let p = mesh.corners(triangle);
                let normal = Vec3::from_array(normal.map(f32::from_bits));
                line(p[k], normal, p[(k + 1) % 3] - p[k])
            };
            corners.iter().map(from_corner).collect()
        }
    }
}
