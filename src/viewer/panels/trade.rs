//! The Trade tab: speed and accuracy of every kernel in this scene.

use super::labels;
use super::table::{aligned, dash, widths};
use super::view::heading;
use crate::app::working_ui;
use crate::settings::Settings;
use crate::theme::kernel_colour;
use crate::trade::{Axis, Trade, TradeState};
use egui::{Color32, FontId, Pos2, RichText, Role, Sense, Theme, WidgetInfo};
use egui_plot::{AxisHints, GridMark, HLine, Plot, PlotPoint, PlotPoints, PlotUi, Points};
use hitscope_core::counts::grouped;
use hitscope_core::kernel::{KernelInfo, Tier};
use hitscope_lab::measure::scene::{OF_WHOLE_SCENE, SceneRow};
use hitscope_lab::measure::statistics::{rate_text, short};

/// The meaning of the table's columns.
const COLUMNS_ABOUT: &str = "\
speed: rays per second of CPU time relative to the fast kernel, averaged over camera, bounce and random rays; the \
fast kernel is measured alternately with each other kernel to cancel out other load
Mrays/s: million rays per second of CPU time; the speed times the mean rate of the fast kernel
wrong/M: wrong decisions per million rays
t ulps: 99th percentile of the error of t, in f32 ulps";

/// Offers to measure the scene. Returns whether the user accepts.
pub fn measure_ui(ui: &mut egui::Ui) -> bool {
    ui.label("Speed and accuracy of every kernel, measured in this scene from the current camera.");
    ui.button("Measure").clicked()
}

/// Shows the plot and its table; a click on a point or a row selects the kernel. Returns whether the
/// user wants to measure again.
pub fn trade_ui(ui: &mut egui::Ui, trade: &mut Trade, settings: &mut Settings) -> bool {
    let rows = trade.rows();
    let mut is_wanted_again = false;
    ui.horizontal_wrapped(|ui| match trade.state() {
        TradeState::Measuring => {
            let title = format!(
                "Measuring kernel {} of {}",
                (rows.len() + 1).min(trade.kernel_count()),
                trade.kernel_count()
            );
            if working_ui(ui, &title, trade.elapsed()) {
                trade.cancel();
            }
        }
        TradeState::Cancelled => {
            ui.label("Cancelled.");
            is_wanted_again = ui.button("Measure again").clicked();
        }
        TradeState::Done => {
            is_wanted_again = ui
                .button("Measure again")
                .on_hover_text("From the current camera")
                .clicked();
        }
        TradeState::Failed => {
            ui.label("The measurement failed; see the terminal for details.");
            is_wanted_again = ui.button("Measure again").clicked();
        }
    });
    let Some(first) = rows.first() else {
        return is_wanted_again;
    };
    ui.label(
        RichText::new(format!(
            "{} camera and bounce rays, compared with exact arithmetic.",
            grouped(first.n as usize)
        ))
        .weak(),
    )
    .on_hover_text(COLUMNS_ABOUT);
    if trade.shapes().len() > 1 {
        ui.label(RichText::new(OF_WHOLE_SCENE).weak());
    }
    ui.horizontal(|ui| {
        ui.selectable_value(&mut trade.axis, Axis::ErrorOfT, "Error of t");
        ui.selectable_value(&mut trade.axis, Axis::Wrong, "Wrong decisions");
    });
    kernel_ui(ui, settings);
    plot_ui(ui, trade, &rows, settings);
    table_ui(ui, trade, &rows, settings);
    is_wanted_again
}

/// Offers to keep a kernel that was selected here for this session, or says how to select one.
fn kernel_ui(ui: &mut egui::Ui, settings: &mut Settings) {
    let info = settings.kernel().info;
    ui.horizontal(|ui| {
        // As high as the button, so that nothing moves when a kernel is selected.
        ui.set_min_height(ui.spacing().interact_size.y);
        if settings.session_kernel.is_none() {
            ui.label(RichText::new("Click a point or a row to use its kernel.").weak());
            return;
        }
        ui.label(format!(
            "{} is used for this session only.",
            info.short_name()
        ));
        if ui.button("Keep").clicked() {
            settings.keep_kernel(info.name);
        }
    });
}

/// The rate of a kernel in million rays per second of CPU time, the mean of all workloads; `None` until that of the fast
/// kernel is measured, to which its speed is relative.
pub fn mrays_per_s(row: &SceneRow, rows: &[SceneRow]) -> Option<f64> {
    let fast = rows.iter().find(|row| row.info.tier == Some(Tier::Fast))?;
    Some(speed(row) * fast.speed.mrays_per_s.mean())
}

/// Speed relative to `fast`, which was measured alternately with this kernel, so that other load slows down
/// both.
fn speed(row: &SceneRow) -> f64 {
    1.0 / row.speed.time_relative_to_fast.max(1e-3)
}

/// A row's place in the plot.
fn place(axis: Axis, row: &SceneRow) -> PlotPoint {
    let height = axis.value(row).max(axis.floor()).log10();
    PlotPoint::new(speed(row), height)
}

/// The plot without its contents; all rows are visible.
fn empty_plot(axis: Axis, rows: &[SceneRow]) -> Plot<'static> {
    let label = match axis {
        Axis::ErrorOfT => "p99 error of t, ulps",
        Axis::Wrong => "wrong per million rays",
    };
    let floor = axis.floor().log10();
    let fastest = rows.iter().map(speed).fold(0.0, f64::max);
    let slowest = rows.iter().map(speed).fold(fastest, f64::min);
    let heights = rows.iter().map(|row| place(axis, row).y);
    let highest = heights.fold(floor + 1.0, f64::max);
    Plot::new("trade")
        .height(240.0)
        .custom_x_axes(vec![
            AxisHints::new_x()
                .label("speed relative to fast")
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
        // Not by the keyboard: the table below has the same choice.
        .sense(Sense::CLICK)
        .show_x(false)
        .show_y(false)
}

fn plot_ui(ui: &mut egui::Ui, trade: &Trade, rows: &[SceneRow], settings: &mut Settings) {
    let axis = trade.axis;
    let theme = ui.theme();
    let mut labelled: Vec<(&KernelInfo, Pos2)> = Vec::new();
    let mut points: Vec<Pos2> = Vec::new();
    let response = empty_plot(axis, rows).show(ui, |plot| {
        let floor = axis.floor().log10();
        plot.hline(HLine::new("zero", floor).color(Color32::GRAY.gamma_multiply(0.5)));
        for row in rows {
            let is_current = trade.is_used(settings.kernel(), row);
            draw_point(plot, row, place(axis, row), is_current, theme);
            let on_screen = plot.screen_from_plot(place(axis, row));
            // A tier has the same place for every shape.
            let name = row.info.short_name();
            let is_labelled = labelled.iter().any(|(info, _)| info.short_name() == name);
            if (row.info.tier.is_some() || is_current) && !is_labelled {
                labelled.push((row.info, on_screen));
            }
            points.push(on_screen);
        }
        let pointer = plot.response().hover_pos()?;
        let distance = |row: &SceneRow| {
            let on_screen = plot.screen_from_plot(place(axis, row));
            on_screen.distance(pointer)
        };
        let nearest = rows
            .iter()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        // About the width of a fingertip, in points.
        (distance(nearest) < 20.0).then_some(nearest)
    });
    let about = || WidgetInfo::labeled(Role::Image, true, "Plot of speed and error");
    response.response.widget_info(about);
    let painter = ui.painter_at(response.response.rect);
    draw_labels(&painter, &labelled, &points, theme);
    if let Some(row) = response.inner {
        if response.response.clicked() {
            settings.use_for_session(row.kernel);
        }
        let text = format!(
            "{}: {}\n{}",
            row.info.short_name(),
            row.info.title,
            figures(row)
        );
        response.response.on_hover_text_at_pointer(text);
    }
}

fn draw_point(
    plot: &mut PlotUi<'_>,
    row: &SceneRow,
    at: PlotPoint,
    is_current: bool,
    theme: Theme,
) {
    let info = row.info;
    let points = Points::new(info.short_name(), PlotPoints::from(vec![[at.x, at.y]]))
        .radius(if is_current { 7.0 } else { 4.5 })
        .color(kernel_colour(info.tier, theme));
    plot.points(points);
}

/// Draws names beside the points of the tiers and of the current kernel.
fn draw_labels(
    painter: &egui::Painter,
    labelled: &[(&KernelInfo, Pos2)],
    all_points: &[Pos2],
    theme: Theme,
) {
    let font = FontId::proportional(11.5);
    let galleys: Vec<_> = labelled
        .iter()
        .map(|(info, _)| {
            let colour = kernel_colour(info.tier, theme);
            painter.layout_no_wrap(info.short_name().to_owned(), font.clone(), colour)
        })
        .collect();
    let points: Vec<Pos2> = labelled.iter().map(|(_, at)| *at).collect();
    let sizes: Vec<egui::Vec2> = galleys.iter().map(|galley| galley.size()).collect();
    let obstacles: Vec<_> = all_points.iter().map(labels::around).collect();
    let places = labels::place(&points, &sizes, &obstacles, painter.clip_rect());
    for (galley, place) in galleys.into_iter().zip(places) {
        painter.galley(place.min, galley, Color32::PLACEHOLDER);
    }
}

/// Shows a row for each kernel, shape by shape; a click selects it.
fn table_ui(ui: &mut egui::Ui, trade: &Trade, rows: &[SceneRow], settings: &mut Settings) {
    const COLUMNS: [&str; 5] = ["kernel", "speed", "Mrays/s", "wrong/M", "t ulps"];
    let cells: Vec<[String; 5]> = std::iter::once(COLUMNS.map(str::to_owned))
        .chain(rows.iter().map(|row| cells(row, rows)))
        .collect();
    let widths = widths(&cells);
    let text = |cells: &[String; 5]| {
        RichText::new(aligned(cells, &widths))
            .monospace()
            .size(10.5)
    };
    let theme = ui.theme();
    egui::ScrollArea::horizontal()
        .id_salt("trade table")
        .show(ui, |ui| {
            ui.spacing_mut().button_padding.x = 2.0;
            ui.spacing_mut().item_spacing.y = 1.0;
            ui.spacing_mut().interact_size.y = 0.0;
            // A button that can't be clicked, so that it aligns with the other rows.
            let header = egui::Button::new(text(&cells[0]).strong())
                .frame(false)
                .wrap_mode(egui::TextWrapMode::Extend);
            ui.add(header.sense(Sense::hover()))
                .on_hover_text(COLUMNS_ABOUT);
            let mut headings = trade.shapes().iter().filter(|_| trade.shapes().len() > 1);
            let mut shape = "";
            for (row, cells) in rows.iter().zip(&cells[1..]) {
                if row.shape != std::mem::replace(&mut shape, row.shape)
                    && let Some(shape) = headings.next()
                {
                    ui.label(RichText::new(heading(shape)).size(11.0));
                }
                let info = row.info;
                let is_current = trade.is_used(settings.kernel(), row);
                let mut text = text(cells);
                // The selection has its own text colour.
                if !is_current {
                    text = text.color(kernel_colour(info.tier, theme));
                }
                let button = egui::Button::selectable(is_current, text);
                let response = ui.add(button.wrap_mode(egui::TextWrapMode::Extend));
                if response
                    .on_hover_text(format!("{}. {}", info.title, info.summary))
                    .clicked()
                {
                    settings.use_for_session(row.kernel);
                }
            }
        });
}

fn cells(row: &SceneRow, rows: &[SceneRow]) -> [String; 5] {
    [
        row.info.short_name().to_owned(),
        format!("{:.2}", speed(row)),
        mrays_per_s(row, rows).map_or_else(dash, short),
        rate_text(row.wrong_count(), row.n),
        row.t_ulps.map_or_else(dash, |t| short(t.p99)),
    ]
}

fn figures(row: &SceneRow) -> String {
    let rates = row.speed.mrays_per_s;
    format!(
        "Mrays/s: camera {}, bounce {}, random {}\nlargest error of t: {} ulps\nof {} rays: {} missed, {} false hits, {} other primitives",
        short(rates.primary),
        short(rates.bounce),
        short(rates.random),
        row.t_ulps.map_or_else(dash, |t| short(t.max)),
        row.n,
        row.missed,
        row.false_hits,
        row.other_triangle,
    )
}

/// The label of a mark on the logarithmic axis: `0`, `0.1`, `10`, `1e5`; empty between powers of ten.
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
