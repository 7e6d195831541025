//! The time from the start of the program to the first traced picture on the screen.

use std::time::{Duration, Instant};

/// The time to the first picture, once it is known.
pub struct FirstPicture {
    began: Instant,
    /// Whether a frame has drawn the picture.
    is_drawn: bool,
    after: Option<Duration>,
}

impl FirstPicture {
    /// Nothing is shown yet by a program that began at this time.
    pub fn new(began: Instant) -> Self {
        Self {
            began,
            is_drawn: false,
            after: None,
        }
    }

    /// The frame draws a traced picture. The next frame, which is asked for, knows that it is on the screen.
    pub fn draw(&mut self, ctx: &egui::Context) {
        if !self.is_drawn {
            self.is_drawn = true;
            ctx.request_repaint();
        }
    }

    /// A frame begins: what the one before it has drawn is on the screen.
    pub fn begin_frame(&mut self) {
        if self.is_drawn && self.after.is_none() {
            self.after = Some(self.began.elapsed());
        }
    }

    /// The time from the start of the program to the first picture; `None` before it.
    pub fn after(&self) -> Option<Duration> {
        self.after
    }
}

/// The time for people, such as `first picture after 0.44 s`.
pub fn shown_time(after: Duration) -> String {
    format!("first picture after {:.2} s", after.as_secs_f64())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_time_ends_with_the_frame_after_the_one_that_drew_the_picture() {
        let ctx = egui::Context::default();
        let began = Instant::now();
        let mut first = FirstPicture::new(began);
        first.begin_frame();
        first.draw(&ctx);
        assert_eq!(first.after(), None);
        first.begin_frame();
        let after = first.after().expect("shown");
        assert!(after <= began.elapsed());
        first.draw(&ctx);
        first.begin_frame();
        assert_eq!(first.after(), Some(after));
        let text = shown_time(Duration::from_millis(437));
        assert_eq!(text, "first picture after 0.44 s");
    }
}
