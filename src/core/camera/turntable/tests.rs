//! Tests of turntable navigation.

use super::*;
use glam::Vec3;

pub(super) const SIZE: UVec2 = UVec2::new(800, 600);

/// Scenes of very different size, and one far from the mesh's origin.
pub(super) fn scenes() -> [Aabb; 5] {
    let cube = |size: f32, at: Vec3| Aabb::around([at, at + size]);
    [
        cube(1e-6, Vec3::ZERO),
        cube(1.0, Vec3::ZERO),
        cube(1e6, Vec3::ZERO),
        cube(100.0, Vec3::splat(1e7)),
        cube(1e30, Vec3::ZERO),
    ]
}

pub(super) fn pixel_of(turntable: &Turntable, point: DVec3) -> DVec2 {
    turntable.camera(SIZE).pixel_of(point).expect("in front")
}

/// A hundredth of a pixel, or what rounding the eye to f32 moves it by.
pub(super) fn tolerance(turntable: &Turntable) -> f64 {
    let place = turntable.camera(SIZE).eye().as_dvec3().abs().max_element();
    let pixel = turntable.height_at_pivot() / f64::from(SIZE.y);
    0.01 + place * f64::from(f32::EPSILON) / pixel
}

#[test]
fn framing_fits_the_whole_scene_to_the_picture() {
    for scene in scenes() {
        for orthographic in [false, true] {
            let mut turntable = Turntable::framing(scene, SIZE);
            turntable.is_orthographic = orthographic;
            let corners = corners(scene).into_iter();
            let pixels: Vec<DVec2> = corners.map(|p| pixel_of(&turntable, p)).collect();
            let inside = |p: &DVec2| p.cmpge(DVec2::ZERO).all() && p.cmple(SIZE.as_dvec2()).all();
            assert!(pixels.iter().all(inside), "{scene:?}: {pixels:?}");
            let heights = pixels.iter().map(|p| p.y);
            let spread =
                heights.clone().fold(f64::MIN, f64::max) - heights.fold(f64::MAX, f64::min);
            assert!(spread > 0.5 * f64::from(SIZE.y), "{spread}");
        }
    }
}

#[test]
fn zooming_keeps_the_point_under_the_cursor() {
    for scene in scenes() {
        for orthographic in [false, true] {
            let mut turntable = Turntable::framing(scene, SIZE);
            turntable.is_orthographic = orthographic;
            let cursor = DVec2::new(600.0, 150.0);
            let camera = turntable.camera(SIZE);
            let anchor = camera.on_plane_through(turntable.pivot, cursor);
            for factor in [0.8, 0.5, 0.1, 1.5, 20.0] {
                turntable.zoom(factor, anchor);
                let moved = (pixel_of(&turntable, anchor) - cursor).length();
                assert!(moved < tolerance(&turntable), "{scene:?} {factor}: {moved}");
            }
        }
    }
}

#[test]
fn centring_on_a_point_keeps_sizes_in_the_picture() {
    for scene in scenes() {
        for orthographic in [false, true] {
            let mut turntable = Turntable::framing(scene, SIZE);
            turntable.is_orthographic = orthographic;
            let corners = corners(scene);
            let (point, before) = (corners[6], turntable);
            turntable.centre_on(point);
            let middle = 0.5 * SIZE.as_dvec2();
            let off = (pixel_of(&turntable, point) - middle).length();
            assert!(off < tolerance(&turntable), "{scene:?}: {off}");
            let size_at = |turntable: &Turntable, p: DVec3| {
                let camera = turntable.camera(SIZE);
                camera.pixel_size_at(camera.depth_of(p))
            };
            for corner in corners {
                let (size, old_size) = (size_at(&turntable, corner), size_at(&before, corner));
                // The eye's place is rounded to f32, by a part of a pixel of each height of the picture.
                let tolerance = tolerance(&turntable) / f64::from(SIZE.y);
                assert!((size / old_size - 1.0).abs() < tolerance, "{scene:?}");
            }
        }
    }
}

#[test]
fn zooming_stops_within_the_range_of_f32() {
    for scene in scenes() {
        let mut turntable = Turntable::framing(scene, SIZE);
        let anchor = turntable.pivot;
        for factor in [0.5, 2.0] {
            (0..200).for_each(|_| turntable.zoom(factor, anchor));
            assert!(turntable.distance > 0.0 && turntable.distance.is_finite());
            let ray = turntable.camera(SIZE).ray_through(DVec2::ZERO);
            assert!(ray.origin.is_finite() && ray.dir.is_normalized());
        }
    }
}

#[test]
fn the_largest_scene_in_f32_has_a_valid_camera() {
    let scene = Aabb::around([Vec3::splat(-3e38), Vec3::splat(3e38)]);
    let mut turntable = Turntable::framing(scene, SIZE);
    for is_orthographic in [false, true] {
        turntable.is_orthographic = is_orthographic;
        turntable.pan(DVec2::new(1e3, 1e3), SIZE);
        turntable.zoom(1.1, turntable.pivot);
        let ray = turntable
            .camera(UVec2::new(3000, 1))
            .ray_through(DVec2::ZERO);
        assert!(ray.origin.is_finite() && ray.dir.is_normalized(), "{ray:?}");
    }
}

#[test]
fn panning_moves_the_pivots_plane_with_the_pointer() {
    for scene in scenes() {
        let mut turntable = Turntable::framing(scene, SIZE);
        let point = turntable.pivot;
        turntable.pan(DVec2::new(50.0, -30.0), SIZE);
        let expected = 0.5 * SIZE.as_dvec2() + DVec2::new(50.0, -30.0);
        let off = (pixel_of(&turntable, point) - expected).length();
        assert!(off < tolerance(&turntable), "{scene:?}: {off}");
    }
}

#[test]
fn orbiting_keeps_the_pivot_the_distance_and_the_horizon() {
    for scene in scenes() {
        let mut turntable = Turntable::framing(scene, SIZE);
        let before = turntable;
        for drag in [
            DVec2::new(123.0, 45.0),
            DVec2::new(-3.0, 1e5),
            DVec2::new(7.0, -1e6),
        ] {
            turntable.orbit(drag, SIZE);
            assert_eq!(
                (turntable.pivot, turntable.distance),
                (before.pivot, before.distance)
            );
            let camera = turntable.camera(SIZE);
            assert!(camera.right().y.abs() < 1e-15 && camera.up().y > -1e-15);
            let axes = turntable.world_from_camera();
            assert!((axes.determinant() - 1.0).abs() < 1e-12);
        }
    }
}

#[test]
fn standard_views_look_along_the_axes_for_either_up() {
    let mut turntable = Turntable::framing(scenes()[1], SIZE);
    for (up_axis, front, up) in [
        (UpAxis::Y, DVec3::Z, DVec3::Y),
        (UpAxis::Z, DVec3::NEG_Y, DVec3::Z),
    ] {
        turntable.up_axis = up_axis;
        for (view, back) in [
            (StandardView::Front, front),
            (StandardView::Back, -front),
            (StandardView::Right, DVec3::X),
            (StandardView::Left, DVec3::NEG_X),
            (StandardView::Top, up),
            (StandardView::Bottom, -up),
            (StandardView::Isometric, (DVec3::X + front + up).normalize()),
        ] {
            turntable.look_from(view);
            assert!(
                (turntable.camera(SIZE).back() - back).length() < 1e-12,
                "{view:?}"
            );
        }
    }
}

#[test]
fn an_empty_scene_or_a_single_point_has_a_valid_camera() {
    let points = [Vec3::ZERO, Vec3::splat(1e7)].map(|point| Aabb::around([point]));
    for bounds in [Aabb::EMPTY, points[0], points[1]] {
        let turntable = Turntable::framing(bounds, SIZE);
        assert!(turntable.distance > 0.0);
        turntable.camera(UVec2::ZERO);
    }
}

#[test]
fn a_turntable_shows_any_given_view_and_turns_with_the_drag() {
    let bounds = Aabb::around([Vec3::splat(-1.0), Vec3::splat(2.0)]);
    let size = UVec2::new(64, 48);
    let views = [
        [
            DVec3::new(3.0, 2.0, 5.0),
            DVec3::new(-0.4, -0.2, -1.0),
            DVec3::Y,
        ],
        [
            DVec3::new(3.0, 2.0, 5.0),
            DVec3::new(-0.4, -0.2, -1.0),
            DVec3::new(1.0, 2.0, 0.3),
        ],
        [
            DVec3::new(0.0, 9.0, 0.0),
            DVec3::NEG_Y,
            DVec3::new(1.0, 0.0, -1.0),
        ],
        [DVec3::new(0.0, 9.0, 0.0), DVec3::Y, DVec3::NEG_X],
    ];
    for (view, up_axis) in views
        .into_iter()
        .zip([UpAxis::Y, UpAxis::Z, UpAxis::Y, UpAxis::Z])
    {
        let [eye, forward, up] = view;
        for projection in [
            Projection::Perspective { fov_y_radians: 0.8 },
            Projection::Orthographic { height: 3.0 },
        ] {
            let wanted = Camera::look_at(eye, eye + forward, up, projection, size).expect("good");
            let mut turntable =
                Turntable::looking(view, projection, up_axis, bounds).expect("a view");
            let camera = turntable.camera(size);
            // Each angle is rounded once.
            for (a, b) in [
                (camera.right(), wanted.right()),
                (camera.up(), wanted.up()),
                (camera.back(), wanted.back()),
            ] {
                assert!((a - b).length() < 1e-14, "{view:?} {a} {b}");
            }
            let from_axis = (camera.exact_eye() - eye).cross(wanted.back()).length();
            assert!(from_axis < 1e-13, "{view:?}");
            if let Projection::Perspective { .. } = projection {
                assert!((camera.exact_eye() - eye).length() < 1e-13, "{view:?}");
            }
            // A drag to the right moves the eye to the left, whatever the roll.
            turntable.orbit(DVec2::new(0.01, 0.0), size);
            let moved = turntable.camera(size).exact_eye() - camera.exact_eye();
            let [along, across] = [camera.right(), camera.up()].map(|axis| moved.dot(axis));
            let is_steep = turntable.pitch_radians.abs() > 1.0;
            assert!(
                is_steep || along < -across.abs(),
                "{view:?}: {along} {across}"
            );
        }
    }
}

#[test]
fn the_nearest_axis_points_up() {
    for (up, axis) in [
        (DVec3::Y, UpAxis::Y),
        (DVec3::Z, UpAxis::Z),
        (DVec3::new(0.9, 0.1, -0.3), UpAxis::Z),
        (DVec3::new(0.0, 1.0, 0.9), UpAxis::Y),
        (DVec3::X, UpAxis::Y),
    ] {
        assert_eq!(UpAxis::nearest(up), axis, "{up}");
    }
}
