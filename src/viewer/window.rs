//! The window: fitting it to the screen, and ending if another program destroys it.

use crate::about::NAME;
use crate::storage::APP_ID;
use eframe::icon_data::from_png_bytes;
use egui::{IconData, Vec2, ViewportBuilder, ViewportCommand, vec2};
use std::panic::{
    AssertUnwindSafe, PanicHookInfo, catch_unwind, resume_unwind, set_hook, take_hook,
};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

/// Initial size in points. With a title bar and a desktop panel it fits a screen of 1280 × 800.
const SIZE: Vec2 = vec2(1200.0, 700.0);
/// Fits a screen of 800 × 600 at a scale of 200 %.
const MIN_SIZE: Vec2 = vec2(380.0, 240.0);
/// Space that frames, title bars (up to 37 points) and panels (up to 48) of common desktops take.
const DESKTOP: Vec2 = vec2(4.0, 60.0);
/// The icon, for desktops that don't take it from a package.
const ICON: &[u8] = include_bytes!("../../assets/icon/hitscope-256.png");

/// The window at the first start.
pub fn viewport() -> ViewportBuilder {
    ViewportBuilder::default()
        .with_app_id(APP_ID)
        .with_title(NAME)
        .with_icon(icon())
        .with_inner_size(SIZE)
        .with_min_inner_size(MIN_SIZE)
}

fn icon() -> IconData {
    from_png_bytes(ICON).expect("a test decodes the icon")
}

/// Removes values from a restored window that could put it off the screen.
///
/// eframe checks a stored position only on Windows and macOS; elsewhere the position is dropped, and the window
/// manager chooses one.
pub fn checked(viewport: ViewportBuilder) -> ViewportBuilder {
    let is_checked = cfg!(any(target_os = "windows", target_os = "macos"));
    let size = viewport.inner_size.filter(|size| size.is_finite());
    ViewportBuilder {
        inner_size: Some(size.unwrap_or(SIZE).max(MIN_SIZE)),
        position: viewport
            .position
            .filter(|position| is_checked && position.is_finite()),
        ..viewport
    }
}

/// Maximizes the window, once, if it leaves no room for its title bar and the desktop's panel, whose sizes only
/// the window manager knows.
#[derive(Default)]
pub struct FitToScreen {
    is_done: bool,
}

impl FitToScreen {
    /// Called in each frame, since window managers ignore requests of a window that isn't shown yet.
    pub fn step(&mut self, ctx: &egui::Context) {
        if self.is_done || ctx.cumulative_frame_nr() < 3 {
            return;
        }
        let (screen, is_large) = ctx.input(|input| {
            let viewport = input.viewport();
            let is_large = viewport.maximized == Some(true) || viewport.fullscreen == Some(true);
            (viewport.monitor_size, is_large)
        });
        let Some(screen) = screen else { return };
        self.is_done = true;
        if !is_large && !fits(ctx.content_rect().size(), screen) {
            ctx.send_viewport_cmd(ViewportCommand::Maximized(true));
        }
    }
}

/// Whether a window's contents leave room for frames, title bar and panel.
fn fits(size: Vec2, screen: Vec2) -> bool {
    (size + DESKTOP).x <= screen.x && (size + DESKTOP).y <= screen.y
}

/// Runs the window; `None` if another program destroyed it (`xdotool windowclose`, `xkill` by its window), or if it
/// panicked and `is_expected` returns `true`.
///
/// X11 then refuses every request for the window, and winit 0.30 panics; this function treats the panic as a
/// normal end.
pub fn run_until_destroyed<T>(
    run: impl FnOnce() -> T,
    is_expected: impl Fn() -> bool,
) -> Option<T> {
    let is_destroyed = Arc::new(AtomicBool::new(false));
    let (shared, report) = (Arc::clone(&is_destroyed), take_hook());
    set_hook(Box::new(move |panic| {
        if is_of_destroyed_window(panic) {
            shared.store(true, Relaxed);
        } else {
            report(panic);
        }
    }));
    match catch_unwind(AssertUnwindSafe(run)) {
        Ok(result) => Some(result),
        Err(_) if is_destroyed.load(Relaxed) || is_expected() => None,
        Err(panic) => resume_unwind(panic),
    }
}

/// Whether winit panicked because the X11 window no longer exists (BadWindow or BadDrawable).
fn is_of_destroyed_window(panic: &PanicHookInfo<'_>) -> bool {
    let message = panic.payload_as_str().unwrap_or_default();
    let kinds = ["error_kind: Window,", "error_kind: Drawable,"];
    message.contains("X11Error") && kinds.iter().any(|kind| message.contains(kind))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_window_has_the_icon() {
        let icon = viewport().icon.expect("an icon");
        assert_eq!([icon.width, icon.height], [256; 2]);
        // The corners are transparent, the centre isn't.
        let alpha = |pixel: usize| icon.rgba[4 * pixel + 3];
        assert_eq!([alpha(0), alpha(256 * 128 + 128)], [0, 255]);
    }

    #[test]
    fn the_first_window_fits_a_small_laptop_but_no_smaller_screen() {
        assert!(fits(SIZE, vec2(1280.0, 800.0)));
        assert!(fits(SIZE, vec2(1366.0, 768.0)));
        assert!(!fits(SIZE, vec2(1280.0, 720.0)));
        assert!(fits(2.0 * MIN_SIZE, vec2(800.0, 600.0)));
        // As limited by eframe.
        assert!(!fits(vec2(800.0, 600.0), vec2(800.0, 600.0)));
    }

    #[test]
    fn a_restored_window_has_a_valid_size_and_position() {
        for (stored, expected) in [
            (vec2(900.0, 640.0), vec2(900.0, 640.0)),
            (vec2(0.0, 64.0), MIN_SIZE),
            (vec2(f32::NAN, 500.0), SIZE),
            (Vec2::splat(f32::INFINITY), SIZE),
        ] {
            let viewport = viewport()
                .with_inner_size(stored)
                .with_position([1e9, -1e9]);
            let checked = checked(viewport);
            assert_eq!(checked.inner_size, Some(expected));
            #[cfg(target_os = "linux")]
            assert_eq!(checked.position, None);
        }
        let nowhere = viewport().with_position([f32::NAN, 0.0]);
        assert_eq!(checked(nowhere).position, None);
    }
}
