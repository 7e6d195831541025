//! Tests of toasts, the log, pictures of the screen and the quality.

use crate::commands::open_menu;
use crate::harness::{app, bare, press, wait, write};
use egui::accesskit::Role;
use egui::{Key, Modifiers, OutputCommand};
use egui_kittest::kittest::Queryable as _;
use hitscope::app::App;
use hitscope::quality::{MovingResolution, Quality};

const MESH: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

#[test]
fn f12_saves_the_picture_beside_the_file_and_a_toast_says_so_for_some_seconds() {
    let folder = tempfile::tempdir().expect("a folder");
    let mesh = folder.path().join("mesh.obj");
    std::fs::write(&mesh, MESH).expect("written");
    let Some(mut window) = app(Some(mesh)) else {
        return;
    };
    wait(&mut window, "the picture", App::is_settled);
    window.run_steps(3);
    for (k, modifiers) in [Modifiers::NONE, Modifiers::SHIFT].into_iter().enumerate() {
        window.key_press_modifiers(modifiers, Key::F12);
        window.step();
        let path = folder.path().join(format!("mesh-{}.png", k + 1));
        let text = format!("Saved {}", path.display());
        wait(&mut window, "the toast", |app| {
            app.toasts().contains(&text.as_str())
        });
        let bytes = std::fs::read(&path).expect("saved");
        // Width and height follow the signature and the start of the header.
        let size = window.state().film().size();
        assert_eq!(bytes[16..20], size.x.to_be_bytes());
        assert_eq!(bytes[20..24], size.y.to_be_bytes());
    }
    // A step takes 1/60 s.
    window.run_steps(300);
    assert!(window.state().toasts().is_empty());
    window.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::L);
    window.run_steps(4);
    window.get_by_label_contains("mesh-1.png");
    window.get_by_label("Copy all");
    press(&mut window, Key::Escape);
    assert!(window.query_by_label("Copy all").is_none());
}

#[test]
fn a_link_in_the_log_leads_to_the_line_that_a_warning_names() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 9\n";
    let mesh = write(&folder, "mesh.obj", text);
    let Some(mut window) = app(Some(mesh)) else {
        return;
    };
    wait(&mut window, "the warning", |app| app.notice().is_some());
    let notice = window.state().notice().expect("a warning").to_owned();
    assert!(notice.contains("line 5"), "{notice}");
    window.key_press_modifiers(Modifiers::COMMAND | Modifiers::SHIFT, Key::L);
    window.run_steps(4);
    window.get_by_role_and_label(Role::Link, "line 5").click();
    window.run_steps(4);
    // The line has no face that could be framed: the box of elements says so.
    for _ in 0..400 {
        window.step();
        if window.query_by_label("Go to element").is_some() {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    panic!("the link goes nowhere");
}

#[test]
fn a_rendered_picture_can_have_a_transparent_background() {
    let folder = tempfile::tempdir().expect("a folder");
    let mesh = write(&folder, "mesh.obj", MESH);
    let Some(mut window) = app(Some(mesh)) else {
        return;
    };
    window.get_by_label("Draft").click();
    window.run_steps(2);
    window.key_press_modifiers(Modifiers::COMMAND, Key::F12);
    window.run_steps(4);
    for label in [
        "Size of the window's picture",
        "Transparent background",
        "Render",
    ] {
        window.get_by_label(label).click();
        window.run_steps(2);
    }
    let path = folder.path().join("mesh-1.png");
    let text = format!("Saved {}", path.display());
    wait(&mut window, "the file", |app| {
        app.toasts().contains(&text.as_str())
    });
    let picture = image::open(&path).expect("a picture").to_rgba8();
    assert_eq!(picture.get_pixel(0, 0).0, [0; 4]);
    let opaque = picture.pixels().filter(|pixel| pixel.0[3] == 255).count();
    assert!(opaque > 1000, "{opaque}");
}

#[test]
fn a_picture_of_any_size_is_rendered_in_the_background() {
    let folder = tempfile::tempdir().expect("a folder");
    let mesh = folder.path().join("mesh.obj");
    std::fs::write(&mesh, MESH).expect("written");
    let Some(mut window) = app(Some(mesh)) else {
        return;
    };
    window.get_by_label("Draft").click();
    window.run_steps(2);
    wait(&mut window, "the picture", App::is_settled);
    window.key_press_modifiers(Modifiers::COMMAND, Key::F12);
    window.run_steps(4);
    let use_size = window.get_by_label("Size of the window's picture");
    use_size.click();
    window.run_steps(2);
    let width = window.state().film().size().x;
    for (format, extension, magic) in [
        ("PNG", "png", &[0x89, b'P', b'N', b'G']),
        ("EXR", "exr", &[0x76, 0x2f, 0x31, 0x01]),
    ] {
        window.get_by_label(format).click();
        window.run_steps(2);
        window.get_by_label("Render").click();
        window.run_steps(2);
        let path = folder.path().join(format!("mesh-1.{extension}"));
        let text = format!("Saved {}", path.display());
        wait(&mut window, "the file", |app| {
            app.toasts().contains(&text.as_str())
        });
        let bytes = std::fs::read(&path).expect("saved");
        assert_eq!(&bytes[..4], magic, "{format}");
        if format == "PNG" {
            assert_eq!(bytes[16..20], width.to_be_bytes());
        }
        window.run_steps(2);
    }
    press(&mut window, Key::Escape);
    assert!(
        window
            .query_by_label("Size of the window's picture")
            .is_none()
    );
}

#[test]
fn the_picture_can_be_copied() {
    let Some(mut window) = bare() else { return };
    wait(&mut window, "the picture", App::is_settled);
    open_menu(&mut window, "Edit");
    let entry = window.get_by_role_and_label(Role::MenuItem, "Copy picture");
    entry.click();
    let size = window.state().film().size().to_array();
    for _ in 0..1000 {
        window.step();
        let commands = &window.output().platform_output.commands;
        let copied = commands.iter().find_map(|command| match command {
            OutputCommand::CopyImage(image) => Some(image.size),
            _ => None,
        });
        if let Some(copied) = copied {
            assert_eq!(copied, size.map(|side| side as usize));
            assert!(window.state().toasts().contains(&"Copied the picture"));
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    panic!("nothing was copied");
}

#[test]
fn the_quality_sets_kernel_and_samples_and_own_settings_are_called_custom() {
    let Some(mut window) = app(None) else { return };
    window.get_by_label("Balanced");
    window.get_by_label("Draft").click();
    window.run_steps(3);
    let settings = window.state().settings();
    assert_eq!(settings.kernel().info.short_name(), "fast");
    assert_eq!(settings.samples, 4);
    assert_eq!(
        Quality::of(settings).map(|quality| quality.title),
        Some("Draft")
    );
    assert_eq!(settings.moving, MovingResolution::Quarter);
    // Another kernel.
    window.key_press_modifiers(Modifiers::COMMAND, Key::P);
    window.run_steps(4);
    window
        .get_by_label("Find a command")
        .type_text("kernel watertight");
    window.run_steps(3);
    press(&mut window, Key::Enter);
    window.run_steps(3);
    assert!(Quality::of(window.state().settings()).is_none());
    // The details open, and the resolution while moving is one of them.
    assert!(window.query_by_label("Resolution while moving").is_none());
    window.get_by_label("Custom").click();
    window.run_steps(20);
    // After the views of the tool bar.
    let combo = window.get_all_by_role(Role::ComboBox).nth(1);
    let combo = combo.expect("the first drop-down of the tab");
    combo.click();
    window.run_steps(3);
    window.get_by_label("1/2").click();
    window.run_steps(3);
    assert_eq!(window.state().settings().moving, MovingResolution::Half);
}
