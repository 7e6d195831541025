//! Decoder of OpenEXR pictures.
//!
//! Source: "OpenEXR File Layout", <https://openexr.com/en/latest/OpenEXRFileLayout.html>.

use super::{Cancellable, Memory, Picture, Problem, black};
use crate::obj::printable;
use crate::progress::{Cancelled, Progress};
use exr::meta::MetaData;
use exr::meta::header::Header;
use exr::prelude::{ReadChannels, ReadLayers, ReadSpecificChannel, Vec2 as Size, read};
use glam::{UVec2, Vec3};
use std::cell::Cell;

/// What a file starts with.
pub(super) const START: &[u8] = &[0x76, 0x2f, 0x31, 0x01];

/// The channels of a picture.
const CHANNELS: [&str; 3] = ["R", "G", "B"];
/// The luminance channel of a grey picture.
const GREY: &str = "Y";
/// A chroma channel, which luminance–chroma pictures have beside `Y`.
const CHROMA: &str = "RY";

/// Decodes the first layer with the channels R, G and B, or else the first grey layer.
///
/// An alpha channel is ignored: colours are stored multiplied by it.
pub(super) fn decode(
    bytes: &[u8],
    memory: Memory,
    progress: &Progress,
) -> Result<Picture, Problem> {
    let problem = |error: exr::error::Error| match progress.check() {
        Ok(()) => Problem::Content(message(&error)),
        Err(Cancelled) => Problem::Cancelled,
    };
    let source = || Cancellable::new(bytes, progress);
    let header = MetaData::read_from_buffered(source(), false).map_err(problem)?;
    let layers = || header.headers.iter();
    let coloured = layers().find(|header| is_picture(header));
    let Some(layer) = coloured.or_else(|| layers().find(|header| is_grey(header))) else {
        let message = "no layer has the channels R, G and B, or the channel Y alone";
        return Err(message.to_owned().into());
    };
    let [width, height] = [layer.layer_size.0, layer.layer_size.1].map(u32::try_from);
    let (Ok(width), Ok(height)) = (width, height) else {
        return Err("the picture is too large".to_owned().into());
    };
    let size = UVec2::new(width, height);
    let texels = Cell::new(black(size, memory)?);
    let set = move |texels: &mut Vec<Vec3>, Size(x, y): Size<usize>, colour: Vec3| {
        if let Some(texel) = texels.get_mut(y * width as usize + x) {
            *texel = colour;
        }
    };
    let reader = read()
        .no_deep_data()
        .largest_resolution_level()
        .specific_channels();
    let texels = if coloured.is_some() {
        let image = reader
            .required(CHANNELS[0])
            .required(CHANNELS[1])
            .required(CHANNELS[2])
            .collect_pixels(
                move |_, _| texels.take(),
                move |texels: &mut Vec<Vec3>, at, (r, g, b): (f32, f32, f32)| {
                    set(texels, at, Vec3::new(r, g, b));
                },
            )
            .first_valid_layer()
            .all_attributes()
            .non_parallel()
            .from_buffered(source());
        image.map_err(problem)?.layer_data.channel_data.pixels
    } else {
        let image = reader
            .required(GREY)
            .collect_pixels(
                move |_, _| texels.take(),
                move |texels: &mut Vec<Vec3>, at, (grey,): (f32,)| {
                    set(texels, at, Vec3::splat(grey));
                },
            )
            .first_valid_layer()
            .all_attributes()
            .non_parallel()
            .from_buffered(source());
        image.map_err(problem)?.layer_data.channel_data.pixels
    };
    Ok(Picture { size, texels })
}

fn is_picture(header: &Header) -> bool {
    !header.deep && CHANNELS.iter().all(|channel| has(header, channel))
}

fn is_grey(header: &Header) -> bool {
    !header.deep && has(header, GREY) && !has(header, CHROMA)
}

fn has(header: &Header, channel: &str) -> bool {
    let mut channels = header.channels.list.iter();
    channels.any(|known| known.name.eq(channel))
}

fn message(error: &exr::error::Error) -> String {
    let text = printable(error.to_string().trim());
    if text.contains("missing bytes") {
        "the file is truncated".to_owned()
    } else {
        text
    }
}
