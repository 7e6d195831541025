//! Fields of view as Mitsuba 3.9.1 computes them.

use super::parse;
use hitscope_core::scene_file::{FovAxis, SensorKind};

/// `fov` parameters and Mitsuba's `x_fov` in degrees, for a film of 768 × 576 pixels.
const FIELDS_OF_VIEW: [(&str, f64); 9] = [
    ("", 38.1848),
    ("<string name='focal_length' value='50mm'/>", 38.1848),
    ("<string name='focal_length' value='50'/>", 38.1848),
    ("<float name='fov' value='40'/>", 40.0),
    (
        "<float name='fov' value='40'/><string name='fov_axis' value='x'/>",
        40.0,
    ),
    (
        "<float name='fov' value='40'/><string name='fov_axis' value='y'/>",
        51.774,
    ),
    (
        "<float name='fov' value='40'/><string name='fov_axis' value='diagonal'/>",
        32.4686,
    ),
    (
        "<float name='fov' value='40'/><string name='fov_axis' value='smaller'/>",
        51.774,
    ),
    (
        "<float name='fov' value='40'/><string name='fov_axis' value='larger'/>",
        40.0,
    ),
];

#[test]
fn fields_of_view_are_those_of_mitsuba() {
    for (parameters, expected) in FIELDS_OF_VIEW {
        let text = format!(
            "<scene version='3.0.0'><sensor type='perspective'>{parameters}</sensor></scene>"
        );
        let scene = parse(&text).unwrap_or_else(|error| panic!("{error}"));
        let sensor = &scene.sensors[0];
        let SensorKind::Perspective(fov) = sensor.kind else {
            panic!("{:?}", sensor.kind);
        };
        let (width, height) = (f64::from(sensor.film.width), f64::from(sensor.film.height));
        let across = match fov.axis {
            FovAxis::X | FovAxis::Larger => width,
            FovAxis::Y | FovAxis::Smaller => height,
            FovAxis::Diagonal => width.hypot(height),
        };
        let half_width = (0.5 * fov.degrees.to_radians()).tan() * width / across;
        let x_fov = 2.0 * half_width.atan().to_degrees();
        // Mitsuba prints six digits.
        assert!((x_fov - expected).abs() < 1e-4, "{parameters}: {x_fov}");
    }
}
