//! Tests of the settings.

use super::*;

#[test]
fn a_session_kernel_is_used_but_not_stored() {
    let mut settings = Settings::default();
    let kept = settings.kernel.clone();
    settings.use_for_session("exact");
    assert_eq!(settings.kernel().info.name, "exact");
    let stored = serde_json::to_string(&settings).expect("plain data");
    let later: Settings = serde_json::from_str(&stored).expect("what was stored");
    assert_eq!(later.kernel().info.name, kept);
    settings.keep_kernel("exact");
    let stored = serde_json::to_string(&settings).expect("plain data");
    let later: Settings = serde_json::from_str(&stored).expect("what was stored");
    assert_eq!(later.kernel().info.name, "exact");
}

#[test]
fn a_chosen_view_is_stored_but_not_that_of_a_file() {
    let mut settings = Settings::default();
    settings.keep_view("normal");
    settings.file_view = Some("path");
    assert_eq!(settings.view().name, "path");
    let stored = serde_json::to_string(&settings).expect("plain data");
    let later: Settings = serde_json::from_str(&stored).expect("what was stored");
    assert_eq!(later.view().name, "normal");
    settings.keep_view("depth");
    assert_eq!(settings.view().name, "depth");
}

#[test]
fn normals_are_turned_on_by_the_shading_and_all_are_turned_off() {
    let mut settings = Settings::default();
    for is_smooth in [false, true] {
        settings.is_smooth = is_smooth;
        settings.toggle_normals();
        let overlays = &settings.overlays;
        let on = [&FACE_NORMALS, &VERTEX_NORMALS].map(|normals| overlays.is_on(normals));
        assert_eq!(on, [!is_smooth, is_smooth]);
        settings.is_smooth = !is_smooth;
        settings.toggle_normals();
        assert!(!settings.shows_normals());
    }
}

#[test]
fn the_up_axis_is_stored_but_not_that_of_a_files_view() {
    let mut settings = Settings::default();
    settings.keep_up_axis(UpAxis::Z);
    settings.file_up_axis = Some(UpAxis::Y);
    assert_eq!(settings.up_axis(), UpAxis::Y);
    let stored = serde_json::to_string(&settings).expect("plain data");
    let later: Settings = serde_json::from_str(&stored).expect("what was stored");
    assert_eq!(later.up_axis(), UpAxis::Z);
}
