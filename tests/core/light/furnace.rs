//! Closed rooms whose walls emit light and reflect a part ρ of what arrives: L = Le/(1 − ρ) everywhere.

use super::{Estimate, lit, path_count};
use glam::Vec3;
use hitscope_core::mesh::shapes::{Placement, sphere};
use hitscope_core::mesh::{Assigned, Attributes, Material, Runs};
use hitscope_core::progress::Progress;
use hitscope_core::scene::{SceneOptions, scene};
use hitscope_core::shape::{AxisBox, Sphere};
use hitscope_core::{Ray, Scene, TriangleMesh};

fn emitting(reflectance: f32) -> Attributes {
    let material = Material {
        diffuse: Some(Vec3::splat(reflectance)),
        emission: Vec3::ONE,
        ..Material::default()
    };
    Attributes {
        materials: Assigned::new(vec![material], Runs::default()),
        ..Attributes::default()
    }
}

fn rooms(reflectance: f32) -> Vec<(&'static str, Scene)> {
    let placed = Placement::UNIT;
    let of_triangles = scene(sphere(4, placed).with_attributes(emitting(reflectance)));
    let of = |add: &dyn Fn(&mut Scene)| {
        let mut room = scene(TriangleMesh::default().with_attributes(emitting(reflectance)));
        add(&mut room);
        room
    };
    let ball = Sphere {
        centre: Vec3::new(0.1, 0.0, 0.0),
        radius: 2.0,
    };
    let cube = AxisBox {
        min: Vec3::splat(-1.0),
        max: Vec3::new(1.0, 2.0, 3.0),
    };
    let (options, progress) = (SceneOptions::default(), Progress::default());
    vec![
        ("triangles", of_triangles),
        (
            "sphere",
            of(&|room| {
                let added = room.add_group(vec![ball], Runs::default(), options, &progress);
                added.expect("nobody cancels");
            }),
        ),
        (
            "box",
            of(&|room| {
                let added = room.add_group(vec![cube], Runs::default(), options, &progress);
                added.expect("nobody cancels");
            }),
        ),
    ]
}

#[test]
fn the_light_in_a_closed_room_is_that_of_the_geometric_series() {
    for reflectance in [0.0, 0.5, 0.9] {
        for (name, room) in rooms(reflectance) {
            let context = lit(room, Vec::new());
            let ray =
                Ray::new(Vec3::new(0.1, 0.2, -0.1), Vec3::new(0.3, -0.5, 0.8)).expect("a ray");
            eprintln!("{name}, ρ = {reflectance}");
            let expected = 1.0 / (1.0 - f64::from(reflectance));
            Estimate::of_ray(&context, "path", path_count(), ray).require(expected);
        }
    }
}
