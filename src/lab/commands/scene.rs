//! A scene on the command line, and how it is shaded and traced.

use super::CommandError;
use super::args::MeshArgs;
use super::kernel::KernelArg;
use clap::{Args, ValueEnum};
use hitscope_core::loading::LoadedScene;
use hitscope_core::mesh::Crease;
use hitscope_core::obj::Recentre;
use hitscope_core::scene::{FirstTree, Shading};
use hitscope_core::{Intersector, Scene};
use std::path::PathBuf;
use std::sync::Arc;

/// A scene, and how it is shaded and traced.
#[derive(Args, Clone, Debug)]
pub struct SceneArgs {
    /// OBJ file, plain or gzipped, or scene file (.xml); - for an OBJ on standard input
    pub file: PathBuf,
    /// Shading of triangles
    #[arg(long, default_value = "flat")]
    pub shading: ShadingArg,
    /// With smooth shading: keep edges sharp where triangles meet at a larger angle than this, and ignore the
    /// file's normals and smoothing groups
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true, value_parser = parse_crease)]
    pub crease: Option<f32>,
    /// Kernel.
    #[command(flatten)]
    pub kernel: KernelArg,
    /// How the scene is loaded.
    #[command(flatten)]
    pub mesh: MeshArgs,
}

/// How normals vary over a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ShadingArg {
    /// One normal per triangle
    Flat,
    /// Interpolated linearly between the vertices, then normalised
    Smooth,
    /// Interpolated between the vertices on the unit sphere
    Spherical,
}

impl From<ShadingArg> for Shading {
    fn from(arg: ShadingArg) -> Self {
        match arg {
            ShadingArg::Flat => Self::Flat,
            ShadingArg::Smooth => Self::Smooth,
            ShadingArg::Spherical => Self::Spherical,
        }
    }
}

impl SceneArgs {
    /// Refuses a crease angle with flat shading, which has no use for it.
    ///
    /// # Errors
    /// [`CommandError::Usage`].
    pub fn check(&self) -> Result<(), CommandError> {
        if self.crease.is_some() && self.shading == ShadingArg::Flat {
            let message =
                "--crease has no effect on flat shading: it needs --shading smooth or spherical";
            return Err(CommandError::Usage(message.to_owned()));
        }
        Ok(())
    }

    /// Loads the scene with the crease angle, and prints the file's warnings.
    ///
    /// # Errors
    /// [`CommandError::Load`].
    pub fn load(&self) -> Result<LoadedScene, CommandError> {
        self.load_with_tree(FirstTree::Best)
    }

    /// The same as [`load`](Self::load), with a choice of the first tree.
    ///
    /// # Errors
    /// [`CommandError::Load`].
    pub(super) fn load_with_tree(
        &self,
        first_tree: FirstTree,
    ) -> Result<LoadedScene, CommandError> {
        let mesh = self.mesh;
        let mut loaded = mesh.load_with_tree(&self.file, Recentre::Auto, first_tree)?;
        if let Some(degrees) = self.crease {
            let crease = Crease::Above(degrees.to_radians());
            loaded.scene = Arc::new(loaded.scene.with_crease(crease));
        }
        Ok(loaded)
    }

    /// The scene packed for the kernel.
    pub fn intersector(&self, scene: &Scene) -> Arc<dyn Intersector> {
        Arc::from(scene.intersector(self.kernel.choice))
    }
}

/// `30`.
fn parse_crease(text: &str) -> Result<f32, String> {
    match text.parse() {
        Ok(degrees) if (0.0..=180.0).contains(&degrees) => Ok(degrees),
        _ => Err("expected degrees from 0 to 180".to_owned()),
    }
}
