//! The cameras of one run of `render`, and the names of their outputs.

use super::super::aim::Aimed;
use super::super::{CameraArgs, CommandError, PreparedScene};
use super::RenderArgs;
use super::camera_list::{self, ListedCamera};
use super::output_names::{INDEX, NAME, VIEW, check_distinct, filled, has_place, padded};
use super::outputs::OutputNames;
use super::turntable::Axis;
use glam::DVec3;
use hitscope_core::Camera;
use std::path::{Path, PathBuf};

/// The cameras to render, in their order.
pub(super) struct Shots<'a> {
    args: &'a RenderArgs,
    source: Source,
}

/// Where the cameras come from.
enum Source {
    /// The options of the command line.
    Options,
    /// The same, turned.
    Turntable { count: usize },
    /// A file.
    List(Vec<ListedCamera>),
}

impl<'a> Shots<'a> {
    /// Finds the cameras that the arguments ask for, and checks them as far as this is possible without the mesh.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub(super) fn new(args: &'a RenderArgs) -> Result<Self, CommandError> {
        let source = match (&args.cameras, args.turntable) {
            (Some(path), _) => Source::List(with_size(camera_list::read(path)?, args)),
            (None, Some(count)) => Source::Turntable {
                count: count as usize,
            },
            (None, None) => Source::Options,
        };
        if let Source::List(cameras) = &source {
            let mut sizes = cameras.iter().filter_map(|listed| listed.camera.size);
            sizes.try_for_each(|size| args.check_size(size))?;
        }
        let shots = Self { args, source };
        shots.check_names()?;
        Ok(shots)
    }

    /// Number of cameras.
    pub(super) fn count(&self) -> usize {
        match &self.source {
            Source::Options => 1,
            Source::Turntable { count } => *count,
            Source::List(cameras) => cameras.len(),
        }
    }

    /// Refuses names that don't tell the pictures apart.
    fn check_names(&self) -> Result<(), CommandError> {
        let refuse = |message: String| Err(CommandError::Usage(message));
        let args = self.args;
        let (views, has_view) = (&args.picture.view.view, has_place(&args.output, VIEW));
        if views.len() > 1 && !has_view {
            return refuse(
                "several views need {view} in the name of the output, as in out-{view}.png"
                    .to_owned(),
            );
        }
        if views.is_empty() && has_view {
            return refuse("{view} in the name of the output needs --view".to_owned());
        }
        let (keys, needed) = match self.source {
            Source::List(_) => (&[NAME, INDEX][..], "{name} or {index}"),
            Source::Turntable { .. } | Source::Options => (&[INDEX][..], "{index}"),
        };
        let patterns = [
            Some(&args.output),
            args.depth_map.as_ref(),
            args.ids.as_ref(),
        ];
        for pattern in patterns.into_iter().flatten() {
            let has_key = keys.iter().any(|key| has_place(pattern, key));
            if self.count() > 1 && !has_key {
                return refuse(format!(
                    "several cameras need {needed} in the names of outputs, as in out-{{index}}.png"
                ));
            }
        }
        let names = self.output_names();
        let names: Vec<PathBuf> = names.iter().flat_map(OutputNames::all).cloned().collect();
        check_distinct(&names)
    }

    /// The names of the outputs of each camera.
    pub(super) fn output_names(&self) -> Vec<OutputNames> {
        (0..self.count())
            .map(|index| self.names_of(index))
            .collect()
    }

    fn names_of(&self, index: usize) -> OutputNames {
        let args = self.args;
        let number = padded(index, self.count());
        let name = |pattern: &Path| match &self.source {
            Source::Options => pattern.to_owned(),
            Source::Turntable { .. } => filled(pattern, &[(INDEX, &number)]),
            Source::List(cameras) => {
                let name = cameras[index].name.as_ref().unwrap_or(&number);
                filled(pattern, &[(NAME, name), (INDEX, &number)])
            }
        };
        let output = name(&args.output);
        let views = &args.picture.view.view;
        OutputNames {
            pictures: if views.is_empty() {
                vec![output]
            } else {
                let of_view = |view: &String| filled(&output, &[(VIEW, view)]);
                views.iter().map(of_view).collect()
            },
            depth_map: args.depth_map.as_deref().map(name),
            ids: args.ids.as_deref().map(name),
        }
    }

    /// The cameras in a scene.
    ///
    /// # Errors
    /// See [`CameraArgs::camera`].
    pub(super) fn cameras(&self, scene: &PreparedScene<'_>) -> Result<Vec<Camera>, CommandError> {
        let args = &self.args.picture;
        let file = &args.scene.file;
        let first = || self.args.aim.aimed(&args.camera, scene.loaded(), file);
        match &self.source {
            Source::Options => Ok(vec![first()?.camera]),
            Source::Turntable { count } => turned(&first()?, *count, args.camera.up, scene),
            Source::List(cameras) => {
                let camera = |listed: &ListedCamera| scene.camera(&listed.camera);
                cameras.iter().map(camera).collect()
            }
        }
    }
}

/// The listed cameras, with the size of the command line unless they have one.
fn with_size(cameras: Vec<ListedCamera>, args: &RenderArgs) -> Vec<ListedCamera> {
    let sized = |listed: ListedCamera| ListedCamera {
        camera: CameraArgs {
            size: listed.camera.size.or(args.picture.camera.size),
            ..listed.camera
        },
        ..listed
    };
    cameras.into_iter().map(sized).collect()
}

/// A camera, turned `count` times by equal angles about the up axis through its target.
fn turned(
    first: &Aimed,
    count: usize,
    up: Option<DVec3>,
    scene: &PreparedScene<'_>,
) -> Result<Vec<Camera>, CommandError> {
    let axis = Axis::new(&first.camera, &scene.loaded().scene, first.target, up)?;
    let turned = |index: usize| Ok(axis.turned(&first.camera, index as f64 / count as f64)?);
    (0..count).map(turned).collect()
}
