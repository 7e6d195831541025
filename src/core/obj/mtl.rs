//! Reads material libraries.
//!
//! A statement that is malformed or unknown is skipped, with a warning; the rest of the library is read.
//!
//! Source: Alias|Wavefront, "MTL material format", Appendix B1 of the Advanced Visualizer Manual, 1995.

use super::Warning;
use super::chunks::each_statement;
use super::error::Problem;
use super::statement::Statement;
use super::tally::{Tally, count_by_keyword, shortened};
use super::words::{name, without_comment};
use crate::counts::counted;
use crate::mesh::{Illumination, Material};
use crate::progress::Progress;
use glam::{Vec2, Vec3};
use std::collections::{BTreeMap, HashSet};
use std::ops::ControlFlow;

/// A material and its texture file.
#[derive(Clone, Debug, Default)]
pub(super) struct Definition {
    pub material: Material,
    pub diffuse_map: Option<MapFile>,
    line: usize,
    /// Whether a `d` was read, which overrides `Tr`.
    has_opacity: bool,
    /// Whether a value above 1 was clamped.
    is_clamped: bool,
}

impl Definition {
    /// Whether only a `Tr 1` makes the material invisible. Some programs write it for opaque materials.
    pub(super) fn is_invisible_by_transparency(&self) -> bool {
        self.material.opacity == 0.0 && !self.has_opacity
    }
}

/// A `map_Kd`: a file's name, and its placement on the surface.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct MapFile {
    pub name: String,
    pub scale: Vec2,
    pub offset: Vec2,
}

/// Statements that programs write for every material and that shading doesn't use. Warnings about them would
/// hide others.
const SILENT: [&str; 3] = ["ka", "ni", "sharpness"];

/// Statements between two cancellation checks.
const STATEMENTS_PER_CHECK: usize = 1 << 12;
/// Largest library in bytes, decompressed: four times the largest file that is read at all.
const LARGEST: usize = 1 << 30;

/// Keywords of the format and its common extensions, in lower case. Warnings quote only these: any file can
/// be named as a library, and its content must not be shown.
const KEYWORDS: [&str; 45] = [
    "ka",
    "kd",
    "ks",
    "ke",
    "km",
    "tf",
    "tr",
    "d",
    "ns",
    "ni",
    "illum",
    "sharpness",
    "map_ka",
    "map_kd",
    "map_ks",
    "map_ke",
    "map_ns",
    "map_ni",
    "map_d",
    "map_tr",
    "map_bump",
    "map_disp",
    "map_refl",
    "map_norm",
    "map_aat",
    "bump",
    "disp",
    "decal",
    "refl",
    "norm",
    "pr",
    "pm",
    "ps",
    "pc",
    "pcr",
    "aniso",
    "anisor",
    "map_pr",
    "map_pm",
    "map_ps",
    "map_pc",
    "map_pcr",
    "map_ao",
    "newmtl",
    "map_opacity",
];

/// A library's materials and the warnings about it.
pub(super) struct MaterialLibrary {
    /// The wanted materials, each by its first definition.
    pub definitions: Vec<Definition>,
    pub warnings: Vec<Warning>,
}

/// Reads the wanted materials of a library; `None` if the file isn't a library.
///
/// # Errors
/// Cancelled by `progress`.
pub(super) fn parse(
    bytes: &[u8],
    library: &str,
    is_wanted: impl Fn(&str) -> bool,
    progress: &Progress,
) -> Result<Option<MaterialLibrary>, Problem> {
    let mut parser = Parser::default();
    let failure = match parser.read_all(bytes, is_wanted, progress) {
        Ok(()) => None,
        Err(Problem::Cancelled) => return Err(Problem::Cancelled),
        Err(problem) => Some(problem.in_file(library.as_ref()).to_string()),
    };
    // A library without materials contains at most comments.
    if parser.material_count == 0 && (parser.statement_count > 0 || failure.is_some()) {
        return Ok(None);
    }
    let about = format!("material library “{}”", shortened(library));
    let skipped = parser.skipped.into_iter().map(|(keyword, tally)| {
        let Tally { count, first_line } = tally;
        let statements = counted(count, &format!("“{keyword}” statement"));
        format!("{about}: {statements} skipped, the first on line {first_line}")
    });
    let unknown = (parser.unknown.count > 0).then(|| {
        let Tally { count, first_line } = parser.unknown;
        let statements = counted(count, "unknown statement");
        format!("{about}: {statements} skipped, the first on line {first_line}")
    });
    let clamped = parser.clamped.into_iter().map(|(keyword, tally)| {
        let Tally { count, first_line } = tally;
        let statements = counted(count, &format!("“{keyword}” statement"));
        format!(
            "{about}: {statements} with a value above 1, clamped; the first on line {first_line}"
        )
    });
    let warnings = skipped.chain(clamped).chain(unknown);
    let mut warnings: Vec<String> = warnings.chain(failure).collect();
    if parser.material_count > 0 && parser.transparent_count == parser.material_count {
        for definition in &mut parser.found {
            definition.material.opacity = 1.0;
        }
        warnings.push(format!(
            "{about}: every material has “Tr 1” and no “d”; taken as opaque"
        ));
    }
    for definition in &mut parser.found {
        let material = &mut definition.material;
        if material.diffuse == Some(Vec3::ZERO) && definition.diffuse_map.is_some() {
            material.diffuse = Some(Vec3::ONE);
            let name = shortened(&material.name);
            warnings.push(format!(
                "{about}: material “{name}”: “Kd 0” would hide its texture; taken as 1"
            ));
        }
    }
    Ok(Some(MaterialLibrary {
        definitions: parser.found,
        warnings: warnings.into_iter().map(Warning::of_file).collect(),
    }))
}

/// State of parsing a library.
#[derive(Default)]
struct Parser {
    found: Vec<Definition>,
    names: HashSet<String>,
    current: Option<Definition>,
    /// Number of statements, not counting comments.
    statement_count: usize,
    material_count: usize,
    /// Skipped statements by keyword.
    skipped: BTreeMap<String, Tally>,
    /// Statements with values above 1, which were clamped.
    clamped: BTreeMap<String, Tally>,
    /// Skipped statements whose keyword isn't in [`KEYWORDS`].
    unknown: Tally,
    /// Number of materials that only a `Tr 1` makes invisible.
    transparent_count: usize,
}

impl Parser {
    fn read_all(
        &mut self,
        bytes: &[u8],
        is_wanted: impl Fn(&str) -> bool,
        progress: &Progress,
    ) -> Result<(), Problem> {
        // A library's bytes don't count as progress.
        let own = Progress::default();
        let (mut count, mut length) = (0, 0);
        each_statement(bytes, &own, |statement| {
            if count % STATEMENTS_PER_CHECK == 0 {
                progress.check()?;
            }
            count += 1;
            length += statement.bytes.len() + 1;
            if length > LARGEST {
                return Err(
                    statement.problem(format!("the library is larger than {} MB", LARGEST >> 20))
                );
            }
            self.take(statement, &is_wanted);
            Ok(ControlFlow::Continue(()))
        })?;
        self.end_material(is_wanted);
        Ok(())
    }

    fn take(&mut self, statement: Statement<'_>, is_wanted: impl Fn(&str) -> bool) {
        let text = name(statement.bytes);
        let (keyword, rest) = text.split_once([' ', '\t']).unwrap_or((&text, ""));
        if keyword.is_empty() || keyword.starts_with('#') {
            return;
        }
        self.statement_count += 1;
        // Keywords have one meaning in any case.
        let lower_case = keyword.to_ascii_lowercase();
        if SILENT.contains(&lower_case.as_str()) {
            return;
        }
        if lower_case == "newmtl" {
            self.end_material(is_wanted);
            self.material_count += 1;
            self.current = Some(Definition {
                material: Material::named(rest.trim()),
                line: statement.line,
                ..Definition::default()
            });
            return;
        }
        // The name of a file may contain a #.
        let rest = match lower_case.as_str() {
            "map_kd" => rest.trim().to_owned(),
            _ => name(without_comment(rest.as_bytes())),
        };
        let current = self.current.as_mut();
        let Some(skipped) = current.and_then(|material| material.read(&lower_case, &rest)) else {
            if KEYWORDS.contains(&lower_case.as_str()) {
                count_by_keyword(&mut self.skipped, keyword, statement.line);
            } else {
                self.unknown.add(statement.line);
            }
            return;
        };
        if let Some(material) = &mut self.current
            && std::mem::take(&mut material.is_clamped)
        {
            count_by_keyword(&mut self.clamped, keyword, statement.line);
        }
        for option in skipped {
            let option = format!("{keyword} {option}");
            count_by_keyword(&mut self.skipped, &option, statement.line);
        }
    }

    fn end_material(&mut self, is_wanted: impl Fn(&str) -> bool) {
        let Some(ended) = self.current.take() else {
            return;
        };
        self.transparent_count += usize::from(ended.is_invisible_by_transparency());
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
}

impl Definition {
    /// Reads a statement and returns the skipped options; `None` if it is malformed or unknown.
    fn read(&mut self, keyword: &str, rest: &str) -> Option<Vec<String>> {
        let material = &mut self.material;
        match keyword {
            "kd" => material.diffuse = Some(clamped(light(rest)?, &mut self.is_clamped)),
            "ks" => material.specular = clamped(light(rest)?, &mut self.is_clamped),
            "ke" => material.emission = light(rest)?,
            "ns" => material.shininess = number(rest).filter(|x| *x >= 0.0)?,
            "d" => {
                // With -halo, the value is the opacity at the centre.
                let value = rest.strip_prefix("-halo").unwrap_or(rest);
                let opacity = number(value).filter(|x| *x >= 0.0)?;
                self.is_clamped = opacity > 1.0;
                material.opacity = opacity.min(1.0);
                self.has_opacity = true;
            }
            "tr" => {
                let transparency = number(rest).filter(|x| *x >= 0.0)?;
                self.is_clamped = transparency > 1.0;
                let opacity = 1.0 - transparency.min(1.0);
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
            "map_kd" => {
                let (map, skipped) = map_file(rest)?;
                self.diffuse_map = Some(map);
                return Some(skipped);
            }
            _ => return None,
        }
        Some(Vec::new())
    }
}

/// Three numbers, or one for all three channels; none may be negative.
fn light(rest: &str) -> Option<Vec3> {
    let numbers: Option<Vec<f32>> = rest.split_whitespace().map(number).collect();
    let light = match numbers?[..] {
        [grey] => Vec3::splat(grey),
        [r, g, b] => Vec3::new(r, g, b),
        _ => return None,
    };
    light.cmpge(Vec3::ZERO).all().then_some(light)
}

/// A reflectance, at most 1 in each channel.
fn clamped(colour: Vec3, is_clamped: &mut bool) -> Vec3 {
    *is_clamped = colour.cmpgt(Vec3::ONE).any();
    colour.min(Vec3::ONE)
}

/// A finite number.
fn number(word: &str) -> Option<f32> {
    let number: f32 = word.trim().parse().ok()?;
    number.is_finite().then_some(number)
}

/// Parses `-option value… name with spaces`; also returns the options that shading doesn't use.
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
            // A name may start with a dash.
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

/// The first word, and the rest.
fn word(text: &str) -> (&str, &str) {
    let text = text.trim_start();
    let (word, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    (word, rest.trim_start())
}

#[cfg(test)]
mod tests;
