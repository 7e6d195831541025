//! Man pages, shell completions, and the files that tie the program to a desktop.

use crate::program::{Program, stdout};
use hitscope::about;
use hitscope::storage::APP_ID;
use std::fs;
use std::path::{Path, PathBuf};

/// The commands that `--help` lists.
fn commands(program: &Program) -> Vec<String> {
    let help = stdout(&program.run("--help"));
    let lines = help.lines().skip_while(|line| *line != "Commands:");
    let lines = lines.skip(1).take_while(|line| !line.is_empty());
    // Further lines of a description are indented more.
    let firsts = lines.filter_map(|line| line.strip_prefix("  "));
    let firsts = firsts.filter(|line| !line.starts_with(' '));
    let names = firsts.filter_map(|line| line.split_whitespace().next());
    let names: Vec<String> = names
        .filter(|name| *name != "help")
        .map(str::to_owned)
        .collect();
    assert!(names.contains(&"render".to_owned()), "{help}");
    names
}

/// A file of the repository.
fn file(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

fn linux(name: &str) -> String {
    fs::read_to_string(file("packaging/linux").join(name)).expect("readable")
}

/// The value of a key of a desktop file.
fn value<'a>(text: &'a str, key: &str) -> &'a str {
    let mut lines = text.lines();
    let value = lines.find_map(|line| line.strip_prefix(key)?.strip_prefix('='));
    value.unwrap_or_else(|| panic!("{key} in {text}"))
}

#[test]
fn every_command_has_a_man_page_and_the_main_page_lists_it() {
    let program = Program::new();
    assert!(program.run("man --out pages/man1").status.success());
    let main = fs::read_to_string(program.path("pages/man1/hitscope.1")).expect("a page");
    assert!(main == stdout(&program.run("man")), "{main}");
    let commands = commands(&program);
    for command in &commands {
        let page = program.path(&format!("pages/man1/hitscope-{command}.1"));
        let page = fs::read_to_string(page).expect("a page");
        let head = format!(".TH HITSCOPE-{} 1 \"\" ", command.to_uppercase());
        assert!(page.contains(&head), "{page}");
        assert!(
            page.contains(&format!(r"hitscope\-{command} \- ")),
            "{page}"
        );
        assert!(main.contains(&format!(r"hitscope\-{command}(1)")), "{main}");
        // Each option of the help is in the page; a line of the help begins with the option.
        let help = stdout(&program.run(&format!("{command} --help")));
        for line in help.lines() {
            let words = line.split_whitespace();
            let mut names = words.take_while(|word| word.starts_with('-'));
            let Some(option) = names.find(|word| word.starts_with("--")) else {
                continue;
            };
            let is_of_name = |c: &char| *c == '-' || c.is_alphanumeric();
            let name: String = option.chars().take_while(is_of_name).collect();
            assert!(page.contains(&name.replace('-', r"\-")), "{name}: {page}");
        }
    }
    let pages = fs::read_dir(program.path("pages/man1")).expect("a folder");
    assert_eq!(
        pages.count(),
        commands.len() + 1,
        "a page of a hidden command"
    );
}

#[test]
fn the_completions_of_every_shell_have_every_command_and_option() {
    let program = Program::new();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = stdout(&program.run(&format!("completions {shell}")));
        for command in commands(&program) {
            assert!(script.contains(&command), "{shell}: {command}");
        }
        for word in ["wireframe", "max-memory", "smooth"] {
            assert!(script.contains(word), "{shell}: {word}");
        }
    }
    assert_eq!(program.run("completions csh").status.code(), Some(2));
}

#[test]
fn the_desktop_file_starts_the_program_and_belongs_to_its_window() {
    let desktop = linux("hitscope.desktop");
    assert_eq!(value(&desktop, "Exec"), format!("{} %f", about::NAME));
    assert_eq!(value(&desktop, "Name"), about::NAME);
    // X11 finds the file by the window's class, Wayland by its own name; both are the window's id.
    assert_eq!(value(&desktop, "StartupWMClass"), APP_ID);
    assert!(file(&format!("packaging/linux/{APP_ID}.desktop")).exists());
    let session = format!("application/x-{}-session", about::NAME);
    let types = value(&desktop, "MimeType");
    assert_eq!(types, format!("model/obj;{session};"));
    assert_eq!(
        value(&linux("hitscope.thumbnailer"), "MimeType"),
        "model/obj;"
    );
    let mime_types = linux("hitscope.xml");
    for known in types.split_terminator(';') {
        let definition = format!("<mime-type type=\"{known}\">");
        assert!(mime_types.contains(&definition), "{known}");
    }
    let pattern = format!("<glob pattern=\"*.{}\"/>", hitscope::session::EXTENSION);
    assert!(mime_types.contains(&pattern));
}

#[test]
fn the_appstream_data_describes_this_release() {
    let data = linux("io.github.hitscope.hitscope.metainfo.xml");
    for element in [
        format!("<release version=\"{}\" ", about::VERSION),
        format!("<project_license>{}</project_license>", about::LICENCE),
        format!("<launchable type=\"desktop-id\">{APP_ID}.desktop</launchable>"),
    ] {
        assert!(data.contains(&element), "{element}");
    }
}

#[test]
fn the_thumbnailer_draws_a_thumbnail_of_a_mesh_with_bad_faces() {
    let program = Program::new();
    program.write("bad.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 7\n");
    let thumbnailer = linux("hitscope.thumbnailer");
    let line = value(&thumbnailer, "Exec").strip_prefix("hitscope ");
    let line = line.expect("the program").replace("%i", "bad.obj");
    let line = line.replace("%o", "thumbnail.png").replace("%s", "48");
    assert!(program.run(&line).status.success());
    let picture = image::open(program.path("thumbnail.png")).expect("a picture");
    assert_eq!([picture.width(), picture.height()], [48; 2]);
}

#[test]
fn the_icons_have_the_sizes_in_their_names() {
    for size in [16, 24, 32, 48, 64, 128, 256, 512] {
        let icon = file(&format!("assets/icon/hitscope-{size}.png"));
        let icon = image::open(icon).expect("a picture");
        assert_eq!([icon.width(), icon.height()], [size; 2]);
    }
}
