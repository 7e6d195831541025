//! The colours that the user chooses for the picture: colour map and scale, legend, tint of back faces, background.

use glam::Vec3;
use hitscope_core::colour::{ColourMap, colour_map};
use hitscope_core::integrator::{Integrator, ScaleOptions, Setting, ViewOptions};
use hitscope_core::srgb::from_texel;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The background of the picture. Views that compare kernels always have a dark one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Background {
    /// That of the theme.
    #[default]
    Theme,
    /// Dark grey.
    Dark,
    /// Grey.
    Grey,
    /// White.
    White,
}

/// The chosen colours.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ColourChoice {
    /// Name of the colour map of views of numbers; of no map for that of each view.
    pub map: String,
    /// Whether views of numbers have a legend in the picture.
    pub shows_legend: bool,
    /// Whether back faces are tinted.
    pub tints_back_faces: bool,
    /// sRGB of the tint.
    pub tint: [u8; 3],
    /// The background.
    pub background: Background,
    /// The scales of views, by their names. Not kept, as ranges belong to a scene.
    #[serde(skip)]
    pub scales: BTreeMap<String, ScaleChoice>,
}

/// The chosen scale of a view. `None` leaves a choice to the view.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ScaleChoice {
    /// The numbers with the first and the last colour.
    pub range: Option<[f64; 2]>,
    /// Whether the scale is logarithmic.
    pub is_logarithmic: Option<bool>,
}

impl Default for ColourChoice {
    fn default() -> Self {
        Self {
            map: String::new(),
            shows_legend: true,
            tints_back_faces: false,
            // The colour of back faces that a clip opens.
            tint: [213, 94, 0],
            background: Background::Theme,
            scales: BTreeMap::new(),
        }
    }
}

impl Background {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Theme, Self::Dark, Self::Grey, Self::White];

    /// The title.
    pub fn title(self) -> &'static str {
        match self {
            Self::Theme => "Of the theme",
            Self::Dark => "Dark",
            Self::Grey => "Grey",
            Self::White => "White",
        }
    }
}

impl ColourChoice {
    /// The chosen colour map; `None` for that of each view.
    pub fn map(&self) -> Option<&'static ColourMap> {
        colour_map(&self.map)
    }

    /// The scale of a view.
    pub fn scale_of(&self, view: &Integrator) -> ScaleChoice {
        self.scales.get(view.name).copied().unwrap_or_default()
    }

    /// The scale of a view, to be changed.
    pub fn scale_mut(&mut self, view: &Integrator) -> &mut ScaleChoice {
        self.scales.entry(view.name.to_owned()).or_default()
    }

    /// The choices that change the picture of a view.
    pub fn options(&self, view: &Integrator) -> ViewOptions {
        let mut options = ViewOptions::default();
        if view.needs.uses(Setting::BackFaces) {
            let tint: Option<Vec3> = self.tints_back_faces.then(|| from_texel(self.tint));
            options.back_face_tint = tint;
        }
        if view.needs.uses(Setting::Scale) {
            let ScaleChoice {
                range,
                is_logarithmic,
            } = self.scale_of(view);
            options.scale = ScaleOptions {
                map: self.map(),
                range,
                is_logarithmic,
            };
        }
        options
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hitscope_core::integrator::integrator;

    #[test]
    fn a_choice_changes_only_the_views_that_use_it() {
        let [depth, shaded] = ["depth", "shaded"].map(|name| integrator(name).expect("a view"));
        let mut colours = ColourChoice {
            map: "cividis".to_owned(),
            tints_back_faces: true,
            ..ColourChoice::default()
        };
        colours.scale_mut(depth).range = Some([1.0, 2.0]);
        let (of_depth, of_shaded) = (colours.options(depth), colours.options(shaded));
        assert_eq!(of_depth.scale.range, Some([1.0, 2.0]));
        assert_eq!(of_depth.scale.map, colour_map("cividis"));
        assert_eq!(of_depth.back_face_tint, None);
        assert_eq!(of_shaded.scale, ScaleOptions::default());
        assert!(of_shaded.back_face_tint.is_some());
    }
}
