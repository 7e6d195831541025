//! Files of cameras: a JSON list, one camera for each picture.

use super::super::camera::{CameraArgs, is_fov, is_height, is_size};
use super::super::{CommandError, file_error};
use crate::json_error::explained;
use glam::{DVec3, UVec2};
use hitscope_core::names::{alternatives, nearest};
use hitscope_core::obj::shown;
use serde::Deserialize;
use serde_json::value::RawValue;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// A camera of the list.
#[derive(Clone, Debug)]
pub struct ListedCamera {
    /// Its name, for the name of the picture.
    pub name: Option<String>,
    /// The camera, as the command line has it.
    pub camera: CameraArgs,
}

/// The fields of a camera in the file; each but the name means the same as the option of its name.
const FIELDS: [&str; 7] = ["name", "eye", "target", "up", "fov", "ortho", "size"];

/// The message about a file without a list.
const EMPTY: &str =
    "the file is empty; it should have a list of cameras, as in [{\"eye\": [0, 0, 5]}]";

/// What is wrong with a part of the file.
struct Fault {
    /// Lines before the wrong one.
    lines_before: usize,
    message: String,
}

/// Reads a list of cameras.
///
/// # Errors
/// [`CommandError::File`] if the file can't be read, and [`CommandError::Other`] with the line and the field that are
/// wrong.
pub fn read(path: &Path) -> Result<Vec<ListedCamera>, CommandError> {
    let text = fs::read_to_string(path).map_err(|source| file_error(path, source))?;
    parse(&text).map_err(|message| CommandError::Other(format!("{}:{message}", shown(path))))
}

/// Parses a list of cameras. An error begins with its line.
fn parse(text: &str) -> Result<Vec<ListedCamera>, String> {
    let located = |fault: Fault| format!("{}: {}", fault.lines_before + 1, fault.message);
    let cameras: Vec<&RawValue> = value(text, text).map_err(located)?;
    if cameras.is_empty() {
        return Err("1: the list has no cameras".to_owned());
    }
    let camera = |(index, camera): (usize, &&RawValue)| {
        camera_of(text, camera.get()).map_err(|fault| {
            let Fault {
                lines_before,
                message,
            } = fault;
            let message = format!("camera {index}: {message}");
            located(Fault {
                lines_before,
                message,
            })
        })
    };
    cameras.iter().enumerate().map(camera).collect()
}

/// Parses a camera, a part of the file's text.
fn camera_of(text: &str, object: &str) -> Result<ListedCamera, Fault> {
    let fields: BTreeMap<String, &RawValue> = value(text, object)?;
    let mut name = None;
    let mut camera = CameraArgs::default();
    for (field, raw) in &fields {
        let raw = raw.get();
        let mut read = || -> Result<(), Fault> {
            match field.as_str() {
                "name" => name = Some(name_of(text, raw)?),
                "eye" => camera.eye = Some(vector(text, raw)?),
                "target" => camera.target = Some(vector(text, raw)?),
                "up" => camera.up = Some(vector(text, raw)?),
                "fov" => camera.fov = Some(number(text, raw, is_fov, "degrees below 180")?),
                "ortho" => {
                    let expected = "a height above 0, at most 3.4e38";
                    camera.ortho = Some(number(text, raw, is_height, expected)?);
                }
                "size" => camera.size = Some(size(text, raw)?),
                unknown => return Err(fault(text, raw, unknown_field(unknown))),
            }
            Ok(())
        };
        read().map_err(|fault| Fault {
            message: format!("{field}: {}", fault.message),
            ..fault
        })?;
    }
    check(&camera).map_err(|message| fault(text, object, message))?;
    Ok(ListedCamera { name, camera })
}

/// Refuses combinations that the command line refuses, too.
fn check(camera: &CameraArgs) -> Result<(), String> {
    for (field, is_given) in [
        ("target", camera.target.is_some()),
        ("up", camera.up.is_some()),
    ] {
        if is_given && camera.eye.is_none() {
            return Err(format!("{field}: it needs eye"));
        }
    }
    if camera.fov.is_some() && camera.ortho.is_some() {
        return Err("ortho: a camera with fov has none".to_owned());
    }
    camera.check().map_err(|error| error.to_string())
}

fn unknown_field(name: &str) -> String {
    match nearest(name, FIELDS) {
        Some(field) => format!("there is no such field; did you mean {field}?"),
        None => format!(
            "there is no such field; there are {}",
            alternatives(&FIELDS)
        ),
    }
}

/// A name that can be part of a file's name.
fn name_of(text: &str, raw: &str) -> Result<String, Fault> {
    let name: String = value(text, raw)?;
    let is_usable = !name.is_empty() && !name.contains(['/', '\\', '\0']);
    let refuse = || fault(text, raw, "expected a name without slashes".to_owned());
    is_usable.then_some(name).ok_or_else(refuse)
}

fn vector(text: &str, raw: &str) -> Result<DVec3, Fault> {
    // JSON has no infinite numbers, and its parser refuses those that are too large.
    value::<[f64; 3]>(text, raw).map(DVec3::from)
}

fn number(text: &str, raw: &str, is_good: fn(f64) -> bool, expected: &str) -> Result<f64, Fault> {
    let number = value(text, raw)?;
    let refuse = || fault(text, raw, format!("expected {expected}, found {number}"));
    is_good(number).then_some(number).ok_or_else(refuse)
}

fn size(text: &str, raw: &str) -> Result<UVec2, Fault> {
    let size = UVec2::from(value::<[u32; 2]>(text, raw)?);
    let refuse = || {
        let message = "width and height must be integers from 1 to 16384";
        fault(text, raw, message.to_owned())
    };
    is_size(size).then_some(size).ok_or_else(refuse)
}

/// Parses a part of a text.
fn value<'t, T: Deserialize<'t>>(text: &str, part: &'t str) -> Result<T, Fault> {
    serde_json::from_str(part).map_err(|error| {
        let message = match part.trim() {
            "" => EMPTY.to_owned(),
            // The position in the part says nothing about the file.
            _ => explained(&error),
        };
        let mut fault = fault(text, part, message);
        fault.lines_before += error.line().saturating_sub(1);
        fault
    })
}

/// A fault that begins with a part of a text.
fn fault(text: &str, part: &str, message: String) -> Fault {
    // The part borrows from the text.
    let offset = (part.as_ptr() as usize).saturating_sub(text.as_ptr() as usize);
    let before = &text.as_bytes()[..offset.min(text.len())];
    Fault {
        lines_before: before.iter().filter(|&&byte| byte == b'\n').count(),
        message,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_camera_has_the_options_of_the_command_line() {
        let text = r#"[
            {"name": "front", "eye": [0, 1.5, 5], "target": [0, 1, 0], "up": [0, 0, 1], "fov": 30},
            {"ortho": 2.5, "size": [640, 480]},
            {}
        ]"#;
        let cameras = parse(text).expect("good");
        let [front, flat, plain] = &cameras[..] else {
            panic!("{cameras:?}");
        };
        assert_eq!(front.name.as_deref(), Some("front"));
        assert_eq!(front.camera.eye, Some(DVec3::new(0.0, 1.5, 5.0)));
        assert_eq!(front.camera.target, Some(DVec3::Y));
        assert_eq!(front.camera.up, Some(DVec3::Z));
        assert_eq!((front.camera.fov, front.camera.ortho), (Some(30.0), None));
        assert_eq!(flat.camera.ortho, Some(2.5));
        assert_eq!(flat.camera.size, Some(UVec2::new(640, 480)));
        assert!(plain.name.is_none() && plain.camera.eye.is_none());
    }

    #[test]
    fn a_broken_file_is_refused_with_its_line_and_field() {
        for (text, reason) in [
            ("", "1: the file is empty; it should have a list of cameras"),
            ("[{\"eye\"", "1: the text ends too early"),
            ("[]", "1: the list has no cameras"),
            ("{\"eye\": [1,2,3]}", "1: expected a list, found an object"),
            ("[{}\n{}]", "2: expected “,” or “]”"),
            (
                "[{}]\n x",
                "2: there is a value too many, or text after the end",
            ),
            ("[{},\n5]", "2: camera 1: expected an object, found 5"),
            (
                "[{},\n{\"eye\": [1,\n2]}]",
                "3: camera 1: eye: expected a list of 3 values, found 2 values",
            ),
            (
                "[{\"eye\": \"1,2,3\"}]",
                "1: camera 0: eye: expected a list of 3 values, found the text “1,2,3”",
            ),
            (
                "[{\n\"eye\":\n[1, 2, 1e999]}]",
                "3: camera 0: eye: a number is too large",
            ),
            (
                "[{\n\"fov\": 180\n}]",
                "2: camera 0: fov: expected degrees below 180, found 180",
            ),
            (
                "[{\"ortho\": 0}]",
                "1: camera 0: ortho: expected a height above 0",
            ),
            (
                "[{\"size\": [0, 5]}]",
                "1: camera 0: size: width and height",
            ),
            (
                "[{\"size\": [5, -5]}]",
                "1: camera 0: size: expected a whole number that isn't too large, found -5",
            ),
            (
                "[{\"name\": \"a/b\"}]",
                "1: camera 0: name: expected a name",
            ),
            (
                "[{\n\"eyes\": 1}]",
                "2: camera 0: eyes: there is no such field; did you mean eye?",
            ),
            (
                "[{\"x\": 1}]",
                "1: camera 0: x: there is no such field; there are name,",
            ),
            (
                "[{\"target\": [1, 2, 3]}]",
                "1: camera 0: target: it needs eye",
            ),
            (
                "[{\"fov\": 40, \"ortho\": 1}]",
                "1: camera 0: ortho: a camera with fov",
            ),
            (
                "[\n{\"eye\": [1,1,1],\n \"target\": [1,1,1]}]",
                "2: camera 0: the camera's eye and target are the same",
            ),
        ] {
            let message = parse(text).expect_err(text);
            assert!(message.starts_with(reason), "{text}: {message}");
        }
    }
}
