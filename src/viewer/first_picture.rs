//! The time from the start of the program to the first traced picture on the screen.

use std::time::{Duration, Instant};

/// The start time of the program, and the time to its first traced picture once that is known.
pub struct FirstPicture {
    began: Instant,
    /// Whether a frame has drawn the picture.
    is_drawn: bool,
    after: Option<Duration>,
}

impl FirstPicture {
    /// The state of a program that began at this time and hasn't shown a picture.
    pub fn new(began: Instant) -> Self {
        Self {
            began,
            is_drawn: false,
            after: None,
        }
    }

    /// Notes that this frame draws a traced picture, and requests the next frame, when the picture is on the screen.
    pub fn draw(&mut self, ctx: &egui::Context) {
        if !self.is_drawn {
            self.is_drawn = true;
            ctx.request_repaint();
        }
    }

    /// Notes that a frame begins. The previous frame is on the screen by then.
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

/// The time as text, such as `first picture after 0.44 s`.
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
