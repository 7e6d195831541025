//! A csg that is certainly empty gives a warning with its line.

use super::loaded;

/// The warnings about a scene file, after their lines.
fn warnings(contents: &str) -> Vec<(Option<usize>, String)> {
    let warnings = loaded(contents).report.warnings.clone().into_iter();
    warnings
        .map(|warning| (warning.line, warning.message))
        .collect()
}

/// A csg that begins a line.
fn csg(operation: &str, parts: &[String]) -> String {
    let operation = format!("<string name='operation' value='{operation}'/>");
    format!("\n<shape type='csg'>{operation}{}</shape>", parts.concat())
}

/// The cube from x − 1 to x + 1.
fn cube(x: f64) -> String {
    format!(
        "<shape type='cube'><transform name='to_world'><translate x='{x}'/></transform></shape>"
    )
}

#[test]
fn a_csg_whose_parts_lie_apart_gives_a_warning_with_its_line() {
    let apart = || csg("intersection", &[cube(0.0), cube(9.0)]);
    let plane = "<shape type='plane'/>".to_owned();
    let message = "the csg is empty: the boxes around its parts don't overlap";
    for (contents, line) in [
        (apart(), 3),
        (csg("intersection", &[plane, cube(0.0), cube(9.0)]), 3),
        // The innermost one that is empty, once.
        (csg("union", &[apart(), cube(0.0)]), 4),
        (csg("difference", &[apart(), cube(0.0)]), 4),
        (csg("intersection", &[cube(0.0), apart()]), 4),
        (csg("difference", &[cube(0.0), apart()]), 4),
    ] {
        let expected = [(Some(line), message.to_owned())];
        assert_eq!(warnings(&contents), expected, "{contents}");
    }
    for (count, others) in [(2, "another one"), (3, "2 others")] {
        let verb = if count == 2 { "is" } else { "are" };
        let expected = [(Some(3), format!("{message}; so {verb} {others}"))];
        assert_eq!(warnings(&apart().repeat(count)), expected);
    }
}

#[test]
fn a_csg_that_may_hold_a_point_gives_no_warning() {
    for contents in [
        csg("union", &[cube(0.0), cube(9.0)]),
        csg("difference", &[cube(0.0), cube(9.0)]),
        csg("intersection", &[cube(0.0), cube(1.5)]),
        // They touch, so that the boxes overlap in a square, although no point is inside.
        csg("intersection", &[cube(0.0), cube(2.0)]),
        // Empty, but nothing is known about it without tracing rays.
        csg("difference", &[cube(0.0), cube(0.0)]),
    ] {
        assert_eq!(warnings(&contents), [], "{contents}");
    }
}
