//! Parser of material libraries.
//!
//! Malformed and unknown statements are skipped with a warning.
//!
//! Source: Alias|Wavefront, "MTL material format", Appendix B1 of the Advanced Visualizer Manual, 1995.

use super::keywords::{IGNORED, KEYWORDS, VALUES, expected_value};
use super::map_file::MapFile;
use super::map_statements::ReliefStatement;
use crate::brightness::MAX_BRIGHTNESS;
use crate::counts::counted;
use crate::mesh::{Illumination, Material, Property};
use crate::obj::chunks::each_statement;
use crate::obj::error::{Problem, Warning};
use crate::obj::statement::Statement;
use crate::obj::tally::{Tally, count_by_keyword, shortened};
use crate::obj::words::{name, without_comment};
use crate::progress::Progress;
use glam::Vec3;
use std::collections::{BTreeMap, HashSet};
use std::ops::ControlFlow;

/// A material as defined in a library, and its texture file.
#[derive(Clone, Debug, Default)]
pub(super) struct Definition {
    pub material: Material,
    pub diffuse_map: Option<MapFile>,
    pub further_maps: Vec<(Property, MapFile)>,
    pub relief: Option<(ReliefStatement, MapFile)>,
    line: usize,
    /// Whether a `d` statement was read. It overrides `Tr`.
    has_opacity: bool,
    /// Whether a value was clamped.
    is_clamped: bool,
}

impl Definition {
    /// Whether only `Tr 1` makes the material invisible. Some programs write `Tr 1` for opaque materials.
    pub(super) fn is_invisible_only_by_tr(&self) -> bool {
        self.material.opacity == 0.0 && !self.has_opacity
    }

    /// Makes a texture visible that a factor of 0 would hide. Returns the warning about it; `about` names the library.
    fn mend_colours(&mut self, about: &str) -> Option<String> {
        let material = &mut self.material;
        let mut further = self.further_maps.iter();
        if material.emission == Vec3::ZERO && further.any(|(of, _)| *of == Property::Emission) {
            // A texture alone says what is emitted.
            material.emission = Vec3::ONE;
        }
        if material.diffuse != Some(Vec3::ZERO) || self.diffuse_map.is_none() {
            return None;
        }
        material.diffuse = Some(Vec3::ONE);
        let name = shortened(&material.name);
        Some(format!(
            "{about}: material “{name}”: “Kd 0” would hide the texture; treated as 1"
        ))
    }
}

/// The number of statements between cancellation checks: a millisecond's work.
const STATEMENTS_PER_CHECK: usize = 1 << 12;
/// The maximum size of a decompressed library: four times the maximum size of a referenced file.
const MAX_BYTES: usize = 1 << 30;

/// The wanted materials of a library, and warnings about it.
pub(super) struct MaterialLibrary {
    /// The first definition of each wanted material.
    pub definitions: Vec<Definition>,
    pub warnings: Vec<Warning>,
}

/// Parses the wanted materials of a library; `None` if the file isn't a library.
///
/// # Errors
/// The load was cancelled.
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
    let skipped = parser.skipped_statements(&about);
    let mut warnings: Vec<String> = skipped.into_iter().chain(failure).collect();
    warnings.extend(parser.mend_opacity(&about));
    let mended = parser.found.iter_mut();
    warnings.extend(mended.filter_map(|definition| definition.mend_colours(&about)));
    Ok(Some(MaterialLibrary {
        definitions: parser.found,
        warnings: warnings.into_iter().map(Warning::of_file).collect(),
    }))
}

/// The state of parsing a library.
#[derive(Default)]
struct Parser {
    found: Vec<Definition>,
    names: HashSet<String>,
    current: Option<Definition>,
    /// The number of statements, without comments.
    statement_count: usize,
    material_count: usize,
    /// Skipped statements by keyword.
    skipped: BTreeMap<String, Tally>,
    /// Skipped statements with an invalid value, by keyword.
    invalid: BTreeMap<String, Tally>,
    /// Statements with a clamped value, by keyword.
    clamped: BTreeMap<String, Tally>,
    /// Skipped statements whose keyword isn't in [`KEYWORDS`].
    unknown: Tally,
    /// The number of materials that only `Tr 1` makes invisible.
    transparent_count: usize,
}

impl Parser {
    /// Warnings about skipped and changed statements, ordered by line; `about` names the library.
    fn skipped_statements(&self, about: &str) -> Vec<String> {
        let describe = |what: &str, tally: Tally, outcome: &str| {
            let statements = counted(tally.count, &format!("{what} statement"));
            let first = if tally.count == 1 { "" } else { "the first " };
            let line = tally.first_line;
            let warning = format!("{about}: {statements} {outcome}, {first}on line {line}");
            (line, warning)
        };
        let quoted = |keyword: &str| format!("“{keyword}”");
        let skipped = self.skipped.iter();
        let skipped = skipped.map(|(keyword, &tally)| describe(&quoted(keyword), tally, "skipped"));
        let clamped = self.clamped.iter().map(|(keyword, &tally)| {
            let most = match keyword.eq_ignore_ascii_case("ke") {
                true => format!("{MAX_BRIGHTNESS:.1e}"),
                false => "1".to_owned(),
            };
            let outcome = format!("with a value above {most} clamped");
            describe(&quoted(keyword), tally, &outcome)
        });
        let invalid = self.invalid.iter().map(|(keyword, &tally)| {
            let outcome = format!("skipped: {}", expected_value(keyword));
            describe(&quoted(keyword), tally, &outcome)
        });
        let unknown =
            (self.unknown.count > 0).then(|| describe("unknown", self.unknown, "skipped"));
        let known = skipped.chain(clamped).chain(invalid);
        let mut by_line: Vec<(usize, String)> = known.chain(unknown).collect();
        by_line.sort_by_key(|(line, _)| *line);
        by_line.into_iter().map(|(_, warning)| warning).collect()
    }

    /// Makes the wanted materials opaque if `Tr 1` makes every material of the library invisible. Returns the warning
    /// about it; `about` names the library.
    fn mend_opacity(&mut self, about: &str) -> Option<String> {
        if self.material_count == 0 || self.transparent_count != self.material_count {
            return None;
        }
        for definition in &mut self.found {
            definition.material.opacity = 1.0;
        }
        Some(format!(
            "{about}: every material has “Tr 1” and no “d”; treated as opaque"
        ))
    }

    fn read_all(
        &mut self,
        bytes: &[u8],
        is_wanted: impl Fn(&str) -> bool,
        progress: &Progress,
    ) -> Result<(), Problem> {
        // Don't count a library's bytes as progress.
        let uncounted = Progress::default();
        let (mut count, mut length) = (0, 0);
        each_statement(bytes, &uncounted, |statement| {
            if count % STATEMENTS_PER_CHECK == 0 {
                progress.check()?;
            }
            count += 1;
            length += statement.bytes.len() + 1;
            if length > MAX_BYTES {
                return Err(
                    statement.problem(format!("the library is larger than {} MB", MAX_BYTES >> 20))
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
        // Keywords are case-insensitive.
        let lower_case = keyword.to_ascii_lowercase();
        if IGNORED.contains(&lower_case.as_str()) {
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
        // A file name may contain a #.
        let rest = match lower_case.as_str() {
            "map_kd" | "map_ks" | "map_ke" | "map_d" | "map_opacity" | "map_pr" | "map_pm"
            | "norm" | "map_norm" | "bump" | "map_bump" => rest.trim().to_owned(),
            _ => name(without_comment(rest.as_bytes())),
        };
        let current = self.current.as_mut();
        let Some(skipped) = current.and_then(|material| material.apply(&lower_case, &rest)) else {
            if VALUES.contains(&lower_case.as_str()) && self.current.is_some() {
                count_by_keyword(&mut self.invalid, keyword, statement.line);
            } else if KEYWORDS.contains(&lower_case.as_str()) {
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
        self.transparent_count += usize::from(ended.is_invisible_only_by_tr());
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
    /// Applies a statement. Returns its skipped options, or `None` if the statement is malformed or unknown.
    fn apply(&mut self, keyword: &str, rest: &str) -> Option<Vec<String>> {
        let material = &mut self.material;
        match keyword {
            "kd" => material.diffuse = Some(clamped(colour(rest)?, 1.0, &mut self.is_clamped)),
            "ks" => material.specular = clamped(colour(rest)?, 1.0, &mut self.is_clamped),
            "ke" => {
                let radiance = colour(rest)?;
                material.emission = clamped(radiance, MAX_BRIGHTNESS, &mut self.is_clamped);
            }
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
                    3 => Illumination::Mirror,
                    4 | 6 | 7 | 9 => Illumination::Glass,
                    5 => Illumination::FresnelMirror,
                    2 | 8 | 10 => Illumination::Highlights,
                    _ => return None,
                };
            }
            // Some programs write 0 for all materials.
            "ni" => material.refraction = number(rest).filter(|x| *x > 0.0).unwrap_or(1.0),
            "tf" => material.filter = Some(clamped(colour(rest)?, 1.0, &mut self.is_clamped)),
            "pr" => material.roughness = Some(number(rest).filter(|x| *x >= 0.0)?.min(1.0)),
            "pm" => material.metalness = Some(number(rest).filter(|x| *x >= 0.0)?.min(1.0)),
            _ => return self.apply_map(keyword, rest),
        }
        Some(Vec::new())
    }
}

/// Parses a colour: three non-negative numbers, or one for all channels.
fn colour(rest: &str) -> Option<Vec3> {
    let numbers: Option<Vec<f32>> = rest.split_whitespace().map(number).collect();
    let colour = match numbers?[..] {
        [grey] => Vec3::splat(grey),
        [r, g, b] => Vec3::new(r, g, b),
        _ => return None,
    };
    colour.cmpge(Vec3::ZERO).all().then_some(colour)
}

/// A colour clamped per channel; sets `is_clamped`.
fn clamped(colour: Vec3, most: f32, is_clamped: &mut bool) -> Vec3 {
    *is_clamped = colour.cmpgt(Vec3::splat(most)).any();
    colour.min(Vec3::splat(most))
}

/// Parses a finite number.
pub(super) fn number(word: &str) -> Option<f32> {
    let number: f32 = word.trim().parse().ok()?;
    number.is_finite().then_some(number)
}

#[cfg(test)]
mod tests;
