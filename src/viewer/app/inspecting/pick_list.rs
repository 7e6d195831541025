//! The state of the list of picks, and what is known about them.

use crate::measuring::{MeasuredPoint, Measurements};
use crate::picks::{PickedPixel, PickedPoint, Snapping};
use crate::task::{KeyedTask, Task};
use glam::{DVec3, UVec2};
use hitscope_core::bvh::OpenedBox;
use hitscope_core::mesh::Crease;
use hitscope_core::scene::Shading;
use hitscope_core::{Aabb, Camera, Scene};
use hitscope_lab::inspection::ThicknessReport;
use std::path::PathBuf;
use std::sync::Arc;

/// The picks, and what is known about them.
#[derive(Default)]
pub(crate) struct Picks {
    pub list: Vec<PickedPixel>,
    last_number: u32,
    /// The number of the pick that is inspected.
    pub selected: Option<u32>,
    pub snapping: Snapping,
    /// What the rays hit, by the picks' numbers, and what that depends on.
    pub found: Option<(Basis, Hits)>,
    pub task: KeyedTask<Basis, Hits>,
    pub measures_thickness: bool,
    pub shows_walk: bool,
    /// The selected box of the walk, counted from 0.
    pub step: usize,
    pub detail: Option<(DetailBasis, Detail)>,
    pub detail_task: KeyedTask<DetailBasis, Detail>,
    /// The file that is being written.
    pub writing: Option<(PathBuf, Task<Result<(), String>>)>,
}

/// What the rays of picks hit, by the picks' numbers.
pub(crate) type Hits = Vec<(u32, Option<PickedPoint>)>;

/// What the hits of the picks depend on.
#[derive(Clone)]
pub(crate) struct Basis {
    pub scene: Arc<Scene>,
    pub kernel: &'static str,
    pub shading: Shading,
    pub crease: Crease,
    pub snapping: Snapping,
    pub picks: Vec<(u32, Camera, UVec2)>,
}

impl PartialEq for Basis {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.scene, &other.scene)
            && (self.kernel, self.shading, self.crease)
                == (other.kernel, other.shading, other.crease)
            && (self.snapping, &self.picks) == (other.snapping, &other.picks)
    }
}

/// What the details of the selected pick depend on.
#[derive(Clone)]
pub(crate) struct DetailBasis {
    pub scene: Arc<Scene>,
    pub kernel: &'static str,
    pub has_last_tree: bool,
    pub place: (Camera, UVec2),
    pub wants: [bool; 2],
}

impl PartialEq for DetailBasis {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.scene, &other.scene)
            && (self.kernel, self.has_last_tree) == (other.kernel, other.has_last_tree)
            && (self.place, self.wants) == (other.place, other.wants)
    }
}

/// More about the selected pick.
pub(crate) struct Detail {
    pub thickness: Option<ThicknessReport>,
    pub walk: Vec<OpenedBox>,
}

impl Picks {
    /// Adds a pixel and selects it. Unless `keeps_others`, the picks that aren't pinned are removed.
    pub fn add(&mut self, camera: Camera, pixel: UVec2, keeps_others: bool) {
        if !keeps_others {
            self.list.retain(|pick| pick.is_pinned);
        }
        self.last_number += 1;
        self.list.push(PickedPixel {
            number: self.last_number,
            name: String::new(),
            is_pinned: false,
            camera,
            pixel,
        });
        self.selected = Some(self.last_number);
        self.step = 0;
    }

    /// Removes the picks that aren't pinned.
    pub fn clear_unpinned(&mut self) {
        self.list.retain(|pick| pick.is_pinned);
        self.selected = None;
    }

    /// Removes all picks; the next one has the number 1.
    pub fn clear(&mut self) {
        (self.list, self.selected, self.last_number) = (Vec::new(), None, 0);
    }

    /// Moves the cameras to the place where they see the same in a scene whose origin has moved.
    pub fn shift(&mut self, by: DVec3) {
        for pick in &mut self.list {
            pick.camera = pick.camera.moved(by);
        }
    }

    pub fn selected(&self) -> Option<&PickedPixel> {
        let number = self.selected?;
        self.list.iter().find(|pick| pick.number == number)
    }

    /// What a pick's ray hits; `None` for a miss, and until it is known.
    pub fn hit(&self, number: u32) -> Option<&PickedPoint> {
        let (_, found) = self.found.as_ref()?;
        let of_pick = found.iter().find(|(of, _)| *of == number)?;
        of_pick.1.as_ref()
    }

    pub fn with_hits(&self) -> Vec<(&PickedPixel, Option<&PickedPoint>)> {
        let picks = self.list.iter();
        picks.map(|pick| (pick, self.hit(pick.number))).collect()
    }

    /// The points with their numbers and names, in the scene's coordinates.
    pub fn points(&self) -> Vec<(DVec3, String)> {
        let text = |pick: &PickedPixel| match pick.name.as_str() {
            "" => format!("#{}", pick.number),
            name => format!("#{} {name}", pick.number),
        };
        let point = |pick: &PickedPixel| Some((self.hit(pick.number)?.in_scene, text(pick)));
        self.list.iter().filter_map(point).collect()
    }

    /// The measurements between the picks, and at the selected one.
    pub fn measurements(&self) -> Measurements {
        let points = self.with_hits().into_iter().filter_map(|(pick, hit)| {
            let hit = hit?;
            Some(MeasuredPoint {
                number: pick.number,
                in_file: DVec3::from_array(hit.point),
                in_scene: hit.in_scene,
                normal: glam::Vec3::from_array(hit.geometric_normal).as_dvec3(),
            })
        });
        let points: Vec<MeasuredPoint> = points.collect();
        let mut all = Measurements::between(&points);
        let hit = self.selected().and_then(|pick| self.hit(pick.number));
        if let (Some((basis, detail)), Some(hit)) = (&self.detail, hit)
            && let Some(thickness) = &detail.thickness
        {
            let origin = basis.scene.mesh().origin();
            let from = DVec3::from_array(hit.position) - origin;
            all.add_thickness(thickness, from, origin);
        }
        all
    }

    pub fn walk(&self) -> &[OpenedBox] {
        let detail = self.detail.as_ref().filter(|_| self.shows_walk);
        detail.map_or(&[], |(_, detail)| &detail.walk)
    }

    /// The selected box of the walk.
    pub fn opened(&self) -> Option<Aabb> {
        let walk = self.walk();
        let last = walk.len().checked_sub(1)?;
        Some(walk[self.step.min(last)].bounds)
    }
}
