//! Tests of the views that compare kernels and of the Trade tab.

use crate::harness::{app, press, wait};
use egui::Key;
use egui_kittest::kittest::Queryable as _;
use hitscope::trade::{Trade, TradeState};
use hitscope_core::kernel::TRIANGLE_KERNELS;

#[test]
fn the_trade_tab_measures_every_kernel_and_its_rows_select_one() {
    let Some(mut window) = app(None) else { return };
    assert!(window.state().trade().is_none(), "not requested yet");
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
    assert_eq!(exact.wrong_count(), 0);

    window.run_steps(2);
    let kept = window.state().settings().kernel.clone();
    window.get_by_label_contains("edge-planes ").click();
    wait(&mut window, "the kernel", |app| {
        app.settings().kernel().info.name == "edge-planes"
            && app.document().intersector().kernel().name == "edge-planes"
    });
    // It isn't kept between runs unless the user clicks “Keep”.
    assert_eq!(window.state().settings().kernel, kept);
    window.get_by_label_contains("edge-planes kernel");
    window.get_by_label("Keep").click();
    window.run_steps(2);
    assert_eq!(window.state().settings().kernel, "edge-planes");
}

#[test]
fn another_file_is_measured_only_on_request() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("one.obj");
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    std::fs::write(&file, text).expect("written");
    let Some(mut window) = app(Some(file)) else {
        return;
    };
    wait(&mut window, "the file", |app| {
        app.document().name() == "one.obj"
    });
    window.get_by_label("Trade").click();
    wait(&mut window, "the first measurement", |app| {
        app.trade().is_some()
    });
    let before = std::sync::Arc::clone(&window.state().document().loaded.scene);
    press(&mut window, Key::F5);
    wait(&mut window, "the file again", |app| {
        !std::sync::Arc::ptr_eq(&app.document().loaded.scene, &before) && app.is_settled()
    });
    window.run_steps(3);
    assert!(window.state().trade().is_none());
    window.get_by_label("Measure").click();
    wait(&mut window, "the measurement", |app| app.trade().is_some());
}

#[test]
fn comparing_views_pack_a_second_kernel_and_others_drop_it() {
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
            app.settings().view().title == view && app.document().second().kernel().name == second
        });
    }
    wait(&mut window, "the picture", hitscope::app::App::is_settled);
}
