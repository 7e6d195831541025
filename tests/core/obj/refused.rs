//! Refused files and their messages.

use super::{LENIENT, STRICT, files, load_path};
use hitscope_core::mesh::NO_INDEX;
use hitscope_core::obj;
use hitscope_core::progress::Progress;

/// The error message for a file that isn't loaded, without the folder's name.
fn error(name: &str) -> String {
    let error = load_path(&files().join(name), STRICT).expect_err(name);
    let folder = format!("{}/", files().display());
    error.to_string().replace(&folder, "")
}

#[test]
fn an_invalid_index_is_an_error_or_drops_its_face() {
    for (name, message, dropped) in [
        (
            "too_high.obj",
            "too_high.obj:5: vertex index 9 is out of range: there are 3",
            1,
        ),
        (
            "zero.obj",
            "zero.obj:5:3: vertex index 0; indices start at 1",
            1,
        ),
        (
            "too_far_back.obj",
            "too_far_back.obj:5:3: vertex index -4 is out of range: there are 3",
            1,
        ),
        (
            "too_short.obj",
            "too_short.obj:5: a face needs at least three corners; this one has 2",
            2,
        ),
        (
            "no_normal.obj",
            "no_normal.obj:6: normal index 7 is out of range: there is 1",
            0,
        ),
    ] {
        assert_eq!(error(name), message);
        let loaded = load_path(&files().join(name), LENIENT).expect(name);
        assert_eq!(loaded.report.dropped.bad_index, dropped, "{name}");
        assert_eq!(
            loaded.report.warnings.len(),
            1,
            "{name}: {:?}",
            loaded.report.warnings
        );
        assert!(loaded.report.warnings[0].line.is_some(), "{name}");
    }
    let loaded = load_path(&files().join("too_high.obj"), LENIENT).expect("lenient");
    assert_eq!(loaded.mesh.triangles(), [[0, 1, 2], [0, 1, 2], [0, 2, 1]]);
    let loaded = load_path(&files().join("no_normal.obj"), LENIENT).expect("lenient");
    let normals = &loaded.mesh.attributes().normals;
    assert_eq!(
        [0, 1].map(|t| normals.indices(t)),
        [[0; 3], [0, NO_INDEX, 0]]
    );
}

#[test]
fn a_word_in_place_of_a_number_is_reported_with_its_position() {
    for (name, message) in [
        (
            "four_parts.obj",
            "four_parts.obj:4:3: “1/1/1/1” has more parts than vertex/texture/normal",
        ),
        ("comma.obj", "comma.obj:2:3: “0,5” is not a number"),
        ("word.obj", "word.obj:3:5: “one” is not a number"),
        ("fraction.obj", "fraction.obj:4:3: “1.0” is not an index"),
    ] {
        assert_eq!(error(name), message);
        let lenient = load_path(&files().join(name), LENIENT);
        assert!(
            lenient.is_err(),
            "{name}: the vertices after it would be others"
        );
    }
}

#[test]
fn errors_name_the_format_of_files_that_are_not_obj() {
    let nothing = "no vertices and no faces: this is not an OBJ file";
    for (name, message) in [
        ("empty.obj", "the file is empty"),
        ("prose.obj", nothing),
        ("page.obj", "this is an HTML page, not an OBJ file"),
        ("program.obj", "this is a binary file, not an OBJ file"),
        ("sub", "this is a directory, not an OBJ file"),
    ] {
        assert_eq!(error(name), format!("{name}: {message}"));
    }
    assert!(error("nowhere.obj").starts_with("nowhere.obj: "));
}

#[cfg(unix)]
#[test]
fn an_unreadable_file_is_reported() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("secret.obj");
    std::fs::copy(files().join("crlf.obj"), &path).expect("copied");
    let nobody = std::fs::Permissions::from_mode(0o000);
    std::fs::set_permissions(&path, nobody).expect("changed");
    if std::fs::File::open(&path).is_ok() {
        eprintln!("skipped: this user may read everything");
        return;
    }
    let error = load_path(&path, STRICT)
        .expect_err("unreadable")
        .to_string();
    assert!(error.contains("ermission denied"), "{error}");
}

#[test]
fn a_truncated_gzip_file_is_an_error() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("half.obj.gz");
    let whole = std::fs::read(files().join("packed.obj.gz")).expect("there");
    std::fs::write(&path, &whole[..whole.len() - 9]).expect("written");
    assert!(load_path(&path, STRICT).is_err());
}

/// The file grows while it is read. Loading fails, or reads the whole file if it finishes first.
#[test]
fn a_file_that_changes_during_reading_never_gives_a_partial_mesh() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("growing.obj");
    let mut text = String::from("v 0 0 0\nv 1 0 0\nv 0 1 0\n");
    for _ in 0..200_000 {
        text += "f 1 2 3\n";
    }
    std::fs::write(&path, &text).expect("written");
    let progress = Progress::default();
    let result = std::thread::scope(|threads| {
        let loading = threads.spawn(|| obj::load(&path, STRICT, &progress));
        while progress.bytes().0 == 0 && !loading.is_finished() {
            std::thread::yield_now();
        }
        text += "f 1 3 2\n";
        std::fs::write(&path, &text).expect("written");
        loading.join().expect("no panic")
    });
    match result {
        Ok(loaded) => assert!(loaded.mesh.triangles().len() >= 200_000),
        Err(error) => assert!(error.to_string().contains("changed"), "{error}"),
    }
}
