//! Long-running background work: it is shown, and the user can cancel it.
//!
//! Loading has its own progress bar, as has the dialog *Render a picture* while it is open.

use super::App;
use crate::settings::Settings;
use crate::tab::Tab;
use crate::trade::TradeState;
use std::time::Duration;

/// Work that takes longer is shown.
const SHOWN_AFTER: Duration = Duration::from_millis(200);
/// Work that takes longer can be cancelled.
const CANCELLED_AFTER: Duration = Duration::from_secs(1);
/// Time between two frames while work is running.
const FRAME: Duration = Duration::from_millis(100);

/// A kind of work.
pub(super) struct Work {
    title: &'static str,
    /// Time since it began; `None` if it isn't running.
    elapsed: fn(&App) -> Option<Duration>,
    cancel: fn(&mut App),
}

/// All kinds.
static WORK: &[Work] = &[
    Work {
        title: "Packing the scene for the kernel",
        elapsed: |app| app.open.document.packing_elapsed(),
        cancel: |app| {
            app.open.document.cancel_packing();
            let packed = app.open.document.kernel().info.name;
            app.seen.settings.keep_kernel(packed);
        },
    },
    Work {
        title: "Packing the scene for the second kernel",
        elapsed: |app| app.open.document.second_packing_elapsed(),
        cancel: |app| {
            let default = Settings::default().view;
            app.seen.settings.keep_view(&default);
        },
    },
    Work {
        title: "Building the tree of the shown parts",
        elapsed: |app| app.open.document.primitives_elapsed(),
        cancel: App::cancel_parts,
    },
    Work {
        title: "Inspecting the pixel",
        elapsed: |app| Some(app.picked.picking.as_ref()?.elapsed()),
        cancel: |app| app.picked.clear_pick(),
    },
    Work {
        title: "Measuring at the selected pick",
        elapsed: |app| app.picked.inspecting.picks.detail_task.elapsed(),
        cancel: |app| {
            let picks = &mut app.picked.inspecting.picks;
            (picks.measures_thickness, picks.shows_walk) = (false, false);
            picks.detail_task.cancel();
        },
    },
    Work {
        title: "Packing the scene for side B",
        elapsed: |app| app.compared.packing_elapsed(),
        cancel: |app| app.seen.comparison.is_on = false,
    },
    Work {
        title: "Measuring distances between both sides",
        elapsed: |app| app.compared.measuring_elapsed(),
        cancel: |app| app.seen.comparison.is_on = false,
    },
    Work {
        title: "Rendering a picture",
        elapsed: |app| app.pictures.dialog.hidden_elapsed(),
        cancel: |app| app.pictures.dialog.cancel(),
    },
    Work {
        title: "Measuring speed and accuracy",
        elapsed: |app| {
            // The Trade tab shows it itself.
            let is_elsewhere = !app.preferences.shows_panel || app.preferences.tab != Tab::Trade;
            let trade = app.open.trade.as_ref().filter(|_| is_elsewhere)?;
            (trade.state() == TradeState::Measuring).then(|| trade.elapsed())
        },
        cancel: |app| {
            if let Some(trade) = &app.open.trade {
                trade.cancel();
            }
        },
    },
];

/// Shows a spinner and, after a while, a *Cancel* button. Returns whether it was clicked.
pub(crate) fn working_ui(ui: &mut egui::Ui, title: &str, elapsed: Duration) -> bool {
    ui.ctx().request_repaint_after(FRAME);
    let row = ui.horizontal_wrapped(|ui| {
        ui.spinner();
        ui.label(format!("{title}, {:.1} s", elapsed.as_secs_f64()));
        let is_long = elapsed >= CANCELLED_AFTER;
        is_long && ui.button("Cancel").clicked()
    });
    row.inner
}

impl App {
    /// The work that has been running long enough to be shown.
    pub(super) fn long_work(&self, ctx: &egui::Context) -> Vec<(&'static Work, Duration)> {
        let running = WORK
            .iter()
            .filter_map(|work| Some((work, (work.elapsed)(self)?)));
        let running: Vec<_> = running.collect();
        if !running.is_empty() {
            ctx.request_repaint_after(FRAME);
        }
        let is_long = |(_, elapsed): &(&Work, Duration)| *elapsed >= SHOWN_AFTER;
        running.into_iter().filter(is_long).collect()
    }

    /// Cancels work.
    pub(super) fn cancel_work(&mut self, work: &Work) {
        (work.cancel)(self);
    }
}

/// Shows work. Returns the work that the user cancels.
pub(super) fn work_ui(
    ui: &mut egui::Ui,
    running: &[(&'static Work, Duration)],
) -> Option<&'static Work> {
    let mut cancelled = None;
    for &(work, elapsed) in running {
        egui::Frame::popup(ui.style()).show(ui, |ui| {
            if working_ui(ui, work.title, elapsed) {
                cancelled = Some(work);
            }
        });
    }
    cancelled
}

#[cfg(test)]
mod tests {
    use crate::harness::{app, wait};
    use crate::task::sabotage;
    use egui_kittest::kittest::Queryable as _;

    #[test]
    fn long_work_is_shown_and_cancelling_it_keeps_kernel_and_parts() {
        let Some(mut window) = app(None) else { return };
        let hold = sabotage::hold("pack");
        window
            .state_mut()
            .seen
            .settings
            .keep_kernel("moller-trumbore");
        window.run_steps(2);
        let is_shown = |window: &crate::harness::Window, label: &str| {
            window.query_by_label_contains(label).is_some()
        };
        for label in ["Packing the scene", "Cancel"] {
            while !is_shown(&window, label) {
                std::thread::sleep(std::time::Duration::from_millis(20));
                window.step();
            }
        }
        window.get_by_label("Cancel").click();
        window.run_steps(3);
        assert!(!is_shown(&window, "Packing the scene"));
        assert_eq!(window.state().settings().kernel().info.name, "exact");
        drop(hold);

        let hold = sabotage::hold("parts");
        while window.state_mut().seen.parts.list().is_none() {
            std::thread::sleep(std::time::Duration::from_millis(5));
            window.step();
        }
        window.state_mut().seen.parts.show(1, false);
        while !is_shown(&window, "Cancel") {
            std::thread::sleep(std::time::Duration::from_millis(20));
            window.step();
        }
        window.get_by_label("Cancel").click();
        window.run_steps(3);
        assert!(window.state().parts().choice().shows_all());
        assert!(window.state().document().primitives_elapsed().is_none());
        drop(hold);

        window
            .state_mut()
            .seen
            .settings
            .keep_kernel("moller-trumbore");
        wait(&mut window, "the kernel", |app| {
            app.document().intersector().kernel().name == "moller-trumbore"
        });
    }

    #[test]
    fn work_can_be_cancelled_in_a_narrow_window() {
        let Some(mut window) = app(None) else { return };
        let hold = sabotage::hold("pack");
        let settings = &mut window.state_mut().seen.settings;
        settings.keep_kernel("moller-trumbore");
        while window.query_by_label("Cancel").is_none() {
            std::thread::sleep(std::time::Duration::from_millis(20));
            window.step();
        }
        // A window of 800 × 600 pixels at 300 %.
        window.set_size(egui::vec2(267.0, 200.0));
        window.run_steps(3);
        let button = window.get_by_label("Cancel").rect();
        let screen = window.ctx.content_rect();
        assert!(screen.contains_rect(button), "{button:?} in {screen:?}");
        drop(hold);
    }
}
