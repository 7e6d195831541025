//! The comparison of two pictures.

use super::CompareArgs;
use crate::commands::CommandError;
use crate::json;
use crate::picture_comparison::{PictureComparison, PicturePair};
use crate::rounding::significant;
use hitscope_core::picture::PictureFile;
use hitscope_core::progress::Progress;
use std::io::{self, Write};
use std::path::Path;

impl CompareArgs {
    /// Compares two pictures.
    pub(super) fn compare_pictures(&self, out: &mut dyn Write) -> Result<(), CommandError> {
        let output = self.created_output()?;
        let load =
            |path: &Path| PictureFile::load(path, self.mesh.memory.bytes(), &Progress::default());
        let (a, b) = (load(&self.a)?, load(&self.b)?);
        let pair = PicturePair::new(a, b).map_err(|error| super::about(&self.a, error))?;
        let found = pair.compared(self.pictures.tolerance);
        if let Some(output) = output {
            let pixels = pair.difference_picture(self.pictures.gain);
            output.write_png(pair.size(), &pixels)?;
        }
        if self.prints_picture() {
            return Ok(());
        }
        if self.json {
            writeln!(out, "{}", json::to_pretty(&found))?;
        } else {
            print(&found, out)?;
        }
        Ok(())
    }
}

fn print(found: &PictureComparison, out: &mut dyn Write) -> io::Result<()> {
    let [width, height] = found.size;
    let encoding = if found.is_linear {
        "linear RGB"
    } else {
        "sRGB"
    };
    writeln!(out, "{width} x {height} pixels, {encoding}")?;
    writeln!(out, "mse            {}", significant(found.mse, 6))?;
    writeln!(out, "rmse           {}", significant(found.rmse, 6))?;
    match found.psnr_db {
        Some(psnr) => writeln!(out, "psnr           {psnr:.2} dB")?,
        None => writeln!(out, "psnr           no difference")?,
    }
    if let Some(relative) = found.relative_mse {
        writeln!(out, "relative mse   {}", significant(relative, 6))?;
    }
    if let Some(worst) = &found.worst {
        let [x, y] = worst.pixel;
        writeln!(
            out,
            "worst          {:.6} at pixel {x},{y}, channel {}: {} and {}",
            worst.difference, worst.channel, worst.a, worst.b
        )?;
    }
    writeln!(
        out,
        "over {:<9} {} pixels, {:.3} %",
        found.tolerance, found.pixels_over_tolerance, found.percent_over_tolerance
    )?;
    if found.non_finite_pixels > 0 {
        writeln!(out, "not finite     {} pixels", found.non_finite_pixels)?;
    }
    for channel in &found.channels {
        writeln!(
            out,
            "mean {}         {:.6} and {:.6}, mse {}",
            channel.name,
            channel.mean_a,
            channel.mean_b,
            significant(channel.mse, 6)
        )?;
    }
    Ok(())
}
