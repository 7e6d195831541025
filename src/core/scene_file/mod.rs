//! Scene files: a subset of the XML format of Mitsuba 3, and shapes of our own.
//!
//! [`parse`] turns a file into a [`SceneFile`], which holds plain f64 numbers; [`to_xml`] writes one. No mesh is
//! loaded and no shape is built here. What follows was compared with Mitsuba 3.9.1, variant `scalar_rgb`.
//!
//! | step | file |
//! |---|---|
//! | bytes are decoded; lines of offsets | `text` |
//! | text that would take the parser too long is refused | `outline` |
//! | **the file and its includes are parsed**, and their objects read | `include`, `reader` |
//! | elements, attributes, `$name` | `element`, `defaults` |
//! | properties: numbers, vectors, transforms | `properties`, `number`, `transform`, `parameters` |
//! | objects | `shapes` and `kinds`, `materials`, `bsdfs`, `emitters`, `sensors`, `integrators`; others: `objects` |
//! | the result | `description`, `bsdf`, `emitter`, `sensor`, `plugin` |
//! | errors, warnings, memory limit | `problem`, `warnings`, `memory` |
//! | files on the disk | `stored` |
//! | writer | `writer`, `shape_writer`, `bsdf_writer`, `emitter_writer`, `xml` |
//!
//! # Format
//!
//! The root is `<scene version="3.0.0">`; versions from 2.0.0 are accepted. Text is UTF-8, or UTF-16 with a byte order
//! mark. Document types, entities and namespaces aren't allowed. Elements are nested up to 100 deep.
//!
//! An object is an element with a `type`, and optionally an `id` and a `name`. It contains properties (`boolean`,
//! `integer`, `float`, `string`, `point`, `vector`, `rgb`, `spectrum` with one number, `transform`) and other objects.
//! Numbers in a list are separated by commas or spaces; one number stands for three equal ones. All numbers are
//! finite.
//!
//! | element | meaning |
//! |---|---|
//! | `<default name value>` | defines a parameter from here on, also after the end of an included file; the first definition counts |
//! | `$name` in an attribute | the parameter's value; a name consists of ASCII letters, digits and `_`. There is no escape for `$` |
//! | `<include filename>` | the contents of another `<scene>`, anywhere in an object; up to 15 deep |
//! | `<ref id>` | the object with this `id`: in a shape a `bsdf`, which may follow later; in a `bsdf` a `bsdf` or texture defined before |
//!
//! File names are relative to the folder of the file that contains them. Mitsuba does the same for `include`, and then
//! also searches the main file's folder; it searches for OBJ files in the main file's folder alone. A warning tells
//! where this differs.
//!
//! ## Transforms
//!
//! `<transform name="to_world">` contains operations. Each is applied after those before it.
//!
//! | operation | attributes |
//! |---|---|
//! | `translate`, `scale` | `value`, or `x`, `y`, `z` with default 0 or 1 |
//! | `rotate` | axis as in `translate`, `angle` in degrees, counter-clockwise. Mitsuba doesn't normalise the axis: it then also scales |
//! | `matrix` | `value`: 9 or 16 numbers, row by row; the last row of 16 must be 0 0 0 1, and Mitsuba ignores it |
//! | `lookat` | `origin`, `target`, optionally `up`: z points to the target, y upwards, x to the **left** |
//!
//! A transform must be invertible. What it may do to a shape depends on the shape:
//!
//! | shape | transforms |
//! |---|---|
//! | `obj`, `disk`, `rectangle`, `cube`, `box`, `plane` | all: a disk may become an ellipse, a box a parallelepiped |
//! | `sphere` | all: scaled unequally, it becomes an ellipsoid, which is a quadric |
//! | `cylinder`, `cone` | rotation, translation, and scaling by one factor along the axis and another across it |
//! | `torus` | rotation, translation, and scaling by one factor |
//! | `quadric` | translation, scaling along x, y and z, and quarter turns, because the edges of its box stay along the axes |
//! | `csg` | those that all its shapes allow |
//!
//! Others are refused. For a cylinder and a cone, the message gives the coefficients and the box of a `quadric` with the
//! same surface.
//!
//! ## Shapes
//!
//! Every shape has `to_world` and `flip_normals` (default `false`), and may contain a `bsdf` or a `ref` to one, and an
//! `emitter`.
//!
//! | shape of Mitsuba's | parameters and defaults |
//! |---|---|
//! | `obj` | `filename`, `face_normals` = false, `flip_tex_coords` = true |
//! | `sphere` | `center` = 0, `radius` = 1; in Mitsuba, `to_world` may not make it an ellipsoid |
//! | `cylinder` | `p0` = 0, `p1` = (0, 0, 1), `radius` = 1; open. Ours: `capped` = false |
//! | `disk` | unit radius, facing +z |
//! | `rectangle` | from (−1, −1, 0) to (1, 1, 0), facing +z |
//! | `cube` | from −1 to 1 |
//!
//! With `flip_tex_coords` = true, v increases upwards in a picture, as OBJ files mean it; with false, downwards. Shapes of
//! the same OBJ file share its textures.
//!
//! Mitsuba doesn't know the following shapes, nor `capped`, and refuses a file with them:
//!
//! | shape of ours | parameters and defaults |
//! |---|---|
//! | `plane` | infinite; `point` = 0 and `normal` = (0, 0, 1), or `point` and the vectors `v`, `w`, or the points `p0`, `p1`, `p2`, or `a`, `b`, `c`, `d` for ax + by + cz + d = 0 |
//! | `box` | `min` = −1, `max` = 1 |
//! | `cone` | base centre `p0` = 0, apex `p1` = (0, 0, 1), `radius` = 1, `capped` = false |
//! | `torus` | `center` = 0, `axis` = (0, 0, 1), radii `major` = 1 and `minor` = 0.25 |
//! | `quadric` | `a` to `j` = 0 for ax² + by² + cz² + 2dxy + 2eyz + 2fxz + 2gx + 2hy + 2iz + j = 0, cut by the box from `min` = −1 to `max` = 1 |
//! | `csg` | `operation`: `union`, `intersection` or `difference` (of the first and all others); two or more nested solids: closed shapes, planes (the half-space behind the normal) or `csg` |
//!
//! Radii are positive here. Mitsuba also accepts 0 and negative ones.
//!
//! A `bsdf` and `flip_normals` of a shape nested in a `csg` have no effect: those of the outermost `csg` apply to its
//! whole surface. They give a warning unless the `bsdf` is the same.
//!
//! ### The side of normals
//!
//! Normals point outwards, to +z of a flat shape, along the normal of a plane, and for a mesh to the side of its file's
//! normals or, without these, to the side from which its corners are counter-clockwise. `flip_normals` reverses them.
//! Under a transform that mirrors (its determinant is negative), they stay on the image of this side, with two
//! exceptions, as in Mitsuba: normals of a `sphere` then point inwards, and those of an `obj` without normals (or with
//! `face_normals`) are reversed.
//!
//! Mitsuba has two normals, on different sides for a mirrored `cube`, `rectangle` and `obj` with normals. Here, both are
//! on the side of Mitsuba's shading normal, on which it evaluates materials and emitters. An emitter in a mirrored sphere
//! or in a mirrored `obj` without normals therefore shines from the other side, which gives a warning.
//!
//! ## Materials
//!
//! | bsdf | parameters and defaults |
//! |---|---|
//! | `diffuse` | `reflectance` = 0.5: `rgb` (linear), `spectrum` or `float`, from 0 to 1. The back is black |
//! | `conductor` | `material` = none, a mirror; or `eta` and `k`; `specular_reflectance` = 1. The back is black |
//! | `dielectric`, `thindielectric` | `int_ior` = bk7, `ext_ior` = air: a number or a name; `specular_reflectance` = `specular_transmittance` = 1 |
//! | `plastic` | `int_ior` = polypropylene, `ext_ior` = air, `diffuse_reflectance` = 0.5, `specular_reflectance` = 1, `nonlinear` = false. The back is black |
//! | `roughconductor`, `roughdielectric`, `roughplastic` | the same, and `distribution` = beckmann or `ggx`, `alpha` = 0.1 |
//! | `mask` | `opacity` = 0.5 and a nested `bsdf` |
//! | `normalmap` | a nested texture of normals, 0…1 for −1…1, and a nested `bsdf` |
//! | `bumpmap` | a nested texture of heights in the scene's unit, `scale` = 1, and a nested `bsdf` |
//! | `twosided` | one nested `bsdf` for both sides, or two for front and back; light mustn't pass through them |
//!
//! A shape without a `bsdf` is `diffuse` with a reflectance of 0.5, as in Mitsuba; its back is black. An `obj` whose
//! file has materials or vertex colours keeps them; Mitsuba ignores them.
//!
//! Metals are Ag, Al, Au, Be, Cr, Cu, Hg, Ir, Rh, TiN and W. Different `alpha_u` and `alpha_v` give a warning. Mitsuba's
//! other BSDFs give a warning and a diffuse reflectance of 0.5.
//!
//! ### Textures
//!
//! A `<texture>` can stand in place of `reflectance`, `diffuse_reflectance`, `specular_reflectance`,
//! `specular_transmittance`, `opacity`, and `alpha` of `roughconductor` and `roughdielectric`; in place of others it gives
//! a warning, and the parameter's default is used. So can a `<ref>` to one that is defined before.
//!
//! | texture | parameters and defaults |
//! |---|---|
//! | `bitmap` | `filename`: PNG or JPEG, or Radiance HDR or OpenEXR, whose numbers are linear; `raw` = false: whether bytes aren't sRGB; `filter_type` = bilinear or `nearest`; `wrap_mode` = repeat, `mirror` or `clamp`. A file that can't be read gives a warning and the parameter's default |
//! | `checkerboard` | `color0` = 0.4, `color1` = 0.2, constant |
//!
//! `to_uv` maps the surface's texture coordinates to the texture's, of which (0, 0) is the upper left corner and (1, 1) the
//! lower right one. An `obj` has the coordinates of its file, with 1 − v in place of v if `flip_tex_coords` is true;
//! `sphere`, `cylinder`, `disk`, `rectangle` and `cube` have Mitsuba's, and a `box` those of a cube. Other shapes have
//! none: a warning says that the parameters' defaults are used.
//!
//! ## Sensors
//!
//! `perspective` has `fov` in degrees along `fov_axis` = x, or `focal_length` = 50mm, which determines the diagonal of
//! a film of 36 mm × 24 mm. `thinlens` also has `aperture_radius`, which has no default, and `focus_distance` = 10
//! 000. `orthographic` spans x from −1 to 1, so that the scale of `to_world` determines its extent. `<film>` has
//! `width` = 768, `height` = 576, both up to 16384, and a crop window; `<sampler>` has `sample_count` = 4. The first
//! sensor is the initial view. The others and `sample_count` are kept, but aren't used: commands and the window have their
//! own number of samples. The crop window and the lens are kept, too, but aren't used, and give a warning; so do
//! `near_clip`, `far_clip` and other parameters.
//!
//! ## Emitters
//!
//! | emitter | parameters and defaults |
//! |---|---|
//! | `area`, inside a shape | `radiance` = 1. The front shines, the side of the normal. Without a bsdf, the shape is black |
//! | `constant` | `radiance` = 1 |
//! | `point` | `position` = 0, or `to_world`; `intensity` = 1 |
//! | `directional` | `direction` = (0, 0, 1) in which the light travels, or `to_world`; `irradiance` = 1. A scale in `to_world` doesn't change the light, unlike in Mitsuba |
//! | `envmap` | `filename`: a latitude–longitude picture, Radiance HDR or OpenEXR; `scale` = 1; `to_world`: a rotation. `mis_compensation` has no effect |
//!
//! Light is `rgb` (linear), `spectrum` with one number or `float`, and isn't negative. Radiance, irradiance and
//! `scale` are at most 2.8e14: brighter light would exceed the picture's range. A scene has at most one
//! `constant` or `envmap`. Mitsuba's other emitters are kept, but give no light and a warning. The `radiance` of `area`
//! can be a texture; in place of other colours, one gives a warning.
//!
//! ## Integrators
//!
//! The integrator selects the initial view: `path`, `direct`, `depth`, or the name of a view of ours, which Mitsuba
//! refuses. For others of Mitsuba's, a warning names the view that is shown instead.
//!
//! `max_depth` = −1 (no limit) counts the surfaces on a path and the emitter: 1 shows emitters alone, 2 also light that
//! one surface reflects. In [`Integrator::depth_limit`] it is one less, the number of surfaces. `rr_depth` = 5 is the
//! number of the surface from which on Russian roulette may end a path. If `hide_emitters` is true, which by default it
//! isn't, camera rays pass through surfaces that emit light, and show the background where they hit nothing; behind a
//! `mask`, emitters and the environment stay visible, as in Mitsuba's `direct`.
//!
//! ## Objects that aren't used
//!
//! Mitsuba's other objects give a warning and aren't kept. An element, type, attribute or parameter that Mitsuba doesn't know either is an error.

mod bsdf;
mod bsdf_writer;
mod bsdfs;
mod defaults;
mod description;
mod element;
mod emitter;
mod emitter_writer;
mod emitters;
mod include;
mod integrators;
mod kinds;
mod materials;
mod memory;
mod number;
mod objects;
mod outline;
mod parameters;
mod plugin;
mod problem;
mod properties;
mod reader;
mod relief;
mod sensor;
mod sensors;
mod shape_writer;
mod shapes;
mod side;
mod stored;
mod text;
mod textures;
mod transform;
mod warnings;
mod writer;
mod xml;

pub use crate::group::CsgOperation;
pub use bsdf::{Bsdf, Form, Roughness};
pub use description::{Material, Place, SceneFile, Shape};
pub use emitter::{Emitter, EmitterKind};
pub use integrators::Integrator;
pub(crate) use kinds::with_kinds;
pub use kinds::{
    Cone, Csg, Cube, Cuboid, Cylinder, Disk, Obj, Plane, Quadric, Rectangle, ShapeKind, Sphere,
    Torus,
};
pub(crate) use memory::exceeded;
pub use plugin::{Parameter, Plugin, Value};
pub(crate) use problem::quoted;
pub(crate) use reader::load_counted;
pub use reader::{load, parse};
pub use relief::{Relief, ReliefKind};
pub use sensor::{Crop, FieldOfView, Film, FovAxis, Sensor, SensorKind};
pub use side::Side;
pub use stored::ReadFile;
pub use textures::{Bitmap, Checkerboard, Texture, TextureKind};
pub use writer::to_xml;
pub use xml::WriteError;
pub(crate) use xml::{number as number_text, vector as vector_text};
