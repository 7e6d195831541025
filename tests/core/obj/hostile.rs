//! Malicious files give a clear error or the mesh, within the memory limit.

use super::{LENIENT, STRICT, parse, warnings};
use hitscope_core::obj::{self, LoadError, LoadOptions};
use hitscope_core::progress::Progress;
use std::fmt::Write as _;
use std::io::{self, Read, Write as _};
use std::path::Path;

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

/// An endless repetition of the same bytes, cut at a length.
struct Repeated {
    bytes: &'static [u8],
    at: usize,
    left: u64,
}

impl Repeated {
    fn new(bytes: &'static [u8], length: u64) -> Self {
        Self {
            bytes,
            at: 0,
            left: length,
        }
    }
}

impl Read for Repeated {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let count = (out.len() as u64).min(self.left) as usize;
        for byte in &mut out[..count] {
            *byte = self.bytes[self.at];
            self.at = (self.at + 1) % self.bytes.len();
        }
        self.left -= count as u64;
        Ok(count)
    }
}

fn parse_with(bytes: impl Read, max_memory: u64) -> Result<obj::Loaded, LoadError> {
    let options = LoadOptions {
        max_memory,
        ..STRICT
    };
    let none = |_: &str| Err(io::ErrorKind::NotFound.into());
    obj::parse(
        bytes,
        Path::new("x.obj"),
        options,
        &none,
        &Progress::default(),
    )
}

fn message(result: Result<obj::Loaded, LoadError>) -> String {
    match result {
        Ok(_) => "loaded".to_owned(),
        Err(error) => error.to_string(),
    }
}

#[test]
fn an_index_of_a_billion_is_out_of_range() {
    let text = format!("{TRIANGLE}f 1 2 1000000000\nf 1 2 3\n");
    let error = message(parse(text.as_bytes(), STRICT));
    assert_eq!(
        error,
        "x.obj:4: vertex index 1000000000 is out of range: there are 3"
    );
    let loaded = parse(text.as_bytes(), LENIENT).expect("one face is good");
    assert_eq!(loaded.mesh.triangles().len(), 1);
    assert_eq!(loaded.mesh.positions().len(), 3);
}

#[test]
fn a_line_of_a_gigabyte_is_refused_early() {
    let bytes = Repeated::new(b"v 1 2 3 ", 1 << 30);
    let error = message(parse_with(bytes, 1 << 30));
    assert_eq!(error, "x.obj:1: the statement is longer than 128 MB");
    // The limit is lower with less memory, also for a line with continuations.
    for line in [&b"v 1 2 3 "[..], b"v 1 2 3 \\\n"] {
        let bytes = Repeated::new(line, 1 << 30);
        let error = message(parse_with(bytes, 64 << 20));
        assert_eq!(error, "x.obj:1: the statement is longer than 16 MB");
    }
}

#[test]
fn a_load_beyond_the_memory_limit_is_refused_with_the_options_name() {
    const MB: u64 = 1 << 20;
    for line in [
        &b"v 1 2 3\n"[..],
        b"vt 1 2\n",
        b"vn 1 2 3\n",
        b"v 1 2 3 1 1 1\nf 1 1 1\n",
        b"g a\nf 1 1 1\ng b\nf 1 1 1\nv 0 0 0\n",
        b"p 1\nv 0 0 0\n",
        b"s 1\nf 1 1 1\ns 2\nv 0 0 0\n",
    ] {
        let bytes = Repeated::new(line, 200 * MB);
        let error = message(parse_with(bytes, 64 * MB));
        let text = String::from_utf8_lossy(line);
        assert_eq!(
            error, "x.obj: loading needs more than the 64 MB of memory allowed (--max-memory)",
            "{text:?}"
        );
    }
}

#[test]
fn the_memory_limit_stops_a_gzip_bomb() {
    let packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    let mut packer = io::BufWriter::new(packer);
    for _ in 0..20_000_000 {
        packer.write_all(b"v 0 0 0\n").expect("memory");
    }
    let packer = packer.into_inner().expect("memory");
    let bomb = packer.finish().expect("memory");
    assert!(bomb.len() < 2_000_000, "{} bytes", bomb.len());
    let options = LoadOptions {
        max_memory: 64 << 20,
        ..STRICT
    };
    let error = message(parse(&bomb, options));
    assert!(error.contains("--max-memory"), "{error}");
}

#[test]
fn a_million_materials_and_a_hundred_thousand_groups_are_read() {
    let (mut library, mut text) = (String::new(), String::from("mtllib many.mtl\n"));
    text += TRIANGLE;
    for k in 0..1_000_000 {
        writeln!(library, "newmtl m{k}\nKd 1 0 0").expect("memory");
        if k % 10 == 0 {
            writeln!(text, "usemtl m{k}\ng g{k} nested in g{k}\nf 1 2 3").expect("memory");
        }
    }
    text += "g";
    for k in 0..100_000 {
        write!(text, " g{k}").expect("memory");
    }
    text += "\nf 1 2 3\n";
    let many = |name: &str| match name {
        "many.mtl" => Ok(library.clone().into_bytes()),
        _ => Err(io::ErrorKind::NotFound.into()),
    };
    let path = Path::new("x.obj");
    let bytes = text.as_bytes();
    let loaded = obj::parse(bytes, path, STRICT, &many, &Progress::default()).expect("good");
    // Only materials that faces use are kept.
    assert_eq!(loaded.mesh.named_material_count(), 100_000);
    assert_eq!(loaded.mesh.named_group_count(), 100_001);
    assert_eq!(loaded.report.warnings, []);
}

#[test]
fn a_polygon_with_many_corners_is_read() {
    let corners = 20_000;
    let mut text = String::new();
    for i in 0..corners {
        let angle = f64::from(i) / f64::from(corners) * std::f64::consts::TAU;
        writeln!(text, "v {} {} 0", angle.cos(), angle.sin()).expect("memory");
    }
    text += "f";
    for i in 1..=corners {
        write!(text, " {i}").expect("memory");
    }
    let loaded = parse(text.as_bytes(), STRICT).expect("good");
    assert_eq!(loaded.mesh.triangles().len(), corners as usize - 2);
    assert_eq!(loaded.mesh.face_count(), 1);
}

#[test]
fn of_thousands_of_warnings_some_are_listed_and_the_rest_counted() {
    let (mut library, mut text) = (String::new(), String::from(TRIANGLE));
    for k in 0..3000 {
        writeln!(library, "newmtl m{k}\nmap_Kd lost{k}.png\nodd{k} 1").expect("memory");
        writeln!(
            text,
            "mtllib lost{k}.mtl\nstrange{k} 1\nusemtl m{k}\nf 1 2 3"
        )
        .expect("memory");
    }
    text += "mtllib there.mtl\n";
    let files = |name: &str| match name {
        "there.mtl" => Ok(library.clone().into_bytes()),
        _ => Err(io::ErrorKind::NotFound.into()),
    };
    let (path, bytes) = (Path::new("x.obj"), text.as_bytes());
    let loaded = obj::parse(bytes, path, STRICT, &files, &Progress::default()).expect("good");
    let warnings = warnings(&loaded);
    assert!(warnings.len() < 150, "{}", warnings.len());
    for expected in [
        "2\u{202f}980 more warnings about unreadable material libraries",
        "2\u{202f}980 more warnings about textures",
        "2\u{202f}960 “…” statements ignored",
    ] {
        assert!(warnings.iter().any(|w| w.contains(expected)), "{expected}");
    }
    // All pictures share one checker.
    assert_eq!(loaded.mesh.attributes().textures.len(), 1);
}

/// A picture whose header declares a size beyond all memory.
#[test]
fn a_texture_bomb_gives_a_checker_and_a_warning() {
    let header = [
        &b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR"[..],
        &60_000u32.to_be_bytes(),
        &60_000u32.to_be_bytes(),
        b"\x08\x02\0\0\0",
    ]
    .concat();
    let files = |name: &str| match name {
        "m.mtl" => Ok(b"newmtl a\nmap_Kd bomb.png\n".to_vec()),
        "bomb.png" => Ok(header.clone()),
        _ => Err(io::ErrorKind::NotFound.into()),
    };
    let text = format!("mtllib m.mtl\n{TRIANGLE}vt 0 0\nusemtl a\nf 1/1 2/1 3/1\n");
    let (path, bytes) = (Path::new("x.obj"), text.as_bytes());
    let loaded = obj::parse(bytes, path, STRICT, &files, &Progress::default()).expect("good");
    let warning = loaded.report.warnings[0].to_string();
    assert!(warning.starts_with("texture “bomb.png”: "), "{warning}");
    assert!(loaded.mesh.attributes().textures[0].bytes() < 20_000);
}

/// A reader that panics, in place of a dependency that does.
#[test]
fn a_panic_while_reading_is_an_error() {
    struct Panicking;
    impl Read for Panicking {
        fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
            panic!("on purpose")
        }
    }
    let none = |_: &str| Err(io::ErrorKind::NotFound.into());
    // At once, and in a later chunk.
    for text in [String::new(), TRIANGLE.repeat(100_000)] {
        let bytes = text.as_bytes().chain(Panicking);
        let path = Path::new("x.obj");
        let result = obj::parse(bytes, path, STRICT, &none, &Progress::default());
        let error = message(result);
        assert_eq!(error, "x.obj: reading failed unexpectedly: on purpose");
    }
}
