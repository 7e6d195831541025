//! Files that an OBJ refers to: where they may be, what they may be, and how much of them is read.

use super::{STRICT, load_path, warnings};
use hitscope_core::obj::{LoadOptions, Loaded};
use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::Path;

/// Loads an OBJ with one textured triangle and this first line, from a folder with these other files.
fn load_beside(first_line: &str, files: &[(&str, &[u8])], options: LoadOptions) -> Loaded {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).expect("written");
    }
    load_in(folder.path(), first_line, options)
}

fn load_in(folder: &Path, first_line: &str, options: LoadOptions) -> Loaded {
    let text =
        format!("{first_line}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl a\nf 1/1 2/1 3/1\n");
    let path = folder.join("x.obj");
    fs::write(&path, text).expect("written");
    load_path(&path, options).expect("the mesh is good")
}

fn png(width: u32, height: u32) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let picture = image::RgbImage::from_pixel(width, height, image::Rgb([9, 8, 7]));
    let written = picture.write_to(&mut bytes, image::ImageFormat::Png);
    written.expect("memory");
    bytes.into_inner()
}

#[test]
fn a_file_that_is_no_library_or_picture_is_named_but_not_quoted() {
    const SECRET: &[u8] = b"root:hunter2:0:0\nKd hunter2\n\xFF\xD8hunter2\n";
    let library = ("m.mtl", &b"newmtl a\nmap_Kd secret\n"[..]);
    for (line, expected) in [
        (
            "mtllib secret",
            "line 1: material library “secret”: not a material library",
        ),
        (
            "mtllib m.mtl",
            "texture “secret”: not a PNG, JPEG, OpenEXR or Radiance HDR picture; shown as a checkerboard",
        ),
    ] {
        let loaded = load_beside(line, &[("secret", SECRET), library], STRICT);
        let warnings = warnings(&loaded);
        assert_eq!(warnings[0], expected);
        assert!(!warnings.concat().contains("hunter2"), "{warnings:?}");
    }
    // Unknown statements aren't quoted, either.
    let library = ("m.mtl", &b"newmtl a\nhunter2 1\nKd hunter2\n"[..]);
    let warnings = warnings(&load_beside("mtllib m.mtl", &[library], STRICT));
    assert_eq!(
        warnings,
        [
            "material library “m.mtl”: 1 unknown statement skipped, on line 2",
            "material library “m.mtl”: 1 “Kd” statement skipped: a colour is one or three numbers that aren't negative, on line 3",
        ]
    );
}

#[cfg(target_os = "linux")]
#[test]
fn devices_pipes_and_kernel_files_are_rejected_as_libraries_and_textures() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let made = std::process::Command::new("mkfifo")
        .arg(at("pipe"))
        .status();
    assert!(made.expect("mkfifo runs").success());
    for (link, to) in [
        ("pagemap", "/proc/self/pagemap"),
        ("zero", "/dev/zero"),
        ("folder", "/proc/self"),
    ] {
        std::os::unix::fs::symlink(to, at(link)).expect("linked");
    }
    let of_system = "in a virtual file system";
    for (name, why) in [
        ("/proc/self/pagemap", of_system),
        ("/proc/self/environ", of_system),
        ("pagemap", of_system),
        ("folder/pagemap", of_system),
        ("/dev/zero", "not a regular file"),
        ("zero", "not a regular file"),
        ("pipe", "not a regular file"),
    ] {
        let loaded = load_in(folder.path(), &format!("mtllib {name}"), STRICT);
        let expected = format!("line 1: material library “{name}”: {why}");
        assert_eq!(warnings(&loaded)[0], expected);
        fs::write(at("m.mtl"), format!("newmtl a\nmap_Kd {name}\n")).expect("written");
        let loaded = load_in(folder.path(), "mtllib m.mtl", STRICT);
        let expected = format!("texture “{name}”: {why}; shown as a checkerboard");
        assert_eq!(warnings(&loaded), [expected]);
    }
}

#[test]
fn a_texture_with_several_spellings_of_its_path_is_decoded_once() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("sub")).expect("made");
    fs::write(folder.path().join("Wood.png"), png(2, 2)).expect("written");
    let (mut library, mut text) = (String::new(), String::from("mtllib m.mtl\n"));
    text += "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n";
    for k in 0..60 {
        let spelling = ["./", "sub/../", ".//"][k % 3].repeat(k / 3);
        let name = ["Wood.png", "wood.PNG"][k % 2];
        writeln!(library, "newmtl m{k}\nmap_Kd {spelling}{name}").expect("memory");
        writeln!(text, "usemtl m{k}\nf 1/1 2/1 3/1").expect("memory");
    }
    fs::write(folder.path().join("m.mtl"), library).expect("written");
    let path = folder.path().join("x.obj");
    fs::write(&path, text).expect("written");
    let loaded = load_path(&path, STRICT).expect("good");
    assert_eq!(warnings(&loaded), [""; 0]);
    assert_eq!(loaded.mesh.attributes().textures.len(), 1);
    let maps = loaded
        .mesh
        .attributes()
        .materials
        .entries()
        .iter()
        .filter(|m| m.diffuse_map.is_some());
    assert_eq!(maps.count(), 60);
}

#[test]
fn a_library_with_several_spellings_of_its_path_is_read_once() {
    let library = ("m.mtl", &b"newmtl a\nodd 1\n"[..]);
    let loaded = load_beside(
        "mtllib m.mtl\nmtllib ./m.mtl\nmtllib M.mtl",
        &[library],
        STRICT,
    );
    let expected = "material library “m.mtl”: 1 unknown statement skipped, on line 2";
    assert_eq!(warnings(&loaded), [expected]);
}

#[test]
fn a_truncated_jpeg_is_shown_with_a_warning() {
    // Noise, so that most of the file is after the header.
    let channel = |x: u32| (x.wrapping_mul(2_654_435_761) >> 24) as u8;
    let texel = |x, y| image::Rgb([x, y, x + y].map(channel));
    let picture = image::RgbImage::from_fn(256, 256, texel);
    let mut whole = Vec::new();
    image::codecs::jpeg::JpegEncoder::new(&mut whole)
        .encode_image(&picture)
        .expect("memory");
    let library = ("m.mtl", &b"newmtl a\nmap_Kd p.jpg\n"[..]);
    let load = |bytes: &[u8]| load_beside("mtllib m.mtl", &[library, ("p.jpg", bytes)], STRICT);
    let early = "texture “p.jpg”: truncated file: part of the picture is missing";
    for (bytes, expected) in [
        (whole.clone(), None),
        // Cameras append their own data.
        ([&whole[..], b"appended"].concat(), None),
        (whole[..whole.len() / 2].to_vec(), Some(early)),
        (whole[..whole.len() - 2].to_vec(), Some(early)),
    ] {
        let loaded = load(&bytes);
        let expected: Vec<String> = expected.into_iter().map(str::to_owned).collect();
        assert_eq!(warnings(&loaded), expected);
        assert_eq!(loaded.mesh.attributes().textures[0].bytes(), 3 * 256 * 256);
    }
}

/// A black PNG with one bit per pixel.
fn one_bit_png(side: u32) -> Vec<u8> {
    let mut packer = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
    let row = vec![0; 1 + side.div_ceil(8) as usize];
    (0..side).for_each(|_| packer.write_all(&row).expect("memory"));
    let data = packer.finish().expect("memory");
    let side = side.to_be_bytes();
    let header = [&side[..], &side, b"\x01\0\0\0\0"].concat();
    let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
    for (name, content) in [(b"IHDR", header), (b"IDAT", data), (b"IEND", Vec::new())] {
        let mut sum = flate2::Crc::new();
        sum.update(name);
        sum.update(&content);
        bytes.extend((content.len() as u32).to_be_bytes());
        bytes.extend(name);
        bytes.extend(content);
        bytes.extend(sum.sum().to_be_bytes());
    }
    bytes
}

#[test]
fn a_picture_beyond_the_memory_limit_is_refused_before_decoding() {
    const MB: u64 = 1 << 20;
    let library = ("m.mtl", &b"newmtl a\nmap_Kd p.png\n"[..]);
    let load = |side: u32, max_memory: u64| {
        let options = LoadOptions {
            max_memory,
            ..STRICT
        };
        let picture = one_bit_png(side);
        load_beside("mtllib m.mtl", &[library, ("p.png", &picture)], options)
    };
    // One byte per pixel while decoding, and three when stored: 1526 MB.
    let refused = warnings(&load(20_000, 1200 * MB));
    let expected = "texture “p.png”: decoding needs 1526 MB of memory, but only 1199 MB is left (--max-memory); shown as a checkerboard";
    assert_eq!(refused, [expected]);
    // 15.3 MB.
    assert_eq!(load(2000, 14 * MB).report.warnings.len(), 1);
    let loaded = load(2000, 17 * MB);
    assert_eq!(warnings(&loaded), [""; 0]);
    assert_eq!(loaded.mesh.attributes().textures[0].bytes(), 12_000_000);
}
