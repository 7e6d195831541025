//! Tests of commands by key, tool bar, menu and palette, and of the help sheet.

use crate::harness::{Window, app, bare, click, in_picture, press, wait};
use crate::pointer::on_the_knot;
use egui::accesskit::{Role, Toggled};
use egui::{Key, Modifiers, ThemePreference};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use glam::UVec2;
use hitscope::about;
use hitscope::app::App;
use hitscope::command::{self, Command, keys, tool_bar};
use hitscope::overlay::grid::GRID;
use hitscope::overlay::wireframe::WIREFRAME;
use hitscope_core::camera::{StandardView, Turntable, UpAxis};

type State = fn(&App) -> bool;

/// Commands that turn something on and off, and are off in a window without its side panel.
const TOGGLES: [(&str, Key, State); 6] = [
    ("Smooth shading", Key::S, |app| app.settings().is_smooth),
    ("Wireframe", Key::W, |app| {
        app.settings().overlays.is_on(&WIREFRAME)
    }),
    ("Normals", Key::N, |app| app.settings().shows_normals()),
    ("Orthographic", Key::Num5, |app| {
        app.turntable().is_orthographic
    }),
    ("Auto-rotation", Key::T, App::is_rotating),
    ("Pause", Key::P, App::is_paused),
];

/// The command with this title.
fn titled(title: &str) -> &'static Command {
    let found = command::all().find(|command| command.title == title);
    found.unwrap_or_else(|| panic!("no command {title}"))
}

/// Opens a menu of the menu bar.
pub fn open_menu(window: &mut Window, title: &str) {
    window.get_by_role_and_label(Role::Button, title).click();
    window.run_steps(4);
}

/// Opens the palette and types a query.
fn search(window: &mut Window, query: &str) {
    window.key_press_modifiers(Modifiers::COMMAND, Key::P);
    window.run_steps(4);
    let field = window.get_by_label("Find a command");
    assert!(field.is_focused());
    field.type_text(query);
    window.run_steps(3);
}

fn shows_wireframe(window: &Window) -> bool {
    window.state().settings().overlays.is_on(&WIREFRAME)
}

/// Whether the palette shows a command.
fn lists(window: &Window, title: &str) -> bool {
    let row = window.query_by_role_and_label(Role::ListBoxOption, title);
    row.is_some()
}

#[test]
fn every_toggle_of_the_tool_bar_works_by_button_and_by_key() {
    let Some(mut window) = bare() else { return };
    for (title, key, is_on) in TOGGLES {
        assert!(tool_bar::names().any(|name| name == titled(title).name));
        assert!(!is_on(window.state()), "{title}");
        window.get_by_label(title).click();
        window.run_steps(2);
        assert!(is_on(window.state()), "{title} by its button");
        press(&mut window, key);
        assert!(!is_on(window.state()), "{title} by its key");
    }
}

#[test]
fn menus_show_the_state_of_toggles_and_change_it() {
    let Some(mut window) = bare() else { return };
    for (title, _, is_on) in TOGGLES {
        let menu = titled(title).place.menu.title();
        for on in [true, false] {
            open_menu(&mut window, menu);
            let entry = window.get_by_role_and_label(Role::MenuItemCheckBox, title);
            let shown = entry.accesskit_node().toggled();
            assert_eq!(shown, Some(Toggled::from(!on)), "{title}");
            entry.click();
            window.run_steps(4);
            assert_eq!(is_on(window.state()), on, "{title} by its menu entry");
            let entry = window.query_by_role_and_label(Role::MenuItemCheckBox, title);
            assert!(entry.is_none(), "the menu stays open");
        }
    }
}

#[test]
fn a_command_that_cannot_be_run_is_disabled_in_its_menu_and_its_key_says_why() {
    let Some(mut window) = bare() else { return };
    open_menu(&mut window, "File");
    let reload = window.get_by_role_and_label(Role::MenuItem, "Reload");
    assert!(reload.accesskit_node().is_disabled());
    press(&mut window, Key::Escape);
    window.run_steps(3);
    assert!(
        window
            .query_by_role_and_label(Role::MenuItem, "Reload")
            .is_none()
    );
    press(&mut window, Key::F5);
    let notice = window.state().notice().expect("a reason");
    assert!(notice.contains("built-in scene"), "{notice}");
    press(&mut window, Key::Escape);
    press(&mut window, Key::CloseBracket);
    let notice = window.state().notice().expect("a reason");
    assert!(notice.contains("No pixel is picked"), "{notice}");
}

#[test]
fn keys_show_the_next_and_the_previous_view() {
    let Some(mut window) = bare() else { return };
    let view = |window: &Window| window.state().settings().view().name;
    let first = view(&window);
    press(&mut window, Key::V);
    assert_ne!(view(&window), first);
    let back = |window: &mut Window| {
        window.key_press_modifiers(Modifiers::SHIFT, Key::V);
        window.run_steps(2);
    };
    back(&mut window);
    assert_eq!(view(&window), first);
    back(&mut window);
    press(&mut window, Key::V);
    assert_eq!(view(&window), first);
}

#[test]
fn a_message_about_an_obstacle_disappears_with_the_obstacle() {
    let Some(mut window) = bare() else { return };
    press(&mut window, Key::X);
    let notice = window.state().notice().expect("a reason");
    assert!(notice.contains("Nothing is compared"), "{notice}");
    window.run_steps(3);
    assert!(window.state().notice().is_some());
    press(&mut window, Key::C);
    window.run_steps(2);
    assert_eq!(window.state().notice(), None);
}

#[test]
fn the_palette_finds_a_command_by_a_part_of_its_title_and_enter_runs_it() {
    let Some(mut window) = bare() else { return };
    search(&mut window, "wire");
    assert!(lists(&window, "View: Wireframe"));
    assert!(!lists(&window, "File: Open…"));
    press(&mut window, Key::Enter);
    assert!(shows_wireframe(&window));
    assert!(window.query_by_label("Find a command").is_none());
    // The next key is for the window again.
    press(&mut window, Key::W);
    assert!(!shows_wireframe(&window));
}

#[test]
fn the_palette_lists_views_overlays_kernels_tabs_and_themes_and_arrows_choose_one() {
    let Some(mut window) = bare() else { return };
    search(&mut window, "theme");
    assert!(lists(&window, "Theme: Dark") && lists(&window, "Theme: System"));
    press(&mut window, Key::ArrowDown);
    press(&mut window, Key::Enter);
    window.run_steps(3);
    let theme = window.state().preferences().theme;
    assert_eq!(theme, ThemePreference::Light);
    search(&mut window, "view barycentric error");
    press(&mut window, Key::Enter);
    assert_eq!(window.state().settings().view, "error-barycentric");
    search(&mut window, "overlay grid");
    press(&mut window, Key::Enter);
    assert!(window.state().settings().overlays.is_on(&GRID));
    search(&mut window, "kernel precise");
    press(&mut window, Key::Enter);
    let kernel = window.state().settings().kernel();
    assert_eq!(kernel.info.short_name(), "precise");
    search(&mut window, "tab mesh");
    press(&mut window, Key::Enter);
    wait(&mut window, "the tab", |app| app.preferences().shows_panel);
    window.run_steps(20);
    window.get_by_label("Flaws");
}

#[test]
fn escape_closes_the_palette_alone_and_a_disabled_command_is_not_run() {
    let Some(mut window) = app(None) else { return };
    let corner = in_picture(&window, 0.01, 0.01);
    click(&mut window, corner);
    wait(&mut window, "the pick", |app| app.inspection().is_some());
    // The ray hits nothing.
    search(&mut window, "frame pick");
    let row = window.get_by_role_and_label(Role::ListBoxOption, "Camera: Frame pick");
    assert!(row.accesskit_node().is_disabled());
    let before = *window.state().turntable();
    press(&mut window, Key::Enter);
    assert!(lists(&window, "Camera: Frame pick"));
    press(&mut window, Key::Escape);
    window.run_steps(2);
    assert!(window.query_by_label("Find a command").is_none());
    assert!(window.state().inspection().is_some());
    assert_eq!(*window.state().turntable(), before);
    press(&mut window, Key::Escape);
    assert!(window.state().inspection().is_none());
}

#[test]
fn help_lists_every_key_and_every_use_of_the_mouse() {
    let Some(mut window) = bare() else { return };
    press(&mut window, Key::H);
    window.run_steps(2);
    let ctx = window.ctx.clone();
    let with_keys = || command::all().filter(|command| !command.keys.is_empty());
    assert!(with_keys().count() > 20);
    for command in with_keys() {
        window.get_by_label(command.tooltip);
        let keys = keys::key_text(command.keys, &ctx);
        window.get_by_label(&keys);
    }
    for (pointer, about) in window.state().preferences().navigation.help() {
        window.get_by_label(&pointer);
        window.get_by_label(about);
    }
    let open = titled("Open…").tooltip;
    press(&mut window, Key::Escape);
    assert!(window.query_by_label(open).is_none());
    press(&mut window, Key::Questionmark);
    window.run_steps(2);
    window.get_by_label(open);
}

#[test]
fn about_shows_the_version_and_the_graphics_adapter() {
    let Some(mut window) = bare() else { return };
    open_menu(&mut window, "Help");
    let about = window.get_by_role_and_label(Role::MenuItem, "About hitscope");
    about.click();
    window.run_steps(4);
    window.get_by_label(about::version_and_target());
    let adapter = crate::harness::gpu()
        .expect("there is one")
        .adapter
        .get_info();
    window.get_by_label_contains(&adapter.name);
    press(&mut window, Key::Escape);
    assert!(window.query_by_label("Graphics adapter").is_none());
}

#[test]
fn tooltips_end_in_the_key() {
    let Some(mut window) = bare() else { return };
    for (title, keys) in [("Wireframe", "(W or E)"), ("Open…", "(Ctrl+O)")] {
        let button = window.get_by_role_and_label(Role::Button, title);
        let about = button
            .accesskit_node()
            .data()
            .description()
            .map(str::to_owned);
        let about = about.expect("a tooltip");
        let tooltip = titled(title).tooltip;
        assert_eq!(about, format!("{tooltip} {keys}"));
        button.hover();
        window.run_steps(60);
        window.get_by_label(&about);
    }
}

#[test]
fn the_menu_bar_sets_the_up_axis_and_ctrl_z_undoes_it() {
    let Some(mut window) = bare() else { return };
    for (title, axis) in [("Z up", UpAxis::Z), ("Y up", UpAxis::Y)] {
        open_menu(&mut window, "Camera");
        let entry = window.get_by_role_and_label(Role::MenuItemCheckBox, title);
        entry.click();
        window.run_steps(4);
        assert_eq!(window.state().turntable().up_axis, axis);
    }
    for (key, axis) in [
        (Key::Z, UpAxis::Z),
        (Key::Z, UpAxis::Y),
        (Key::Y, UpAxis::Z),
    ] {
        window.key_press_modifiers(Modifiers::COMMAND, key);
        window.run_steps(3);
        assert_eq!(window.state().turntable().up_axis, axis);
    }
}

#[test]
fn the_picked_triangle_can_be_framed_and_the_first_view_comes_back() {
    let Some(mut window) = app(None) else { return };
    // For the picture's final size.
    window.key_press_modifiers(Modifiers::SHIFT, Key::Home);
    window.run_steps(3);
    let first = *window.state().turntable();
    let (x, y) = on_the_knot(&window);
    let at = in_picture(&window, x, y);
    click(&mut window, at);
    wait(&mut window, "the pick", |app| app.inspection().is_some());
    press(&mut window, Key::Period);
    let app = window.state();
    let framed = *app.turntable();
    let hit = app.inspection().and_then(|found| found.hit.clone());
    let primitive = hit.expect("a hit").primitive;
    let scene = &app.document().loaded.scene;
    let corners = scene.corners(primitive).expect("a triangle");
    let camera = framed.camera(app.film().size());
    let size = app.film().size().as_dvec2();
    for corner in corners {
        let pixel = camera.pixel_of(corner.as_dvec3()).expect("in front");
        let is_inside = pixel.cmpge(glam::DVec2::ZERO).all() && pixel.cmple(size).all();
        assert!(is_inside, "{pixel} of {size}");
    }
    assert!(framed.distance < 0.5 * first.distance);
    // The wheel still reaches the whole scene.
    let mut far = framed;
    far.zoom(1e3, framed.pivot);
    assert!(far.distance > first.distance);

    window.key_press_modifiers(Modifiers::SHIFT, Key::Home);
    window.run_steps(3);
    let place = |turntable: &Turntable| turntable.camera(UVec2::new(8, 8));
    assert_eq!(place(window.state().turntable()), place(&first));
    let mut front = first;
    front.look_from(StandardView::Front);
    press(&mut window, Key::Num1);
    assert_eq!(place(window.state().turntable()), place(&front));
}

#[test]
fn the_tool_bar_and_the_menu_bar_fit_a_small_window_and_long_menus_scroll() {
    let Some(mut window) = bare() else { return };
    // 800 × 600 pixels at a scale of 200 %.
    window.set_size(egui::vec2(400.0, 300.0));
    window.run_steps(4);
    let inside = egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(400.0, 300.0));
    for title in ["File", "Edit", "View", "Camera", "Pick", "Window", "Help"] {
        let rect = window.get_by_role_and_label(Role::Button, title).rect();
        assert!(inside.contains_rect(rect), "{title}: {rect}");
    }
    for name in tool_bar::names() {
        let command = command::all().find(|command| command.name == name);
        let title = command.expect("in the table").title;
        let rect = window.get_by_label(title).rect();
        assert!(inside.contains_rect(rect), "{title}: {rect}");
    }
    let picture = window.get_by_label("Rendered picture").rect();
    assert!(picture.height() > 100.0, "{picture}");
    // So low that the last entry is below the window's edge.
    window.set_size(egui::vec2(400.0, 180.0));
    window.run_steps(4);
    let inside = egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(400.0, 180.0));
    open_menu(&mut window, "View");
    let kernel = || window.get_by_role_and_label(Role::Button, "Kernel");
    assert!(!inside.contains_rect(kernel().rect()));
    kernel().scroll_to_me();
    window.run_steps(20);
    let rect = window.get_by_role_and_label(Role::Button, "Kernel").rect();
    assert!(inside.contains_rect(rect), "{rect}");
}
