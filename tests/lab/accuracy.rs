//! Test that the tables in `docs/accuracy.md` and `README.md` match a new measurement.
//!
//! To update them: `HITSCOPE_ACCURACY=write cargo test -p hitscope-lab accuracy`. Look at the difference.

use hitscope_core::progress::Progress;
use hitscope_lab::measure::{self, Measurements, Sizes};
use hitscope_lab::report::{
    accuracy_table, is_in_accuracy_table, is_in_shape_table, shape_table, summary_table,
};

const DOCUMENT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/accuracy.md");
const README: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../README.md");

fn measured(is_wanted: fn(&str) -> bool) -> Measurements {
    let sizes = Sizes {
        speed_rays: 0,
        ..Sizes::FULL
    };
    let all = measure::run(sizes, 1, &is_wanted, &Progress::default(), &|_| ());
    all.expect("never cancelled")
}

/// Compares the table between two comments of a file with a new one, or replaces it.
fn compare(file: &str, name: &str, table: &str) {
    let start = format!("<!-- {name}: written by a test -->\n");
    let end = format!("<!-- end of {name} -->");
    let text = std::fs::read_to_string(file).expect("the document exists");
    let (before, rest) = text.split_once(&start).expect("the table's start");
    let (shown, after) = rest.split_once(&end).expect("the table's end");
    if std::env::var_os("HITSCOPE_ACCURACY").is_some_and(|value| value == "write") {
        let text = format!("{before}{start}{table}{end}{after}");
        std::fs::write(file, text).expect("the document can be written");
    } else {
        assert_eq!(shown, table, "HITSCOPE_ACCURACY=write updates it");
    }
}

#[test]
fn the_accuracy_tables_are_up_to_date() {
    let triangles = measured(is_in_accuracy_table);
    compare(DOCUMENT, "accuracy", &accuracy_table(&triangles));
    let shapes = measured(is_in_shape_table);
    compare(DOCUMENT, "shapes", &shape_table(&shapes));
    compare(README, "accuracy", &summary_table(&shapes));
}
