//! Side B when it is a picture in a file.

use crate::retired::{Retired, Shared};
use crate::task::{KeyedTask, Task, TaskPanicked, in_own_pool};
use glam::{UVec2, Vec3};
use hitscope_core::obj::LoadError;
use hitscope_core::picture::{PictureEncoding, PictureFile};
use hitscope_core::progress::Progress;
use hitscope_core::tone::Display;
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Limit on the pixels of a reference. Side A has as many, and each takes about a hundred bytes.
const MOST_PIXELS: u32 = 1 << 25;

/// A picture in a file, and its pixels encoded for the screen.
#[derive(Default)]
pub struct Reference {
    loaded: Option<(PathBuf, Arc<PictureFile>)>,
    loading: Option<(PathBuf, Task<Result<PictureFile, LoadError>>)>,
    /// Whether the file is to be loaded again.
    is_stale: bool,
    /// The pixels encoded for the screen, and how they are encoded.
    developed: Option<(Display, Vec<[u8; 4]>)>,
    development: KeyedTask<Display, Vec<[u8; 4]>>,
}

impl Shared for Reference {
    fn is_shared(&self) -> bool {
        self.picture().is_some_and(Shared::is_shared)
    }
}

impl Reference {
    /// Starts to load a file, unless it is loaded or being loaded.
    pub fn want(&mut self, path: &Path, max_memory: u64, ctx: &egui::Context) {
        let is_loaded = self.loaded.as_ref().is_some_and(|(known, _)| known == path);
        let is_loading = self
            .loading
            .as_ref()
            .is_some_and(|(known, _)| known == path);
        if (is_loaded && !self.is_stale) || is_loading {
            return;
        }
        self.is_stale = false;
        let file = path.to_owned();
        let load = move || PictureFile::load(&file, max_memory, &Progress::default());
        self.loading = Some((path.to_owned(), Task::spawn("reference", ctx, load)));
    }

    /// Reloads the file on the next [`want`](Self::want). Until it is loaded, the old picture stays.
    pub fn reload(&mut self) {
        (self.loading, self.is_stale) = (None, true);
    }

    /// Collects a loaded picture, and retires the previous one. `longest` is the largest width and height allowed.
    ///
    /// # Errors
    /// Why there is no picture.
    pub fn poll(&mut self, longest: u32, retired: &mut Retired) -> Result<(), String> {
        let Some((path, task)) = &self.loading else {
            return Ok(());
        };
        let path = path.clone();
        let loaded = match task.poll() {
            Ok(None) => return Ok(()),
            Ok(Some(result)) => result.map_err(|error| error.to_string()),
            Err(broken) => Err(format!("{}: {broken}", path.display())),
        };
        retired.add(std::mem::take(self));
        let picture = loaded?;
        let UVec2 { x, y } = picture.size;
        if x.max(y) > longest || u64::from(x) * u64::from(y) > MOST_PIXELS.into() {
            return Err(format!(
                "{}: {x} x {y} pixels are too many for a comparison",
                path.display()
            ));
        }
        self.loaded = Some((path, Arc::new(picture)));
        Ok(())
    }

    /// Whether a file is being loaded.
    pub fn is_loading(&self) -> bool {
        self.loading.is_some()
    }

    /// The picture, once it is loaded.
    pub fn picture(&self) -> Option<&Arc<PictureFile>> {
        self.loaded.as_ref().map(|(_, picture)| picture)
    }

    /// Encodes the picture for the screen in the background. Returns whether there are new pixels.
    ///
    /// # Errors
    /// [`TaskPanicked`] if encoding failed.
    pub fn develop(&mut self, display: Display, ctx: &egui::Context) -> Result<bool, TaskPanicked> {
        let Some((_, picture)) = &self.loaded else {
            return Ok(false);
        };
        if self.developed.as_ref().map(|(display, _)| *display) == Some(display) {
            return Ok(false);
        }
        let start = || {
            let picture = Arc::clone(picture);
            Task::spawn("encode", ctx, move || {
                in_own_pool(|| encoded(&picture, display))
            })
        };
        let developed = self.development.in_turn(display, start)?;
        let is_new = developed.is_some();
        if is_new {
            self.developed = developed;
        }
        Ok(is_new)
    }

    /// Whether the picture is being loaded, or encoded.
    pub fn is_pending(&self) -> bool {
        let lacks_pixels = self.loaded.is_some() && self.developed.is_none();
        self.is_loading() || self.development.is_running() || lacks_pixels
    }

    /// All pixels, as they were last encoded; `None` before that.
    pub fn pixels(&self) -> Option<&[[u8; 4]]> {
        self.developed.as_ref().map(|(_, pixels)| &**pixels)
    }
}

fn encoded(picture: &PictureFile, display: Display) -> Vec<[u8; 4]> {
    let shown = |&[r, g, b, _]: &[f32; 4]| match picture.encoding {
        PictureEncoding::Linear => display.encode(Vec3::new(r, g, b)),
        PictureEncoding::Display => {
            let [r, g, b] = [r, g, b].map(|x| (255.0 * x).round() as u8);
            [r, g, b, 255]
        }
    };
    picture.texels.par_iter().map(shown).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::task::sabotage;
    use std::time::Duration;

    #[test]
    fn a_reference_is_encoded_in_the_background() {
        let ctx = egui::Context::default();
        let picture = PictureFile {
            size: UVec2::ONE,
            encoding: PictureEncoding::Display,
            texels: vec![[1.0, 0.0, 0.2, 1.0]],
        };
        let mut reference = Reference {
            loaded: Some((PathBuf::new(), Arc::new(picture))),
            ..Reference::default()
        };
        let hold = sabotage::hold("encode");
        let develop = |reference: &mut Reference| reference.develop(Display::default(), &ctx);
        assert!(matches!(develop(&mut reference), Ok(false)));
        assert!(reference.is_pending() && reference.pixels().is_none());
        drop(hold);
        while !develop(&mut reference).expect("no panic") {
            std::thread::sleep(Duration::from_millis(1));
        }
        assert_eq!(reference.pixels(), Some(&[[255, 0, 51, 255]][..]));
        assert!(!reference.is_pending());
    }
}
