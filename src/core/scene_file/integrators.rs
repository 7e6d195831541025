//! Integrators: `<integrator>` elements, and the views that they stand for.

use super::element::Element;
use super::objects;
use super::parameters::Parameters;
use super::plugin::{Parameter, Plugin};
use super::problem::{Problem, quoted};
use super::reader::Reader;
use crate::integrator::{self, ROULETTE_DEPTH};

/// An integrator as it stands in the file, and the view that it stands for.
#[derive(Clone, Debug, PartialEq)]
pub struct Integrator {
    /// The object with all its parameters.
    pub plugin: Plugin,
    /// The name of the view; `None` if no view shows the like.
    pub view: Option<&'static str>,
    /// The most surfaces on a path; `None` for no limit. Mitsuba's `max_depth` also counts the emitter.
    pub depth_limit: Option<u32>,
    /// The number of the surface, counted from 1, from which on Russian roulette may end a path.
    pub roulette_depth: u32,
    /// Whether the camera sees neither emitters nor the environment.
    pub hides_emitters: bool,
}

/// The integrators of Mitsuba 3.9.1 that aren't views, and the view that is shown instead.
pub(super) const OTHERS: [(&str, Option<&str>); 12] = [
    ("aov", None),
    ("direct_projective", Some("direct")),
    ("moment", None),
    ("prb", Some("path")),
    ("prb_basic", Some("path")),
    ("prb_projective", Some("path")),
    ("prbvolpath", Some("path")),
    ("ptracer", Some("path")),
    ("stokes", None),
    ("volpath", Some("path")),
    ("volpathmis", Some("path")),
    ("volprim_rf_basic", None),
];

/// An integrator.
///
/// # Errors
/// Its type isn't known, or a part of it isn't valid.
pub(super) fn integrator(reader: &mut Reader, element: Element) -> Result<Integrator, Problem> {
    let plugin = objects::plugin(reader, element)?;
    let mut parameters = Parameters::new("integrator", &plugin.kind, element.place);
    // The copies last until the end of the function.
    let bytes: usize = plugin.parameters.iter().map(Parameter::bytes).sum();
    reader.memory.take(bytes as u64, element.place)?;
    for parameter in &plugin.parameters {
        parameters.add(parameter.clone())?;
    }
    let depth_limit = depth_limit(reader, &mut parameters)?;
    let roulette_depth = parameters.count("rr_depth", 1..=u32::MAX)?;
    let hides_emitters = parameters.boolean("hide_emitters", false)?;
    let samples = ["shading_samples", "emitter_samples", "bsdf_samples"];
    parameters.warn_about(&samples, &mut reader.warnings);

    let view = match OTHERS.iter().find(|(name, _)| *name == plugin.kind) {
        None => {
            parameters.finish(&mut reader.memory)?;
            integrator::integrator(&plugin.kind).map(|view| view.name)
        }
        Some((_, view)) => {
            let kind = quoted(&plugin.kind);
            let instead = view.map_or(String::new(), |view| {
                format!("; the view {} is shown instead", quoted(view))
            });
            let message = format!("integrator {kind} isn't supported{instead}");
            reader.warnings.add(plugin.place, message);
            *view
        }
    };
    reader.memory.give_back(bytes as u64);
    Ok(Integrator {
        plugin,
        view,
        depth_limit,
        roulette_depth: roulette_depth.unwrap_or(ROULETTE_DEPTH),
        hides_emitters,
    })
}

/// The number of surfaces in `max_depth`, where −1 is no limit.
fn depth_limit(reader: &mut Reader, parameters: &mut Parameters) -> Result<Option<u32>, Problem> {
    let Some((depth, place)) = parameters.integer("max_depth")? else {
        return Ok(None);
    };
    if depth == 0 {
        let message = "“max_depth” 0 is black in Mitsuba; here, emitters are visible".to_owned();
        reader.warnings.add(place, message);
    }
    match depth {
        -1 => Ok(None),
        0 => Ok(Some(0)),
        1.. => Ok(Some(u32::try_from(depth - 1).unwrap_or(u32::MAX))),
        _ => Err(Problem::at(place, "“max_depth” must be -1 or more")),
    }
}
