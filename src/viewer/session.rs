//! A session as plain data: the open file and how it is shown. Its [`Sight`] is also an undo step, and `--session`
//! takes its camera on the command line.
//!
//! Session files are JSON. Unknown fields are ignored. Settings that are missing, or that no control can set, have
//! their defaults. Settings that have their defaults aren't written.

mod compact;
mod picked_pixel;

pub use hitscope_lab::viewpoint::Viewpoint;
pub use picked_pixel::PickedPixel;

use crate::comparison::Comparison;
use crate::parts::PartsChoice;
use crate::picks::Snapping;
use crate::settings::Settings;
use crate::storage::usable;
use crate::tab::Tab;
use hitscope_core::obj::shown;
use hitscope_lab::viewpoint;
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

/// The extension of session files.
pub const EXTENSION: &str = "hitscope";
/// Size limit of a session file, which usually has some thousand bytes.
const MAX_BYTES: u64 = 1 << 20;

/// A session.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Session {
    /// The version of the format.
    hitscope: u32,
    /// The open file; `None` for the built-in scene.
    #[serde(default)]
    pub file: Option<PathBuf>,
    /// How it is seen.
    pub sight: Sight,
    /// Whether noise is shown instead of the picture.
    #[serde(default)]
    shows_noise: bool,
    /// Whether the side panel is shown.
    #[serde(default)]
    pub shows_panel: bool,
    /// The tab of the side panel.
    #[serde(default)]
    pub tab: Tab,
}

/// How a document is seen: the step of undo.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sight {
    /// The camera.
    pub camera: Viewpoint,
    /// How the scene is shown.
    #[serde(default, serialize_with = "compact::changed")]
    pub settings: Settings,
    /// The choices about the comparison.
    #[serde(default, serialize_with = "compact::changed")]
    pub comparison: Comparison,
    /// Hidden parts, and custom colours of parts.
    #[serde(default, serialize_with = "compact::changed")]
    pub parts: PartsChoice,
    /// The list of picks.
    #[serde(default)]
    pub picks: Vec<PickedPixel>,
    /// What picks snap to.
    #[serde(default)]
    pub snapping: Snapping,
}

impl Session {
    /// A session. Its settings don't depend on what the file asks for.
    pub fn new(file: Option<PathBuf>, sight: Sight, shows_panel: bool, tab: Tab) -> Self {
        let mut sight = sight;
        let settings = &mut sight.settings;
        let (view, kernel, axis) = (settings.view(), settings.kernel(), settings.up_axis());
        settings.keep_view(view.name);
        settings.keep_kernel(kernel.info.name);
        settings.keep_up_axis(axis);
        settings.keep_environment(settings.environment());
        Self {
            hitscope: viewpoint::SESSION_FORMAT,
            file,
            shows_noise: settings.shows_noise,
            sight,
            shows_panel,
            tab,
        }
    }

    /// Reads a session file. Its paths become absolute.
    ///
    /// # Errors
    /// A message with the path and, for a syntax error, the line.
    pub fn read(path: &Path) -> Result<Self, String> {
        let named = |error: &dyn std::fmt::Display| format!("{}: {error}", shown(path));
        let mut text = String::new();
        let file = File::open(path).map_err(|error| named(&error))?;
        let read = file.take(MAX_BYTES + 1).read_to_string(&mut text);
        read.map_err(|error| named(&error))?;
        if text.len() as u64 > MAX_BYTES {
            return Err(named(&"too large for a session file"));
        }
        let mut session = Self::of_text(&text).map_err(|error| named(&error))?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
        for path in session.paths() {
            *path = folder.join(&*path);
        }
        Ok(session)
    }

    fn of_text(text: &str) -> Result<Self, String> {
        viewpoint::check_format(text)?;
        let session = serde_json::from_str(text);
        let mut session: Self = session.map_err(|error| viewpoint::unreadable(text, &error))?;
        if session.file.as_deref().is_some_and(is_session) {
            return Err("its file is a session, not a mesh or a scene".to_owned());
        }
        let sight = &mut session.sight;
        sight.camera.check()?;
        for pick in &sight.picks {
            pick.check()?;
        }
        sight.settings = usable(sight.settings.clone());
        sight.comparison = sight.comparison.clone().usable();
        sight.settings.shows_noise = session.shows_noise;
        sight.settings.keep_up_axis(sight.camera.up_axis());
        Ok(session)
    }

    /// The text of a session file at a path. Files in its folder and below are named relative to it.
    ///
    /// # Errors
    /// If a path isn't UTF-8.
    pub fn text_at(mut self, path: &Path) -> Result<String, String> {
        let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let session_file = absolute(path);
        let folder = session_file.parent().unwrap_or(Path::new(""));
        for path in self.paths() {
            let whole = absolute(path);
            *path = whole.strip_prefix(folder).unwrap_or(&whole).to_owned();
        }
        let text = compact::text(&self).map_err(|error| error.to_string())?;
        Ok(text + "\n")
    }

    /// All paths.
    fn paths(&mut self) -> impl Iterator<Item = &mut PathBuf> {
        let environment = &mut self.sight.settings.environment_file;
        let compared = &mut self.sight.comparison;
        let compared = compared
            .mesh_file
            .iter_mut()
            .chain(&mut compared.picture_file);
        self.file.iter_mut().chain(environment).chain(compared)
    }
}

/// Whether a file's name is that of a session.
pub fn is_session(path: &Path) -> bool {
    path.extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case(EXTENSION))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::comparison::Side;
    use crate::document::embedded_scene;
    use crate::overlay::wireframe::WIREFRAME;
    use crate::picks;
    use glam::{DVec3, UVec2};
    use hitscope_core::camera::Turntable;
    use hitscope_core::{Camera, Scene};

    fn pick(number: u32, name: &str, camera: Camera) -> picks::PickedPixel {
        picks::PickedPixel {
            number,
            name: name.to_owned(),
            is_pinned: !name.is_empty(),
            side: Side::A,
            camera,
            pixel: UVec2::new(3, 4),
        }
    }

    fn session(scene: &Scene) -> Session {
        let mut turntable = Turntable::framing(scene.bounds(), UVec2::new(64, 48));
        turntable.turn(0.1);
        turntable.zoom(0.7, DVec3::new(0.1, 0.2, 0.3));
        let origin = scene.mesh().origin();
        let camera = turntable.camera(UVec2::new(64, 48));
        let mut settings = Settings {
            file_view: Some("path"),
            is_smooth: true,
            ..Settings::default()
        };
        settings.overlays.set_on(&WIREFRAME, true);
        settings.overlays.state_mut(&WIREFRAME).width_px = 2.3;
        let sight = Sight {
            camera: Viewpoint::of(&turntable, origin),
            settings,
            comparison: Comparison {
                is_on: true,
                mesh_file: Some("/a/b/other.obj".into()),
                divider: 0.3,
                ..Comparison::default()
            },
            parts: PartsChoice::default(),
            picks: vec![
                PickedPixel::new(&pick(2, "", camera), origin),
                PickedPixel::new(&pick(5, "corner", camera), origin).selected(Some(1)),
            ],
            snapping: Snapping::Edge,
        };
        Session::new(Some("/a/b/mesh.obj".into()), sight, true, Tab::Mesh)
    }

    #[test]
    fn a_session_is_read_back_to_the_last_bit() {
        let loaded = embedded_scene();
        let session = session(&loaded.scene);
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("x.hitscope");
        let text = session.clone().text_at(&path).expect("UTF-8");
        std::fs::write(&path, &text).expect("written");
        let read = Session::read(&path).expect("a session");
        assert_eq!(read, session);
        assert_eq!(read.sight.settings.view().name, "path");
        let origin = loaded.scene.mesh().origin();
        let turntable = read.sight.camera.turntable(&loaded.scene);
        assert_eq!(Viewpoint::of(&turntable, origin), session.sight.camera);
        let listed = read.sight.picks[0].in_scene(origin).expect("a camera");
        assert_eq!(PickedPixel::new(&listed, origin), session.sight.picks[0]);
        let listed = read.sight.picks[1].in_scene(origin).expect("a camera");
        let again = PickedPixel::new(&listed, origin).selected(Some(1));
        assert_eq!(again, session.sight.picks[1]);
    }

    #[test]
    fn a_pick_without_number_and_name_is_read_and_selected() {
        let loaded = embedded_scene();
        let text = session(&loaded.scene).text_at(Path::new("x"));
        let mut value: serde_json::Value =
            serde_json::from_str(&text.expect("UTF-8")).expect("JSON");
        let first = value["sight"]["picks"][0].as_object_mut().expect("a pick");
        for field in ["number", "is_selected"] {
            assert!(first.remove(field).is_some(), "{field}");
        }
        let read = Session::of_text(&value.to_string()).expect("a session");
        let first = &read.sight.picks[0];
        assert_eq!((first.number, first.name.as_str()), (0, ""));
        assert!(first.is_selected && !first.is_pinned);
    }

    #[test]
    fn a_session_has_no_defaults_and_a_line_for_each_list() {
        let loaded = embedded_scene();
        let mut session = session(&loaded.scene);
        session.sight.picks.truncate(1);
        let text = session.text_at(Path::new("x")).expect("UTF-8");
        assert!(text.contains("\"pixel\": [3, 4]"), "{text}");
        assert!(text.contains("\"width_px\": 2.3"), "{text}");
        for default in ["ao_distance", "gain", "normals", "\"name\"", "is_pinned"] {
            assert!(!text.contains(default), "{default}: {text}");
        }
        assert!(text.len() < 2500, "{text}");
    }

    #[test]
    fn files_below_the_sessions_folder_have_relative_paths() {
        let loaded = embedded_scene();
        for (at, expected) in [
            ("/a/x.hitscope", "\"b/mesh.obj\""),
            ("/c/x.hitscope", "\"/a/b/mesh.obj\""),
        ] {
            let text = session(&loaded.scene).text_at(Path::new(at));
            assert!(text.expect("UTF-8").contains(expected), "{at}");
        }
    }

    #[test]
    fn broken_sessions_are_refused_with_a_reason() {
        let loaded = embedded_scene();
        let good = session(&loaded.scene).text_at(Path::new("x"));
        let good = good.expect("UTF-8");
        assert!(Session::of_text(&good).is_ok());
        let unknown = good.replacen('{', "{\"of another version\": [1],", 1);
        assert!(Session::of_text(&unknown).is_ok());
        let with = |from: &str, to: &str| {
            let text = good.replacen(from, to, 1);
            assert_ne!(text, good, "{from}");
            Session::of_text(&text).expect_err(to)
        };
        for (from, to, reason) in [
            ("\"hitscope\": 1", "\"hitscope\": 2", "a later version"),
            ("\"distance\": ", "\"distance\": -", "distance"),
            ("\"distance\": ", "\"distance\": x", "line"),
            (
                "\"is_smooth\": true",
                "\"is_smooth\": 3",
                "expected true or false, found 3",
            ),
            ("\"sight\"", "\"sights\"", "“sight” is missing"),
            (&good, " \n", "empty"),
        ] {
            let error = with(from, to);
            assert!(error.contains(reason), "{to}: {error}");
        }
        type Change = (fn(&mut Session), &'static str);
        let changes: [Change; 4] = [
            (
                |bad| bad.sight.picks[1].number = u32::MAX,
                "number is larger",
            ),
            (
                |bad| bad.sight.picks[0].pixel = [64, 4],
                "outside the picture",
            ),
            (|bad| bad.sight.picks[0].up = [0.0; 3], "perpendicular"),
            (|bad| bad.file = Some("x.hitscope".into()), "is a session"),
        ];
        for (change, reason) in changes {
            let mut bad = session(&loaded.scene);
            change(&mut bad);
            let text = bad.text_at(Path::new("x")).expect("UTF-8");
            let error = Session::of_text(&text).expect_err(reason);
            assert!(error.contains(reason), "{error}");
        }
        assert!(Session::of_text("v 0 0 0\n").is_err());
    }
}
