//! Pictures of what is on the screen, saved to a file or copied, in the background.

use super::App;
use super::picture_dialog::PictureDialog;
use crate::offscreen;
use crate::task::{Task, TaskPanicked};
use hitscope_core::obj::shown;
use hitscope_lab::commands::Output;
use std::path::{Path, PathBuf};

/// Where a picture goes.
enum Target {
    File(PathBuf),
    Clipboard,
}

/// A picture that was taken.
enum Taken {
    Saved(PathBuf),
    Copied(egui::ColorImage),
}

/// The picture that is being taken, and the dialog.
pub(super) struct Pictures {
    task: Option<Task<Result<Taken, String>>>,
    /// The dialog for pictures of any size.
    pub dialog: PictureDialog,
    /// Memory of the strips in which the dialog's pictures are rendered, in bytes.
    pub strip_bytes: u64,
}

impl Pictures {
    pub fn new(strip_bytes: u64) -> Self {
        Self {
            task: None,
            dialog: PictureDialog::default(),
            strip_bytes,
        }
    }
}

impl App {
    /// Saves the picture on the screen beside the open file, with or without the overlay.
    pub(crate) fn save_picture(
        &mut self,
        has_overlay: bool,
        ctx: &egui::Context,
        frame: &eframe::Frame,
    ) {
        let open = self.open.document.path.as_deref();
        let target = Target::File(free_path(open.unwrap_or(Path::new("hitscope")), "png"));
        self.take_picture(target, has_overlay, ctx, frame);
    }

    /// Copies the picture on the screen with the overlay.
    pub(crate) fn copy_picture(&mut self, ctx: &egui::Context, frame: &eframe::Frame) {
        self.take_picture(Target::Clipboard, true, ctx, frame);
    }

    fn take_picture(
        &mut self,
        target: Target,
        has_overlay: bool,
        ctx: &egui::Context,
        frame: &eframe::Frame,
    ) {
        let on_screen = self.traced.on_screen.clone().zip(self.shown_picture());
        let matching =
            on_screen.filter(|((_, camera), picture)| camera.resolution() == picture.size);
        let (Some(((scene, camera), picture)), Some(gpu)) = (matching, frame.wgpu_render_state())
        else {
            let reason = self.lacks_shown_picture();
            return self.refuse(reason.unwrap_or("The picture isn't ready yet"));
        };
        let scale = ctx.pixels_per_point();
        let is_overlaid = has_overlay && picture.overlaid_columns > 0;
        let input = is_overlaid.then(|| self.overlay_input(&scene, camera, scale));
        let overlays = self.seen.settings.overlays.clone();
        let (device, queue) = (gpu.device.clone(), gpu.queue.clone());
        let work = move || {
            let (size, mut pixels) = (picture.size, picture.pixels);
            if let Some(input) = input {
                let (width, overlaid) = (size.x as usize, picture.overlaid_columns as usize);
                let bare = (overlaid < width).then(|| pixels.clone());
                offscreen::draw_onto(&mut pixels, (&device, &queue), &input, &overlays)
                    .map_err(|error| error.to_string())?;
                let bare_rows = bare.iter().flat_map(|bare| bare.chunks(width));
                for (row, bare) in pixels.chunks_mut(width).zip(bare_rows) {
                    row[overlaid..].copy_from_slice(&bare[overlaid..]);
                }
            }
            match target {
                Target::File(path) => Output::create(&path)
                    .and_then(|output| output.write_png(size, &pixels))
                    .map(|()| Taken::Saved(path))
                    .map_err(|error| error.to_string()),
                Target::Clipboard => {
                    let size = size.to_array().map(|side| side as usize);
                    let bytes = pixels.as_flattened();
                    let image = egui::ColorImage::from_rgba_unmultiplied(size, bytes);
                    Ok(Taken::Copied(image))
                }
            }
        };
        self.pictures.task = Some(Task::spawn("picture", ctx, work));
    }

    /// Tells when a picture is saved or copied.
    pub(super) fn poll_pictures(&mut self, ctx: &egui::Context) {
        let result = match self.pictures.task.as_ref().map(Task::poll) {
            None | Some(Ok(None)) => return,
            Some(Ok(Some(result))) => result,
            Some(Err(broken @ TaskPanicked)) => Err(broken.to_string()),
        };
        self.pictures.task = None;
        match result {
            Ok(Taken::Saved(path)) => self.tell(format!("Saved {}", shown(&path))),
            Ok(Taken::Copied(image)) => {
                ctx.copy_image(image);
                self.tell("Copied the picture");
            }
            Err(error) => self.error(error),
        }
    }
}

/// The first path of `mesh-1.png`, `mesh-2.png` and so on beside `mesh.obj` that has no file.
pub(super) fn free_path(open: &Path, extension: &str) -> PathBuf {
    let stem = open.file_stem().unwrap_or(open.as_os_str()).to_owned();
    let numbered = |k: u32| {
        let mut name = stem.clone();
        name.push(format!("-{k}.{extension}"));
        open.with_file_name(name)
    };
    let free = (1..u32::MAX).map(numbered).find(|path| !path.exists());
    free.unwrap_or_else(|| numbered(u32::MAX))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_is_saved_beside_the_file_under_a_free_name() {
        let folder = tempfile::tempdir().expect("a folder");
        let mesh = folder.path().join("mesh.obj");
        assert_eq!(free_path(&mesh, "png"), folder.path().join("mesh-1.png"));
        std::fs::write(folder.path().join("mesh-1.png"), "").expect("written");
        assert_eq!(free_path(&mesh, "png"), folder.path().join("mesh-2.png"));
        assert_eq!(
            free_path(Path::new("hitscope"), "png"),
            Path::new("hitscope-1.png")
        );
    }
}
