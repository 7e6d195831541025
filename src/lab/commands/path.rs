//! Options of the path of a sample, and its printing.

use super::{CommandError, DARK_BACKGROUND, LightArgs};
use crate::inspection::{PathReport, VertexReport, light_text};
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser as _};
use glam::UVec2;
use hitscope_core::camera::UpAxis;
use hitscope_core::integrator::{Context, INTEGRATORS, Integrator, ViewOptions, integrator};
use hitscope_core::loading::LoadedScene;
use hitscope_core::scene::Shading;
use hitscope_core::srgb::from_display;
use hitscope_core::{Camera, Intersector};
use std::io::{self, Write};
use std::sync::Arc;

/// The path of a sample
#[derive(Args, Clone, Debug)]
pub struct PathArgs {
    /// Show the path of a sample as this view follows it
    /// [default with --sample: the scene file's integrator, or path]
    #[arg(long, visible_alias = "integrator", value_name = "NAME", value_parser = view_names())]
    pub view: Option<String>,
    /// Show the path of the sample with this number, counted from 0 [default with --view: 0]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = clap::value_parser!(u32).range(0..65536))]
    pub sample: Option<u32>,
    /// Light.
    #[command(flatten)]
    pub light: LightArgs,
}

impl PathArgs {
    /// Whether a path is asked for.
    pub fn is_wanted(&self) -> bool {
        self.view.is_some() || self.sample.is_some()
    }

    /// Refuses options that have no effect.
    ///
    /// # Errors
    /// [`CommandError::Usage`].
    pub fn check(&self) -> Result<(), CommandError> {
        if !self.is_wanted() {
            return self.light.refuse_all("--view or --sample");
        }
        match &self.view {
            Some(name) => self.light.check(&[named(name)]),
            None => Ok(()),
        }
    }

    /// The path of a sample of a pixel, with the same random numbers as in `render`. `up_axis` points up in the
    /// picture.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn report(
        &self,
        loaded: &LoadedScene,
        intersector: Arc<dyn Intersector>,
        (camera, up_axis): (&Camera, UpAxis),
        shading: Shading,
        (pixel, max_memory): (UVec2, u64),
    ) -> Result<Option<PathReport>, CommandError> {
        if !self.is_wanted() {
            return Ok(None);
        }
        let of_file = loaded.integrator().filter(|view| view.follows_paths());
        let chosen = self.view.as_deref().map(named).or(of_file);
        let view = chosen.unwrap_or_else(|| named("path"));
        self.light.check(&[view])?;
        let context = Context {
            scene: Arc::clone(&loaded.scene),
            second: Arc::clone(&intersector),
            intersector,
            camera: *camera,
            shading,
            background: from_display(DARK_BACKGROUND),
            lighting: self.light.lighting(loaded, (camera, up_axis), max_memory)?,
            options: ViewOptions::default(),
        };
        let sample = self.sample.unwrap_or(0);
        let path = view.record(&context, pixel, sample);
        Ok(path.map(|path| PathReport::new(&loaded.scene, view, sample, &path)))
    }
}

fn named(name: &str) -> &'static Integrator {
    integrator(name).expect("a name in the table")
}

fn view_names() -> impl clap::builder::TypedValueParser<Value = String> {
    let views = INTEGRATORS.iter().filter(|view| view.follows_paths());
    PossibleValuesParser::new(views.map(|view| view.name)).map(|name| name)
}

/// Prints a path as a table.
pub(super) fn print_path(path: &PathReport, out: &mut dyn Write) -> io::Result<()> {
    let PathReport { view, sample, .. } = path;
    writeln!(out, "path of sample {sample} in the view “{view}”")?;
    let header = ["throughput", "emitted light", "light from lights"];
    let [throughput, emission, direct] = header;
    writeln!(
        out,
        "  {:>3} {:>14} {:<20} {throughput:<24} {emission:<24} {direct:<24}",
        "", "t", "primitive"
    )?;
    for (number, vertex) in (1..).zip(&path.vertices) {
        let VertexReport {
            t,
            shape,
            primitive,
            emission,
            direct,
            throughput,
            ..
        } = vertex;
        let primitive = format!("{shape} {primitive}");
        let [throughput, emission, direct] = [throughput, emission, direct].map(|l| light_text(*l));
        let line = format!(
            "  {number:>3} {t:>14} {primitive:<20} {throughput:<24} {emission:<24} {direct:<24} {}",
            vertex.notes()
        );
        writeln!(out, "{}", line.trim_end())?;
    }
    let afar = light_text(path.from_afar);
    writeln!(out, "  end: {}; light of the environment {afar}", path.end)?;
    writeln!(out, "  colour {}", light_text(path.radiance))
}
