//! Tests of the view as text: copied to the clipboard, pasted from it, and read by `render`.

use crate::harness::{Window, bare, press, wait};
use egui::{Event, Key, Modifiers, OutputCommand};
use egui_kittest::kittest::Queryable as _;
use glam::{DVec2, UVec2};
use hitscope_core::Camera;
use hitscope_core::camera::UpAxis;

/// The toast after a view was pasted.
const PASTED: &str = "Moved the camera to the pasted view";

/// Copies the view by its key. One frame, so that its output can be read.
fn copied(window: &mut Window) -> String {
    let modifiers = Modifiers::COMMAND | Modifiers::SHIFT;
    window.input_mut().events.push(Event::Key {
        key: Key::C,
        physical_key: None,
        pressed: true,
        repeat: false,
        modifiers,
    });
    window.step();
    let commands = &window.output().platform_output.commands;
    let mut texts = commands.iter().filter_map(|command| match command {
        OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    });
    texts.next_back().expect("a copied text")
}

fn paste(window: &mut Window, text: &str) {
    window.event(Event::Paste(text.to_owned()));
    window.run_steps(3);
}

fn camera(window: &Window) -> Camera {
    let app = window.state();
    app.turntable().camera(app.film().size())
}

/// Requires that two cameras have the same rays.
fn assert_same_rays(a: &Camera, b: &Camera, scale: f64) {
    let size = a.resolution();
    assert_eq!(size, b.resolution());
    for part in [[0.0, 0.0], [0.5, 0.5], [0.9, 0.1], [1.0, 1.0]] {
        let at = size.as_dvec2() * DVec2::from(part);
        let [from_a, from_b] = [a, b].map(|camera| camera.ray_before_rounding(at));
        let [off, turned] = [0, 1].map(|k| (from_a[k] - from_b[k]).length());
        // Some dozen roundings of f64; pictures need 2⁻²⁴, which is 6e-8.
        assert!(off < 1e-13 * scale, "{at}: {off}");
        assert!(turned < 1e-13, "{at}: {turned}");
    }
}

#[test]
fn a_copied_view_is_pasted_as_the_same_rays() {
    for is_orthographic in [false, true] {
        let Some(mut window) = bare() else { return };
        if is_orthographic {
            press(&mut window, Key::Num5);
        }
        // Anywhere.
        press(&mut window, Key::T);
        window.run_steps(17);
        press(&mut window, Key::T);
        let before = camera(&window);
        let text = copied(&mut window);
        let projection = if is_orthographic { "--ortho" } else { "--fov" };
        assert!(
            text.starts_with("--eye ") && text.contains(projection),
            "{text}"
        );
        press(&mut window, Key::Num5);
        press(&mut window, Key::Num7);
        assert_ne!(camera(&window), before);
        // A focused button doesn't prevent pasting.
        window.get_by_label("Wireframe").focus();
        window.run_steps(2);
        paste(&mut window, &text);
        assert_eq!(window.state().notice(), None);
        let scale = window.state().turntable().distance;
        assert_same_rays(&camera(&window), &before, scale);
    }
}

#[test]
fn render_reads_the_copied_view() {
    use clap::Parser as _;
    #[derive(clap::Parser)]
    struct Arguments {
        #[command(flatten)]
        camera: hitscope_lab::commands::CameraArgs,
    }
    let Some(mut window) = bare() else { return };
    press(&mut window, Key::Num3);
    let text = copied(&mut window);
    let size = window.state().film().size();
    let words = format!("render {text} --size {}x{}", size.x, size.y);
    let arguments = Arguments::parse_from(words.split(' '));
    let scene = &window.state().document().loaded.scene;
    let read = arguments.camera.camera(scene, None).expect("a camera");
    let scale = window.state().turntable().distance;
    assert_same_rays(&read, &camera(&window), scale);
}

#[test]
fn a_pasted_view_needs_an_eye_alone_and_a_text_that_is_no_view_gives_a_reason() {
    let Some(mut window) = bare() else { return };
    paste(&mut window, " --eye 0,0,9\n --target 0,1,0 --fov 25 ");
    let app = window.state();
    assert_eq!(app.notice(), None);
    let turntable = app.turntable();
    let camera = turntable.camera(UVec2::new(8, 8));
    assert!((camera.exact_eye() - glam::DVec3::new(0.0, 0.0, 9.0)).length() < 1e-12);
    assert!((turntable.fov_y_radians.to_degrees() - 25.0).abs() < 1e-12);
    assert_eq!(turntable.up_axis, UpAxis::Y);
    assert!((turntable.pivot - glam::DVec3::Y).length() < 1e-12);
    let before = *turntable;
    for (text, reason) in [
        ("hello world", "hello"),
        ("--fov 40", "--eye is missing"),
        ("--eye 1,2", "three numbers"),
        ("--eye 1,1,1 --target 1,1,1", "same point"),
    ] {
        paste(&mut window, text);
        let notice = window.state().notice().expect("a reason");
        assert!(
            notice.contains("holds no view") && notice.contains(reason),
            "{notice}"
        );
        assert_eq!(*window.state().turntable(), before);
        press(&mut window, Key::Escape);
    }
    // A view closes the message about the last text.
    paste(&mut window, "hello world");
    paste(&mut window, "--eye 0,0,9");
    assert_eq!(window.state().notice(), None);
    assert_eq!(window.state().toasts().last(), Some(&PASTED));
    assert_ne!(*window.state().turntable(), before);
}

#[test]
fn a_view_with_extreme_numbers_is_shown_or_refused() {
    let Some(mut window) = bare() else { return };
    let far = "--eye 1e12,1,1 --target 0,0,0 --fov 179";
    paste(&mut window, far);
    let app = window.state();
    assert_eq!((app.notice(), app.toasts()), (None, vec![PASTED]));
    let eye = app.turntable().camera(UVec2::new(8, 8)).exact_eye();
    assert!((eye.x - 1e12).abs() < 1e4, "{eye}");
    let before = *app.turntable();
    for too_far in ["--eye 1e38,1,1 --target 0,0,0", "--eye 0,0,9 --ortho 1e38"] {
        paste(&mut window, too_far);
        let notice = window.state().notice().expect("a reason");
        assert!(notice.contains("too far away"), "{notice}");
        assert_eq!(*window.state().turntable(), before);
        press(&mut window, Key::Escape);
    }
    press(&mut window, Key::Home);
    wait(&mut window, "the mesh", |app| {
        app.turntable().distance < 1e3 && app.is_settled()
    });
}

#[test]
fn a_long_pasted_text_is_shortened_in_the_message() {
    let Some(mut window) = bare() else { return };
    paste(&mut window, &"x".repeat(3_000_000));
    let notice = window.state().notice().expect("a reason");
    assert!(
        notice.contains('…') && notice.len() < 300,
        "{}",
        notice.len()
    );
}

#[test]
fn a_whole_command_is_pasted_as_its_view() {
    let Some(mut window) = bare() else { return };
    paste(
        &mut window,
        "hitscope render mesh.obj -o x.png --eye 0,0,9 --fov 25",
    );
    assert_eq!(window.state().notice(), None);
    let turntable = window.state().turntable();
    assert!((turntable.fov_y_radians.to_degrees() - 25.0).abs() < 1e-12);
}
