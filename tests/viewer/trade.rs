//! Views that compare kernels, and the tab that measures them.

use crate::harness::{app, wait};
use egui_kittest::kittest::Queryable as _;
use hitscope::trade::{Trade, TradeState};
use hitscope_core::kernel::TRIANGLE_KERNELS;

#[test]
fn the_trade_tab_measures_every_kernel_and_its_rows_choose_one() {
    let Some(mut window) = app(None) else { return };
    assert!(window.state().trade().is_none(), "nobody has asked yet");
    window.get_by_label("Trade").click();
    wait(&mut window, "the measurement", |app| {
        app.trade().map(Trade::state) == Some(TradeState::Done)
    });
    let rows = window.state().trade().expect("measured").rows();
    let kernels: Vec<&str> = TRIANGLE_KERNELS.iter().map(|k| k.info.name).collect();
    assert_eq!(
        rows.iter().map(|row| row.kernel).collect::<Vec<_>>(),
        kernels
    );
    for row in rows.iter() {
        assert!(row.n > 1000 && row.hits > 1000, "{row:?}");
        assert!(row.speed.mrays_per_s.primary > 0.0, "{row:?}");
    }
    let exact = rows
        .iter()
        .find(|row| row.kernel == "exact")
        .expect("a row");
    assert_eq!(exact.missed + exact.false_hits + exact.other_triangle, 0);

    window.run_steps(2);
    window.get_by_label("edge-planes").click();
    wait(&mut window, "the kernel", |app| {
        app.settings().kernel().info.name == "edge-planes"
            && app.document().intersector().kernel().name == "edge-planes"
    });
}

#[test]
fn a_view_that_compares_packs_a_second_kernel_and_others_drop_it() {
    let Some(mut window) = app(None) else { return };
    let chosen = window.state().document().intersector().kernel().name;
    for (view, second) in [
        ("Disagreement", "exact"),
        ("Error of t", "exact"),
        ("Depth", chosen),
        ("Barycentric error", "exact"),
    ] {
        window.get_by_label(view).click();
        wait(&mut window, view, |app| {
            app.settings().integrator().title == view
                && app.document().second().kernel().name == second
        });
    }
    wait(&mut window, "the picture", hitscope::app::App::is_settled);
}
