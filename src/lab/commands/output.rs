//! Output files of commands, which appear under their names once they are complete.

use super::draft::Draft;
use super::{CommandError, file_error};
use glam::UVec2;
use hitscope_core::Film;
use hitscope_core::picture::{Alpha, Guides, write_exr};
use std::fmt::Display;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

const STDOUT: &str = "/dev/stdout";

/// An output file, which was writable when this was created.
///
/// A regular file is written to a temporary file in its directory, which is renamed once it is complete. Until then
/// an older file is unchanged; its permissions are kept. Symbolic links are followed. A pipe or a device is opened
/// at once and written directly.
#[derive(Clone, Debug)]
pub struct Output {
    path: PathBuf,
    destination: Destination,
}

#[derive(Clone, Debug)]
enum Destination {
    /// A regular file, which may not exist yet: its path with links resolved.
    Replaced(PathBuf),
    /// A pipe or a device.
    Opened(Arc<File>),
}

impl Output {
    /// Checks that the path can be written. Call this before long work.
    ///
    /// # Errors
    /// [`CommandError::File`] with the system's error.
    pub fn create(path: &Path) -> Result<Self, CommandError> {
        let destination = destination(path).map_err(|source| file_error(path, source))?;
        Ok(Self {
            path: path.to_owned(),
            destination,
        })
    }

    /// The path, as it was given.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes the file. `content` receives a buffered writer.
    ///
    /// # Errors
    /// [`CommandError::File`] with the system's error; an older file is then unchanged.
    pub fn write(
        &self,
        content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), CommandError> {
        let written = match &self.destination {
            Destination::Opened(file) => write_through(file, content),
            Destination::Replaced(path) => Draft::create(path).and_then(|draft| {
                write_through(draft.file(), content)?;
                draft.rename()
            }),
        };
        written.map_err(|source| file_error(&self.path, source))
    }

    /// Writes a film with its guides and its alpha as an OpenEXR file.
    ///
    /// # Errors
    /// See [`write`](Self::write).
    pub fn write_exr(
        &self,
        film: &Film,
        guides: Option<&Guides>,
        alpha: Option<&Alpha>,
    ) -> Result<(), CommandError> {
        self.write_seekable(|to| write_exr(film, guides, alpha, to))
    }

    /// Writes a file whose format needs a place to seek in.
    ///
    /// # Errors
    /// See [`write`](Self::write); also those of `content`.
    pub(super) fn write_seekable<E: Display>(
        &self,
        content: impl FnOnce(&mut io::Cursor<Vec<u8>>) -> Result<(), E>,
    ) -> Result<(), CommandError> {
        let mut bytes = io::Cursor::new(Vec::new());
        content(&mut bytes).map_err(|error| CommandError::Other(error.to_string()))?;
        self.write(|out| out.write_all(bytes.get_ref()))
    }

    /// Writes sRGB pixels, row by row from the top, as a PNG file.
    ///
    /// # Errors
    /// See [`write`](Self::write).
    ///
    /// # Panics
    /// If the number of pixels doesn't match `size`.
    pub fn write_png(&self, size: UVec2, pixels: &[[u8; 4]]) -> Result<(), CommandError> {
        assert_eq!(pixels.len(), size.as_usizevec2().element_product());
        self.write_png_rows(size, |rows| rows.write(pixels))
    }

    /// Writes a PNG file. `content` receives the writer of its rows, and writes them from top to bottom.
    ///
    /// # Errors
    /// See [`write`](Self::write); also those of `content`. In either case an older file is unchanged.
    pub fn write_png_rows<E: From<CommandError>>(
        &self,
        size: UVec2,
        content: impl FnOnce(&mut PngRows<'_>) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut failed = None;
        let written = self.write(|out| {
            let mut encoder = png::Encoder::new(out, size.x, size.y);
            encoder.set_color(png::ColorType::Rgba);
            encoder.set_depth(png::BitDepth::Eight);
            encoder.set_compression(png::Compression::Fast);
            encoder.set_filter(png::Filter::Adaptive);
            let mut writer = encoder.write_header()?;
            let mut stream = writer.stream_writer()?;
            let mut rows = PngRows {
                path: &self.path,
                stream: &mut stream,
            };
            if let Err(error) = content(&mut rows) {
                failed = Some(error);
                return Err(io::Error::other("the rows are missing"));
            }
            stream.finish()?;
            Ok(writer.finish()?)
        });
        match failed {
            Some(error) => Err(error),
            None => Ok(written?),
        }
    }
}

/// Writes the rows of a PNG file.
pub struct PngRows<'a> {
    path: &'a Path,
    stream: &'a mut dyn Write,
}

impl PngRows<'_> {
    /// Writes the next rows: sRGB pixels with alpha.
    ///
    /// # Errors
    /// [`CommandError::File`] with the system's error.
    pub fn write(&mut self, pixels: &[[u8; 4]]) -> Result<(), CommandError> {
        let written = self.stream.write_all(pixels.as_flattened());
        written.map_err(|source| file_error(self.path, source))
    }
}

/// Whether two paths name the same existing file.
pub(super) fn is_same_file(a: &Path, b: &Path) -> bool {
    match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
    }
}

/// Whether a path is written directly, as pipes, devices and descriptors are, and not replaced.
pub(super) fn is_stream(path: &Path) -> bool {
    // A file that stdout is redirected to mustn't be replaced: other programs may write to it, too.
    let is_descriptor = [STDOUT, "/dev/stderr", "/dev/fd", "/proc"]
        .iter()
        .any(|place| path.starts_with(place));
    is_descriptor || fs::metadata(path).is_ok_and(|info| !info.is_file() && !info.is_dir())
}

fn destination(path: &Path) -> io::Result<Destination> {
    if is_stream(path) {
        return Ok(Destination::Opened(Arc::new(stream(path)?)));
    }
    let path = behind_links(path)?;
    match OpenOptions::new().write(true).open(&path) {
        // A read-only file isn't replaced either.
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
        _ => {}
    }
    let draft = Draft::create(&path).map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => io::Error::other("its folder doesn't exist"),
        _ => error,
    });
    drop(draft?);
    Ok(Destination::Replaced(path))
}

fn stream(path: &Path) -> io::Result<File> {
    // Opened by its name, a file that stdout is redirected to would be overwritten from its beginning.
    #[cfg(unix)]
    if path == Path::new(STDOUT) {
        use std::os::fd::AsFd as _;
        return Ok(io::stdout().as_fd().try_clone_to_owned()?.into());
    }
    #[cfg(windows)]
    if path == Path::new(STDOUT) {
        use std::os::windows::io::AsHandle as _;
        return Ok(io::stdout().as_handle().try_clone_to_owned()?.into());
    }
    OpenOptions::new().append(true).open(path)
}

/// A path with the symbolic links at its end resolved. The target needn't exist.
fn behind_links(path: &Path) -> io::Result<PathBuf> {
    /// The limit of Linux.
    const MOST_LINKS: u32 = 40;
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        let Ok(target) = fs::read_link(&path) else {
            return Ok(path);
        };
        path = path.parent().unwrap_or(Path::new("")).join(target);
    }
    Err(io::Error::other("too many levels of symbolic links"))
}

/// Writes through a buffer.
fn write_through(
    file: &File,
    content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let mut out = BufWriter::new(file);
    content(&mut out)?;
    out.flush()
}
