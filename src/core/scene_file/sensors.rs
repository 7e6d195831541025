//! Sensors: `<sensor>` elements with their film and sampler.

use super::description::Place;
use super::element::Element;
use super::objects::{self, Head};
use super::parameters::Parameters;
use super::problem::{Problem, quoted, unknown};
use super::properties;
use super::reader::Reader;
use super::sensor::{Crop, FieldOfView, Film, FovAxis, Sensor, SensorKind};
use crate::camera::MAX_SIDE;

/// The sensors that are read, then Mitsuba's others.
const SENSORS: [&str; 7] = [
    "perspective",
    "orthographic",
    "thinlens",
    "batch",
    "distant",
    "irradiancemeter",
    "radiancemeter",
];
const FILMS: [&str; 2] = ["hdrfilm", "specfilm"];
const SAMPLERS: [&str; 5] = [
    "independent",
    "ldsampler",
    "multijitter",
    "orthogonal",
    "stratified",
];
const FILTERS: [&str; 6] = [
    "box",
    "catmullrom",
    "gaussian",
    "lanczos",
    "mitchell",
    "tent",
];

/// The parameters of a film's crop window.
const CROP: [&str; 4] = [
    "crop_offset_x",
    "crop_offset_y",
    "crop_width",
    "crop_height",
];

/// Mitsuba's default of `sample_count`.
const SAMPLE_COUNT: u32 = 4;
/// Mitsuba's default of `focus_distance`: that of `far_clip`.
const FOCUS_DISTANCE: f64 = 10_000.0;

/// The nested objects of a sensor.
struct Parts {
    parameters: Parameters,
    film: Option<Film>,
    sample_count: Option<u32>,
}

/// A sensor, or `None` if it is one of Mitsuba's that aren't supported.
///
/// # Errors
/// Its type isn't known, or a part of it isn't valid.
pub(super) fn sensor(reader: &mut Reader, element: Element) -> Result<Option<Sensor>, Problem> {
    let head = Head::of(reader, element)?;
    match SENSORS.iter().position(|kind| *kind == head.kind) {
        Some(0..=2) => {}
        Some(_) => {
            let message = format!("sensor {} isn't supported", quoted(&head.kind));
            reader.warnings.add(element.place, message);
            return Ok(None);
        }
        None => return Err(element.problem(unknown("sensor", &head.kind, &SENSORS[..3]))),
    }
    reader
        .memory
        .take(2 * size_of::<Sensor>() as u64, element.place)?;
    let mut parts = Parts {
        parameters: Parameters::new("sensor", &head.kind, element.place),
        film: None,
        sample_count: None,
    };
    reader.each_child(element, &mut |reader, child| parts.add(reader, child))?;
    let parameters = &mut parts.parameters;
    let kind = match head.kind.as_str() {
        "perspective" => SensorKind::Perspective(field_of_view(parameters)?),
        "orthographic" => SensorKind::Orthographic,
        _ => thin_lens(parameters)?,
    };
    if matches!(kind, SensorKind::ThinLens { aperture_radius, .. } if aperture_radius > 0.0) {
        let message = "sensor “thinlens”: the lens isn't used; everything is in focus";
        reader.warnings.add(element.place, message.to_owned());
    }
    let to_world = parameters.world_transform()?;
    let unused = [
        "near_clip",
        "far_clip",
        "shutter_open",
        "shutter_close",
        "principal_point_offset_x",
        "principal_point_offset_y",
    ];
    parameters.warn_about(&unused, &mut reader.warnings);
    parts.parameters.finish(&mut reader.memory)?;
    Ok(Some(Sensor {
        place: element.place,
        id: head.id,
        kind,
        to_world,
        film: parts.film.unwrap_or_default(),
        sample_count: parts.sample_count.unwrap_or(SAMPLE_COUNT),
    }))
}

impl Parts {
    fn add(&mut self, reader: &mut Reader, child: Element) -> Result<(), Problem> {
        if let Some(parameter) = properties::parameter(reader, child)? {
            return self.parameters.add(parameter);
        }
        let is_second = match child.tag() {
            "film" => self.film.is_some(),
            "sampler" => self.sample_count.is_some(),
            _ => false,
        };
        if is_second {
            let object = self.parameters.object();
            return Err(child.problem(format!("{object} has a second {}", child.tag())));
        }
        match child.tag() {
            "film" => self.film = Some(film(reader, child)?),
            "sampler" => self.sample_count = Some(sampler(reader, child)?),
            _ => objects::skip(reader, child, &self.parameters.object())?,
        }
        Ok(())
    }
}

fn thin_lens(parameters: &mut Parameters) -> Result<SensorKind, Problem> {
    let Some((aperture_radius, place)) = parameters.float("aperture_radius")? else {
        return Err(parameters.problem("parameter “aperture_radius” is missing"));
    };
    if aperture_radius < 0.0 {
        return Err(Problem::at(place, "“aperture_radius” must not be negative"));
    }
    Ok(SensorKind::ThinLens {
        fov: field_of_view(parameters)?,
        aperture_radius,
        focus_distance: parameters.positive("focus_distance", FOCUS_DISTANCE)?,
    })
}

fn field_of_view(parameters: &mut Parameters) -> Result<FieldOfView, Problem> {
    const AXES: [(&str, FovAxis); 5] = [
        ("x", FovAxis::X),
        ("y", FovAxis::Y),
        ("diagonal", FovAxis::Diagonal),
        ("smaller", FovAxis::Smaller),
        ("larger", FovAxis::Larger),
    ];
    let fov = parameters.float("fov")?;
    let axis = match parameters.text("fov_axis")? {
        None => FovAxis::X,
        Some((name, place)) => {
            let found = AXES.iter().find(|(known, _)| *known == name);
            let unknown = || unknown("axis", &name, &AXES.map(|axis| axis.0));
            let found = found.map(|(_, axis)| *axis);
            found.ok_or_else(|| Problem::at(place, unknown()))?
        }
    };
    let focal_length = parameters.text("focal_length")?;
    let Some((degrees, place)) = fov else {
        let degrees = match focal_length {
            Some((text, place)) => diagonal_degrees(&text, place)?,
            // Mitsuba's default is 50mm.
            None => diagonal_of(50.0),
        };
        let axis = FovAxis::Diagonal;
        return Ok(FieldOfView { degrees, axis });
    };
    if let Some((_, place)) = focal_length {
        let message = "“fov” and “focal_length” exclude each other";
        return Err(Problem::at(place, message));
    }
    if degrees <= 0.0 || degrees >= 180.0 {
        return Err(Problem::at(place, "“fov” must be between 0 and 180"));
    }
    Ok(FieldOfView { degrees, axis })
}

/// The diagonal field of view of a focal length such as `50mm`.
fn diagonal_degrees(text: &str, place: Place) -> Result<f64, Problem> {
    let number = text.strip_suffix("mm").unwrap_or(text);
    let length: f64 = number.trim().parse().unwrap_or(f64::NAN);
    let degrees = diagonal_of(length);
    if length > 0.0 && degrees > 0.0 && degrees < 180.0 {
        return Ok(degrees);
    }
    let text = quoted(text);
    Err(Problem::at(
        place,
        format!("{text} isn't a focal length such as “50mm”"),
    ))
}

/// The angle in degrees over the diagonal of a 35 mm film, which is 36 mm wide and 24 mm high.
fn diagonal_of(focal_length_mm: f64) -> f64 {
    let half_diagonal = 0.5 * 36f64.hypot(24.0);
    2.0 * (half_diagonal / focal_length_mm).atan().to_degrees()
}

fn film(reader: &mut Reader, element: Element) -> Result<Film, Problem> {
    let mut parameters = head_parameters(reader, element, "film", &FILMS)?;
    reader.each_child(element, &mut |reader, child| {
        if let Some(parameter) = properties::parameter(reader, child)? {
            return parameters.add(parameter);
        }
        if child.tag() != "rfilter" {
            return objects::skip(reader, child, &parameters.object());
        }
        let filter = Head::of(reader, child)?;
        if !FILTERS.contains(&filter.kind.as_str()) {
            return Err(child.problem(unknown("rfilter", &filter.kind, &FILTERS)));
        }
        if filter.kind != "box" {
            let kind = quoted(&filter.kind);
            let message = format!("rfilter {kind} isn't supported; “box” is used");
            reader.warnings.add(child.place, message);
        }
        Ok(())
    })?;
    let default = Film::default();
    let width = parameters.count("width", 1..=MAX_SIDE)?;
    let height = parameters.count("height", 1..=MAX_SIDE)?;
    let width = width.unwrap_or(default.width);
    let height = height.unwrap_or(default.height);
    let crop_place = parameters.place_of(&CROP);
    let crop = crop(&mut parameters, width, height)?;
    if let (Some(crop), Some(place)) = (crop, crop_place)
        && [crop.width, crop.height] != [width, height]
    {
        let object = parameters.object();
        let message = format!("{object}: the crop window isn't used; the whole film is shown");
        reader.warnings.add(place, message);
    }
    let unused = [
        "file_format",
        "pixel_format",
        "component_format",
        "sample_border",
        "compensate",
        "banner",
    ];
    parameters.warn_about(&unused, &mut reader.warnings);
    parameters.finish(&mut reader.memory)?;
    Ok(Film {
        width,
        height,
        crop,
    })
}

fn crop(parameters: &mut Parameters, width: u32, height: u32) -> Result<Option<Crop>, Problem> {
    let [x, y, crop_width, crop_height] = CROP;
    let x = parameters.count(x, 0..=MAX_SIDE)?;
    let y = parameters.count(y, 0..=MAX_SIDE)?;
    let crop_width = parameters.count(crop_width, 1..=MAX_SIDE)?;
    let crop_height = parameters.count(crop_height, 1..=MAX_SIDE)?;
    if [x, y, crop_width, crop_height] == [None; 4] {
        return Ok(None);
    }
    let crop = Crop {
        x: x.unwrap_or(0),
        y: y.unwrap_or(0),
        width: crop_width.unwrap_or(width),
        height: crop_height.unwrap_or(height),
    };
    let is_within =
        |start: u32, size: u32, whole: u32| u64::from(start) + u64::from(size) <= u64::from(whole);
    if is_within(crop.x, crop.width, width) && is_within(crop.y, crop.height, height) {
        Ok(Some(crop))
    } else {
        Err(parameters.problem("the crop window exceeds the film"))
    }
}

fn sampler(reader: &mut Reader, element: Element) -> Result<u32, Problem> {
    let mut parameters = head_parameters(reader, element, "sampler", &SAMPLERS)?;
    reader.each_child(
        element,
        &mut |reader, child| match properties::parameter(reader, child)? {
            Some(parameter) => parameters.add(parameter),
            None => objects::skip(reader, child, &parameters.object()),
        },
    )?;
    let sample_count = parameters.count("sample_count", 1..=u32::MAX)?;
    parameters.warn_about(&["seed", "jitter"], &mut reader.warnings);
    parameters.finish(&mut reader.memory)?;
    Ok(sample_count.unwrap_or(SAMPLE_COUNT))
}

/// Empty parameters for an object of one of the given types.
fn head_parameters(
    reader: &mut Reader,
    element: Element,
    tag: &'static str,
    kinds: &[&str],
) -> Result<Parameters, Problem> {
    let head = Head::of(reader, element)?;
    if !kinds.contains(&head.kind.as_str()) {
        return Err(element.problem(unknown(tag, &head.kind, kinds)));
    }
    Ok(Parameters::new(tag, &head.kind, element.place))
}
