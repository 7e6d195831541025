//! Quality levels: sets of settings from a draft to a reference.

use crate::settings::Settings;
use hitscope_core::group::kernel_named;
use hitscope_core::spawn::default_spawn_policy;
use serde::{Deserialize, Serialize};

/// A set of settings.
pub struct Quality {
    /// The title.
    pub title: &'static str,
    /// What it is for, and what it sets.
    pub about: &'static str,
    /// The tier of the kernel.
    kernel: &'static str,
    /// Samples per pixel; a power of two.
    samples: u32,
    /// Name of the rule for rays that leave surfaces; `None` for the default one.
    spawn: Option<&'static str>,
    /// The most surfaces on a path.
    depth_limit: Option<u32>,
    /// The resolution while the camera moves.
    moving: MovingResolution,
}

/// The resolution of the first picture from a new place, relative to that of the finished picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum MovingResolution {
    /// As high as the time of a frame allows.
    #[default]
    Automatic,
    /// The full resolution.
    Full,
    /// Half of it in each direction.
    Half,
    /// A quarter of it in each direction.
    Quarter,
}

impl MovingResolution {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Automatic, Self::Full, Self::Half, Self::Quarter];

    /// The title.
    pub fn title(self) -> &'static str {
        match self {
            Self::Automatic => "Automatic",
            Self::Full => "1",
            Self::Half => "1/2",
            Self::Quarter => "1/4",
        }
    }

    /// A description, as in the tooltips of [`QUALITY`].
    pub fn words(self) -> &'static str {
        match self {
            Self::Automatic => "automatic resolution",
            Self::Full => "full resolution",
            Self::Half => "half of the resolution",
            Self::Quarter => "a quarter of the resolution",
        }
    }

    /// The side of the blocks of pixels in the first picture; `None` for the smallest that the time of a frame allows.
    pub fn block(self) -> Option<u32> {
        match self {
            Self::Automatic => None,
            Self::Full => Some(1),
            Self::Half => Some(2),
            Self::Quarter => Some(4),
        }
    }
}

/// All levels, from fast to accurate.
pub static QUALITY: &[Quality] = &[
    Quality {
        title: "Draft",
        about: "For looking around: the fast kernel, 4 samples, offsets by a scaled epsilon, paths of up to 3 surfaces, a quarter of the resolution while moving",
        kernel: "fast",
        samples: 4,
        spawn: Some("scaled-epsilon"),
        depth_limit: Some(3),
        moving: MovingResolution::Quarter,
    },
    Quality {
        title: "Fast",
        about: "For quick pictures: the fast kernel, 16 samples, the default offsets, paths of up to 8 surfaces, automatic resolution while moving",
        kernel: "fast",
        samples: 16,
        spawn: None,
        depth_limit: Some(8),
        moving: MovingResolution::Automatic,
    },
    Quality {
        title: "Balanced",
        about: "For most uses: the exact kernel, 64 samples, the default offsets, paths of any length, automatic resolution while moving",
        kernel: "exact",
        samples: 64,
        spawn: None,
        depth_limit: None,
        moving: MovingResolution::Automatic,
    },
    Quality {
        title: "Final",
        about: "For final pictures: the exact kernel, 256 samples, the default offsets, paths of any length, automatic resolution while moving",
        kernel: "exact",
        samples: 256,
        spawn: None,
        depth_limit: None,
        moving: MovingResolution::Automatic,
    },
    Quality {
        title: "Reference",
        about: "For comparisons with other renderers: the exact kernel, 1024 samples, the default offsets, paths of any length, full resolution while moving",
        kernel: "exact",
        samples: 1024,
        spawn: None,
        depth_limit: None,
        moving: MovingResolution::Full,
    },
];

impl Quality {
    /// The set that the settings match; `None` if they are the user's own.
    pub fn of(settings: &Settings) -> Option<&'static Self> {
        QUALITY.iter().find(|quality| quality.matches(settings))
    }

    fn matches(&self, settings: &Settings) -> bool {
        settings.kernel().info.short_name() == self.kernel
            && settings.samples == self.samples
            && settings.spawn().name == self.spawn_name()
            && settings.depth_limit() == self.depth_limit
            && settings.moving == self.moving
    }

    fn spawn_name(&self) -> &'static str {
        self.spawn.unwrap_or(default_spawn_policy().name)
    }

    /// Changes the settings to these.
    pub fn apply(&self, settings: &mut Settings) {
        let kernel = kernel_named(self.kernel);
        settings.keep_kernel(kernel.map_or(self.kernel, |kernel| kernel.info.name));
        settings.samples = self.samples;
        settings.moving = self.moving;
        self.spawn_name().clone_into(&mut settings.spawn);
        settings.has_depth_limit = self.depth_limit.is_some();
        if let Some(limit) = self.depth_limit {
            settings.depth_limit = limit;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_are_balanced_and_each_quality_is_recognized_until_a_setting_changes() {
        let title = |settings: &Settings| Quality::of(settings).map(|quality| quality.title);
        let mut settings = Settings::default();
        assert_eq!(title(&settings), Some("Balanced"));
        for quality in QUALITY {
            quality.apply(&mut settings);
            assert_eq!(title(&settings), Some(quality.title));
            let about = quality.about;
            assert!(about.contains(quality.kernel), "{about}");
            assert!(
                about.contains(&format!("{} samples", quality.samples)),
                "{about}"
            );
            let moving = format!("{} while moving", quality.moving.words());
            assert!(about.contains(&moving), "{about}");
        }
        settings.samples = 8;
        assert_eq!(title(&settings), None);
        QUALITY[0].apply(&mut settings);
        settings.moving = MovingResolution::Half;
        assert_eq!(title(&settings), None);
    }
}
