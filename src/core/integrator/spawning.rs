//! The view *Spawn policies*: the differences in direct light between two policies.
//!
//! Both policies use the same random numbers. Direct light is darker where a policy lets a surface shadow itself, and
//! brighter where it lets light through a surface.

use super::palette::{FALSE_HIT, MISSED, decision, named};
use super::path::follow_all;
use super::{Context, Integrator, Legend, Lighting, Needs, Sample, Setting, Source};
use crate::film::Seen;
use crate::srgb::luminance;

/// The row of the view.
pub(super) static SPAWNING: Integrator = Integrator {
    name: "spawning",
    title: "Spawn policies",
    about: "Where direct light is darker by the chosen policy than by the second one, because a surface shadows itself, or brighter, because light leaks through a surface.",
    needs: Needs {
        settings: &[
            Setting::Lights,
            Setting::Spawn,
            Setting::SecondSpawn,
            Setting::Terminator,
        ],
        ..Needs::LIGHTS
    },
    legend,
    source: Source::Batch(radiances),
};

fn radiances(context: &Context, samples: &mut [Sample]) {
    let lighting = &context.lighting;
    let other = Context {
        lighting: Lighting {
            spawn: lighting.second_spawn,
            ..lighting.clone()
        },
        ..context.clone()
    };
    let mut others = samples.to_vec();
    follow_all(context, samples, Some(1));
    follow_all(&other, &mut others, Some(1));
    for (sample, other) in samples.iter_mut().zip(&others) {
        if sample.seen != Seen::Surface {
            sample.radiance = context.background;
            continue;
        }
        let [first, second] = [sample.radiance, other.radiance].map(luminance);
        sample.radiance = decision(first < second, first > second, first > 0.0);
    }
}

fn legend() -> Legend {
    vec![vec![
        named(FALSE_HIT, "darker by the chosen one"),
        named(MISSED, "brighter by the chosen one"),
    ]]
}
