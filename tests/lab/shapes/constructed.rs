//! Rays that are exactly tangent, or exactly on an edge, a rim or a corner, in integers.

use super::frame::{Frame, triple};
use super::{ray_count, sum_over};
use hitscope_core::Ray;
use hitscope_core::kernel::Tier;
use hitscope_core::random::Random;
use hitscope_core::shape::{Cone, Cuboid, Cylinder, Sphere, Torus};
use hitscope_lab::measure::shapes::Sampled;
use hitscope_lab::oracle::ExactT;

/// The exact kernel and the oracle find these t and no others. The kernel's come one by one.
fn crosses_at<S: Sampled>(ray: &Ray, shape: &S, expected: &[f32]) {
    let mut of_oracle = shape.crossings(ray);
    let of_oracle: Vec<f32> = of_oracle.iter_mut().map(ExactT::to_f32).collect();
    assert_eq!(of_oracle, expected, "oracle: {shape:?} {ray:?}");
    let mut rest = *ray;
    for &t in expected {
        let found = S::kernel_of(Tier::Exact).intersect(&rest, shape.clone());
        assert_eq!(found.map(|hit| hit.t), Some(t), "{shape:?} {rest:?}");
        rest.t_min = t;
    }
    let found = S::kernel_of(Tier::Exact).intersect(&rest, shape.clone());
    assert_eq!(found, None, "{shape:?} {rest:?}");
}

fn for_each_case(check: impl Fn(&mut Random, &Frame) + Send + Sync) {
    sum_over(ray_count(), |number| {
        let mut random = Random::new(number);
        let frame = Frame::random(&mut random);
        check(&mut random, &frame);
        1
    });
}

#[test]
fn an_exact_tangent_of_a_sphere_or_a_cylinder_hits_it_once() {
    for_each_case(|random, frame| {
        // (a, b) on the circle of radius c, with the tangent (−b, a).
        let [a, b, c] = triple(random);
        let steps = 1 + random.index(6) as i32;
        let height = random.index(40) as i32;
        let ball = Sphere {
            centre: frame.point([0; 3]),
            radius: frame.length(c),
        };
        let ray = frame.ray([a, b, 0], [-b, a, random.index(9) as i32 - 4], steps);
        crosses_at(&ray, &ball, &[steps as f32]);
        for is_capped in [false, true] {
            let cylinder = Cylinder {
                p0: frame.point([0; 3]),
                p1: frame.point([0, 0, 29]),
                radius: frame.length(c),
                is_capped,
            };
            let ray = frame.ray([a, b, height], [-b, a, random.index(9) as i32 - 4], steps);
            let is_beside = height <= 29;
            let expected = [steps as f32];
            crosses_at(&ray, &cylinder, if is_beside { &expected } else { &[] });
        }
    });
}

#[test]
fn an_exact_tangent_of_a_cone_hits_it_once() {
    for_each_case(|random, frame| {
        // At half the height the radius is half of that of the base.
        let [a, b, c] = triple(random);
        let cone = Cone {
            p0: frame.point([0; 3]),
            p1: frame.point([0, 0, 8]),
            radius: frame.length(2 * c),
            is_capped: random.index(2) == 0,
        };
        let steps = 1 + random.index(6) as i32;
        // Horizontal, so that it touches a circle; a tangent plane also contains the line to the apex.
        let ray = frame.ray([a, b, 4], [-b, a, 0], steps);
        crosses_at(&ray, &cone, &[steps as f32]);
        // Through the apex from the side.
        let ray = frame.ray([0, 0, 8], [a, b, 0], steps);
        crosses_at(&ray, &cone, &[steps as f32]);
        // Along a line of the surface, which counts as a miss of the side; the cap's rim is hit.
        let ray = frame.ray([2 * a, 2 * b, 0], [-a, -b, 4], steps);
        let rim = [steps as f32];
        crosses_at(&ray, &cone, if cone.is_capped { &rim } else { &[] });
    });
}

#[test]
fn exact_tangents_of_a_torus_touch_its_equators_and_its_top() {
    for_each_case(|random, frame| {
        let [a, b, c] = triple(random);
        let minor = 1 + random.index(c as usize - 1) as i32;
        let steps = 1 + random.index(6) as i32;
        let torus = |major: i32| Torus {
            centre: frame.point([0; 3]),
            axis: frame.vector([0, 0, 1]),
            major: frame.length(major),
            minor: frame.length(minor),
        };
        // The outer equator has the radius c.
        if c - minor > minor {
            let outer = frame.ray([a, b, 0], [-b, a, 0], steps);
            crosses_at(&outer, &torus(c - minor), &[steps as f32]);
            let upwards = frame.ray([a, b, 0], [0, 0, 1], steps);
            crosses_at(&upwards, &torus(c - minor), &[steps as f32]);
        }
        // The inner equator has the radius c: along the axis the ray touches it from inside.
        let inner = frame.ray([a, b, 0], [0, 0, 1], steps);
        crosses_at(&inner, &torus(c + minor), &[steps as f32]);
        // Across the top circle, of radius c, which the ray touches on either side.
        let over = frame.ray([-a, -b, minor], [a, b, 0], steps);
        crosses_at(&over, &torus(c), &[steps as f32, (steps + 2) as f32]);
    });
}

#[test]
fn rays_through_edges_and_corners_of_a_box_hit_it_once() {
    for_each_case(|random, frame| {
        let half = [(); 3].map(|()| 1 + random.index(40) as i32);
        let cuboid = Cuboid {
            centre: frame.point([0; 3]),
            axes: [[half[0], 0, 0], [0, half[1], 0], [0, 0, half[2]]].map(|v| frame.vector(v)),
        };
        let signs = [(); 3].map(|()| [-1, 1][random.index(2)]);
        let steps = 1 + random.index(6) as i32;
        let corner = std::array::from_fn(|k| signs[k] * half[k]);
        // Into the octants beside the box: the ray meets the corner alone.
        let mut out = [0; 3].map(|_: i32| 1 + random.index(9) as i32);
        let (inwards, outwards) = (random.index(3), random.index(2));
        out[inwards] = -out[inwards];
        if outwards == 0 {
            out[(inwards + 1) % 3] = 0;
        }
        let dir = std::array::from_fn(|k| signs[k] * out[k]);
        crosses_at(&frame.ray(corner, dir, steps), &cuboid, &[steps as f32]);
        // Along an edge, which lies in two faces: the two others are crossed at its ends.
        let axis = random.index(3);
        let mut along = [0; 3];
        along[axis] = -2 * signs[axis] * half[axis];
        let ends = [steps as f32, steps as f32 + 1.0];
        crosses_at(&frame.ray(corner, along, steps), &cuboid, &ends);
        // Over an edge, in the plane of one face.
        let mut edge: [i32; 3] = corner;
        edge[axis] = 0;
        let mut over = [0; 3];
        over[(axis + 1) % 3] = signs[(axis + 1) % 3];
        over[(axis + 2) % 3] = -signs[(axis + 2) % 3];
        crosses_at(&frame.ray(edge, over, steps), &cuboid, &[steps as f32]);
    });
}

#[test]
fn rays_through_the_rim_of_a_cylinder_hit_it() {
    for_each_case(|random, frame| {
        let [a, b, c] = triple(random);
        let steps = 1 + random.index(6) as i32;
        for is_capped in [false, true] {
            let cylinder = Cylinder {
                p0: frame.point([0; 3]),
                p1: frame.point([0, 0, 7]),
                radius: frame.length(c),
                is_capped,
            };
            // Across the plane of the top, whose rim is crossed twice; a ray in the cap misses the cap.
            let across = frame.ray([a, b, 7], [-2 * a, -2 * b, 0], steps);
            crosses_at(&across, &cylinder, &[steps as f32, steps as f32 + 1.0]);
            // From outside over the rim, upwards.
            let over = frame.ray([a, b, 7], [-a, -b, 1 + random.index(9) as i32], steps);
            crosses_at(&over, &cylinder, &[steps as f32]);
            // Along the side: only the caps' rims are hit.
            let along = frame.ray([a, b, 0], [0, 0, 7], steps);
            let rims = [steps as f32, steps as f32 + 1.0];
            crosses_at(&along, &cylinder, if is_capped { &rims } else { &[] });
        }
    });
}
