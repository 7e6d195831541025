//! What does a material library say of its materials?
//!
//! Read here and not by tobj, which panics on the legal `Kd 0.5` and drops a whole library for a
//! statement that it doesn't know. One bad line costs that line.
//!
//! Source: Alias|Wavefront, "MTL material format", Appendix B1 of the Advanced Visualizer Manual, 1995.

use super::Warning;
use super::error::Problem;
use super::facts::{Tally, count_by_keyword, shortened};
use super::lines::{Lines, Statement};
use super::words::{name, without_comment};
use crate::mesh::{Illumination, Material};
use crate::progress::Progress;
use glam::{Vec2, Vec3};
use std::collections::{BTreeMap, HashSet};

/// A material, and the picture that it names.
#[derive(Clone, Debug, Default)]
pub(super) struct Definition {
    pub material: Material,
    pub diffuse_map: Option<MapFile>,
    line: usize,
    /// Whether a `d` was read, which counts more than a `Tr`.
    has_opacity: bool,
}

/// A `map_Kd`: a file's name, and how it lies on the surface.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MapFile {
    pub name: String,
    pub scale: Vec2,
    pub offset: Vec2,
}

/// Statements that programs write for each material and that shading has no use for: told of, they would hide
/// what is odd.
const SILENT: [&str; 3] = ["Ka", "Ni", "sharpness"];

/// Statements between two looks at whether the load is still wanted.
const STATEMENTS_PER_CHECK: usize = 1 << 12;
/// A library of more bytes, unpacked, isn't read to its end: four times the largest file that is read at all.
const LARGEST: usize = 1 << 30;

/// The materials of a library that are wanted, each by its first definition, and what was odd about it.
///
/// # Errors
/// Cancelled by `progress`.
pub(super) fn parse(
    bytes: &[u8],
    library: &str,
    is_wanted: impl Fn(&str) -> bool,
    progress: &Progress,
) -> Result<(Vec<Definition>, Vec<Warning>), Problem> {
    let mut parser = Parser::default();
    let mut failure = None;
    // Bytes of libraries don't count as progress.
    let own = Progress::default();
    let (mut count, mut length) = (0, 0);
    let mut read = || -> Result<(), Problem> {
        let mut lines = Lines::new(bytes, &own)?;
        while let Some(statement) = lines.next()? {
            if count % STATEMENTS_PER_CHECK == 0 {
                progress.check()?;
            }
            count += 1;
            length += statement.bytes.len() + 1;
            if length > LARGEST {
                return Err(statement.problem(format!("more than {} MB", LARGEST >> 20)));
            }
            parser.take(statement, &is_wanted);
        }
        Ok(())
    };
    match read() {
        Ok(()) => {}
        Err(Problem::Cancelled) => return Err(Problem::Cancelled),
        Err(problem) => failure = Some(problem.in_file(library.as_ref()).to_string()),
    }
    let definitions = parser.finish(&is_wanted);
    let skipped = parser.skipped.into_iter().map(|(keyword, tally)| {
        let Tally { count, first_line } = tally;
        format!(
            "material library “{}”: {count} “{keyword}” statement(s) skipped, line {first_line} first",
            shortened(library)
        )
    });
    let warnings = skipped.chain(failure).map(Warning::of_file).collect();
    Ok((definitions, warnings))
}

/// The materials so far.
#[derive(Default)]
struct Parser {
    found: Vec<Definition>,
    names: HashSet<String>,
    current: Option<Definition>,
    skipped: BTreeMap<String, Tally>,
}

impl Parser {
    fn take(&mut self, statement: Statement<'_>, is_wanted: impl Fn(&str) -> bool) {
        let text = name(statement.bytes);
        let (keyword, rest) = text.split_once([' ', '\t']).unwrap_or((&text, ""));
        if keyword.is_empty() || keyword.starts_with('#') || SILENT.contains(&keyword) {
            return;
        }
        if keyword == "newmtl" {
            self.end_material(is_wanted);
            self.current = Some(Definition {
                material: Material::named(rest.trim()),
                line: statement.line,
                ..Definition::default()
            });
            return;
        }
        let rest = name(without_comment(rest.as_bytes()));
        let current = self.current.as_mut();
        let Some(skipped) = current.and_then(|material| material.read(keyword, &rest)) else {
            count_by_keyword(&mut self.skipped, &shortened(keyword), statement.line);
            return;
        };
        for option in skipped {
            let option = format!("{keyword} {option}");
            count_by_keyword(&mut self.skipped, &option, statement.line);
        }
    }

    fn end_material(&mut self, is_wanted: impl Fn(&str) -> bool) {
        let Some(ended) = self.current.take() else {
            return;
        };
        let name = &ended.material.name;
        if !is_wanted(name) {
            return;
        }
        if self.names.insert(name.clone()) {
            self.found.push(ended);
        } else {
            count_by_keyword(&mut self.skipped, "newmtl", ended.line);
        }
    }

    fn finish(&mut self, is_wanted: impl Fn(&str) -> bool) -> Vec<Definition> {
        self.end_material(is_wanted);
        std::mem::take(&mut self.found)
    }
}

impl Definition {
    /// Reads a statement, and gives the options that were skipped; `None` if it can't be read or isn't known.
    fn read(&mut self, keyword: &str, rest: &str) -> Option<Vec<String>> {
        let material = &mut self.material;
        match keyword {
            "Kd" => material.diffuse = Some(colour(rest)?),
            "Ks" => material.specular = colour(rest)?,
            "Ke" => material.emission = light(rest)?,
            "Ns" => material.shininess = number(rest).filter(|x| *x >= 0.0)?,
            "d" => {
                // With -halo, the given opacity is the one in the middle.
                let value = rest.strip_prefix("-halo").unwrap_or(rest);
                material.opacity = part(value)?;
                self.has_opacity = true;
            }
            "Tr" => {
                let opacity = 1.0 - part(rest)?;
                if !self.has_opacity {
                    material.opacity = opacity;
                }
            }
            "illum" => {
                material.illumination = match rest.parse().ok()? {
                    0u8 => Illumination::Constant,
                    1 => Illumination::Diffuse,
                    2..=10 => Illumination::Highlights,
                    _ => return None,
                };
            }
            "map_Kd" | "map_kd" => {
                let (map, skipped) = map_file(rest)?;
                self.diffuse_map = Some(map);
                return Some(skipped);
            }
            _ => return None,
        }
        Some(Vec::new())
    }
}

/// Three numbers, or one for all three channels, of no channel less than 0.
fn light(rest: &str) -> Option<Vec3> {
    let numbers: Option<Vec<f32>> = rest.split_whitespace().map(number).collect();
    let light = match numbers?[..] {
        [grey] => Vec3::splat(grey),
        [r, g, b] => Vec3::new(r, g, b),
        _ => return None,
    };
    light.cmpge(Vec3::ZERO).all().then_some(light)
}

/// A reflectance: from 0 to 1 in each channel.
fn colour(rest: &str) -> Option<Vec3> {
    light(rest).filter(|colour| colour.cmple(Vec3::ONE).all())
}

/// A number from 0 to 1.
fn part(word: &str) -> Option<f32> {
    number(word).filter(|x| (0.0..=1.0).contains(x))
}

/// A finite number.
fn number(word: &str) -> Option<f32> {
    let number: f32 = word.trim().parse().ok()?;
    number.is_finite().then_some(number)
}

/// `-option value… name with spaces`, and the options that shading has no use for.
fn map_file(rest: &str) -> Option<(MapFile, Vec<String>)> {
    let mut map = MapFile {
        name: String::new(),
        scale: Vec2::ONE,
        offset: Vec2::ZERO,
    };
    let mut skipped = Vec::new();
    let mut rest = rest.trim();
    while rest.starts_with('-') {
        let (option, mut after) = word(rest);
        let least_most = match option {
            "-s" | "-o" | "-t" => (1, 3),
            "-mm" => (2, 2),
            "-blendu" | "-blendv" | "-cc" | "-clamp" | "-boost" | "-bm" | "-texres"
            | "-imfchan" | "-type" => (1, 1),
            // A name may begin with a dash.
            _ => break,
        };
        let mut values = Vec::new();
        for k in 0..least_most.1 {
            let (value, next) = word(after);
            let is_number = number(value).is_some();
            if k >= least_most.0 && !is_number {
                break;
            }
            values.push(number(value).unwrap_or(0.0));
            after = next;
        }
        let pair = Vec2::new(values[0], values.get(1).copied().unwrap_or(values[0]));
        match option {
            "-s" => map.scale = pair,
            "-o" => map.offset = Vec2::new(values[0], values.get(1).copied().unwrap_or(0.0)),
            _ => skipped.push(option.to_owned()),
        }
        rest = after;
    }
    map.name = rest.trim_matches('"').replace('\\', "/");
    (!map.name.is_empty()).then_some((map, skipped))
}

/// The first word, and what follows it.
fn word(text: &str) -> (&str, &str) {
    let text = text.trim_start();
    let (word, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    (word, rest.trim_start())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn messages(text: &str) -> (Vec<Definition>, Vec<String>) {
        let parsed = parse(text.as_bytes(), "m.mtl", |_| true, &Progress::default());
        let (materials, warnings) = parsed.expect("nobody cancels");
        let warnings = warnings.iter().map(ToString::to_string);
        (materials, warnings.collect())
    }

    #[test]
    fn odd_statements_do_not_cost_the_other_materials() {
        let (materials, warnings) = messages(
            "newmtl a #1\rKd 0.5 # grey\r\nKd spectral f.rfl\nillum 999\nmap_Kd\nnewmtl c\nKd 1 0 0\nKd\nnewmtl d\nKd nan 0 0\nPr 1\n",
        );
        let named: Vec<&str> = materials.iter().map(|m| m.material.name.as_str()).collect();
        assert_eq!(named, ["a #1", "c", "d"]);
        let diffuse: Vec<_> = materials.iter().map(|m| m.material.diffuse).collect();
        assert_eq!(diffuse, [Some(Vec3::splat(0.5)), Some(Vec3::X), None]);
        let skipped = |n: u32, keyword: &str, line: u32| {
            format!(
                "material library “m.mtl”: {n} “{keyword}” statement(s) skipped, line {line} first"
            )
        };
        assert_eq!(
            warnings,
            [
                skipped(3, "Kd", 3),
                skipped(1, "Pr", 11),
                skipped(1, "illum", 4),
                skipped(1, "map_Kd", 5)
            ]
        );
    }

    #[test]
    fn everything_that_shading_uses_is_read() {
        let (materials, warnings) = messages(
            "newmtl glass\nKs .1 .2 .3\nKe 2 0 0\nNs 50\nillum 1\nTr 0.75\nnewmtl b\nd -halo 0.5\nTr 1\nKa 1 1 1\nNi 1.5\n",
        );
        assert_eq!(warnings, [""; 0]);
        let expected = Material {
            specular: Vec3::new(0.1, 0.2, 0.3),
            emission: Vec3::new(2.0, 0.0, 0.0),
            shininess: 50.0,
            illumination: Illumination::Diffuse,
            opacity: 0.25,
            ..Material::named("glass")
        };
        assert_eq!(materials[0].material, expected);
        assert_eq!(materials[1].material.opacity, 0.5);
    }

    #[test]
    fn a_map_has_options_before_its_name() {
        let map = |name: &str, scale, offset| Some((name.to_owned(), scale, offset));
        let (one, zero) = (Vec2::ONE, Vec2::ZERO);
        for (text, expected) in [
            ("wood.png", map("wood.png", one, zero)),
            ("maps\\old wood.png", map("maps/old wood.png", one, zero)),
            (
                "-s 2 3 1 a b.png",
                map("a b.png", Vec2::new(2.0, 3.0), zero),
            ),
            ("-s 2 a.png", map("a.png", Vec2::splat(2.0), zero)),
            (
                "-o 0.5 -bm 1 -clamp on -mm 0 1 a.png",
                map("a.png", one, Vec2::new(0.5, 0.0)),
            ),
            ("-odd-name.png", map("-odd-name.png", one, zero)),
            ("-s 2 3", None),
        ] {
            let found = map_file(text).map(|(map, _)| (map.name, map.scale, map.offset));
            assert_eq!(found, expected, "{text}");
        }
    }
}
