//! Tests of cameras.

use super::*;

const PERSPECTIVE: Projection = Projection::Perspective { fov_y_radians: 1.0 };
const ORTHOGRAPHIC: Projection = Projection::Orthographic { height: 3.0 };

fn camera(projection: Projection) -> Camera {
    let (eye, target) = (DVec3::new(3.0, 4.0, 5.0), DVec3::new(0.0, 1.0, 0.0));
    Camera::look_at(eye, target, DVec3::Y, projection, UVec2::new(320, 200)).expect("good")
}

/// How many pixels a ray may pass beside where it was aimed, so far along the viewing direction: what its
/// rounding to f32 comes to.
///
/// Coordinates of a direction, at most 1, are off by 2⁻²⁵ at most, those of an orthographic origin, below 8,
/// by 2⁻²²: √3 of that in length. In perspective an angle counts for 1 + tan² of the angle from the
/// picture's centre, at most 1 + (1.6² + 1)·tan²(½) = 2.07, and the origin isn't rounded.
fn rounding_px(camera: &Camera, distance: f64) -> f64 {
    let (of_dir, of_origin) = (3f64.sqrt() * 2f64.powi(-25), 3f64.sqrt() * 2f64.powi(-22));
    let pixel = camera.pixel_size_at(distance);
    match camera.projection() {
        Projection::Perspective { .. } => 2.07 * distance * of_dir / pixel,
        Projection::Orthographic { .. } => (of_origin + distance * of_dir) / pixel,
    }
}

/// Some sixty roundings of numbers up to 320 pixels in f64.
const F64_PX: f64 = 60.0 * 320.0 * f64::EPSILON;

#[test]
fn a_point_projects_to_the_pixel_whose_ray_passes_through_it() {
    for projection in [PERSPECTIVE, ORTHOGRAPHIC] {
        let camera = camera(projection);
        for at in [
            DVec2::new(0.5, 0.5),
            DVec2::new(160.0, 100.0),
            DVec2::new(300.2, 7.9),
        ] {
            let ray = camera.ray_through(at);
            let point = ray.origin.as_dvec3() + 6.0 * ray.dir.as_dvec3();
            let back = camera.pixel_of(point).expect("in front");
            let most = rounding_px(&camera, 6.0) + F64_PX;
            assert!((back - at).length() < most, "{at} {back}");
        }
    }
}

#[test]
fn the_target_is_at_the_pictures_centre_and_up_points_upwards() {
    for projection in [PERSPECTIVE, ORTHOGRAPHIC] {
        let camera = camera(projection);
        let middle = camera
            .pixel_of(DVec3::new(0.0, 1.0, 0.0))
            .expect("in front");
        assert!((middle - DVec2::new(160.0, 100.0)).length() < F64_PX);
        let above = camera
            .pixel_of(DVec3::new(0.0, 1.5, 0.0))
            .expect("in front");
        assert!(above.y < middle.y && (above.x - middle.x).abs() < F64_PX);
    }
}

#[test]
fn a_sample_at_one_half_is_the_pixels_centre() {
    let camera = camera(PERSPECTIVE);
    let centre = camera.ray(UVec2::new(10, 20), Vec2::splat(0.5));
    assert_eq!(centre, camera.ray_through(DVec2::new(10.5, 20.5)));
}

#[test]
fn a_pixels_point_on_a_plane_facing_the_camera_projects_to_the_pixel() {
    let on_plane = DVec3::new(0.5, 1.0, -2.0);
    for projection in [PERSPECTIVE, ORTHOGRAPHIC] {
        let camera = camera(projection);
        let at = DVec2::new(300.2, 7.9);
        let point = camera.on_plane_through(on_plane, at);
        // Lengths and pixels of some 10 and 300, in f64.
        let off = camera.pixel_of(point).expect("in front") - at;
        assert!(off.length() < 1e-11, "{off}");
        assert!((point - on_plane).dot(camera.back()).abs() < 1e-13);
    }
}

#[test]
fn moving_the_camera_and_a_point_together_keeps_the_pixel() {
    for projection in [PERSPECTIVE, ORTHOGRAPHIC] {
        let camera = camera(projection);
        // f32 holds the eye and its sum with this.
        let by = DVec3::new(-8.0, 64.0, 0.5);
        let point = DVec3::new(0.5, 1.0, -2.0);
        let moved = camera.moved(by).pixel_of(point + by);
        assert_eq!(moved, camera.pixel_of(point));
    }
}

#[test]
fn clip_space_agrees_with_pixels_and_depth_decreases_from_one() {
    for projection in [PERSPECTIVE, ORTHOGRAPHIC] {
        let camera = camera(projection);
        let clip_from_eye = camera.clip_from_eye(0.5, 100.0);
        // The ray's direction is rounded to f32.
        let mut last_depth = 1.0 + f64::from(f32::EPSILON);
        for distance in [0.5, 1.0, 10.0, 99.0] {
            let ray = camera.ray_through(DVec2::new(40.0, 30.0));
            let along = distance / -ray.dir.as_dvec3().dot(camera.back());
            let point = ray.origin.as_dvec3() + along * ray.dir.as_dvec3();
            let clip = clip_from_eye * (point - camera.eye().as_dvec3()).extend(1.0);
            let at = (clip.truncate().truncate() / clip.w * DVec2::new(0.5, -0.5) + 0.5)
                * DVec2::new(320.0, 200.0);
            let most = rounding_px(&camera, distance) + F64_PX;
            assert!((at - DVec2::new(40.0, 30.0)).length() < most, "{at}");
            let depth = clip.z / clip.w;
            assert!(depth > 0.0 && depth < last_depth, "{depth}");
            last_depth = depth;
        }
    }
}

#[test]
fn up_vectors_and_distances_of_any_length_are_normalised() {
    let camera = |eye: DVec3, up: DVec3| {
        Camera::look_at(eye, DVec3::ZERO, up, PERSPECTIVE, UVec2::ONE).expect("good")
    };
    let usual = camera(DVec3::Z, DVec3::new(1.0, 1.0, 0.0));
    for length in [1e-320, 1e-200, 1e200, 1e308] {
        let up = DVec3::new(length, length, 0.0);
        assert_eq!(camera(DVec3::Z, up), usual, "{length}");
    }
    let near = camera(DVec3::Z * 1e-200, DVec3::Y);
    assert_eq!(near.back(), DVec3::Z);
}

#[test]
fn invalid_cameras_are_refused_with_the_reason() {
    let make = |eye: DVec3, up: DVec3, projection, size| {
        Camera::look_at(eye, DVec3::ZERO, up, projection, size).expect_err("refused")
    };
    let (eye, size) = (DVec3::Z, UVec2::ONE);
    assert_eq!(
        make(DVec3::ZERO, DVec3::Y, PERSPECTIVE, size),
        CameraError::NoDirection
    );
    assert_eq!(
        make(DVec3::NAN, DVec3::Y, PERSPECTIVE, size),
        CameraError::NotFinite
    );
    assert_eq!(
        make(DVec3::Z * 1e300, DVec3::Y, PERSPECTIVE, size),
        CameraError::NotFinite
    );
    assert_eq!(make(eye, DVec3::Z, PERSPECTIVE, size), CameraError::NoUp);
    assert_eq!(
        make(eye, DVec3::Y, PERSPECTIVE, UVec2::ZERO),
        CameraError::NoPixels
    );
    for fov_y_radians in [0.0, 4.0, f64::NAN] {
        let projection = Projection::Perspective { fov_y_radians };
        assert_eq!(
            make(eye, DVec3::Y, projection, size),
            CameraError::BadProjection
        );
    }
}
