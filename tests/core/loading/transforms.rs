//! Which transforms keep cylinders, cones and disks what they are, and what is said about others.

use super::{Files, crossings, loaded};
use glam::{DMat3, DVec3};
use hitscope_core::loading::LoadedScene;

/// A scene of one shape: its parameters, and the operations of its transform.
fn shape(kind: &str, parameters: &str, operations: &str) -> String {
    format!(
        "<shape type='{kind}'>{parameters}<transform name='to_world'>{operations}</transform></shape>"
    )
}

/// The extents of a scene of one shape.
fn extents(contents: &str) -> [DVec3; 2] {
    let bounds = loaded(contents).scene.bounds();
    [bounds.min.as_dvec3(), bounds.max.as_dvec3()]
}

/// The message about a scene file that is refused, after the name of the file.
fn refusal(contents: &str) -> String {
    let error = Files::new(contents).load().err();
    let message = error.unwrap_or_else(|| panic!("accepted: {contents}"));
    let message = message.to_string();
    let (_, rest) = message.split_once("scene.xml").expect("the file");
    rest.to_owned()
}

#[test]
fn cylinders_and_cones_can_be_scaled_along_and_across_their_axis() {
    for kind in ["cylinder", "cone"] {
        let scene = loaded(&shape(kind, "", "<scale x='2' y='2' z='5'/>"));
        // The radius is exactly 2: at half the height, that of a cone is 1.
        let radius = if kind == "cone" { 1.0 } else { 2.0 };
        let through = crossings(&scene, [-4.0, 0.0, 2.5], [1.0, 0.0, 0.0]);
        assert_eq!(through, [(kind, 4.0 - radius), (kind, 4.0 + radius)]);
        assert_eq!(crossings(&scene, [-4.0, 0.0, 5.5], [1.0, 0.0, 0.0]), []);
        // Along the axis alone, at any angle: it is turned to z, scaled, and turned back.
        let ends = "<point name='p0' value='0 0 0'/><point name='p1' value='0.6 0 0.8'/>";
        let angle = 0.6_f64.asin().to_degrees();
        let scaled = format!(
            "<rotate y='1' angle='-{angle}'/><scale z='3'/><rotate y='1' angle='{angle}'/>"
        );
        let [min, max] = extents(&shape(kind, ends, &scaled));
        // The disk about the axis reaches 0.8, 1 and 0.6.
        let expected = match kind {
            "cone" => DVec3::new(1.8, 1.0, 2.4),
            _ => DVec3::new(1.8 + 0.8, 1.0, 2.4 + 0.6),
        };
        assert!((max - expected).abs().max_element() < 1e-5, "{max}");
        assert!(
            (min - DVec3::new(-0.8, -1.0, -0.6)).abs().max_element() < 1e-5,
            "{min}"
        );
    }
}

#[test]
fn disks_stay_disks_or_become_ellipses() {
    let [min, max] = extents(&shape("disk", "", "<scale x='2' y='2' z='7'/>"));
    let half = DVec3::new(2.0, 2.0, 0.0);
    assert!((min + half).abs().max_element() < 1e-6 && (max - half).abs().max_element() < 1e-6);
    let scene = loaded(&shape("disk", "", "<scale x='2' y='3' z='1'/>"));
    let down = |x: f32, y: f32| crossings(&scene, [x, y, 1.0], [0.0, 0.0, -1.0]).len();
    // x²/4 + y²/9 ≤ 1.
    assert_eq!([down(1.9, 0.0), down(2.1, 0.0), down(0.0, 2.9)], [1, 0, 1]);
    assert_eq!([down(1.2, 2.3), down(1.2, 2.5)], [1, 0]);
}

#[test]
fn a_refused_transform_is_told_with_the_shape_its_identifier_and_ways_out() {
    for (contents, expected) in [
        (
            shape("cylinder", "", "<scale x='2'/>"),
            ":2: shape “cylinder”: the transform makes it elliptic: it scales by 2 and by 1 across the axis. These factors must be equal; along the axis, any is possible. Or use a “quadric” without a transform: a = 0.25, b = 1, j = -1, min = (-2.00002, -1.00001, 0), max = (2.00002, 1.00001, 1)",
        ),
        (
            shape(
                "cone",
                "<float name='radius' value='2'/>",
                "<scale y='1.0001'/>",
            )
            .replace("type", "\nid='tower' type"),
            ":2: shape “cone” with the id “tower”: the transform makes it elliptic: it scales by 1.0001 and by 1 across the axis. ",
        ),
        (
            shape(
                "cylinder",
                "<boolean name='capped' value='true'/>",
                "<matrix value='1 0 1 0 1 0 0 0 1'/>",
            ),
            ":2: shape “cylinder”: the transform makes it oblique: the circles aren't perpendicular to the axis any more. Only scaling along and across the axis, rotation and translation are possible. Or use a “quadric” without a transform (it ends at the sides of its box, without caps outside a csg): a = 1, b = 1, c = 1, f = -1, j = -1, ",
        ),
        (
            shape("torus", "", "<scale x='2'/>").replace("type", "id='ring' type"),
            ":2: shape “torus” with the id “ring”: the transform scales it unequally or shears it; ",
        ),
        (
            shape(
                "quadric",
                "<float name='a' value='1'/>",
                "<rotate z='1' angle='45'/>",
            ),
            ":2: shape “quadric”: the transform turns its box, ",
        ),
        (
            shape("sphere", "", "<scale value='0'/>"),
            ":2: shape “sphere”: the transform makes it flat: its matrix is singular",
        ),
        (
            format!(
                "<shape type='csg'><string name='operation' value='union'/><shape type='sphere'/>\n{}<transform name='to_world'><scale x='3'/></transform></shape>",
                shape(
                    "cone",
                    "<boolean name='capped' value='true'/>",
                    "<scale value='2'/>"
                )
                .replace("type", "id='a' type")
            ),
            ":3: shape “cone” with the id “a”: the transform makes it elliptic: it scales by 6 and by 2 across the axis. ",
        ),
    ] {
        let found = refusal(&contents);
        assert!(found.starts_with(expected), "{found}\n{expected}");
    }
}

/// The quadric that a message names.
fn quadric_in(message: &str) -> String {
    let (_, parameters) = message.split_once("without a transform").expect("a hint");
    let (_, parameters) = parameters.split_once(": ").expect("parameters");
    let mut quadric = String::new();
    let (coefficients, corners) = parameters.split_once(", min = (").expect("a box");
    for coefficient in coefficients.split(", ") {
        let (name, value) = coefficient.split_once(" = ").expect("a coefficient");
        quadric += &format!("<float name='{name}' value='{value}'/>");
    }
    let (min, max) = corners.split_once("), max = (").expect("two corners");
    let max = max.strip_suffix(')').expect("the end");
    quadric += &format!("<point name='min' value='{min}'/><point name='max' value='{max}'/>");
    format!("<shape type='quadric'>{quadric}</shape>")
}

/// t of all crossings.
fn all_t(scene: &LoadedScene, origin: DVec3, target: DVec3) -> Vec<f32> {
    let (origin, dir) = (origin.as_vec3(), (target - origin).as_vec3());
    let found = crossings(scene, origin.to_array(), dir.to_array());
    found.into_iter().map(|(_, t)| t).collect()
}

#[test]
fn the_quadric_of_the_message_has_the_surface_of_the_refused_shape() {
    let ends = "<point name='p0' value='1 0 -1'/><point name='p1' value='1 0 1.5'/><float name='radius' value='0.5'/>";
    let map = DMat3::from_diagonal(DVec3::new(2.0, 0.75, 2.0));
    for kind in ["cylinder", "cone"] {
        let message = refusal(&shape(kind, ends, "<scale x='2' y='0.75' z='2'/>"));
        let scene = loaded(&quadric_in(&message));
        let before = loaded(&format!("<shape type='{kind}'>{ends}</shape>"));
        let mut count = 0;
        for k in 0..200 {
            // Through the shape's own coordinates, in which t is the same.
            let angle = f64::from(k);
            let (sin, cos) = angle.sin_cos();
            let origin = DVec3::new(1.0 + 4.0 * cos, 4.0 * sin, 2.0 * (2.0 * angle).cos());
            let target = DVec3::new(
                1.0 + 0.4 * (3.0 * angle).sin(),
                0.0,
                0.9 * (5.0 * angle).sin(),
            );
            let expected = all_t(&before, origin, target);
            let found = all_t(&scene, map * origin, map * target);
            assert_eq!(
                found.len(),
                expected.len(),
                "{kind} {k}: {found:?} {expected:?}"
            );
            for (a, b) in found.iter().zip(&expected) {
                // Coordinates in f32 err by 2.4e-7; no ray of these meets the surface at sin α < 1e-3.
                assert!((a - b).abs() < 5e-4, "{kind} {k}: {a} {b}");
            }
            count += found.len();
        }
        assert!(count > 200, "{kind} {count}");
    }
}
