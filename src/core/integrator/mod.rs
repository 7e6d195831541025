//! Views: functions from a ray to a colour.
//!
//! Each view is a file with its row of [`INTEGRATORS`]. Colours are linear RGB.

mod ambient_occlusion;
mod barycentric;
mod cost;
mod depth;
mod direct;
mod disagreement;
mod error;
mod hidden_emitters;
mod interpolation;
mod normal;
mod number;
mod offset;
mod options;
mod orientation;
pub mod palette;
mod path;
mod record;
mod shaded;
mod shading_normal;
mod spawning;
mod transport;
mod triangle;
mod visibility;
mod whitted;

pub use options::{ScaleOptions, SurfaceColours, ViewOptions, back_face_colour};
pub use record::{PathEnd, PathRecord, PathVertex, ShadowRay};

use crate::camera::Camera;
use crate::film::Seen;
use crate::intersector::Intersector;
use crate::kernel::{KernelChoice, exact_triangle_kernel};
use crate::light::Lights;
use crate::ray::{Hit, Ray};
use crate::sampler::Sampler;
use crate::scene::{Scene, Shading};
use crate::spawn::{SPAWN_POLICIES, SpawnPolicy, default_spawn_policy};
use crate::terminator::{TerminatorRepair, default_terminator_repair};
use glam::Vec3;
use number::NumberView;
use std::slice::from_mut;
use std::sync::Arc;

/// Everything that a colour depends on besides the ray.
#[derive(Clone)]
pub struct Context {
    /// The scene.
    pub scene: Arc<Scene>,
    /// The intersector of the chosen kernel; with the scene's clip, as the second one. See [`Scene::clipped`].
    pub intersector: Arc<dyn Intersector>,
    /// The intersector that comparing views compare with; any one for the others.
    pub second: Arc<dyn Intersector>,
    /// The camera.
    pub camera: Camera,
    /// Flat or smooth shading.
    pub shading: Shading,
    /// The colour of rays that hit nothing.
    pub background: Vec3,
    /// Lights, for views that need them.
    pub lighting: Lighting,
    /// The user's choices about colours.
    pub options: ViewOptions,
}

/// What light transport depends on besides the scene.
#[derive(Clone)]
pub struct Lighting {
    /// The lights.
    pub lights: Arc<Lights>,
    /// How rays leave surfaces.
    pub spawn: &'static SpawnPolicy,
    /// The policy that the view *Spawn policies* compares with.
    pub second_spawn: &'static SpawnPolicy,
    /// The distance to which surfaces occlude in the view *Ambient occlusion*, in radii of the scene's bounding sphere.
    pub ao_distance: f32,
    /// The most surfaces on a path; `None` for no limit.
    pub depth_limit: Option<u32>,
    /// The number of the surface, counted from 1, from which on Russian roulette may end a path.
    pub roulette_depth: u32,
    /// Whether the camera sees neither emitters nor the environment. They stay visible in mirrors, through glass, and
    /// through surfaces with coverage.
    pub hides_emitters: bool,
    /// The repair of the shadow terminator.
    pub terminator: &'static TerminatorRepair,
}

/// The default of [`Lighting::roulette_depth`]; Mitsuba's.
pub(crate) const ROULETTE_DEPTH: u32 = 5;

impl Default for Lighting {
    /// No lights, the default policy, the first of the table to compare it with, and no repair.
    fn default() -> Self {
        Self {
            lights: Arc::default(),
            spawn: default_spawn_policy(),
            second_spawn: &SPAWN_POLICIES[0],
            ao_distance: 1.0,
            depth_limit: None,
            roulette_depth: ROULETTE_DEPTH,
            hides_emitters: false,
            terminator: default_terminator_repair(),
        }
    }
}

/// A view: how a ray gets its colour.
pub struct Integrator {
    /// The name, as in `--view`.
    pub name: &'static str,
    /// The title in menus.
    pub title: &'static str,
    /// The meaning of the colours, in one sentence.
    pub about: &'static str,
    /// What the view needs besides the scene and the chosen kernel.
    pub needs: Needs,
    /// The legend of the colours that no scale has; empty if there are none.
    pub legend: fn() -> Legend,
    source: Source,
}

/// A sample of a picture. Views that follow paths replace the ray and its hit by the last ones of the path.
#[derive(Clone, Debug)]
pub struct Sample {
    /// The camera's ray.
    pub ray: Ray,
    /// Its first hit.
    pub hit: Option<Hit>,
    /// The random numbers.
    pub sampler: Sampler,
    /// The colour in linear RGB; black until [`Integrator::radiances`] sets it.
    pub radiance: Vec3,
    /// The source of its colour: without a hit the background, until a view with an environment sets it.
    pub seen: Seen,
}

impl Sample {
    /// A sample without a colour.
    pub fn new(ray: Ray, hit: Option<Hit>, sampler: Sampler) -> Self {
        Self {
            ray,
            hit,
            sampler,
            radiance: Vec3::ZERO,
            seen: if hit.is_some() {
                Seen::Surface
            } else {
                Seen::Background
            },
        }
    }
}

/// Where the colours of a view come from.
enum Source {
    /// A function from a ray and its first hit to a colour.
    Colour(fn(&Context, &Ray, Option<Hit>, &mut Sampler) -> Vec3),
    /// A function that sets the colours of a batch of samples and traces their further rays together.
    Batch(fn(&Context, &mut [Sample])),
    /// Numbers, which a scale colours.
    Number(NumberView),
    /// The index of the primitive that was hit.
    Index,
}

/// What a view needs besides the scene and the chosen kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Needs {
    /// The kernel that the view compares the chosen one with.
    pub second: Comparison,
    /// Whether the view uses vertex normals, so that flat and smooth shading differ.
    pub vertex_normals: bool,
    /// Whether the view needs lights.
    pub lights: bool,
    /// Whether the view depends on the tree, as the cost of rays does. Hits don't.
    pub final_tree: bool,
    /// The settings that change the picture.
    pub settings: &'static [Setting],
}

/// A setting that changes the pictures of some views.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Setting {
    /// The lights and the environment.
    Lights,
    /// How rays leave surfaces.
    Spawn,
    /// The way of leaving surfaces with which the view compares.
    SecondSpawn,
    /// The most surfaces on a path.
    Depth,
    /// The repair of the shadow terminator.
    Terminator,
    /// The distance to which surfaces occlude.
    OcclusionDistance,
    /// The factor between light and colour: the view's colours are light.
    Exposure,
    /// The tint of back faces.
    BackFaces,
    /// Custom colours of parts.
    PartColours,
    /// The scale of the view's numbers.
    Scale,
}

impl Needs {
    /// Nothing else.
    const NOTHING: Self = Self {
        second: Comparison::Nothing,
        vertex_normals: false,
        lights: false,
        final_tree: false,
        settings: &[],
    };
    /// Vertex normals.
    const VERTEX_NORMALS: Self = Self {
        vertex_normals: true,
        ..Self::NOTHING
    };
    /// Vertex normals and lights.
    const LIGHTS: Self = Self {
        lights: true,
        settings: &[
            Setting::Lights,
            Setting::Spawn,
            Setting::Terminator,
            Setting::Exposure,
        ],
        ..Self::VERTEX_NORMALS
    };
    /// Vertex normals and lights, for paths of any length.
    const PATHS: Self = Self {
        settings: &[
            Setting::Lights,
            Setting::Spawn,
            Setting::Depth,
            Setting::Terminator,
            Setting::Exposure,
        ],
        ..Self::LIGHTS
    };

    /// Whether a setting changes the picture.
    pub fn uses(&self, setting: Setting) -> bool {
        self.settings.contains(&setting)
    }
}

/// The kernel that a view compares the chosen one with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Comparison {
    /// None: the view uses one kernel.
    Nothing,
    /// The exact kernel.
    Exact,
    /// A second kernel that the user chooses.
    Second,
}

impl Comparison {
    /// The kernel to compare with, where the user's second kernel is `chosen`.
    pub fn kernel(self, chosen: KernelChoice) -> Option<KernelChoice> {
        match self {
            Self::Nothing => None,
            Self::Exact => Some(exact_triangle_kernel().into()),
            Self::Second => Some(chosen),
        }
    }
}

/// Colours in linear RGB and their meaning, line by line.
pub type Legend = Vec<Vec<(Vec3, String)>>;

impl Integrator {
    /// Whether the colours stand for indices of primitives.
    pub fn shows_indices(&self) -> bool {
        matches!(self.source, Source::Index)
    }

    /// The intersector to compare `first` with; `first` itself if the view doesn't compare.
    pub fn second(
        &self,
        scene: &Scene,
        first: &Arc<dyn Intersector>,
        chosen: KernelChoice,
    ) -> Arc<dyn Intersector> {
        let second = self.needs.second.kernel(chosen);
        second.map_or_else(
            || Arc::clone(first),
            |kernel| Arc::from(scene.intersector(kernel)),
        )
    }

    /// The colour of a ray in linear RGB, given the first hit of [`Context::intersector`].
    pub fn radiance(
        &self,
        context: &Context,
        ray: &Ray,
        hit: Option<Hit>,
        sampler: &mut Sampler,
    ) -> Vec3 {
        let mut sample = Sample::new(*ray, hit, sampler.clone());
        self.radiances(context, from_mut(&mut sample));
        *sampler = sample.sampler;
        sample.radiance
    }

    /// Sets the colours of a batch of samples, each bit-identical to that of the sample alone. Samples of a transparent
    /// background are black.
    pub fn radiances(&self, context: &Context, samples: &mut [Sample]) {
        let is_background = |sample: &Sample| sample.hit.is_none();
        let transparent: Vec<bool> = if context.options.has_transparent_background {
            samples.iter().map(is_background).collect()
        } else {
            Vec::new()
        };
        self.colour(context, samples);
        for (sample, _) in samples.iter_mut().zip(transparent).filter(|(_, is)| *is) {
            (sample.radiance, sample.seen) = (Vec3::ZERO, Seen::Background);
        }
    }

    fn colour(&self, context: &Context, samples: &mut [Sample]) {
        match &self.source {
            Source::Batch(radiances) => radiances(context, samples),
            Source::Colour(radiance) => {
                for sample in samples {
                    let Sample { ray, hit, .. } = *sample;
                    sample.radiance = radiance(context, &ray, hit, &mut sample.sampler);
                }
            }
            Source::Index => {
                for sample in samples {
                    let colour = |hit: Hit| palette::id_colour(hit.primitive);
                    sample.radiance = sample.hit.map_or(context.background, colour);
                }
            }
            Source::Number(view) => {
                for sample in samples {
                    let Sample { ray, hit, .. } = *sample;
                    let shown = (view.shown)(context, &ray, hit, &mut sample.sampler);
                    sample.radiance = view.colour(context, shown);
                }
            }
        }
    }
}

/// All views, in the order of the menu.
pub static INTEGRATORS: &[&Integrator] = &[
    &shaded::SHADED,
    &ambient_occlusion::AMBIENT_OCCLUSION,
    &direct::DIRECT,
    &whitted::WHITTED,
    &path::PATH,
    &normal::NORMAL,
    &barycentric::BARYCENTRIC,
    &depth::DEPTH,
    &orientation::ORIENTATION,
    &triangle::TRIANGLE,
    &cost::COST,
    &error::ERROR_T,
    &error::ERROR_BARYCENTRIC,
    &interpolation::INTERPOLATION,
    &disagreement::DISAGREEMENT,
    &shading_normal::SHADING_NORMAL,
    &spawning::SPAWNING,
];

/// The view of this name.
pub fn integrator(name: &str) -> Option<&'static Integrator> {
    INTEGRATORS.iter().copied().find(|view| view.name == name)
}
