//! Storage of the settings between runs. Settings read from any file are valid.
//!
//! eframe writes the file `app.ron`, a table of strings by name, at the end and twice per minute. The settings are one
//! of the strings, as JSON. Each setting is read separately, so that a bad value affects no other.

use crate::overlay::older;
use crate::panels::light::{
    AO_DISTANCES, BRIGHTNESSES, DEPTH_LIMITS, NOISE_LIMITS, ROTATIONS, TIME_LIMITS_S,
};
use crate::preferences::{PANEL_WIDTHS, Preferences};
use crate::settings::{EnvironmentSource, Settings};
use hitscope_core::brightness::EXPOSURES;
use hitscope_core::group::kernel_named;
use hitscope_core::integrator::integrator;
use hitscope_core::plan::MAX_SAMPLES;
use hitscope_core::spawn::spawn_policy;
use hitscope_core::terminator::terminator_repair;
use hitscope_core::tone::tone_curve;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::collections::HashMap;
use std::fs::File;
use std::io::Read as _;
use std::ops::RangeInclusive;
use std::path::Path;

/// The name of the settings folder, and the program's name for the desktop.
pub const APP_ID: &str = "hitscope";

/// Name of the settings in eframe's table.
const KEY: &str = "settings";
/// Name of egui's widget state, which earlier versions stored.
const EGUI_KEY: &str = "egui";
/// Size limit of the file, which usually has some thousand bytes; a larger one isn't read.
const MAX_BYTES: u64 = 1 << 20;

/// The range of Ctrl+Plus and Ctrl+Minus.
const ZOOMS: RangeInclusive<f32> = 0.2..=5.0;
// The ranges of controls in the Display tab.
const CREASES: RangeInclusive<f32> = 0.0..=180.0;

/// What is kept between runs, in one table.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Kept {
    /// How the scene is shown.
    #[serde(flatten)]
    pub settings: Settings,
    /// The preferences of the window.
    #[serde(flatten)]
    pub preferences: Preferences,
}

/// The settings and preferences that were stored last, or the defaults.
pub fn stored() -> Kept {
    let folder = eframe::storage_dir(APP_ID);
    folder
        .and_then(|folder| read(&folder.join("app.ron")))
        .unwrap_or_else(of_first_run)
}

/// The settings of the first run: the default ones, with smooth shading.
fn of_first_run() -> Kept {
    let settings = Settings {
        is_smooth: true,
        ..Settings::default()
    };
    Kept {
        settings,
        ..Kept::default()
    }
}

fn read(path: &Path) -> Option<Kept> {
    let mut text = String::new();
    let file = File::open(path).ok()?;
    file.take(MAX_BYTES).read_to_string(&mut text).ok()?;
    let texts: HashMap<String, String> = ron::from_str(&text).ok()?;
    Some(from_json(texts.get(KEY)?))
}

/// Passes the settings to eframe, which writes the file.
pub fn store(settings: &Settings, preferences: &Preferences, storage: &mut dyn eframe::Storage) {
    let kept = Kept {
        settings: settings.clone(),
        preferences: preferences.clone(),
    };
    if let Some(text) = to_json(kept) {
        storage.set_string(KEY, text);
    }
    if storage.get_string(EGUI_KEY).is_some() {
        storage.remove_string(EGUI_KEY);
    }
}

/// The settings as JSON. A path that isn't UTF-8, which JSON can't hold, is left out.
fn to_json(mut kept: Kept) -> Option<String> {
    kept.preferences.recent = kept.preferences.recent.in_utf_8();
    kept.settings.environment_file = kept
        .settings
        .environment_file
        .filter(|path| path.to_str().is_some());
    serde_json::to_string(&kept).ok()
}

/// Parses the settings; a setting that is missing or invalid has its default.
pub(crate) fn from_json(text: &str) -> Kept {
    let default = Kept::default();
    let Ok(Value::Object(mut stored)) = serde_json::from_str(text) else {
        return default;
    };
    older::convert(&mut stored);
    let kept = merged(&default, stored);
    Kept {
        settings: usable(kept.settings),
        preferences: usable_preferences(kept.preferences),
    }
}

/// A struct with the stored fields; a field that is missing or invalid has its default. Unknown fields, from other versions,
/// are ignored.
pub(crate) fn merged<T>(default: &T, stored: Map<String, Value>) -> T
where
    T: Serialize + DeserializeOwned + Clone,
{
    let Ok(Value::Object(mut kept)) = serde_json::to_value(default) else {
        return default.clone();
    };
    for (name, value) in stored {
        let Some(old) = kept.insert(name.clone(), value) else {
            kept.remove(&name);
            continue;
        };
        if T::deserialize(Value::Object(kept.clone())).is_err() {
            kept.insert(name, old);
        }
    }
    T::deserialize(Value::Object(kept)).unwrap_or_else(|_| default.clone())
}

/// Replaces values that the window can't have set by the defaults.
fn usable_preferences(preferences: Preferences) -> Preferences {
    let default = Preferences::default();
    Preferences {
        zoom: number(preferences.zoom, ZOOMS, default.zoom),
        panel_width: number(preferences.panel_width, PANEL_WIDTHS, default.panel_width),
        ..preferences
    }
}

/// The same for settings.
pub(crate) fn usable(settings: Settings) -> Settings {
    let default = Settings::default();
    let kernel = |name: String, default: String| {
        if kernel_named(&name).is_some() {
            name
        } else {
            default
        }
    };
    let settings = usable_light(settings);
    Settings {
        crease_degrees: number(settings.crease_degrees, CREASES, default.crease_degrees),
        samples: if settings.samples.is_power_of_two() && settings.samples <= MAX_SAMPLES {
            settings.samples
        } else {
            default.samples
        },
        kernel: kernel(settings.kernel, default.kernel),
        against: kernel(settings.against, default.against),
        view: if integrator(&settings.view).is_some() {
            settings.view
        } else {
            default.view
        },
        ..settings
    }
}

/// The same for the settings of views that need lights.
fn usable_light(settings: Settings) -> Settings {
    let default = Settings::default();
    let policy = |name: String, default: String| {
        if spawn_policy(&name).is_some() {
            name
        } else {
            default
        }
    };
    let lacks_file =
        settings.environment == EnvironmentSource::File && settings.environment_file.is_none();
    Settings {
        time_limit_s: number(settings.time_limit_s, TIME_LIMITS_S, default.time_limit_s),
        noise_limit_percent: number(
            settings.noise_limit_percent,
            NOISE_LIMITS,
            default.noise_limit_percent,
        ),
        ao_distance: number(settings.ao_distance, AO_DISTANCES, default.ao_distance),
        depth_limit: if DEPTH_LIMITS.contains(&settings.depth_limit) {
            settings.depth_limit
        } else {
            default.depth_limit
        },
        environment_brightness: number(
            settings.environment_brightness,
            BRIGHTNESSES,
            default.environment_brightness,
        ),
        environment_degrees: number(
            settings.environment_degrees,
            ROTATIONS,
            default.environment_degrees,
        ),
        exposure_stops: number(settings.exposure_stops, EXPOSURES, default.exposure_stops),
        environment: if lacks_file {
            default.environment
        } else {
            settings.environment
        },
        spawn: policy(settings.spawn, default.spawn),
        second_spawn: policy(settings.second_spawn, default.second_spawn),
        terminator: if terminator_repair(&settings.terminator).is_some() {
            settings.terminator
        } else {
            default.terminator
        },
        tone_curve: if tone_curve(&settings.tone_curve).is_some() {
            settings.tone_curve
        } else {
            default.tone_curve
        },
        ..settings
    }
}

/// The value if it is in the range, else the default.
pub(crate) fn number(value: f32, range: RangeInclusive<f32>, default: f32) -> f32 {
    if range.contains(&value) {
        value
    } else {
        default
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tab::Tab;

    /// Values that differ from the defaults.
    fn chosen() -> Kept {
        Kept {
            settings: Settings {
                samples: 16,
                is_smooth: true,
                ..Settings::default()
            },
            preferences: Preferences {
                zoom: 1.5,
                tab: Tab::Mesh,
                ..Preferences::default()
            },
        }
    }

    /// The chosen settings with one value replaced by other JSON.
    fn with(name: &str, value: &str) -> Kept {
        let text = serde_json::to_string(&chosen()).expect("JSON");
        let mut fields: HashMap<String, Value> = serde_json::from_str(&text).expect("an object");
        assert!(fields.contains_key(name), "{name}");
        let value = serde_json::from_str(value).unwrap_or(Value::from("NaN"));
        fields.insert(name.to_owned(), value);
        from_json(&serde_json::to_string(&fields).expect("JSON"))
    }

    #[test]
    fn stored_settings_are_read_back() {
        let text = serde_json::to_string(&chosen()).expect("JSON");
        assert_eq!(from_json(&text), chosen());
    }

    #[test]
    fn a_bad_value_becomes_the_default_and_affects_no_other() {
        let default = Kept::default();
        for zoom in ["0", "-1", "NaN", "1000", "1e39", "null", "\"large\"", "[1]"] {
            let mut expected = chosen();
            expected.preferences.zoom = default.preferences.zoom;
            assert_eq!(with("zoom", zoom), expected, "{zoom}");
        }
        for width in ["0", "-5", "1e30", "null"] {
            let panel_width = with("panel_width", width).preferences.panel_width;
            assert_eq!(panel_width, default.preferences.panel_width, "{width}");
        }
        // Without the name of a file.
        let environment = with("environment", "\"File\"").settings.environment;
        assert_eq!(environment, default.settings.environment);
        for samples in ["0", "3", "131072", "-1", "1.5"] {
            assert_eq!(
                with("samples", samples).settings.samples,
                default.settings.samples,
                "{samples}"
            );
        }
        for name in [
            "kernel",
            "against",
            "view",
            "tab",
            "theme",
            "spawn",
            "second_spawn",
            "terminator",
            "tone_curve",
            "environment",
            "recent",
        ] {
            let read = with(name, "\"of another version\"");
            let kept = |kept: &Kept| serde_json::to_value(kept).expect("JSON")[name].clone();
            assert_eq!(kept(&read), kept(&default), "{name}");
            assert!(read.settings.is_smooth, "{name} affects no other");
        }
        for name in [
            "overlays",
            "crease_degrees",
            "time_limit_s",
            "noise_limit_percent",
            "ao_distance",
            "depth_limit",
            "environment_brightness",
            "environment_degrees",
            "environment_colour",
            "exposure_stops",
        ] {
            let read = with(name, "-100");
            assert_eq!(read, chosen(), "{name}");
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_path_that_is_not_utf_8_does_not_prevent_storage() {
        use std::os::unix::ffi::OsStringExt as _;
        let mut kept = chosen();
        kept.settings.environment = EnvironmentSource::File;
        kept.settings.environment_file = Some("sky.hdr".into());
        let text = to_json(kept.clone()).expect("JSON");
        assert_eq!(from_json(&text), kept);
        let path = std::ffi::OsString::from_vec(b"sky\xff.hdr".to_vec());
        kept.preferences.recent.add(Path::new(&path));
        kept.settings.environment_file = Some(path.into());
        let text = to_json(kept).expect("JSON");
        assert_eq!(from_json(&text), chosen());
    }

    #[test]
    fn a_file_without_settings_gives_the_defaults() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("app.ron");
        assert_eq!(read(&path), None, "no file");
        for bytes in [
            &b""[..],
            b"\xff\xfe\0",
            b"{",
            b"{\"settings\": 3}",
            b"{\"egui\": \"(options:(zoom_factor:0.0))\"}",
            &[b'['; 100_000],
        ] {
            std::fs::write(&path, bytes).expect("written");
            assert_eq!(
                read(&path),
                None,
                "{}",
                String::from_utf8_lossy(&bytes[..bytes.len().min(40)])
            );
        }
        for text in ["", "{", "[]", "3", "(view:\"facing\")", "{\"settings\":1}"] {
            assert_eq!(from_json(text), Kept::default(), "{text}");
        }
        let text = serde_json::to_string(&chosen()).expect("JSON");
        let texts = HashMap::from([(KEY, text)]);
        std::fs::write(&path, ron::to_string(&texts).expect("RON")).expect("written");
        assert_eq!(read(&path), Some(chosen()));
    }
}
