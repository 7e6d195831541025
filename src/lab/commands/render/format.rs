//! The formats and names of outputs.

use super::super::output::is_stream;
use clap::ValueEnum;
use std::path::{Path, PathBuf};

/// The format of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PictureFormat {
    /// PNG, with the colours of the screen
    Png,
    /// OpenEXR, with linear radiance
    Exr,
}

impl PictureFormat {
    /// The format that the name of a file asks for: that of its extension; PNG for pipes and devices.
    pub fn of_name(path: &Path) -> Option<Self> {
        if is_stream(path) || has_extension(path, "png") {
            Some(Self::Png)
        } else {
            has_extension(path, "exr").then_some(Self::Exr)
        }
    }
}

/// Standard output as a file.
const STDOUT: &str = "/dev/stdout";

/// Parses the path of a picture in any format; `-` is standard output.
///
/// # Errors
/// A message for the user.
pub fn parse_output(text: &str) -> Result<PathBuf, String> {
    match text {
        "" => Err("expected the name of a file".to_owned()),
        "-" => Ok(STDOUT.into()),
        _ => Ok(text.into()),
    }
}

/// Parses the path of a PNG file: a name ending in .png, a pipe or a device.
///
/// # Errors
/// A message for the user.
pub fn parse_png(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match PictureFormat::of_name(&path) {
        Some(PictureFormat::Png) => Ok(path),
        _ => Err(
            "only PNG files are written: the name must end in .png, or be /dev/stdout".to_owned(),
        ),
    }
}

/// Parses the path of an OpenEXR file.
///
/// # Errors
/// A message for the user.
pub fn parse_exr(text: &str) -> Result<PathBuf, String> {
    if has_extension(Path::new(text), "exr") {
        Ok(text.into())
    } else {
        Err("the name must end in .exr".to_owned())
    }
}

fn has_extension(path: &Path, extension: &str) -> bool {
    let own = path.extension().unwrap_or_default();
    own.eq_ignore_ascii_case(extension)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_format_follows_from_the_name() {
        for (name, format) in [
            ("a.png", Some(PictureFormat::Png)),
            ("a.PNG", Some(PictureFormat::Png)),
            ("a.b.exr", Some(PictureFormat::Exr)),
            ("/dev/stdout", Some(PictureFormat::Png)),
            ("/tmp/thumbnail.tmp", None),
            ("png", None),
            ("a.obj", None),
        ] {
            assert_eq!(PictureFormat::of_name(Path::new(name)), format, "{name}");
        }
        assert_eq!(parse_output("-"), Ok(STDOUT.into()));
        assert!(parse_png("a.exr").is_err() && parse_output("").is_err());
        assert!(parse_exr("a.png").is_err());
    }
}
