//! Shapes in the coordinates of the world, in f64, and their f32 counterparts.

use crate::scene_file::{Quadric as QuadricDescription, ShapeKind};
use crate::shape::{Cone, Cuboid, Cylinder, Disk, Plane, Quadric, Rectangle, Span, Sphere, Torus};
use glam::{DMat3, DMat4, DVec3, Vec3};

/// Deviation from a right angle or from equal lengths, relatively, that counts as rounding of a matrix's entries: some
/// compositions of rotations in f64.
const ROUNDING: f64 = 1e-12;

/// A shape of the core in f64.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Placed {
    Sphere {
        centre: DVec3,
        radius: f64,
    },
    Plane {
        point: DVec3,
        normal: DVec3,
    },
    Disk {
        centre: DVec3,
        axes: [DVec3; 2],
    },
    Rectangle {
        centre: DVec3,
        axes: [DVec3; 2],
    },
    Cuboid {
        centre: DVec3,
        axes: [DVec3; 3],
    },
    Cylinder {
        ends: [DVec3; 2],
        radius: f64,
        is_capped: bool,
    },
    Cone {
        ends: [DVec3; 2],
        radius: f64,
        is_capped: bool,
    },
    Torus {
        centre: DVec3,
        axis: DVec3,
        major: f64,
        minor: f64,
    },
    Quadric {
        coefficients: [f64; 10],
        centre: DVec3,
        half: DVec3,
    },
}

/// Why a shape can't be placed.
pub(super) type Refusal = String;

impl Placed {
    /// The shape transformed by an affine map. `None` for meshes.
    ///
    /// # Errors
    /// The transform makes it a shape that there isn't.
    pub fn new(kind: &ShapeKind, to_world: &DMat4) -> Result<Option<Self>, Refusal> {
        let linear = DMat3::from_mat4(*to_world);
        if !(linear.determinant() != 0.0 && to_world.is_finite()) {
            return Err("the transform makes the shape flat: its matrix is singular".to_owned());
        }
        let point = |p: DVec3| to_world.transform_point3(p);
        let placed = match *kind {
            ShapeKind::Obj { .. } => return Ok(None),
            ShapeKind::Sphere { center, radius } => match scale_of(linear) {
                Some(scale) => Self::Sphere {
                    centre: point(center),
                    radius: scale * radius,
                },
                None => ellipsoid(point(center), linear * radius),
            },
            ShapeKind::Plane { point: at, normal } => Self::Plane {
                point: point(at),
                normal: linear.inverse().transpose() * normal,
            },
            ShapeKind::Disk => Self::Disk {
                centre: point(DVec3::ZERO),
                axes: [linear.x_axis, linear.y_axis],
            },
            ShapeKind::Rectangle => Self::Rectangle {
                centre: point(DVec3::ZERO),
                axes: [linear.x_axis, linear.y_axis],
            },
            ShapeKind::Cube => cuboid(to_world, -DVec3::ONE, DVec3::ONE),
            ShapeKind::Box { min, max } => cuboid(to_world, min, max),
            ShapeKind::Cylinder {
                p0,
                p1,
                radius,
                is_capped,
            } => Self::Cylinder {
                ends: [point(p0), point(p1)],
                radius: radius * scale_across(linear, p1 - p0).ok_or_else(elliptic)?,
                is_capped,
            },
            ShapeKind::Cone {
                p0,
                p1,
                radius,
                is_capped,
            } => Self::Cone {
                ends: [point(p0), point(p1)],
                radius: radius * scale_across(linear, p1 - p0).ok_or_else(elliptic)?,
                is_capped,
            },
            ShapeKind::Torus {
                center,
                axis,
                major,
                minor,
            } => {
                let scale = scale_of(linear).ok_or(
                    "the transform scales the torus unequally: there is no such shape".to_owned(),
                )?;
                Self::Torus {
                    centre: point(center),
                    axis: linear * axis,
                    major: scale * major,
                    minor: scale * minor,
                }
            }
            ShapeKind::Quadric(ref quadric) => placed_quadric(quadric, to_world)?,
            ShapeKind::Csg { .. } => {
                return Err("csg can't be traced yet".to_owned());
            }
        };
        Ok(Some(placed))
    }

    /// The box around the shape; `None` if it is infinite.
    pub fn bounds(&self) -> Option<[DVec3; 2]> {
        let about = |centre: DVec3, half: DVec3| Some([centre - half, centre + half]);
        let extent = |axes: &[DVec3]| axes.iter().map(|axis| axis.abs()).sum();
        match self {
            Self::Sphere { centre, radius } => about(*centre, DVec3::splat(*radius)),
            Self::Plane { .. } => None,
            Self::Disk { centre, axes } | Self::Rectangle { centre, axes } => {
                about(*centre, extent(axes))
            }
            Self::Cuboid { centre, axes } => about(*centre, extent(axes)),
            Self::Cylinder { ends, radius, .. } | Self::Cone { ends, radius, .. } => {
                let reach = DVec3::splat(*radius);
                Some([ends[0].min(ends[1]) - reach, ends[0].max(ends[1]) + reach])
            }
            Self::Torus {
                centre,
                major,
                minor,
                ..
            } => about(*centre, DVec3::splat(major + minor)),
            Self::Quadric { centre, half, .. } => about(*centre, *half),
        }
    }

    /// Adds the shape to its list, relative to an origin and rounded to f32.
    pub fn push_to(&self, lists: &mut Lists, origin: DVec3, material: u32) {
        let near = |p: DVec3| (p - origin).as_vec3();
        match *self {
            Self::Sphere { centre, radius } => lists.spheres.push(
                Sphere {
                    centre: near(centre),
                    radius: radius as f32,
                },
                material,
            ),
            Self::Plane { point, normal } => lists.planes.push(
                Plane {
                    // The point nearest to the origin, so that it is rounded little.
                    point: near(point - (point - origin).reject_from(normal)),
                    normal: normal.normalize_or_zero().as_vec3(),
                },
                material,
            ),
            Self::Disk { centre, axes } => {
                lists.disks.push(Disk(span(near(centre), axes)), material);
            }
            Self::Rectangle { centre, axes } => lists
                .rectangles
                .push(Rectangle(span(near(centre), axes)), material),
            Self::Cuboid { centre, axes } => lists.cuboids.push(
                Cuboid {
                    centre: near(centre),
                    axes: axes.map(|axis| axis.as_vec3()),
                },
                material,
            ),
            Self::Cylinder {
                ends,
                radius,
                is_capped,
            } => lists.cylinders.push(
                Cylinder {
                    p0: near(ends[0]),
                    p1: near(ends[1]),
                    radius: radius as f32,
                    is_capped,
                },
                material,
            ),
            Self::Cone {
                ends,
                radius,
                is_capped,
            } => lists.cones.push(
                Cone {
                    p0: near(ends[0]),
                    p1: near(ends[1]),
                    radius: radius as f32,
                    is_capped,
                },
                material,
            ),
            Self::Torus {
                centre,
                axis,
                major,
                minor,
            } => lists.tori.push(
                Torus {
                    centre: near(centre),
                    axis: axis.normalize_or_zero().as_vec3(),
                    major: major as f32,
                    minor: minor as f32,
                },
                material,
            ),
            Self::Quadric {
                coefficients,
                centre,
                half,
            } => lists.quadrics.push(
                Quadric {
                    coefficients: coefficients.map(|x| x as f32),
                    centre: near(centre),
                    half: half.as_vec3(),
                },
                material,
            ),
        }
    }
}

/// Shapes of each kind and their materials.
#[derive(Default)]
pub(super) struct Lists {
    pub spheres: List<Sphere>,
    pub planes: List<Plane>,
    pub disks: List<Disk>,
    pub rectangles: List<Rectangle>,
    pub cuboids: List<Cuboid>,
    pub cylinders: List<Cylinder>,
    pub cones: List<Cone>,
    pub tori: List<Torus>,
    pub quadrics: List<Quadric>,
}

/// Shapes of one kind and their materials.
pub(super) struct List<S> {
    pub shapes: Vec<S>,
    pub materials: Vec<u32>,
}

impl<S> Default for List<S> {
    fn default() -> Self {
        Self {
            shapes: Vec::new(),
            materials: Vec::new(),
        }
    }
}

impl<S> List<S> {
    fn push(&mut self, shape: S, material: u32) {
        self.shapes.push(shape);
        self.materials.push(material);
    }
}

fn span(centre: Vec3, axes: [DVec3; 2]) -> Span {
    let [u, v] = axes.map(|axis| axis.as_vec3());
    Span { centre, u, v }
}

fn cuboid(to_world: &DMat4, min: DVec3, max: DVec3) -> Placed {
    let (linear, half) = (DMat3::from_mat4(*to_world), 0.5 * (max - min));
    Placed::Cuboid {
        centre: to_world.transform_point3(0.5 * (min + max)),
        axes: [
            half.x * linear.x_axis,
            half.y * linear.y_axis,
            half.z * linear.z_axis,
        ],
    }
}

/// The factor of a map that scales all directions equally; `None` for others.
fn scale_of(linear: DMat3) -> Option<f64> {
    let [x, y, z] = [linear.x_axis, linear.y_axis, linear.z_axis];
    let squared = x.length_squared();
    let is_near = |a: f64, b: f64| (a - b).abs() <= ROUNDING * squared;
    let is_similar = is_near(y.length_squared(), squared)
        && is_near(z.length_squared(), squared)
        && [x.dot(y), y.dot(z), z.dot(x)]
            .iter()
            .all(|&product| is_near(product, 0.0));
    is_similar.then(|| squared.sqrt())
}

/// The factor by which a map scales all directions across an axis, if it keeps them perpendicular to the axis.
fn scale_across(linear: DMat3, axis: DVec3) -> Option<f64> {
    let along = axis.normalize();
    let (u, v) = along.any_orthonormal_pair();
    let [w, u, v] = [linear * along, linear * u, linear * v];
    let squared = u.length_squared();
    let is_zero = |product: f64, size: f64| product.abs() <= ROUNDING * size;
    let is_round = is_zero(v.length_squared() - squared, squared)
        && is_zero(u.dot(v), squared)
        && is_zero(u.dot(w), u.length() * w.length())
        && is_zero(v.dot(w), v.length() * w.length());
    is_round.then(|| squared.sqrt())
}

/// The image of the unit sphere under a linear map, moved to a centre: |L⁻¹x|² = 1.
fn ellipsoid(centre: DVec3, linear: DMat3) -> Placed {
    let inverse = linear.inverse();
    let q = inverse.transpose() * inverse;
    let rows = linear.transpose();
    // The greatest extent along each axis is the length of the matrix's row; a little more, so that the box cuts nothing.
    let half = DVec3::new(
        rows.x_axis.length(),
        rows.y_axis.length(),
        rows.z_axis.length(),
    );
    Placed::Quadric {
        coefficients: [
            q.x_axis.x, q.y_axis.y, q.z_axis.z, q.x_axis.y, q.y_axis.z, q.x_axis.z, 0.0, 0.0, 0.0,
            -1.0,
        ],
        centre,
        half: half * (1.0 + 1e-5),
    }
}

/// A quadric under a map that keeps its box's edges along the axes.
fn placed_quadric(quadric: &QuadricDescription, to_world: &DMat4) -> Result<Placed, Refusal> {
    let linear = DMat3::from_mat4(*to_world);
    let columns = [linear.x_axis, linear.y_axis, linear.z_axis];
    let is_along = |v: DVec3| v.to_array().iter().filter(|x| **x != 0.0).count() == 1;
    if !columns.into_iter().all(is_along) {
        return Err("the transform turns the quadric's box; only scaling, translation and quarter turns are possible".to_owned());
    }
    let inverse = linear.inverse();
    let [a, b, c, d, e, f, g, h, i, j] = quadric.coefficients;
    let q = DMat3::from_cols_array(&[a, d, f, d, b, e, f, e, c]);
    let linear_part = DVec3::new(g, h, i);
    // About the box's centre m in its own coordinates: x = m + y.
    let m = 0.5 * (quadric.min + quadric.max);
    let constant = m.dot(q * m) + 2.0 * linear_part.dot(m) + j;
    let slope = inverse.transpose() * (q * m + linear_part);
    let q = inverse.transpose() * q * inverse;
    let half = 0.5 * (quadric.max - quadric.min);
    let half = columns[0].abs() * half.x + columns[1].abs() * half.y + columns[2].abs() * half.z;
    Ok(Placed::Quadric {
        coefficients: [
            q.x_axis.x, q.y_axis.y, q.z_axis.z, q.x_axis.y, q.y_axis.z, q.x_axis.z, slope.x,
            slope.y, slope.z, constant,
        ],
        centre: to_world.transform_point3(m),
        half,
    })
}

fn elliptic() -> Refusal {
    "the transform makes the shape elliptic or oblique: there is no such shape".to_owned()
}
