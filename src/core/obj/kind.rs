//! Detection of other file formats by their first bytes.

use memchr::memchr;

/// The first bytes of other file formats, and their descriptions. Case is ignored.
const SIGNATURES: [(&[u8], &str); 16] = [
    (b"<!doctype", "an HTML page"),
    (b"<html", "an HTML page"),
    (b"<?xml", "an XML file"),
    (
        b"version https://git-lfs",
        "a Git LFS pointer whose file wasn't fetched",
    ),
    (b"solid ", "an STL file"),
    (b"ply\n", "a PLY file"),
    (b"ply\r", "a PLY file"),
    (b"{", "a JSON file"),
    (b"[", "a JSON file"),
    (b"%PDF", "a PDF document"),
    (b"\x89PNG", "a PNG picture"),
    (b"\xFF\xD8\xFF", "a JPEG picture"),
    (b"glTF", "a glTF file"),
    (b"Kaydara FBX", "an FBX file"),
    (b"PK\x03\x04", "a ZIP archive"),
    (b"BZh", "a bzip2 file"),
];

/// The error message if the first bytes show that a file isn't an OBJ.
pub(super) fn not_an_obj(first_bytes: &[u8]) -> Option<String> {
    if first_bytes.is_empty() {
        return Some("the file is empty".to_owned());
    }
    let start = first_bytes.trim_ascii_start();
    let starts_with =
        |with: &[u8]| start.len() >= with.len() && start[..with.len()].eq_ignore_ascii_case(with);
    let known = SIGNATURES.iter().find(|(bytes, _)| starts_with(bytes));
    let format = known.map(|(_, format)| *format);
    let is_binary = || memchr(0, first_bytes).map(|_| "a binary file");
    let format = format.or_else(is_binary)?;
    Some(format!("this is {format}, not an OBJ file"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_formats_are_recognised() {
        for (bytes, format) in [
            (&b"\n  <HTML><body>"[..], "an HTML page"),
            (b"ply\nformat ascii 1.0", "a PLY file"),
            (b"solid cube\nfacet", "an STL file"),
            (b"{\"asset\":{}}", "a JSON file"),
            (b"\x7fELF\0\0", "a binary file"),
            (b"BZh91AY", "a bzip2 file"),
        ] {
            let expected = format!("this is {format}, not an OBJ file");
            assert_eq!(
                not_an_obj(bytes),
                Some(expected),
                "{}",
                bytes.escape_ascii()
            );
        }
        for bytes in [&b"v 0 0 0"[..], b"# solid state", b"plyers"] {
            assert_eq!(not_an_obj(bytes), None, "{}", bytes.escape_ascii());
        }
    }
}
