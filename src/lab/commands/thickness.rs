//! The option of wall thickness, and its printing.

use super::inspect::list;
use crate::inspection::ThicknessReport;
use clap::Args;
use glam::UVec2;
use hitscope_core::{Camera, Scene};
use std::io::{self, Write};

/// Wall thickness
#[derive(Args, Clone, Copy, Debug)]
pub struct ThicknessArg {
    /// Measure the thickness of the wall behind the hit and the clearance in front of it, along the normal
    #[arg(long)]
    pub thickness: bool,
}

impl ThicknessArg {
    /// The thickness at the hit of a pixel's ray, if it is asked for; `Some(None)` if the ray hits nothing.
    pub fn report(
        self,
        scene: &Scene,
        camera: &Camera,
        pixel: UVec2,
    ) -> Option<Option<ThicknessReport>> {
        let report = || ThicknessReport::of_pixel(scene, camera, pixel);
        self.thickness.then(report)
    }
}

/// Prints the thickness and the clearance.
pub(super) fn print_thickness(
    thickness: Option<&ThicknessReport>,
    out: &mut dyn Write,
) -> io::Result<()> {
    let Some(ThicknessReport {
        inwards, outwards, ..
    }) = thickness
    else {
        return writeln!(out, "thickness: no hit");
    };
    for (title, wall) in [("thickness", inwards), ("clearance", outwards)] {
        let Some(wall) = wall else {
            writeln!(out, "{title}: no other surface along the normal")?;
            continue;
        };
        let line = wall
            .line
            .map_or_else(String::new, |line| format!(" on line {line}"));
        writeln!(
            out,
            "{title}: {} to {} {}{line} at {}",
            wall.distance,
            wall.shape,
            wall.primitive,
            list(wall.position)
        )?;
    }
    Ok(())
}
