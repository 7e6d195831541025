//! The report has the same figures for the kernels of every shape.

use hitscope_core::group::all_kernels;
use hitscope_core::progress::Progress;
use hitscope_lab::measure::{self, Measurements, Sizes};
use hitscope_lab::report::{RunInfo, print, to_json, to_page};

/// A few rays for each kernel of every shape in its ordinary case, and their speed.
fn measured() -> Measurements {
    let sizes = Sizes {
        triangle_rays: 20,
        shape_rays: 20,
        speed_rays: 500,
        speed_rounds: 1,
        speed_cells: 4,
        packed_primitives: 32,
        ..Sizes::QUICK
    };
    let is_wanted = |name: &str| {
        let is_ordinary = name.starts_with("shape-") && name.ends_with("-around");
        is_ordinary || name == "offset-0e0"
    };
    let all = measure::run(sizes, 1, &is_wanted, &Progress::default(), &|_| ());
    all.expect("never cancelled")
}

#[test]
fn every_kernel_of_every_shape_has_speed_and_accuracy() {
    let all = measured();
    let about = RunInfo {
        version: "0",
        command: String::new(),
        machine: String::new(),
        started: String::new(),
        seconds: 0.0,
        seed: 1,
        size: "quick",
    };
    let json = to_json(&about, &all);
    let rows = json["shape_kernels"].as_array().expect("a list");
    for shape in all_kernels() {
        let name = shape.shape.name;
        for kernel in shape.kernels {
            let rows = rows
                .iter()
                .chain(json["kernels"].as_array().expect("a list"));
            let is_its = |row: &&serde_json::Value| match name {
                "triangle" => row["shape"].is_null(),
                name => row["shape"] == name,
            };
            let mut rows = rows.filter(is_its);
            let row = rows.find(|row| row["name"] == kernel.name);
            let row = row.unwrap_or_else(|| panic!("{name} {}", kernel.name));
            let rate = row["speed"]["mrays_per_s"]["primary"].as_f64();
            assert!(rate > Some(0.0), "{name}: {row}");
            // A quarter of the rays for solids.
            assert!(row["accuracy"]["n"].as_u64() >= Some(5), "{name}: {row}");
            assert!(
                row["accuracy"]["wrong_per_million"].is_f64(),
                "{name}: {row}"
            );
        }
    }
    for shape in ["plane", "box"] {
        let aligned = all.shape_speed.iter().filter(|row| row.is_aligned);
        assert!(
            aligned.filter(|row| row.shape == shape).count() > 2,
            "{shape}"
        );
    }
    let mut text = Vec::new();
    print(&all, &mut text).expect("written");
    let text = String::from_utf8(text).expect("UTF-8");
    assert!(
        text.contains("Speed at random primitives of every shape"),
        "{text}"
    );
    assert!(text.contains("solid-watertight"), "{text}");
    assert!(to_page(&json).contains("torus-shifted-f64"));
}
