//! The film and its guides, distances, and numbers of surfaces as OpenEXR files.
//!
//! A file has one part. Its layers are prefixes of channel names, which every program reads. A film's file:
//!
//! | channels | contents |
//! |---|---|
//! | `R` `G` `B` | the mean of the samples, linear, with the primaries of sRGB |
//! | `A` | the part of the samples that hit something, if the background is transparent; `R`, `G` and `B` are premultiplied by it |
//! | `albedo.R` `albedo.G` `albedo.B` | mean diffuse reflectance of the first hits |
//! | `normal.X` `normal.Y` `normal.Z` | mean shading normal of the first hits |
//! | `Z` | mean distance of the first hits in the scene's units; infinite if there are none |
//! | `id` | index of the primitive (for meshes, the triangle) that the centre sample hits, or [`NO_PRIMITIVE`]; 32-bit integer |
//! | `sampleCount` | number of samples; 32-bit integer |
//! | `variance` | squared standard error of the pixel's luminance; 0 for fewer than two samples |
//!
//! A file of distances has the centre samples alone, infinite where they hit nothing:
//!
//! | channels | contents |
//! |---|---|
//! | `t` | distance along the pixel's ray in the scene's units |
//! | `Z` | distance along the direction of the view |
//!
//! A file of numbers has 32-bit integers of the centre samples, [`NO_PRIMITIVE`] where there is none:
//!
//! | channels | contents |
//! |---|---|
//! | `primitive` | index of the primitive; for meshes, of the triangle |
//! | `group` | line of the attribute `groups`, counted from 0: the names of the file's groups and objects |
//! | `material` | line of the attribute `materials`, likewise |
//!
//! For Open Image Denoise, which reads single pictures: `oiiotool in.exr --ch R,G,B -o color.pfm`, and the same with the
//! channels of `albedo` and `normal`; or Houdini's `idenoise -a albedo -n normal in.exr out.exr`.
//!
//! Sources: "Technical Introduction to OpenEXR", <https://openexr.com/en/latest/TechnicalIntroduction.html> (names of
//! layers, and `Z`); Open Image Denoise's documentation, <https://www.openimagedenoise.org/documentation.html>.

use super::alpha::Alpha;
use super::guides::{Guide, Guides};
use super::surfaces::{SurfaceIds, VisibleSurface, VisibleSurfaces};
use crate::film::Film;
use crate::mesh::Attributes;
use exr::error::Error;
use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Encoding, FlatSamples, Image, Layer, LayerAttributes,
    SmallVec, Text, WritableImage,
};
use glam::{UVec2, Vec3};
use std::io::{self, Seek, Write};

/// The number of a primitive, a group or a material where the centre sample hits none.
pub const NO_PRIMITIVE: u32 = u32::MAX;

/// Why a picture can't be written.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// Film and guides, or film and alpha, differ in size.
    #[error("the guides or the alpha channel have {guides} pixels, the film has {film} pixels")]
    Size {
        /// Width and height of the guides or the alpha.
        guides: UVec2,
        /// Width and height of the film.
        film: UVec2,
    },
    /// The file can't be written.
    #[error(transparent)]
    Write(#[from] io::Error),
}

/// Writes a film in OpenEXR format, compressed without loss, with the channels that the module's documentation lists;
/// without guides and alpha, those of the film. Pixels without a sample are black.
///
/// # Errors
/// See [`PictureError`].
pub fn write_exr(
    film: &Film,
    guides: Option<&Guides>,
    alpha: Option<&Alpha>,
    to: impl Write + Seek,
) -> Result<(), PictureError> {
    let size = film.size();
    let mut channels = of_film(film);
    if let Some(alpha) = alpha {
        if alpha.size() != size {
            let (guides, film) = (alpha.size(), size);
            return Err(PictureError::Size { guides, film });
        }
        let values = FlatSamples::F32(alpha.pixels().to_vec());
        channels.push(AnyChannel::new("A", values));
    }
    if let Some(guides) = guides {
        if guides.size() != size {
            let (guides, film) = (guides.size(), size);
            return Err(PictureError::Size { guides, film });
        }
        channels.extend(of_guides(guides));
    }
    Ok(write(size, channels, LayerAttributes::default(), to)?)
}

/// Writes the distances of surfaces in OpenEXR format, with the channels that the module's documentation lists.
///
/// # Errors
/// Those of the writer.
pub fn write_depth(surfaces: &VisibleSurfaces, to: impl Write + Seek) -> io::Result<()> {
    let values = |value: fn(&VisibleSurface) -> f32| {
        FlatSamples::F32(surfaces.pixels().iter().map(value).collect())
    };
    let channels = Channels::from_iter([
        AnyChannel::new("t", values(|surface| surface.t)),
        AnyChannel::new("Z", values(|surface| surface.z)),
    ]);
    write(surfaces.size(), channels, LayerAttributes::default(), to)
}

/// Writes the numbers of surfaces in OpenEXR format, with the channels that the module's documentation lists, and the names
/// of the mesh's groups and materials.
///
/// # Errors
/// Those of the writer.
pub fn write_ids(
    surfaces: &VisibleSurfaces,
    names: &Attributes,
    to: impl Write + Seek,
) -> io::Result<()> {
    let values = |value: fn(SurfaceIds) -> Option<u32>| {
        let of = |surface: &VisibleSurface| surface.ids.and_then(value).unwrap_or(NO_PRIMITIVE);
        FlatSamples::U32(surfaces.pixels().iter().map(of).collect())
    };
    let channels = Channels::from_iter([
        AnyChannel::new("primitive", values(|ids| Some(ids.primitive))),
        AnyChannel::new("group", values(|ids| ids.group)),
        AnyChannel::new("material", values(|ids| Some(ids.material))),
    ]);
    let groups: Vec<&str> = names.groups.entries().iter().map(String::as_str).collect();
    let materials = names.materials.entries().iter();
    let materials: Vec<&str> = materials.map(|material| &*material.name).collect();
    let mut attributes = LayerAttributes::default();
    for (name, lines) in [("groups", groups), ("materials", materials)] {
        // Bytes of UTF-8, as other programs write.
        let text = Text::from_slice_unchecked(lines.join("\n").as_bytes());
        let value = AttributeValue::Text(text);
        attributes.other.insert(Text::from(name), value);
    }
    write(surfaces.size(), channels, attributes, to)
}

/// Writes channels, compressed without loss.
fn write(
    size: UVec2,
    channels: Channels,
    attributes: LayerAttributes,
    to: impl Write + Seek,
) -> io::Result<()> {
    let attributes = LayerAttributes {
        software_name: Text::new_or_none("hitscope"),
        ..attributes
    };
    let layer = Layer::new(
        (size.x as usize, size.y as usize),
        attributes,
        Encoding::SMALL_LOSSLESS,
        AnyChannels::sort(channels),
    );
    let image = Image::from_layer(layer);
    let written = image.write().non_parallel().to_buffered(to);
    written.map_err(|error| match error {
        Error::Io(error) => error,
        error => io::Error::other(error.to_string()),
    })
}

type Channels = SmallVec<[AnyChannel<FlatSamples>; 4]>;

fn of_film(film: &Film) -> Channels {
    let size = film.size();
    let pixels = || (0..size.y).flat_map(move |y| (0..size.x).map(move |x| UVec2::new(x, y)));
    let radiance = |axis: usize| {
        let value = |pixel| film.radiance(pixel).unwrap_or(Vec3::ZERO)[axis];
        FlatSamples::F32(pixels().map(value).collect())
    };
    let variance = |pixel| {
        film.standard_error(pixel)
            .map_or(0.0, |error| error * error) as f32
    };
    let counts = pixels().map(|pixel| film.sample_count(pixel)).collect();
    Channels::from_iter([
        AnyChannel::new("R", radiance(0)),
        AnyChannel::new("G", radiance(1)),
        AnyChannel::new("B", radiance(2)),
        AnyChannel::new("sampleCount", FlatSamples::U32(counts)),
        AnyChannel::new(
            "variance",
            FlatSamples::F32(pixels().map(variance).collect()),
        ),
    ])
}

fn of_guides(guides: &Guides) -> Channels {
    let values = |value: &dyn Fn(&Guide) -> f32| {
        FlatSamples::F32(guides.pixels().iter().map(value).collect())
    };
    let id = |guide: &Guide| guide.primitive.unwrap_or(NO_PRIMITIVE);
    let ids = guides.pixels().iter().map(id).collect();
    Channels::from_iter([
        AnyChannel::new("albedo.R", values(&|guide| guide.albedo.x)),
        AnyChannel::new("albedo.G", values(&|guide| guide.albedo.y)),
        AnyChannel::new("albedo.B", values(&|guide| guide.albedo.z)),
        AnyChannel::new("normal.X", values(&|guide| guide.normal.x)),
        AnyChannel::new("normal.Y", values(&|guide| guide.normal.y)),
        AnyChannel::new("normal.Z", values(&|guide| guide.normal.z)),
        AnyChannel::new("Z", values(&|guide| guide.depth)),
        AnyChannel::new("id", FlatSamples::U32(ids)),
    ])
}
