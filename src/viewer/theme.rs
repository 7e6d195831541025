//! Colours of the window's two themes. All text has a contrast of at least 4.5:1, the outlines of controls 3:1.
//!
//! Source: WCAG 2.2, success criteria 1.4.3 and 1.4.11, level AA.

use crate::colour_choice::Background;
use egui::{Color32, Stroke, Theme, Visuals};
use glam::Vec3;
use hitscope_core::integrator::{Comparison, Integrator};
use hitscope_core::kernel::Tier;
use hitscope_core::srgb::from_display;
use hitscope_lab::commands::DARK_BACKGROUND;

/// Colour of the mark at the picked point.
pub const PICK: Color32 = Color32::WHITE;
/// Colour of the mark at a flaw.
pub const FLAW: Color32 = Color32::from_rgb(255, 140, 140);

/// Opacity of disabled widgets: egui's 0.5 leaves their text too faint.
const DISABLED_ALPHA: f32 = 0.75;
const LIGHT_BACKGROUND: Vec3 = Vec3::new(0.90, 0.91, 0.92);

/// Sets the colours of both themes.
pub fn apply(ctx: &egui::Context) {
    for theme in [Theme::Dark, Theme::Light] {
        ctx.set_visuals_of(theme, visuals(theme));
    }
}

/// The frame of a panel. It is transparent: the window is cleared with the panels' colour. If the bars at the window's top
/// and bottom fill themselves, Mesa's llvmpipe takes 5 ms more CPU time per frame (1280 pixels wide, AVX2, 2026-11).
pub fn panel_frame(style: &egui::Style) -> egui::Frame {
    egui::Frame::side_top_panel(style).fill(Color32::TRANSPARENT)
}

/// egui's colours, except those that are hard to read.
fn visuals(theme: Theme) -> Visuals {
    let (mut visuals, outline) = match theme {
        Theme::Dark => (dark(), 110),
        Theme::Light => (light(), 140),
    };
    // Check boxes have no other edge.
    visuals.widgets.inactive.bg_stroke = Stroke::new(1.0, Color32::from_gray(outline));
    visuals.disabled_alpha = DISABLED_ALPHA;
    visuals
}

fn dark() -> Visuals {
    Visuals {
        weak_text_color: Some(Color32::from_gray(165)),
        error_fg_color: Color32::from_rgb(255, 110, 110),
        ..Visuals::dark()
    }
}

fn light() -> Visuals {
    Visuals {
        weak_text_color: Some(Color32::from_gray(95)),
        warn_fg_color: Color32::from_rgb(150, 75, 0),
        error_fg_color: Color32::from_rgb(190, 0, 0),
        hyperlink_color: Color32::from_rgb(0, 90, 170),
        ..Visuals::light()
    }
}

/// The background of a view's picture, in linear RGB. It is always dark for views that compare kernels.
pub fn background(view: &Integrator, chosen: Background, theme: Theme) -> Vec3 {
    let chosen = if view.needs.second == Comparison::Nothing {
        chosen
    } else {
        Background::Dark
    };
    from_display(match (chosen, theme) {
        (Background::Dark, _) | (Background::Theme, Theme::Dark) => DARK_BACKGROUND,
        (Background::Theme, Theme::Light) => LIGHT_BACKGROUND,
        (Background::Grey, _) => Vec3::splat(0.5),
        (Background::White, _) => Vec3::ONE,
    })
}

/// The colour of a kernel by its tier; grey if it has none.
pub fn kernel_colour(tier: Option<Tier>, theme: Theme) -> Color32 {
    let [on_dark, on_light] = match tier {
        Some(Tier::Fast) => [[235, 135, 80], [165, 70, 10]],
        Some(Tier::Watertight) => [[90, 165, 245], [20, 95, 175]],
        Some(Tier::Precise) => [[80, 190, 130], [15, 110, 60]],
        Some(Tier::Exact) => [[205, 140, 235], [130, 50, 165]],
        None => [[165; 3], [95; 3]],
    };
    let [r, g, b] = match theme {
        Theme::Dark => on_dark,
        Theme::Light => on_light,
    };
    Color32::from_rgb(r, g, b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use hitscope_core::integrator::INTEGRATORS;

    const LEAST_CONTRAST: f32 = 4.5;

    /// Contrast of two colours in linear RGB.
    fn contrast(a: Vec3, b: Vec3) -> f32 {
        let luminance = |colour: Vec3| colour.dot(Vec3::new(0.2126, 0.7152, 0.0722));
        let (a, b) = (luminance(a) + 0.05, luminance(b) + 0.05);
        a.max(b) / a.min(b)
    }

    fn linear(colour: Color32) -> Vec3 {
        assert!(colour.is_opaque(), "{colour:?}");
        let [r, g, b, _] = colour.to_array();
        from_display(Vec3::new(r.into(), g.into(), b.into()) / 255.0)
    }

    #[test]
    fn contrast_agrees_with_wcag() {
        // The channels' coefficients are rounded to f32.
        assert!((contrast(Vec3::ZERO, Vec3::ONE) - 21.0).abs() < 1e-5);
        let grey = linear(Color32::from_gray(0x76));
        // #767676 is the lightest grey of level AA on white.
        assert!((contrast(grey, Vec3::ONE) - 4.54).abs() < 0.005);
    }

    #[test]
    fn text_is_readable_in_both_themes() {
        for theme in [Theme::Dark, Theme::Light] {
            let visuals = visuals(theme);
            let widgets = &visuals.widgets;
            let fills = [
                ("panel", visuals.panel_fill),
                ("window", visuals.window_fill),
                ("field", visuals.extreme_bg_color),
            ];
            let tiers = [Tier::Fast, Tier::Watertight, Tier::Precise, Tier::Exact].map(Some);
            let tiers = tiers.into_iter().chain([None]);
            let kernels = tiers.map(|tier| ("kernel", kernel_colour(tier, theme)));
            let texts = [
                ("text", visuals.text_color()),
                ("strong", visuals.strong_text_color()),
                ("weak", visuals.weak_text_color()),
                ("warning", visuals.warn_fg_color),
                ("error", visuals.error_fg_color),
                ("link", visuals.hyperlink_color),
            ];
            let mut pairs = Vec::new();
            for (name, text) in texts.into_iter().chain(kernels) {
                pairs.extend(fills.map(|(on, fill)| (name, on, text, fill)));
            }
            for (name, widget) in [
                ("inactive", widgets.inactive),
                ("hovered", widgets.hovered),
                ("active", widgets.active),
                ("open", widgets.open),
            ] {
                pairs.push((name, "button", widget.text_color(), widget.weak_bg_fill));
            }
            let selection = visuals.selection;
            pairs.push((
                "text",
                "selection",
                selection.stroke.color,
                selection.bg_fill,
            ));
            for (name, on, text, fill) in pairs {
                let contrast = contrast(linear(text), linear(fill));
                assert!(
                    contrast >= LEAST_CONTRAST,
                    "{theme:?}: {name} on {on}: {contrast}"
                );
            }
        }
    }

    #[test]
    fn disabled_text_and_outlines_of_controls_stand_out_in_both_themes() {
        for theme in [Theme::Dark, Theme::Light] {
            let visuals = visuals(theme);
            let (panel, inactive) = (visuals.panel_fill, visuals.widgets.inactive);
            // Blended as egui does, in gamma space.
            let disabled = panel.lerp_to_gamma(inactive.text_color(), visuals.disabled_alpha);
            let text = contrast(linear(disabled), linear(panel));
            assert!(text >= LEAST_CONTRAST, "{theme:?}: disabled text: {text}");
            let outline = contrast(linear(inactive.bg_stroke.color), linear(panel));
            assert!(outline >= 3.0, "{theme:?}: outline: {outline}");
        }
    }

    #[test]
    fn colours_of_comparing_views_differ_from_the_background() {
        for view in INTEGRATORS {
            if view.needs.second == Comparison::Nothing {
                continue;
            }
            for theme in [Theme::Dark, Theme::Light] {
                let background = background(view, Background::White, theme);
                for (colour, meaning) in (view.legend)().into_iter().flatten() {
                    let contrast = contrast(colour, background);
                    assert!(
                        contrast >= LEAST_CONTRAST,
                        "{} in {theme:?}: {meaning}: {contrast}",
                        view.name
                    );
                }
            }
        }
    }
}
