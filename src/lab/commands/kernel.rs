//! The option `--kernel`, and the list of all kernels.

use clap::Args;
use hitscope_core::group::{all_kernels, kernel_named};
use hitscope_core::kernel::{KernelChoice, KernelInfo, Tier};
use hitscope_core::names::{alternatives, nearest};

/// The kernel that traces the rays.
#[derive(Args, Clone, Copy, Debug)]
pub struct KernelArg {
    /// Intersection kernel: fast, watertight, precise or exact, or an algorithm that `hitscope lab --help` lists
    #[arg(long = "kernel", value_name = "KERNEL", default_value = Tier::DEFAULT.name(), value_parser = parse_kernel)]
    pub choice: KernelChoice,
}

/// `watertight`, `sphere-geometric`.
pub(super) fn parse_kernel(name: &str) -> Result<KernelChoice, String> {
    kernel_named(name).ok_or_else(|| match &similar(name)[..] {
        [] => {
            let tiers = Tier::ALL.map(Tier::name).join(", ");
            format!("expected {tiers}, or an algorithm that `hitscope lab --help` lists")
        }
        names => {
            let names = alternatives(names);
            format!("did you mean {names}? `hitscope lab --help` lists all kernels")
        }
    })
}

/// The names that a wrong one resembles: the nearest, or else those that contain it, unless they are many.
fn similar(name: &str) -> Vec<&'static str> {
    /// Fewer letters are part of many names.
    const LEAST_LETTERS: usize = 3;
    /// Each shape has fewer kernels than this.
    const MOST_NAMES: usize = 16;
    let infos = all_kernels().into_iter().flat_map(|shape| shape.kernels);
    let mut known: Vec<&str> = Tier::ALL.map(Tier::name).to_vec();
    known.extend(infos.map(|info| info.name));
    if let Some(near) = nearest(name, known.iter().copied()) {
        return vec![near];
    }
    let part = name.to_lowercase();
    known.retain(|known| known.contains(&part));
    if part.chars().count() < LEAST_LETTERS || known.len() > MOST_NAMES {
        known.clear();
    }
    known
}

/// The names of all kernels, shape by shape, in lines of at most 80 characters.
pub(super) fn kernel_list() -> String {
    let mut text = "Kernels of each shape, with the tiers that select them:".to_owned();
    for shape in all_kernels() {
        let names: Vec<String> = shape.kernels.iter().map(|info| with_tier(info)).collect();
        text += "\n";
        text += &paragraph(shape.shape.name, &names.join(", "));
    }
    text
}

/// `sphere-geometric (fast)`.
fn with_tier(info: &KernelInfo) -> String {
    match info.tier {
        Some(tier) if tier.name() != info.name => format!("{} ({})", info.name, tier.name()),
        _ => info.name.to_owned(),
    }
}

/// A title, and words beside it.
fn paragraph(title: &str, words: &str) -> String {
    const WIDTH: usize = 80;
    let mut lines = vec![format!("  {title:<19}")];
    for word in words.split(' ') {
        let line = lines.last().map_or(0, |line| line.chars().count());
        if line + 1 + word.chars().count() > WIDTH {
            lines.push(" ".repeat(21));
        }
        if let Some(line) = lines.last_mut() {
            line.push(' ');
            line.push_str(word);
        }
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_kernel_name_is_refused_with_similar_names() {
        assert_eq!(
            parse_kernel("exact").map(|kernel| kernel.tier()),
            Ok(Tier::Exact)
        );
        for (wrong, reason) in [
            ("watertihgt", "did you mean watertight? "),
            ("Sphere-Geometrik", "did you mean sphere-geometric? "),
            (
                "torus",
                "did you mean torus-unshifted, torus-unshifted-f64, torus-shifted or torus-shifted-f64? ",
            ),
            ("f64", "expected fast, watertight, precise, exact, or "),
            ("embree", "expected fast, watertight, precise, exact, or "),
            ("", "expected fast, watertight, precise, exact, or "),
        ] {
            let message = parse_kernel(wrong).expect_err(wrong);
            assert!(message.starts_with(reason), "{wrong}: {message}");
            assert!(message.contains("`hitscope lab --help`"), "{message}");
        }
    }

    #[test]
    fn the_list_of_kernels_has_every_name_and_no_long_line() {
        let text = kernel_list();
        for shape in all_kernels() {
            assert!(
                text.contains(&format!("\n  {} ", shape.shape.name)),
                "{text}"
            );
            for kernel in shape.kernels {
                assert!(text.contains(&format!(" {}", kernel.name)), "{text}");
            }
        }
        assert!(
            text.lines().all(|line| line.chars().count() <= 80),
            "{text}"
        );
    }
}
