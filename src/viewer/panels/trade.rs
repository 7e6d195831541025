//! What speed costs in accuracy in this scene: a point for each kernel.

use crate::settings::Settings;
use crate::trade::{Axis, Trade, TradeState};
use egui::{Color32, RichText};
use egui_plot::{AxisHints, GridMark, HLine, Plot, PlotPoint, PlotPoints, PlotUi, Points, Text};
use hitscope_core::kernel::{KernelInfo, Tier, triangle_kernel};
use hitscope_lab::measure::scene::SceneRow;
use hitscope_lab::measure::statistics::{rate_text, short};

/// The plot and its table; a click on a point or a row chooses the kernel. Returns whether the
/// user wants it measured again.
pub fn trade_ui(ui: &mut egui::Ui, trade: &mut Trade, settings: &mut Settings) -> bool {
    let rows = trade.rows();
    let mut is_wanted_again = false;
    ui.horizontal(|ui| match trade.state() {
        TradeState::Measuring => {
            ui.spinner();
            ui.label(format!(
                "Measuring, {} of {}",
                rows.len(),
                trade.kernel_count()
            ));
        }
        TradeState::Done => {
            is_wanted_again = ui
                .button("Measure again")
                .on_hover_text("From where the camera stands now")
                .clicked();
        }
        TradeState::Failed => {
            ui.label("The measurement broke off; the terminal has the details.");
            is_wanted_again = ui.button("Measure again").clicked();
        }
    });
    let Some(first) = rows.first() else {
        return is_wanted_again;
    };
    ui.label(
        RichText::new(format!(
            "{} camera and bounce rays against exact arithmetic. Speed: CPU time beside that of fast, a mean of camera, bounce and random rays.",
            first.n
        ))
        .weak(),
    );
    ui.horizontal(|ui| {
        ui.selectable_value(&mut trade.axis, Axis::ErrorOfT, "Error of t");
        ui.selectable_value(&mut trade.axis, Axis::Wrong, "Wrong decisions");
    });
    plot_ui(ui, trade.axis, &rows, settings);
    table_ui(ui, &rows, settings);
    is_wanted_again
}

/// As a part of `fast`'s, measured beside it: what else the machine does meets both alike.
fn speed(row: &SceneRow) -> f64 {
    1.0 / row.speed.time_relative_to_fast.max(1e-3)
}

/// The mean of the workloads' rates.
fn mrays_per_s(row: &SceneRow) -> f64 {
    let rates = row.speed.mrays_per_s;
    (rates.primary + rates.bounce + rates.random) / 3.0
}

fn plot_ui(ui: &mut egui::Ui, axis: Axis, rows: &[SceneRow], settings: &mut Settings) {
    let height = |row: &SceneRow| axis.value(row).max(axis.floor()).log10();
    let label = match axis {
        Axis::ErrorOfT => "ulps off, p99",
        Axis::Wrong => "wrong per million",
    };
    let floor = axis.floor().log10();
    let fastest = rows.iter().map(speed).fold(0.0, f64::max);
    let slowest = rows.iter().map(speed).fold(fastest, f64::min);
    let highest = rows.iter().map(height).fold(floor + 1.0, f64::max);
    let plot = Plot::new("trade")
        .height(240.0)
        .custom_x_axes(vec![
            AxisHints::new_x()
                .label("speed, fast = 1")
                .label_spacing(egui::Rangef::new(18.0, 36.0)),
        ])
        .y_axis_label(label)
        .include_x(0.85 * slowest)
        .include_x(1.12 * fastest)
        .include_y(floor - 0.3)
        .include_y(highest + 0.4)
        .y_axis_formatter(move |mark: GridMark, _: &_| power_text(mark.value, floor))
        .x_grid_spacer(egui_plot::uniform_grid_spacer(|_| [1.0, 0.2, 0.1]))
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .show_x(false)
        .show_y(false);
    let response = plot.show(ui, |plot| {
        plot.hline(HLine::new("zero", floor).color(Color32::GRAY.gamma_multiply(0.5)));
        for row in rows {
            let is_current = settings.kernel().info.name == row.kernel;
            draw_point(plot, row, [speed(row), height(row)], is_current);
        }
        let pointer = plot.response().hover_pos()?;
        let distance = |row: &SceneRow| {
            let at = PlotPoint::new(speed(row), height(row));
            plot.screen_from_plot(at).distance(pointer)
        };
        let nearest = rows
            .iter()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        // As near as a finger is wide.
        (distance(nearest) < 20.0).then_some(nearest)
    });
    if let Some(row) = response.inner {
        if response.response.clicked() {
            settings.kernel = row.kernel.to_owned();
        }
        let text = format!("{}\n{}", info(row).title, figures(row));
        response.response.on_hover_text_at_pointer(text);
    }
}

/// A kernel's point; the tiers' and the current one have a name beside it.
fn draw_point(plot: &mut PlotUi<'_>, row: &SceneRow, at: [f64; 2], is_current: bool) {
    let info = info(row);
    let points = Points::new(info.title, PlotPoints::from(vec![at]))
        .radius(if is_current { 7.0 } else { 4.5 })
        .color(colour(info));
    plot.points(points);
    if info.tier.is_some() || is_current {
        let name = format!(" {} ", info.short_name());
        let name = RichText::new(name).size(11.0).strong().color(colour(info));
        let at = PlotPoint::new(at[0], at[1]);
        plot.text(Text::new(info.title, at, name).anchor(anchor(info)));
    }
}

fn table_ui(ui: &mut egui::Ui, rows: &[SceneRow], settings: &mut Settings) {
    egui::ScrollArea::horizontal()
        .id_salt("trade table")
        .show(ui, |ui| {
            egui::Grid::new("trade rows")
                .striped(true)
                .spacing([8.0, 2.0])
                .show(ui, |ui| {
                    for title in ["", "speed", "Mrays/s", "wrong/M", "t p99"] {
                        ui.label(RichText::new(title).size(11.5));
                    }
                    ui.end_row();
                    for row in rows {
                        let info = info(row);
                        let is_current = settings.kernel().info.name == row.kernel;
                        let mut name = RichText::new(info.name).size(11.5);
                        // A tier's colour is hard to read on that of the selection.
                        if !is_current {
                            name = name.color(colour(info));
                        }
                        if ui
                            .selectable_label(is_current, name)
                            .on_hover_text(info.summary)
                            .clicked()
                        {
                            settings.kernel = row.kernel.to_owned();
                        }
                        let ulps = |x: Option<f64>| x.map_or("–".to_owned(), short);
                        let wrong = row.missed + row.false_hits + row.other_triangle;
                        for cell in [
                            format!("{:.2}", speed(row)),
                            short(mrays_per_s(row)),
                            rate_text(wrong, row.n),
                            ulps(row.t_ulps.map(|t| t.p99)),
                        ] {
                            ui.label(RichText::new(cell).monospace().size(11.0));
                        }
                        ui.end_row();
                    }
                });
        });
}

fn figures(row: &SceneRow) -> String {
    let rates = row.speed.mrays_per_s;
    format!(
        "primary {}, bounce {}, random {} Mrays/s\nt off by {} ulps at most\nmissed {}, false {}, other triangle {} of {}",
        short(rates.primary),
        short(rates.bounce),
        short(rates.random),
        row.t_ulps.map_or("–".to_owned(), |t| short(t.max)),
        row.missed,
        row.false_hits,
        row.other_triangle,
        row.n,
    )
}

fn info(row: &SceneRow) -> &'static KernelInfo {
    let kernel = triangle_kernel(row.kernel);
    kernel.expect("rows are of kernels in the table").info
}

/// The tiers' colours; grey for what is there to be compared.
fn colour(info: &KernelInfo) -> Color32 {
    match info.tier {
        Some(Tier::Fast) => Color32::from_rgb(230, 120, 60),
        Some(Tier::Watertight) => Color32::from_rgb(70, 150, 235),
        Some(Tier::Precise) => Color32::from_rgb(60, 170, 110),
        Some(Tier::Exact) => Color32::from_rgb(185, 105, 220),
        None => Color32::from_gray(140),
    }
}

/// The side of its point on which a name stands: each tier's its own, as they often lie close together.
fn anchor(info: &KernelInfo) -> egui::Align2 {
    match info.tier {
        Some(Tier::Fast) => egui::Align2::CENTER_BOTTOM,
        Some(Tier::Watertight) => egui::Align2::RIGHT_BOTTOM,
        Some(Tier::Precise) | None => egui::Align2::LEFT_TOP,
        Some(Tier::Exact) => egui::Align2::RIGHT_TOP,
    }
}

/// `0`, `0.1`, `10`, `1e5` for a place on the logarithmic axis; nothing between powers of ten.
fn power_text(exponent: f64, floor: f64) -> String {
    if (exponent - floor).abs() < 1e-6 {
        "0".to_owned()
    } else if exponent.fract() != 0.0 || exponent < floor {
        String::new()
    } else if exponent.abs() <= 3.0 {
        format!("{}", 10f64.powf(exponent))
    } else {
        format!("1e{exponent}")
    }
}
