//! Tests of comparisons that are incomplete: figures of unfinished pictures, and sides without a picture.

use crate::comparing::{SQUARE, choose, colour, compare, opened, settled};
use crate::harness::{Window, press};
use egui::Key;
use egui_kittest::kittest::Queryable as _;

#[test]
fn figures_of_pictures_that_are_being_refined_are_marked() {
    let Some((mut window, _folder)) = opened(SQUARE) else {
        return;
    };
    compare(&mut window);
    let is_final = |window: &Window| {
        let final_label = window.query_by_label_contains("with all their samples");
        let so_far = window.query_by_label_contains("So far: ");
        assert_ne!(final_label.is_some(), so_far.is_some());
        final_label.is_some()
    };
    assert!(is_final(&window));
    // Moving the camera restarts both sides; the old figures are shown meanwhile.
    press(&mut window, Key::Num7);
    assert!(!is_final(&window));
    settled(&mut window);
    assert!(is_final(&window));
}

#[test]
fn a_side_b_without_a_file_is_empty_and_says_so() {
    let Some((mut window, _folder)) = opened(SQUARE) else {
        return;
    };
    compare(&mut window);
    let before = colour(&mut window, 0.55, 0.5);
    choose(&mut window, "Source", "Another file");
    window.get_by_label("No file: choose one in the tab Compare");
    let after = colour(&mut window, 0.55, 0.6);
    assert_ne!(after, before);
    assert_eq!(after, colour(&mut window, 0.95, 0.9));
    choose(&mut window, "Source", "This scene, traced");
    assert_eq!(colour(&mut window, 0.55, 0.5), before);
}
