//! Toasts: short messages about results, which disappear by themselves.

use egui::{Align2, Area, Frame, Id, Order, Rect, vec2};
use std::time::Duration;

/// Time for which a toast is shown.
const SHOWN_SECS: f64 = 4.0;
/// The most toasts that are shown at once; older ones disappear.
const MOST: usize = 4;

/// A message.
struct Toast {
    text: String,
    /// When it disappears, by egui's clock; `None` before it is first shown.
    end_secs: Option<f64>,
}

/// The messages that are shown.
#[derive(Default)]
pub struct Toasts(Vec<Toast>);

impl Toasts {
    /// Shows a message.
    pub fn add(&mut self, text: impl Into<String>) {
        if self.0.len() == MOST {
            self.0.remove(0);
        }
        self.0.push(Toast {
            text: text.into(),
            end_secs: None,
        });
    }

    /// Shows all messages for their full time again.
    pub fn show_again(&mut self) {
        self.0.iter_mut().for_each(|toast| toast.end_secs = None);
    }

    /// The texts, oldest first.
    pub fn texts(&self) -> Vec<&str> {
        self.0.iter().map(|toast| toast.text.as_str()).collect()
    }

    /// Shows the messages at the bottom right of a rectangle. A click closes one.
    pub fn toasts_ui(&mut self, ctx: &egui::Context, within: Rect) {
        let now = ctx.input(|input| input.time);
        for toast in &mut self.0 {
            toast.end_secs.get_or_insert(now + SHOWN_SECS);
        }
        self.0
            .retain(|toast| toast.end_secs.is_some_and(|end| end > now));
        let ends = self.0.iter().filter_map(|toast| toast.end_secs);
        let Some(next) = ends.reduce(f64::min) else {
            return;
        };
        ctx.request_repaint_after(Duration::from_secs_f64(next - now));
        let mut closed = None;
        Area::new(Id::unique("toasts"))
            .order(Order::Foreground)
            .pivot(Align2::RIGHT_BOTTOM)
            .fixed_pos(within.max - vec2(10.0, 10.0))
            .show(ctx, |ui| {
                ui.set_max_width((within.width() - 40.0).clamp(80.0, 360.0));
                for (k, toast) in self.0.iter().enumerate() {
                    Frame::popup(ui.style()).show(ui, |ui| {
                        ui.horizontal(|ui| {
                            ui.label(&toast.text);
                            let close = ui.small_button("×").on_hover_text("Close");
                            if close.clicked() {
                                closed = Some(k);
                            }
                        });
                    });
                }
            });
        if let Some(k) = closed {
            self.0.remove(k);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_toast_makes_room_for_a_new_one() {
        let mut toasts = Toasts::default();
        (0..6).for_each(|k| toasts.add(k.to_string()));
        assert_eq!(toasts.texts(), ["2", "3", "4", "5"]);
    }
}
