//! Materials from a library: their names and diffuse colours, which is all that shading asks for.

use super::reader::statement_of;
use crate::mesh::Material;
use glam::Vec3;

/// Reads the materials of an MTL file.
///
/// tobj sees only `newmtl` and a `Kd` of three numbers: it panics on the legal `Kd 0.5` and drops
/// the whole library for statements that it doesn't know. A colour that can't be read is left out.
pub(super) fn parse(bytes: &[u8]) -> Vec<Material> {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    let mut plain = String::new();
    for line in bytes.split(|b| matches!(b, b'\n' | b'\r')) {
        let statement = statement_of(line);
        let (keyword, rest) = statement
            .split_once(char::is_whitespace)
            .unwrap_or_default();
        let rest = rest.trim();
        match keyword {
            "newmtl" if !rest.is_empty() => plain += &format!("newmtl {rest}\n"),
            "Kd" => {
                if let Some([r, g, b]) = colour(rest) {
                    plain += &format!("Kd {r} {g} {b}\n");
                }
            }
            _ => {}
        }
    }
    let (materials, _) = tobj::load_mtl_buf(&mut plain.as_bytes()).unwrap_or_default();
    let material = |m: tobj::Material| Material {
        name: m.name,
        diffuse: m.diffuse.map(|c| Vec3::from_array(c.map(|x| x as f32))),
    };
    materials.into_iter().map(material).collect()
}

/// Three numbers, or one for all three channels.
fn colour(rest: &str) -> Option<[f64; 3]> {
    let numbers: Result<Vec<f64>, _> = rest.split_whitespace().map(str::parse).collect();
    let colour = match numbers.ok()?[..] {
        [grey] => [grey; 3],
        [r, g, b] => [r, g, b],
        _ => return None,
    };
    colour
        .iter()
        .all(|x| (0.0..=1.0).contains(x))
        .then_some(colour)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn odd_statements_do_not_cost_the_other_materials() {
        let text = "newmtl a #1\rKd 0.5 # grey\r\nKd spectral f.rfl\nillum 999\nmap_Kd\nnewmtl c\nKd 1 0 0\nKd\nnewmtl d\nKd nan 0 0\n";
        let materials = parse(text.as_bytes());
        let names: Vec<&str> = materials.iter().map(|m| m.name.as_str()).collect();
        assert_eq!(names, ["a #1", "c", "d"]);
        assert_eq!(materials[0].diffuse, Some(Vec3::splat(0.5)));
        assert_eq!(materials[1].diffuse, Some(Vec3::X));
        assert_eq!(materials[2].diffuse, None);
    }
}
