//! Combined solids.

mod coincidence;
mod groups;
mod intervals;

use glam::Vec3;
use hitscope_core::group::Solid;
use hitscope_core::kernel::Tier;
use hitscope_core::mesh::{Runs, TriangleMesh};
use hitscope_core::progress::Progress;
use hitscope_core::scene::scene;
use hitscope_core::shape::Cuboid;
use hitscope_core::{Intersector, Ray, Scene};

fn scene_of(solids: Vec<Solid>) -> Scene {
    let mut scene = scene(TriangleMesh::default());
    let added = scene.add_solids(solids, Runs::default(), &Progress::default());
    added.expect("nobody cancels");
    scene
}

fn intersector(scene: &Scene, tier: Tier) -> Box<dyn Intersector> {
    let kernel = hitscope_core::group::kernel_named(tier.name());
    scene.intersector(kernel.expect("a tier"))
}

fn cube(min: Vec3, max: Vec3) -> Cuboid {
    let half = 0.5 * (max - min);
    Cuboid {
        centre: 0.5 * (min + max),
        axes: [half.x * Vec3::X, half.y * Vec3::Y, half.z * Vec3::Z],
    }
}

/// t of all crossings.
fn crossings(intersector: &dyn Intersector, origin: [f32; 3], dir: [f32; 3]) -> Vec<f32> {
    let ray = Ray::new(origin.into(), dir.into()).expect("a ray");
    let hits = intersector.all_hits(&ray);
    hits.iter().map(|crossing| crossing.hit.t).collect()
}
