//! Statements of material libraries that name a picture.

use super::map_file;
use super::mtl::Definition;
use crate::mesh::Property;

/// The statement that names a relief.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ReliefStatement {
    /// `norm`: a normal map.
    Normals,
    /// `bump` or `map_Bump`: heights. Some programs also write normal maps so.
    Bump,
}

impl Definition {
    /// Applies a statement with a texture. Returns its skipped options, or `None` if the statement is malformed or
    /// unknown.
    pub(super) fn apply_map(&mut self, keyword: &str, rest: &str) -> Option<Vec<String>> {
        let relief = match keyword {
            "norm" | "map_norm" => Some(ReliefStatement::Normals),
            "bump" | "map_bump" => Some(ReliefStatement::Bump),
            _ => None,
        };
        if let Some(statement) = relief {
            let (map, skipped) = map_file::parse(rest)?;
            // A normal map says more than heights do.
            let has_normals = matches!(self.relief, Some((ReliefStatement::Normals, _)));
            if statement == ReliefStatement::Normals || !has_normals {
                self.relief = Some((statement, map));
            }
            return Some(skipped.into_iter().map(str::to_owned).collect());
        }
        let property = match keyword {
            "map_kd" => None,
            "map_ks" => Some(Property::Specular),
            "map_ke" => Some(Property::Emission),
            "map_d" | "map_opacity" => Some(Property::Opacity),
            "map_pr" => Some(Property::Roughness),
            "map_pm" => Some(Property::Metalness),
            _ => return None,
        };
        let (map, mut skipped) = map_file::parse(rest)?;
        if map.has_multiplier {
            skipped.push("-bm");
        }
        match property {
            None => self.diffuse_map = Some(map),
            Some(property) => {
                self.further_maps.retain(|(other, _)| *other != property);
                self.further_maps.push((property, map));
            }
        }
        Some(skipped.into_iter().map(str::to_owned).collect())
    }
}
