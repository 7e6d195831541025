//! Every environment file gives a map or a clear error.

use exr::prelude::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes};
use exr::prelude::{SmallVec, WritableImage, f16};
use glam::{UVec2, Vec3};
use hitscope_core::light::{EnvironmentMap, LoadedMap};
use hitscope_core::obj::LoadError;
use hitscope_core::progress::Progress;
use std::f64::consts::{FRAC_1_PI, PI};
use std::io::Cursor;
use std::path::Path;

#[path = "../../../assets/studio_environment.rs"]
#[expect(dead_code, reason = "the program's main function")]
mod studio_environment;

const LIMIT: u64 = 1 << 20;

fn read(bytes: &[u8]) -> Result<LoadedMap, LoadError> {
    EnvironmentMap::read(bytes, Path::new("sky"), LIMIT, &Progress::default())
}

/// The message of the error, which is one line.
fn refusal(bytes: &[u8]) -> String {
    let message = read(bytes).expect_err("refused").to_string();
    assert!(message.starts_with("sky: ") && !message.contains('\n'));
    message
}

/// A file in Radiance HDR format: 1 x 2 pixels, white above and black below.
fn hdr(header: &str, dimensions: &str) -> Vec<u8> {
    let mut bytes = format!("{header}\n\n{dimensions}\n").into_bytes();
    bytes.extend([128, 128, 128, 129, 0, 0, 0, 0]);
    bytes
}

/// A file in OpenEXR format with one layer of 2 x 2 pixels.
fn exr(channels: Vec<(&str, FlatSamples)>, encoding: Encoding) -> Vec<u8> {
    let channels: SmallVec<_> = channels
        .into_iter()
        .map(|(name, samples)| AnyChannel::new(name, samples))
        .collect();
    let attributes = LayerAttributes::default();
    let layer = Layer::new((2, 2), attributes, encoding, AnyChannels::sort(channels));
    let mut bytes = Cursor::new(Vec::new());
    let written = Image::from_layer(layer).write().to_buffered(&mut bytes);
    written.expect("written");
    bytes.into_inner()
}

fn rgb_exr() -> Vec<u8> {
    let ramp = |start: f32| FlatSamples::F32((0..4).map(|k| start + k as f32).collect());
    let channels = vec![("R", ramp(1.0)), ("G", ramp(10.0)), ("B", ramp(100.0))];
    exr(channels, Encoding::SMALL_LOSSLESS)
}

#[test]
fn stored_colours_are_divided_by_exposure_and_colour_correction() {
    for signature in ["#?RADIANCE", "#?RGBE"] {
        let file = hdr(signature, "-Y 2 +X 1");
        let map = read(&file).expect("a picture").map;
        assert_eq!(map.size(), UVec2::new(1, 2));
        assert_eq!(map.radiance(Vec3::Y), Vec3::ONE);
        assert_eq!(map.radiance(Vec3::NEG_Y), Vec3::ZERO);
        let header = "\n# comment\nEXPOSURE=8\nEXPOSURE= 0.25\nCOLORCORR=1 2 4\nSOFTWARE=x";
        let file = hdr(&format!("{signature}{header}"), "-Y 2 +X 1");
        let map = read(&file).expect("a picture").map;
        assert_eq!(map.radiance(Vec3::Y), Vec3::new(0.5, 0.25, 0.125));
    }
}

#[test]
fn exr_files_of_half_and_float_with_any_channels_in_any_order_are_read() {
    let bright = |x: f32| FlatSamples::F32(vec![x, x, 0.0, 0.0]);
    let half = |x: f32| FlatSamples::F16([x, x, 0.0, 0.0].map(f16::from_f32).to_vec());
    for encoding in [
        Encoding::UNCOMPRESSED,
        Encoding::FAST_LOSSLESS,
        Encoding::SMALL_LOSSLESS,
        Encoding::SMALL_FAST_LOSSLESS,
    ] {
        let channels = vec![
            ("Z", bright(9.0)),
            ("B", half(3.0)),
            ("A", half(0.5)),
            ("R", bright(1.0)),
            ("G", bright(2.0)),
        ];
        let map = read(&exr(channels, encoding)).expect("a picture").map;
        assert_eq!(map.size(), UVec2::splat(2));
        let above = map.radiance(Vec3::Y);
        assert!(
            (above - Vec3::new(1.0, 2.0, 3.0)).length() < 1e-5,
            "{above}"
        );
        assert_eq!(map.radiance(Vec3::NEG_Y), Vec3::ZERO);
    }
}

#[test]
fn numbers_that_are_not_finite_or_negative_are_replaced_and_counted() {
    let channel = |values: [f32; 4]| FlatSamples::F32(values.to_vec());
    let channels = vec![
        ("R", channel([f32::INFINITY, f32::INFINITY, 0.0, 0.0])),
        ("G", channel([f32::NAN, -2.0, 0.0, 0.0])),
        ("B", channel([7.0, 7.0, 0.0, 0.0])),
    ];
    let loaded = read(&exr(channels, Encoding::UNCOMPRESSED)).expect("a picture");
    let above = loaded.map.radiance(Vec3::Y);
    assert!(
        (above - Vec3::new(7.0, 0.0, 7.0)).length() < 1e-5,
        "{above}"
    );
    let [warning] = &loaded.warnings[..] else {
        panic!("{:?}", loaded.warnings);
    };
    assert!(warning.message.starts_with("4 of 12 "), "{warning}");
    let good = read(&rgb_exr()).expect("a picture");
    assert!(good.warnings.is_empty());
}

#[test]
fn the_luminance_of_a_grey_exr_file_is_read() {
    let ramp = || FlatSamples::F32((1..=4).map(|k| k as f32).collect());
    let map = read(&exr(vec![("Y", ramp())], Encoding::SMALL_LOSSLESS));
    assert_eq!(map.expect("a picture").map.radiance(Vec3::Y).x, 1.5);
    // Colours relative to the luminance aren't grey.
    let file = exr(
        vec![("RY", ramp()), ("Y", ramp())],
        Encoding::SMALL_LOSSLESS,
    );
    let error = read(&file).expect_err("refused").to_string();
    assert!(error.contains("the channels R, G and B"), "{error}");
}

#[test]
fn broken_files_give_one_clear_line() {
    for (bytes, expected) in [
        (Vec::new(), "neither a Radiance HDR nor an OpenEXR picture"),
        (b"P6 1 1 255".to_vec(), "neither a Radiance HDR"),
        (
            hdr("#?RADIANCE", "+Y 2 +X 1"),
            "+Y +X isn't supported, only -Y +X",
        ),
        (hdr("#?RADIANCE", "+X 1 -Y 2"), "+X -Y isn't supported"),
        (hdr("#?RADIANCE", "-Y 0 +X 1"), "no pixels"),
        (hdr("#?RADIANCE", "-Y 2 +X 0"), "no pixels"),
        (hdr("#?RADIANCE", "-Y 2"), "line"),
        (b"#?RADIANCE\n\n".to_vec(), "the file is truncated"),
        (hdr("#?RADIANCE", "-Y 9 +X 1"), "truncated"),
        (hdr("#?RADIANCE", "-Y 65536 +X 65536"), "--max-memory"),
        (hdr("#?RADIANCE\nEXPOSURE=0", "-Y 2 +X 1"), "EXPOSURE"),
        (hdr("#?RADIANCE\nEXPOSURE=dark", "-Y 2 +X 1"), "EXPOSURE"),
        (
            hdr("#?RADIANCE\nFORMAT=32-bit_rle_xyze", "-Y 2 +X 1"),
            "FORMAT",
        ),
        (b"#?RADIANCE".to_vec(), "the file is truncated"),
    ] {
        let message = refusal(&bytes);
        assert!(message.contains(expected), "{message}, not {expected}");
    }
    let depth = exr(
        vec![("Z", FlatSamples::F32(vec![1.0; 4]))],
        Encoding::UNCOMPRESSED,
    );
    assert!(refusal(&depth).contains("channels R, G and B"));
}

#[test]
fn truncated_and_altered_files_never_panic() {
    for file in [hdr("#?RADIANCE\nEXPOSURE=2", "-Y 2 +X 1"), rgb_exr()] {
        for end in 0..file.len() {
            _ = refusal(&file[..end]);
        }
        for at in 0..file.len() {
            for value in [0, 1, 0x7f, 0xff] {
                let mut altered = file.clone();
                altered[at] = value;
                if let Err(error) = read(&altered) {
                    assert!(!error.to_string().contains("unexpectedly"), "{at}: {error}");
                }
            }
        }
    }
}

#[test]
fn files_and_pictures_beyond_the_memory_limit_are_refused() {
    let file = rgb_exr();
    let read_within = |limit| {
        EnvironmentMap::read(&file, Path::new("sky"), limit, &Progress::default())
            .map_err(|error| error.to_string())
    };
    let needed = file.len() + 4 * EnvironmentMap::BYTES_PER_TEXEL;
    assert!(read_within(needed as u64).is_ok());
    let error = read_within(needed as u64 - 1).expect_err("too large");
    assert!(error.contains("2 x 2 pixels need 1 MB"), "{error}");
    let error = read_within(file.len() as u64 - 1).expect_err("too large");
    assert!(error.contains("larger than"), "{error}");
}

#[test]
fn a_cancelled_load_stops() {
    let progress = Progress::default();
    progress.cancel();
    for file in [hdr("#?RADIANCE", "-Y 2 +X 1"), rgb_exr()] {
        let error = EnvironmentMap::read(&file, Path::new("sky"), LIMIT, &progress);
        assert!(matches!(error, Err(LoadError::Cancelled { .. })));
    }
}

#[test]
fn files_are_loaded_from_the_disk() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("sky.exr");
    let load = |path: &Path| EnvironmentMap::load(path, LIMIT, &Progress::default());
    assert!(matches!(load(&path), Err(LoadError::Unreadable { .. })));
    std::fs::write(&path, rgb_exr()).expect("written");
    assert_eq!(load(&path).expect("a picture").map.size(), UVec2::splat(2));
    let error = load(folder.path()).expect_err("refused").to_string();
    assert!(
        error.ends_with("this is a directory, not a picture"),
        "{error}"
    );
}

#[test]
fn the_built_in_studio_is_what_its_program_makes() {
    let stored = include_bytes!("../../../assets/studio.hdr");
    assert!(stored[..] == studio_environment::file());
    assert!(stored.len() <= 64 << 10);
    let studio = EnvironmentMap::built_in();
    assert_eq!(studio.size(), UVec2::new(128, 64));
    // White that faces up reflects the radiance 1: a sum over directions.
    const N: u32 = 200;
    let mut sum = 0.0;
    for k in 0..N * N {
        let cos = (f64::from(k / N) + 0.5) / f64::from(N);
        let (sin_phi, cos_phi) = (2.0 * PI * f64::from(k % N) / f64::from(N)).sin_cos();
        let sin = (1.0 - cos * cos).sqrt();
        let dir = glam::DVec3::new(sin * cos_phi, cos, sin * sin_phi).as_vec3();
        sum += cos * f64::from(studio.radiance(dir).y);
    }
    let reflected = FRAC_1_PI * sum * 2.0 * PI / f64::from(N * N);
    // The file's eight bits, and two different sums over softboxes' edges.
    assert!((reflected - 1.0).abs() < 0.02, "{reflected}");
}
