//! The path of a sample of the picked pixel, which is followed in the background.

use super::App;
use crate::panels::path::PathView;
use crate::task::{KeyedTask, Task};
use crate::tracer::Request;
use glam::UVec2;
use hitscope_core::integrator::PathRecord;
use hitscope_lab::inspection::PathReport;
use std::sync::Arc;

/// A sample of a pixel in a picture.
#[derive(Clone, PartialEq)]
struct PathKey {
    /// The picture, with the camera of the pick.
    request: Request,
    pixel: UVec2,
    sample: u32,
}

/// A path that was followed.
pub(crate) struct FollowedPath {
    pub record: Arc<PathRecord>,
    pub report: PathReport,
}

/// The path of the picked pixel.
#[derive(Default)]
pub(crate) struct PickedPath {
    /// The selected sample.
    sample: u32,
    /// The last path; `None` if it couldn't be followed.
    followed: Option<(PathKey, Option<FollowedPath>)>,
    task: KeyedTask<PathKey, Option<FollowedPath>>,
}

impl PickedPath {
    /// The path, once it is known.
    pub fn followed(&self) -> Option<&FollowedPath> {
        self.followed.as_ref()?.1.as_ref()
    }
}

impl App {
    /// Follows the path of the selected sample of the picked pixel if the view follows paths.
    pub(super) fn poll_path(&mut self, ctx: &egui::Context) {
        let Some(key) = self.wanted_path() else {
            self.picked.path.followed = None;
            return;
        };
        if let Some((followed, _)) = &self.picked.path.followed
            && *followed == key
        {
            return;
        }
        let (wanted, background) = (key.clone(), ctx.clone());
        let start = move || Task::spawn("path", &background, move || follow(&wanted));
        match self.picked.path.task.get(key.clone(), start) {
            // The last path stays until the next one is known.
            Ok(None) => {}
            Ok(Some(path)) => self.picked.path.followed = Some((key, path)),
            Err(panicked) => {
                self.picked.path.followed = Some((key, None));
                self.error(panicked);
            }
        }
    }

    /// The path of the selected sample; `None` also while it is being followed.
    pub(super) fn current_path(&self) -> Option<&PathReport> {
        let (key, path) = self.picked.path.followed.as_ref()?;
        let is_current = self.wanted_path().is_some_and(|wanted| wanted == *key);
        is_current.then_some(&path.as_ref()?.report)
    }

    /// The sample whose path is shown.
    fn wanted_path(&self) -> Option<PathKey> {
        let (pick, request) = (self.picked.pick.as_ref()?, self.traced.tracer.posted()?);
        let is_current = Arc::ptr_eq(&request.context.scene, &self.open.document.loaded.scene);
        if !request.integrator.follows_paths() || !is_current {
            return None;
        }
        let mut request = request.clone();
        request.context.camera = pick.camera;
        Some(PathKey {
            request,
            pixel: UVec2::from_array(pick.inspection.pixel),
            sample: self.picked.path.sample.min(self.last_sample()),
        })
    }

    /// The last sample that can be selected: the last one that is traced, or that will be if the camera has moved since.
    fn last_sample(&self) -> u32 {
        let camera = self.picked.pick.as_ref().map(|pick| pick.camera);
        let posted = self.traced.tracer.posted();
        let traced = match posted {
            Some(request) if camera != Some(request.context.camera) => request.samples,
            _ => self.traced.tracer.film().samples(),
        };
        traced.max(1) - 1
    }

    /// The contents of the section *Paths*; `None` unless the view follows paths and a pixel is picked.
    pub(super) fn path_view(&self) -> Option<PathView<'_>> {
        let key = self.wanted_path()?;
        Some(PathView {
            path: self.picked.path.followed().map(|path| &path.report),
            sample: key.sample,
            last: self.last_sample(),
        })
    }

    /// Selects the sample whose path is shown.
    pub(super) fn select_sample(&mut self, sample: u32) {
        self.picked.path.sample = sample;
    }
}

fn follow(key: &PathKey) -> Option<FollowedPath> {
    let PathKey {
        request,
        pixel,
        sample,
    } = key;
    let (view, context) = (request.integrator, &request.context);
    let record = view.record(context, *pixel, *sample)?;
    Some(FollowedPath {
        report: PathReport::new(&context.scene, view, *sample, &record),
        record: Arc::new(record),
    })
}
