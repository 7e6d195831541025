//! The tabs of the side panel.

use serde::{Deserialize, Serialize};

/// A tab of the side panel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Tab {
    /// The picked pixel.
    Inspect,
    /// View, shading, kernel, overlay, camera.
    #[default]
    #[serde(alias = "View")]
    Display,
    /// The parts of the scene, which can be hidden.
    Parts,
    /// Contents and flaws of the mesh.
    Mesh,
    /// Speed and accuracy of the kernels in this scene.
    Trade,
    /// Comparisons of the picture with another one.
    Compare,
}

impl Tab {
    /// All tabs, from left to right.
    pub const ALL: [Self; 6] = [
        Self::Inspect,
        Self::Display,
        Self::Parts,
        Self::Mesh,
        Self::Trade,
        Self::Compare,
    ];

    /// The title.
    pub fn title(self) -> &'static str {
        match self {
            Self::Inspect => "Inspect",
            Self::Display => "Display",
            Self::Parts => "Parts",
            Self::Mesh => "Mesh",
            Self::Trade => "Trade",
            Self::Compare => "Compare",
        }
    }

    /// The contents, in a phrase without a full stop.
    pub fn about(self) -> &'static str {
        match self {
            Self::Inspect => "The ray of the picked pixel, its hit, and the answers of all kernels",
            Self::Display => "View, colours, kernel, overlay, clip, camera, theme",
            Self::Parts => "Groups, materials and shapes of the scene, which can be hidden",
            Self::Mesh => "Contents, flaws and memory of the open file",
            Self::Trade => "Speed and accuracy of each kernel in this scene",
            Self::Compare => "Compares the picture with another view, kernel, mesh or picture",
        }
    }
}
