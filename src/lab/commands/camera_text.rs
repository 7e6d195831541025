//! A camera as text: the arguments that the commands read.

use super::CameraArgs;
use clap::{CommandFactory, Parser};
use glam::DVec3;
use hitscope_core::Camera;
use hitscope_core::camera::Projection;
use hitscope_core::obj::shortened;
use std::fmt;
use std::path::Path;

/// The least distance from eye to target, relative to the coordinates of the eye. The direction between points that
/// are closer would lose more digits than pictures need.
const LEAST_DISTANCE: f64 = 1e-4;

/// The arguments without a command.
#[derive(Parser)]
#[command(
    no_binary_name = true,
    disable_help_flag = true,
    disable_version_flag = true
)]
struct CameraText {
    #[command(flatten)]
    camera: CameraArgs,
}

impl CameraArgs {
    /// The arguments of a camera in a scene with this origin, with a target this far away. The picture's size is left
    /// out.
    pub fn of_camera(camera: &Camera, origin: DVec3, distance: f64) -> Self {
        let eye = camera.exact_eye() + origin;
        let distance = distance.max(LEAST_DISTANCE * eye.abs().max_element());
        let (fov, ortho) = match camera.projection() {
            Projection::Perspective { fov_y_radians } => (Some(fov_y_radians.to_degrees()), None),
            Projection::Orthographic { height } => (None, Some(height)),
        };
        Self {
            size: None,
            eye: Some(eye),
            target: Some(eye - distance * camera.back()),
            up: Some(camera.up()),
            fov,
            ortho,
            session: None,
        }
    }

    /// Reads arguments, such as `--eye 1,2,3 --fov 40`, or those of a whole command of hitscope.
    ///
    /// # Errors
    /// The reason, in a short line.
    pub fn from_text(text: &str) -> Result<Self, String> {
        let words: Vec<&str> = text.split_whitespace().collect();
        let parsed = CameraText::try_parse_from(of_camera(&words));
        parsed.map(|text| text.camera).map_err(|error| {
            let message = error.to_string();
            // The usage follows after an empty line.
            let first = message.split("\n\n").next().unwrap_or_default();
            let words: Vec<String> = first.split_whitespace().map(shortened).collect();
            words.join(" ").trim_start_matches("error: ").to_owned()
        })
    }
}

/// The camera's arguments in a command of hitscope; all words if they aren't such a command.
fn of_camera<'w>(words: &[&'w str]) -> Vec<&'w str> {
    let program = words.first().and_then(|word| Path::new(word).file_stem());
    if program.is_none_or(|program| program != "hitscope") {
        return words.to_vec();
    }
    let command = CameraText::command();
    let names: Vec<&str> = command
        .get_arguments()
        .filter_map(|a| a.get_long())
        .collect();
    let mut words = words.iter().copied();
    let mut found = Vec::new();
    while let Some(word) = words.next() {
        let option = word.strip_prefix("--").unwrap_or_default();
        let (name, value) = option.split_once('=').unzip();
        if names.contains(&name.unwrap_or(option)) {
            found.push(word);
            if value.is_none() {
                found.extend(words.next());
            }
        }
    }
    found
}

impl fmt::Display for CameraArgs {
    /// Writes the arguments as they are on a command line. Numbers read back to the same value.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let vector = |v: DVec3| format!("{},{},{}", v.x, v.y, v.z);
        let arguments = [
            (
                "size",
                self.size.map(|size| format!("{}x{}", size.x, size.y)),
            ),
            ("eye", self.eye.map(vector)),
            ("target", self.target.map(vector)),
            ("up", self.up.map(vector)),
            ("fov", self.fov.map(|degrees| degrees.to_string())),
            ("ortho", self.ortho.map(|height| height.to_string())),
            (
                "session",
                self.session.as_ref().map(|path| path.display().to_string()),
            ),
        ];
        let given = arguments
            .into_iter()
            .filter_map(|(name, value)| Some(format!("--{name} {}", value?)));
        f.write_str(&given.collect::<Vec<_>>().join(" "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec2, UVec2};
    use hitscope_core::Scene;
    use hitscope_core::mesh::shapes::{Placement, sphere};
    use hitscope_core::scene::scene;

    /// A scene whose origin isn't zero.
    fn far_scene() -> Scene {
        let mesh = sphere(8, Placement::UNIT);
        scene(mesh.with_origin(DVec3::new(5e5, -2e6, 0.25)))
    }

    #[test]
    fn a_camera_reads_back_from_its_text() {
        let size = UVec2::new(64, 48);
        let scene = far_scene();
        for projection in [
            Projection::Perspective { fov_y_radians: 0.7 },
            Projection::Orthographic { height: 2.5e-3 },
        ] {
            for distance in [3.7, 1e-7] {
                let back = DVec3::new(0.3, -0.8, 0.5).normalize();
                let target = DVec3::new(0.1, 0.2, -0.3);
                let eye = target + distance * back;
                let camera = Camera::look_at(eye, target, DVec3::Z, projection, size);
                let camera = camera.expect("a camera");
                let origin = scene.mesh().origin();
                let text = CameraArgs::of_camera(&camera, origin, distance).to_string();
                let args = CameraArgs::from_text(&text).expect("its own text");
                assert_eq!(args.to_string(), text);
                let args = CameraArgs {
                    size: Some(size),
                    ..args
                };
                let again = args.camera(&scene, None).expect("a camera");
                for at in [DVec2::ZERO, DVec2::new(31.5, 20.25), size.as_dvec2()] {
                    let [(origin, dir), (expected_origin, expected_dir)] =
                        [again, camera].map(|camera| {
                            let [origin, dir] = camera.ray_before_rounding(at);
                            (origin, dir)
                        });
                    // Coordinates of 2e6 are rounded to 2⁻³², and the distance is at least 2e6 / 1e4.
                    let off = (origin - expected_origin).length();
                    assert!(off < 1e-9, "{origin} {expected_origin}: {text}");
                    let off = (dir - expected_dir).length();
                    assert!(off < 1e-11, "{dir} {expected_dir}: {text}");
                }
            }
        }
    }

    #[test]
    fn the_camera_of_a_whole_command_is_read() {
        let expected = CameraArgs::from_text("--eye 1,2,-3 --fov 25").expect("a camera");
        for text in [
            "hitscope --eye 1,2,-3 --fov 25",
            "hitscope mesh.obj --eye=1,2,-3 --fov 25",
            "hitscope render 'a b.obj' -o x.png --samples 4 --eye 1,2,-3 --wireframe --fov=25",
            "./target/release/hitscope inspect mesh.obj --eye 1,2,-3 --pixel 3,4 --fov 25 --json",
        ] {
            let args = CameraArgs::from_text(text).expect(text);
            assert_eq!(args.to_string(), expected.to_string(), "{text}");
        }
        let error = CameraArgs::from_text("hitscope render mesh.obj --eye 1,2");
        assert!(error.expect_err("a reason").contains("three numbers"));
    }

    #[test]
    fn a_long_text_is_shortened_in_the_reason() {
        let reason = CameraArgs::from_text(&"x".repeat(3_000_000)).expect_err("no camera");
        assert!(reason.contains('…') && reason.len() < 200, "{reason}");
    }

    #[test]
    fn what_is_no_camera_is_refused_in_a_line() {
        for (text, reason) in [
            ("hello", "unexpected argument 'hello' found"),
            ("--eye 1,2", "expected three numbers"),
            ("--target 1,2,3", "--eye <X,Y,Z>"),
            ("--eye 1,2,3 --fov 40 --ortho 2", "cannot be used with"),
            ("--help", "unexpected argument"),
        ] {
            let refused = CameraArgs::from_text(text).expect_err(text);
            assert!(refused.contains(reason), "{refused}");
            assert!(
                !refused.contains('\n') && !refused.starts_with("error"),
                "{refused}"
            );
        }
    }
}
