//! Textures that tilt the shading normal: normal maps and bump maps.
//!
//! ```text
//!            n   n′            t is along the first texture coordinate, across n;
//!            |  /              b is across both.
//!            | /
//!   ─────────┼──────→ t        normal map: n′ ∝ x t + y b + z n
//!          surface             bump map:   n′ ∝ n − ∇h
//! ```
//!
//! Sources: Blinn, "Simulation of Wrinkled Surfaces", SIGGRAPH 1978, for bump maps; Cohen, Olano, Manocha,
//! "Appearance-Preserving Simplification", SIGGRAPH 1998, for normal maps; normals that face away from the viewer are
//! mirrored as in Mitsuba's `normalmap`, after Schüßler et al., "Microfacet-Based Normal Mapping for Robust Monte Carlo Path
//! Tracing", SIGGRAPH Asia 2017.

use super::{Texture, TextureFrame, TextureMap};
use crate::srgb::luminance;
use glam::{DMat2, DVec2, DVec3, Vec2, Vec3};

/// A texture that tilts the shading normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relief {
    /// The texture.
    pub map: TextureMap,
    /// The meaning of its values.
    pub kind: ReliefKind,
}

/// The meaning of a relief's values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ReliefKind {
    /// Normals: 0…1 stands for −1…1 along the tangent, the bitangent and the normal.
    Normals {
        /// Multiplies the parts along tangent and bitangent.
        strength: f32,
        /// The direction of the bitangent.
        bitangent: Bitangent,
    },
    /// Heights: the brightness.
    Heights {
        /// Multiplies the height.
        scale: f32,
        /// The unit of the product.
        unit: HeightUnit,
    },
}

/// The direction of the bitangent of a normal map; both agree unless texture coordinates are mirrored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bitangent {
    /// The side to which the second texture coordinate grows.
    AlongTexture,
    /// Normal × tangent, as in Mitsuba; the tangent is along the first coordinate before the map's transform.
    RightHanded,
}

/// The unit of heights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HeightUnit {
    /// The width of a texel on the surface, so that the relief doesn't depend on the size of the scene.
    Texel,
    /// The scene's unit, as in Mitsuba.
    Scene,
}

/// A tilt of a unit normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tilt {
    /// What is added, across the normal.
    across: DVec3,
    /// The factor of the normal; not negative.
    along: f64,
}

impl Tilt {
    /// The tilted unit normal of the side with the given one; `to_eye` is the direction to the viewer. Both sides tilt to
    /// the same direction. A normal that would face away from a viewer in front of the surface tilts to the other side;
    /// one without direction stays.
    pub fn applied_to(&self, normal: Vec3, to_eye: Vec3) -> Vec3 {
        let (side, eye) = (normal.as_dvec3(), to_eye.as_dvec3());
        let along = self.along * side;
        let tilted = self.across + along;
        let faces_away = tilted.dot(eye) * side.dot(eye) <= 0.0;
        let facing = if faces_away {
            along - self.across
        } else {
            tilted
        };
        facing.try_normalize().map_or(normal, DVec3::as_vec3)
    }
}

impl Relief {
    /// The tilt of a unit normal, the front's; `None` if texture coordinates or numbers are degenerate, or `textures`
    /// lacks the texture.
    pub fn tilt(&self, normal: Vec3, frame: &TextureFrame, textures: &[Texture]) -> Option<Tilt> {
        let texture = textures.get(self.map.texture as usize)?;
        let normal = normal.as_dvec3();
        let placed = Placed::new(&self.map, normal, frame)?;
        let tilt = match self.kind {
            ReliefKind::Normals {
                strength,
                bitangent,
            } => {
                let value = texture.value(placed.at, self.map.sampling);
                let Vec3 { x, y, z } = 2.0 * value - 1.0;
                let [t, b] = placed.tangents(normal, frame, bitangent)?;
                let (x, y) = (f64::from(strength * x), f64::from(strength * y));
                Tilt {
                    across: x * t + y * b,
                    along: f64::from(z).max(0.0),
                }
            }
            ReliefKind::Heights { scale, unit } => {
                let slopes = slopes(texture, &self.map, placed.at, unit);
                let unit = match unit {
                    HeightUnit::Texel => placed.texel_width(texture),
                    HeightUnit::Scene => 1.0,
                };
                let gradient = placed.gradient(normal, f64::from(scale) * unit * slopes);
                Tilt {
                    across: -gradient,
                    along: 1.0,
                }
            }
        };
        (tilt.across.is_finite() && tilt.along.is_finite()).then_some(tilt)
    }
}

/// A map at a point.
struct Placed {
    /// The texture's coordinates.
    at: Vec2,
    /// The derivatives of the point by them, across the normal.
    axes: [DVec3; 2],
    /// The area of the parallelogram of both; negative if the texture is mirrored.
    area: f64,
}

impl Placed {
    /// `None` if the area is 0.
    fn new(map: &TextureMap, normal: DVec3, frame: &TextureFrame) -> Option<Self> {
        let to_texture = map.transform.matrix2.as_dmat2();
        if to_texture.determinant() == 0.0 {
            return None;
        }
        let DMat2 { x_axis, y_axis } = to_texture.inverse();
        let [u, v] = frame.axes;
        let axes = [x_axis, y_axis].map(|axis| across(normal, axis.x * u + axis.y * v));
        let area = normal.dot(axes[0].cross(axes[1]));
        (area != 0.0 && area.is_finite()).then_some(Self {
            at: map.transform.transform_point2(frame.uv),
            axes,
            area,
        })
    }

    /// The unit tangent and bitangent.
    fn tangents(
        &self,
        normal: DVec3,
        frame: &TextureFrame,
        bitangent: Bitangent,
    ) -> Option<[DVec3; 2]> {
        match bitangent {
            Bitangent::AlongTexture => {
                let t = self.axes[0].try_normalize()?;
                Some([t, self.area.signum() * normal.cross(t)])
            }
            Bitangent::RightHanded => {
                let t = across(normal, frame.axes[0]).try_normalize()?;
                Some([t, normal.cross(t)])
            }
        }
    }

    /// The side of a square as large as a texel on the surface.
    fn texel_width(&self, texture: &Texture) -> f64 {
        let size = texture.size().as_dvec2();
        (self.area.abs() / (size.x * size.y)).sqrt()
    }

    /// The gradient on the surface of a function with these derivatives by the texture's coordinates.
    fn gradient(&self, normal: DVec3, derivatives: DVec2) -> DVec3 {
        let [u, v] = self.axes;
        (derivatives.x * v.cross(normal) + derivatives.y * normal.cross(u)) / self.area
    }
}

/// The derivatives of a texture's brightness by its coordinates: differences over one texel.
fn slopes(texture: &Texture, map: &TextureMap, at: Vec2, unit: HeightUnit) -> DVec2 {
    let size = texture.size().as_vec2();
    let height = |at: Vec2| f64::from(luminance(texture.value(at, map.sampling)));
    let start = match unit {
        // Central differences, which change gradually.
        HeightUnit::Texel => at - 0.5 / size,
        // From texel centre to texel centre: the derivatives of the bilinear interpolation, as Mitsuba has them.
        HeightUnit::Scene => ((at * size - 0.5).floor() + 0.5) / size,
    };
    let slope = |axis: Vec2| {
        let from = at + axis * (start - at);
        (height(from + axis / size) - height(from)) * f64::from(axis.dot(size))
    };
    DVec2::new(slope(Vec2::X), slope(Vec2::Y))
}

/// The part of a vector across a unit normal.
fn across(normal: DVec3, vector: DVec3) -> DVec3 {
    vector - normal.dot(vector) * normal
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Encoding;
    use glam::{DMat3, UVec2};

    /// A texture with the same value everywhere.
    fn even(texel: [u8; 3]) -> Vec<Texture> {
        Texture::new("t", UVec2::ONE, texel.to_vec())
            .into_iter()
            .collect()
    }

    fn normals(bitangent: Bitangent) -> Relief {
        Relief {
            map: TextureMap::of(0).encoded(Encoding::Linear),
            kind: ReliefKind::Normals {
                strength: 1.0,
                bitangent,
            },
        }
    }

    fn heights(scale: f32, unit: HeightUnit) -> Relief {
        Relief {
            map: TextureMap::of(0).encoded(Encoding::Linear),
            kind: ReliefKind::Heights { scale, unit },
        }
    }

    fn frame(u: DVec3, v: DVec3) -> TextureFrame {
        TextureFrame {
            uv: Vec2::new(0.5, 0.5),
            axes: [u, v],
        }
    }

    /// The normal z, tilted as seen from the same side.
    fn tilted(relief: &Relief, frame: &TextureFrame, textures: &[Texture]) -> Vec3 {
        let tilt = relief.tilt(Vec3::Z, frame, textures).expect("a tilt");
        tilt.applied_to(Vec3::Z, Vec3::Z)
    }

    #[test]
    fn a_flat_normal_map_changes_nothing() {
        let square = frame(DVec3::X, DVec3::Y);
        let normal = tilted(
            &normals(Bitangent::AlongTexture),
            &square,
            &even([128, 128, 255]),
        );
        // 128 stands for 1/255 instead of 0, for each of two axes.
        assert!((normal - Vec3::Z).length() < 1.5 / 255.0, "{normal}");
    }

    #[test]
    fn normals_lean_along_the_texture_also_if_it_is_mirrored_or_turned() {
        let textures = even([255, 191, 191]);
        // 2·191/255 − 1 = 0.498.
        let expected = |t: DVec3, b: DVec3| (t + 0.498 * b + 0.498 * DVec3::Z).normalize();
        let turned = DMat3::from_rotation_z(0.7);
        let (x, y) = (turned * DVec3::X, turned * DVec3::Y);
        for (u, v) in [
            (DVec3::X, DVec3::Y),
            (-DVec3::X, DVec3::Y),
            (1e-20 * x, 1e-20 * y),
            (1e20 * x, -1e20 * y),
        ] {
            let (t, b) = (u.normalize(), v.normalize());
            let leaning = tilted(&normals(Bitangent::AlongTexture), &frame(u, v), &textures);
            // 0.498 has three digits.
            assert!(
                (leaning.as_dvec3() - expected(t, b)).length() < 1e-3,
                "{u} {v}"
            );
            let right = tilted(&normals(Bitangent::RightHanded), &frame(u, v), &textures);
            let b = DVec3::Z.cross(t);
            assert!(
                (right.as_dvec3() - expected(t, b)).length() < 1e-3,
                "{u} {v}"
            );
        }
    }

    #[test]
    fn a_map_that_is_turned_on_the_surface_turns_its_normals() {
        let quarter = glam::Affine2::from_angle(std::f32::consts::FRAC_PI_2);
        let mut relief = normals(Bitangent::AlongTexture);
        relief.map.transform = quarter;
        // Texture coordinate x is −v.
        let normal = tilted(&relief, &frame(DVec3::X, DVec3::Y), &even([255, 128, 128]));
        assert!(normal.y < -0.99, "{normal}");
    }

    #[test]
    fn a_ramp_tilts_the_normal_by_its_slope() {
        // Eight texels, each 10/255 higher than the one to its left.
        let texels: Vec<u8> = (0..8).flat_map(|k| [10 * k; 3]).collect();
        let texture = Texture::new("t", UVec2::new(8, 1), texels).expect("eight texels");
        let textures = [texture];
        // The surface is 2 by 3 units large, and sheared; heights are in units of the scene.
        let sheared = frame(2.0 * DVec3::X, DVec3::new(1.0, 3.0, 0.0));
        let normal = tilted(&heights(5.0, HeightUnit::Scene), &sheared, &textures);
        // 8 texels in 2 units; the height stays the same along the second axis, (1, 3).
        let slope = 5.0 * 8.0 * (10.0 / 255.0) / 2.0;
        let expected = Vec3::new(-slope, slope / 3.0, 1.0).normalize();
        // The texels' values are rounded to f32.
        assert!((normal - expected).length() < 1e-5, "{normal}");

        for size in [1e-15, 1.0, 1e15] {
            // Texels of 1 by 4, as large as squares of side 2.
            let square = frame(8.0 * size * DVec3::X, 4.0 * size * DVec3::Y);
            let normal = tilted(&heights(5.0, HeightUnit::Texel), &square, &textures);
            let slope = 5.0 * 2.0 * (10.0 / 255.0);
            let expected = Vec3::new(-slope, 0.0, 1.0).normalize();
            assert!((normal - expected).length() < 1e-5, "{size}: {normal}");
        }
    }

    #[test]
    fn both_sides_tilt_to_the_same_direction_and_normals_face_the_viewer() {
        let square = frame(DVec3::X, DVec3::Y);
        let tilt = normals(Bitangent::AlongTexture)
            .tilt(Vec3::Z, &square, &even([255, 128, 191]))
            .expect("a tilt");
        let [front, back] = [Vec3::Z, Vec3::NEG_Z].map(|side| tilt.applied_to(side, side));
        assert!(front.x > 0.8 && (front - Vec3::new(back.x, back.y, -back.z)).length() < 1e-6);
        let grazing = Vec3::new(-0.99, 0.0, 0.1).normalize();
        let mirrored = tilt.applied_to(Vec3::Z, grazing);
        assert!(
            mirrored.dot(grazing) > 0.0 && mirrored.x < -0.8,
            "{mirrored}"
        );
    }

    #[test]
    fn degenerate_coordinates_and_values_do_not_tilt() {
        let textures = even([255, 0, 255]);
        for (u, v) in [
            (DVec3::X, DVec3::X),
            (DVec3::ZERO, DVec3::Y),
            (DVec3::NAN, DVec3::Y),
            (DVec3::INFINITY, DVec3::Y),
            (DVec3::Z, DVec3::Y),
        ] {
            for relief in [
                normals(Bitangent::AlongTexture),
                heights(1.0, HeightUnit::Texel),
            ] {
                assert_eq!(relief.tilt(Vec3::Z, &frame(u, v), &textures), None, "{u}");
            }
        }
        let square = frame(DVec3::X, DVec3::Y);
        let relief = normals(Bitangent::RightHanded);
        assert_eq!(relief.tilt(Vec3::Z, &square, &[]), None);
        // Nowhere: all parts are zero or negative.
        let none = Tilt {
            across: DVec3::ZERO,
            along: 0.0,
        };
        assert_eq!(none.applied_to(Vec3::Z, Vec3::Z), Vec3::Z);
        assert!(tilted(&relief, &square, &even([0, 0, 0])).is_normalized());
    }
}
