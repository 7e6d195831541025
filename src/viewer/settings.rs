//! The settings of the picture: how the scene is shown. They are kept between runs, in sessions and in undo steps.

use crate::clip_choice::ClipChoice;
use crate::colour_choice::ColourChoice;
use crate::overlay::Overlays;
use crate::overlay::face_normals::FACE_NORMALS;
use crate::overlay::vertex_normals::VERTEX_NORMALS;
use crate::quality::MovingResolution;
use hitscope_core::camera::UpAxis;
use hitscope_core::group::kernel_named;
use hitscope_core::integrator::{INTEGRATORS, Integrator, Setting, integrator};
use hitscope_core::kernel::{KernelChoice, default_triangle_kernel, exact_triangle_kernel};
use hitscope_core::mesh::Crease;
use hitscope_core::scene::Shading;
use hitscope_core::spawn::{SPAWN_POLICIES, SpawnPolicy, default_spawn_policy, spawn_policy};
use hitscope_core::terminator::{TerminatorRepair, default_terminator_repair, terminator_repair};
use hitscope_core::tone::{Display, TONE_CURVES, ToneCurve, tone_curve};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Where light from far away comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum EnvironmentSource {
    /// The lights of the scene's file; white light from everywhere if nothing in the scene emits light.
    Scene,
    /// A colour, the same from everywhere.
    Colour,
    /// The built-in studio.
    Studio,
    /// A picture in a file.
    File,
}

/// How the scene is shown. Unknown names of views, kernels, spawn policies and tone curves stand for the defaults.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Name of the view.
    pub view: String,
    /// Name of the kernel.
    pub kernel: String,
    /// Name of a kernel to use instead for this session.
    #[serde(skip)]
    pub session_kernel: Option<String>,
    /// Name of the kernel that the selected kernel is compared with.
    pub against: String,
    /// Whether shading is smooth.
    pub is_smooth: bool,
    /// Whether smooth shading interpolates normals on the unit sphere instead of linearly.
    pub is_spherical: bool,
    /// Which overlays are drawn, and how.
    pub overlays: Overlays,
    /// The clip. Not kept, as it belongs to a scene.
    #[serde(skip)]
    pub clip: ClipChoice,
    /// Colour map, legend, tint and background.
    pub colours: ColourChoice,
    /// Samples per pixel of the finished picture; a power of two.
    pub samples: u32,
    /// The resolution while the camera moves.
    pub moving: MovingResolution,
    /// Whether refinement of views that need lights ends after a time.
    pub has_time_limit: bool,
    /// The time, in seconds.
    pub time_limit_s: f32,
    /// Whether refinement of views that need lights ends at a noise.
    pub has_noise_limit: bool,
    /// The mean noise, in percent of the mean luminance.
    pub noise_limit_percent: f32,
    /// Name of the rule for rays that leave surfaces.
    pub spawn: String,
    /// Name of the rule that the view *Spawn policies* compares with.
    pub second_spawn: String,
    /// Offset of the coordinates in which the scene is stored, while the view compares spawn policies. Not kept between
    /// runs, because it belongs to a scene.
    #[serde(skip)]
    pub spawn_offset: f64,
    /// The distance to which surfaces occlude in the view *Ambient occlusion*, in radii of the scene.
    pub ao_distance: f32,
    /// Whether paths have a limit on their surfaces.
    pub has_depth_limit: bool,
    /// The most surfaces on a path.
    pub depth_limit: u32,
    /// Name of the repair of the shadow terminator.
    pub terminator: String,
    /// Where light from far away comes from.
    pub environment: EnvironmentSource,
    /// Whether the open file has an environment of its own, which is used instead of the chosen one.
    #[serde(skip)]
    pub has_file_environment: bool,
    /// The picture of [`EnvironmentSource::File`].
    pub environment_file: Option<PathBuf>,
    /// sRGB of [`EnvironmentSource::Colour`].
    pub environment_colour: [u8; 3],
    /// Factor of the light from far away.
    pub environment_brightness: f32,
    /// Rotation of the light from far away about the up axis.
    pub environment_degrees: f32,
    /// Exposure of views with light, in stops: each doubles the brightness.
    pub exposure_stops: f32,
    /// Name of the tone curve of views with light.
    pub tone_curve: String,
    /// Whether the noise of views that need lights is shown instead of their picture. Not kept, so that no window opens
    /// with a picture of noise.
    #[serde(skip)]
    pub shows_noise: bool,
    /// Name of the view that the open file asks for, which is used instead.
    #[serde(skip)]
    pub file_view: Option<&'static str>,
    /// Whether the mesh's z axis points up.
    pub is_z_up: bool,
    /// The axis that points up in the open file's view, which is used instead.
    #[serde(skip)]
    pub file_up_axis: Option<UpAxis>,
    /// Whether a crease angle replaces the file's normals and smoothing groups.
    pub has_crease: bool,
    /// The crease angle.
    pub crease_degrees: f32,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            view: INTEGRATORS[0].name.to_owned(),
            kernel: default_triangle_kernel().info.name.to_owned(),
            session_kernel: None,
            against: exact_triangle_kernel().info.name.to_owned(),
            is_smooth: false,
            is_spherical: false,
            overlays: Overlays::default(),
            clip: ClipChoice::default(),
            colours: ColourChoice::default(),
            samples: 64,
            moving: MovingResolution::Automatic,
            has_time_limit: false,
            time_limit_s: 60.0,
            has_noise_limit: false,
            noise_limit_percent: 1.0,
            spawn: default_spawn_policy().name.to_owned(),
            second_spawn: SPAWN_POLICIES[0].name.to_owned(),
            spawn_offset: 0.0,
            ao_distance: 1.0,
            has_depth_limit: false,
            depth_limit: 8,
            terminator: default_terminator_repair().name.to_owned(),
            environment: EnvironmentSource::Scene,
            has_file_environment: false,
            environment_file: None,
            environment_colour: [255; 3],
            environment_brightness: 1.0,
            environment_degrees: 0.0,
            exposure_stops: 0.0,
            tone_curve: TONE_CURVES[0].name.to_owned(),
            shows_noise: false,
            is_z_up: false,
            file_up_axis: None,
            file_view: None,
            has_crease: false,
            // The default of modelling programs.
            crease_degrees: 30.0,
        }
    }
}

impl Settings {
    /// The view.
    pub fn view(&self) -> &'static Integrator {
        let name = self.file_view.unwrap_or(&self.view);
        integrator(name).unwrap_or(INTEGRATORS[0])
    }

    /// Uses the view of this name and keeps it between runs.
    pub fn keep_view(&mut self, name: &str) {
        self.file_view = None;
        name.clone_into(&mut self.view);
    }

    /// The kernel.
    pub fn kernel(&self) -> KernelChoice {
        let name = self.session_kernel.as_ref().unwrap_or(&self.kernel);
        kernel_named(name).unwrap_or_else(|| default_triangle_kernel().into())
    }

    /// Uses a kernel for this session, without replacing the one that is kept between runs.
    pub fn use_for_session(&mut self, kernel: &str) {
        self.session_kernel = (kernel != self.kernel).then(|| kernel.to_owned());
    }

    /// Uses a kernel and keeps it between runs.
    pub fn keep_kernel(&mut self, kernel: &str) {
        self.session_kernel = None;
        self.kernel = kernel.to_owned();
    }

    /// The kernel that the view *Disagreement* compares the selected kernel with. Never the selected kernel, which
    /// would always agree.
    pub fn against(&self) -> KernelChoice {
        let chosen = kernel_named(&self.against).unwrap_or_else(|| exact_triangle_kernel().into());
        if chosen == self.kernel() {
            chosen.default_second()
        } else {
            chosen
        }
    }

    /// The kernel that the current view compares the selected kernel with.
    pub fn second_kernel(&self) -> Option<KernelChoice> {
        self.view().needs.second.kernel(self.against())
    }

    /// The name of flat or smooth shading.
    pub fn shading_name(is_smooth: bool) -> &'static str {
        if is_smooth { "smooth" } else { "flat" }
    }

    /// How normals vary over a triangle.
    pub fn shading(&self) -> Shading {
        match (self.is_smooth, self.is_spherical) {
            (false, _) => Shading::Flat,
            (true, false) => Shading::Smooth,
            (true, true) => Shading::Spherical,
        }
    }

    /// Whether normals of faces or of vertices are drawn.
    pub fn shows_normals(&self) -> bool {
        self.overlays.is_on(&FACE_NORMALS) || self.overlays.is_on(&VERTEX_NORMALS)
    }

    /// Turns all normals off; if none are drawn, turns on those that the shading uses.
    pub fn toggle_normals(&mut self) {
        let is_on = !self.shows_normals();
        let smooth = self.is_smooth;
        self.overlays.set_on(&FACE_NORMALS, is_on && !smooth);
        self.overlays.set_on(&VERTEX_NORMALS, is_on && smooth);
    }

    /// The creases of smooth shading.
    pub fn crease(&self) -> Crease {
        if self.has_crease {
            Crease::Above(self.crease_degrees.to_radians())
        } else {
            Crease::FromFile
        }
    }

    /// How rays leave surfaces.
    pub fn spawn(&self) -> &'static SpawnPolicy {
        spawn_policy(&self.spawn).unwrap_or_else(default_spawn_policy)
    }

    /// The rule that the view *Spawn policies* compares with.
    pub fn second_spawn(&self) -> &'static SpawnPolicy {
        spawn_policy(&self.second_spawn).unwrap_or(&SPAWN_POLICIES[0])
    }

    /// The offset of the coordinates in which the scene is stored.
    pub fn offset(&self) -> f64 {
        if self.view().needs.uses(Setting::SecondSpawn) {
            self.spawn_offset
        } else {
            0.0
        }
    }

    /// The most surfaces on a path; `None` for no limit.
    pub fn depth_limit(&self) -> Option<u32> {
        self.has_depth_limit.then_some(self.depth_limit)
    }

    /// The repair of the shadow terminator.
    pub fn terminator(&self) -> &'static TerminatorRepair {
        terminator_repair(&self.terminator).unwrap_or_else(default_terminator_repair)
    }

    /// Whether the view shows light from far away.
    pub fn shows_light(&self) -> bool {
        self.view().needs.uses(Setting::Lights)
    }

    /// Whether the light from far away is a picture, which can be rotated.
    pub fn has_map(&self) -> bool {
        use EnvironmentSource::{File, Studio};
        self.shows_light() && matches!(self.environment(), Studio | File)
    }

    /// Where light from far away comes from.
    pub fn environment(&self) -> EnvironmentSource {
        if self.has_file_environment {
            EnvironmentSource::Scene
        } else {
            self.environment
        }
    }

    /// Uses an environment and keeps it between runs.
    pub fn keep_environment(&mut self, source: EnvironmentSource) {
        self.has_file_environment = false;
        self.environment = source;
    }

    /// Uses the environment picture in a file, and keeps it between runs. A new file resets the rotation.
    pub fn keep_environment_file(&mut self, path: &Path) {
        if self.environment_file.as_deref() != Some(path) {
            self.environment_degrees = 0.0;
        }
        self.environment_file = Some(path.to_owned());
        self.keep_environment(EnvironmentSource::File);
    }

    /// Whether exposure and tone curve change the picture. The view *Shaded* is shown as it is, which is faster.
    pub fn is_exposed(&self) -> bool {
        let needs = self.view().needs;
        needs.lights && needs.uses(Setting::Exposure)
    }

    /// The factor of light in the picture.
    pub fn exposure(&self) -> f32 {
        if self.is_exposed() {
            self.exposure_stops.exp2()
        } else {
            1.0
        }
    }

    /// How colours are limited to those of the screen.
    pub fn tone_curve(&self) -> &'static ToneCurve {
        tone_curve(&self.tone_curve).unwrap_or(TONE_CURVES[0])
    }

    /// How light is shown.
    pub fn display(&self) -> Display {
        if self.is_exposed() {
            Display::new(self.exposure_stops, self.tone_curve())
        } else {
            Display::default()
        }
    }

    /// The axis that points up.
    pub fn up_axis(&self) -> UpAxis {
        let kept = if self.is_z_up { UpAxis::Z } else { UpAxis::Y };
        self.file_up_axis.unwrap_or(kept)
    }

    /// Uses an axis as the one that points up and keeps it between runs.
    pub fn keep_up_axis(&mut self, axis: UpAxis) {
        self.file_up_axis = None;
        self.is_z_up = axis == UpAxis::Z;
    }
}

#[cfg(test)]
mod tests;
