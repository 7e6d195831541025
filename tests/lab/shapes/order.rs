//! The nearest of primitives of several shapes that coincide or touch where a ray crosses them.

use super::frame::{Frame, triple};
use super::{ray_count, sum_over};
use glam::Vec3;
use hitscope_core::kernel::{KernelTable as _, Tier};
use hitscope_core::mesh::{Runs, TriangleMesh, shapes::soup};
use hitscope_core::progress::Progress;
use hitscope_core::random::Random;
use hitscope_core::scene::SceneOptions;
use hitscope_core::shape::{
    Cone, Cuboid, Cylinder, Disk, Plane, Quadric, Rectangle, Span, Sphere, Torus, Triangle,
};
use hitscope_core::{Ray, Scene};
use hitscope_lab::measure::shapes::Sampled;
use hitscope_lab::oracle::ExactT;
use std::cmp::Ordering;

type FirstCrossing = Box<dyn Fn(&Ray) -> Option<ExactT>>;
type Adder = Box<dyn Fn(&mut Groups)>;

/// A scene of several groups, and the first exact crossing of each primitive in their order.
struct Groups {
    scene: Scene,
    crossings: Vec<FirstCrossing>,
}

impl Groups {
    fn of_triangles(triangles: &[[Vec3; 3]]) -> Self {
        let mesh = if triangles.is_empty() {
            TriangleMesh::default()
        } else {
            soup(triangles)
        };
        let mut groups = Self {
            scene: hitscope_core::scene::scene(mesh),
            crossings: Vec::new(),
        };
        triangles
            .iter()
            .for_each(|&corners| groups.expect(Triangle(corners)));
        groups
    }

    fn expect<S: Sampled>(&mut self, shape: S) {
        let crossing = move |ray: &Ray| {
            let first = shape.crossings(ray).into_iter().next();
            first.filter(|t| t.clone().to_f32() < f32::MAX)
        };
        self.crossings.push(Box::new(crossing));
    }

    fn add<S: Sampled>(&mut self, shapes: Vec<S>) {
        shapes.iter().for_each(|shape| self.expect(shape.clone()));
        let options = SceneOptions::default();
        let added = self
            .scene
            .add_group(shapes, Runs::default(), options, &Progress::default());
        added.expect("nobody cancels");
    }

    /// The lowest of the primitives that the ray crosses first, and whether others are crossed at the same t.
    fn nearest(&self, ray: &Ray) -> Option<(u32, f32, bool)> {
        let mut nearest: Option<(u32, ExactT, bool)> = None;
        for (primitive, crossing) in (0..).zip(&self.crossings) {
            let Some(mut t) = crossing(ray) else { continue };
            let order = nearest
                .as_mut()
                .map_or(Ordering::Less, |(_, first, _)| t.compare(first));
            match (order, &mut nearest) {
                (Ordering::Equal, Some((_, _, is_tie))) => *is_tie = true,
                (Ordering::Less, _) => nearest = Some((primitive, t, false)),
                _ => {}
            }
        }
        nearest.map(|(primitive, mut t, is_tie)| (primitive, t.to_f32(), is_tie))
    }
}

/// Groups of flat shapes and boxes that touch the ball of radius c.
fn flat_groups(frame: &Frame, c: i32) -> [Adder; 4] {
    let axes = [[c, 0, 0], [0, c, 0], [0, 0, c]].map(|v| frame.vector(v));
    let (centre, high) = (frame.point([0; 3]), frame.point([0, 0, c]));
    let normal = frame.vector([0, 0, 1]);
    let top = Span {
        centre: high,
        u: axes[0],
        v: axes[1],
    };
    [
        Box::new(move |groups| groups.add(vec![Disk(top), Disk(top)])),
        Box::new(move |groups| groups.add(vec![Rectangle(top)])),
        Box::new(move |groups| {
            groups.add(vec![Plane {
                point: high,
                normal,
            }]);
        }),
        Box::new(move |groups| groups.add(vec![Cuboid { centre, axes }])),
    ]
}

/// Groups of curved shapes that coincide with the ball of radius c, or touch it.
fn curved_groups(frame: &Frame, c: i32) -> [Adder; 5] {
    let (centre, unit) = (frame.point([0; 3]), frame.vector([0, 0, 1]));
    let (low, high) = (frame.point([0, 0, -c]), frame.point([0, 0, c]));
    let radius = frame.length(c);
    let (half, tube) = (radius / 2.0, radius / 4.0);
    let ball = Sphere { centre, radius };
    [
        Box::new(move |groups| groups.add(vec![ball, ball])),
        Box::new(move |groups| {
            let cylinder = |is_capped| Cylinder {
                p0: low,
                p1: high,
                radius,
                is_capped,
            };
            groups.add(vec![cylinder(true), cylinder(false)]);
        }),
        Box::new(move |groups| {
            let cone = |p0, p1| Cone {
                p0,
                p1,
                radius,
                is_capped: true,
            };
            groups.add(vec![cone(centre, high), cone(high, centre)]);
        }),
        Box::new(move |groups| {
            let squared = radius * radius;
            let coefficients = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -squared];
            groups.add(vec![Quadric {
                coefficients,
                centre,
                half: Vec3::splat(radius),
            }]);
        }),
        Box::new(move |groups| {
            // The outer equator, and the inner one.
            let torus = |major, minor| Torus {
                centre,
                axis: unit,
                major,
                minor,
            };
            groups.add(vec![torus(radius - tube, tube), torus(radius + half, half)]);
            groups.add(vec![torus(radius - tube, tube)]);
        }),
    ]
}

/// Shapes about the ball of radius c that coincide with it, with each other, or touch them.
fn touching(random: &mut Random, frame: &Frame, c: i32) -> Groups {
    let corners = [[-2 * c, -c, c], [2 * c, -c, c], [0, 2 * c, c]].map(|p| frame.point(p));
    let is_there = random.index(2) == 0;
    let mut groups = Groups::of_triangles(if is_there {
        &[]
    } else {
        std::slice::from_ref(&corners)
    });
    let mut adders: Vec<Adder> = Vec::new();
    adders.extend(flat_groups(frame, c));
    adders.extend(curved_groups(frame, c));
    // Some of the groups, in any order.
    while adders.len() > 3 {
        let adder = adders.swap_remove(random.index(adders.len()));
        adder(&mut groups);
    }
    groups
}

/// A ray through a point where shapes touch, or one with small integers.
fn ray_at(random: &mut Random, frame: &Frame, [a, b, c]: [i32; 3]) -> Ray {
    let places = [
        [a, b, 0],
        [c, 0, 0],
        [0, c, 0],
        [0, 0, c],
        [a, b, c],
        [c, c, c],
        [0, 0, 0],
        [a, 0, b],
    ];
    let mut small = || random.index(2 * c as usize + 1) as i32 - c;
    let (mut through, mut dir) = ([small(), small(), small()], [small(), small(), small()]);
    if random.index(4) > 0 {
        through = places[random.index(places.len())];
    }
    if random.index(3) == 0 {
        // Towards the axis or along an axis.
        dir = [[-a, -b, 0], [0, 0, -1], [-b, a, 0], [0, 0, 1]][random.index(4)];
    }
    if dir == [0; 3] {
        dir = [0, 0, -1];
    }
    frame.ray(through, dir, random.index(7) as i32)
}

#[test]
fn the_nearest_of_touching_primitives_of_several_groups_is_that_of_the_oracle() {
    const RAYS_PER_SCENE: u64 = 128;
    let scenes = ray_count().div_ceil(RAYS_PER_SCENE);
    let ties = std::sync::atomic::AtomicU64::new(0);
    let hits = sum_over(scenes, |number| {
        let mut random = Random::new(number);
        let frame = Frame::random(&mut random);
        let circle = triple(&mut random);
        let groups = touching(&mut random, &frame, circle[2]);
        let intersector = groups.scene.intersector(Sphere::kernel_of(Tier::Exact));
        let mut hits = 0;
        for _ in 0..RAYS_PER_SCENE {
            let ray = ray_at(&mut random, &frame, circle);
            let expected = groups.nearest(&ray);
            let found = intersector
                .closest_hit(&ray)
                .map(|hit| (hit.primitive, hit.t));
            let nearest = expected.map(|(primitive, t, _)| (primitive, t));
            assert_eq!(found, nearest, "scene {number} of {circle:?}: {ray:?}");
            assert_eq!(intersector.any_hit(&ray), found.is_some(), "{ray:?}");
            hits += u64::from(found.is_some());
            let is_tie = expected.is_some_and(|(.., is_tie)| is_tie);
            ties.fetch_add(is_tie.into(), std::sync::atomic::Ordering::Relaxed);
        }
        hits
    });
    let (n, ties) = (scenes * RAYS_PER_SCENE, ties.into_inner());
    eprintln!("{n} rays, {hits} hits, {ties} of them ties, 0 wrong");
    assert!(ties > n / 20, "{ties}");
}
