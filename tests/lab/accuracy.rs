//! Test that the table in `docs/accuracy.md` matches a new measurement.
//!
//! To update it: `HITSCOPE_ACCURACY=write cargo test -p hitscope-lab accuracy`. Look at the difference.

use hitscope_core::progress::Progress;
use hitscope_lab::measure::{self, Sizes};
use hitscope_lab::report::{accuracy_table, is_in_accuracy_table};

const DOCUMENT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/accuracy.md");
const START: &str = "<!-- accuracy: written by a test -->\n";
const END: &str = "<!-- end of accuracy -->";

#[test]
fn the_accuracy_table_is_up_to_date() {
    let sizes = Sizes {
        speed_rays: 0,
        ..Sizes::FULL
    };
    let all = measure::run(
        sizes,
        1,
        &is_in_accuracy_table,
        &Progress::default(),
        &|_| (),
    );
    let table = accuracy_table(&all.expect("never cancelled"));
    let text = std::fs::read_to_string(DOCUMENT).expect("the document exists");
    let (before, rest) = text.split_once(START).expect("the table's start");
    let (shown, after) = rest.split_once(END).expect("the table's end");
    if std::env::var_os("HITSCOPE_ACCURACY").is_some_and(|value| value == "write") {
        let text = format!("{before}{START}{table}{END}{after}");
        std::fs::write(DOCUMENT, text).expect("the document can be written");
    } else {
        assert_eq!(shown, table, "HITSCOPE_ACCURACY=write updates it");
    }
}
