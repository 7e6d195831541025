//! Validation of the shaders without a GPU.

use hitscope::gpu::{picture, view};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use std::path::Path;

#[test]
fn every_shader_parses_and_validates() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    let mut failures = Vec::new();
    let mut count = 0;
    for entry in std::fs::read_dir(&folder).expect("the shaders' folder") {
        let path = entry.expect("an entry").path();
        let own = std::fs::read_to_string(&path).expect("readable");
        let source = if [view::SHADER, picture::SHADER].contains(&own.as_str()) {
            own
        } else {
            format!("{}\n{own}", view::SHADER)
        };
        count += 1;
        let checked = naga::front::wgsl::parse_str(&source)
            .map_err(|error| error.emit_to_string(&source))
            .and_then(|module| {
                Validator::new(ValidationFlags::all(), Capabilities::empty())
                    .validate(&module)
                    .map_err(|error| error.emit_to_string(&source))
            });
        if let Err(error) = checked {
            failures.push(format!("{}:\n{error}", path.display()));
        }
    }
    assert!(count >= 3, "{count} shaders in {}", folder.display());
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
