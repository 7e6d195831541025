//! Tests of the program on a display: clipboard, closing, stored settings and fonts.

use crate::harness::{gpu, require};
use crate::window::Xvfb;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Time limit of a step on the slowest machine.
const PATIENCE: Duration = Duration::from_secs(120);

/// The program in its window.
struct Program<'a> {
    xvfb: &'a Xvfb,
    folder: &'a TempDir,
    child: Child,
    /// The window's id, for xdotool.
    id: String,
}

impl<'a> Program<'a> {
    /// Starts the program and waits for its window.
    fn start(xvfb: &'a Xvfb, folder: &'a TempDir) -> Self {
        let stderr = std::fs::File::create(folder.path().join("stderr")).expect("made");
        let mut command = Command::new(env!("CARGO_BIN_EXE_hitscope"));
        let child = xvfb
            .environment(&mut command, folder)
            // Hides zenity and portals from the program.
            .env("PATH", folder.path())
            .env("XDG_DATA_DIRS", folder.path())
            .env_remove("DBUS_SESSION_BUS_ADDRESS")
            .stderr(stderr)
            .spawn()
            .expect("the program starts");
        let mut program = Self {
            xvfb,
            folder,
            child,
            id: String::new(),
        };
        program.id = program.wait("the window", |program| program.find_window("hitscope"));
        program.xdotool(&["windowfocus", &program.id]);
        program
    }

    /// The id of a visible window whose title contains this.
    fn find_window(&self, title: &str) -> Option<String> {
        let found = self.xdotool(&["search", "--onlyvisible", "--name", title]);
        found.lines().next().map(str::to_owned)
    }

    fn xdotool(&self, args: &[&str]) -> String {
        let output = self.tool("xdotool").args(args).output();
        String::from_utf8_lossy(&output.expect("xdotool runs").stdout).into_owned()
    }

    /// Another program on the same display.
    fn tool(&self, name: &str) -> Command {
        let mut command = Command::new(name);
        self.xvfb.environment(&mut command, self.folder);
        command
    }

    /// Polls until there is an answer.
    fn wait<T>(&mut self, what: &str, answer: impl Fn(&Self) -> Option<T>) -> T {
        let start = Instant::now();
        loop {
            if let Some(answer) = answer(self) {
                return answer;
            }
            let ended = self.child.try_wait().expect("a child");
            assert!(ended.is_none(), "{what}: {ended:?}: {}", self.said());
            assert!(start.elapsed() < PATIENCE, "timed out waiting for {what}");
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    /// The program's stderr.
    fn said(&self) -> String {
        std::fs::read_to_string(self.folder.path().join("stderr")).unwrap_or_default()
    }

    /// Quits the program with Ctrl+Q, pressed until the window reacts.
    fn quit(mut self) {
        let start = Instant::now();
        while self.child.try_wait().expect("a child").is_none() && start.elapsed() < PATIENCE {
            self.xdotool(&["windowfocus", &self.id, "key", "ctrl+q"]);
            std::thread::sleep(Duration::from_millis(500));
        }
        self.ends_well("Ctrl+Q");
    }

    /// Waits until the program ends; fails if it ends with an error or a panic.
    fn ends_well(mut self, after: &str) {
        let start = Instant::now();
        let status = loop {
            if let Some(status) = self.child.try_wait().expect("a child") {
                break status;
            }
            assert!(start.elapsed() < PATIENCE, "{after}: still running");
            std::thread::sleep(Duration::from_millis(50));
        };
        let said = self.said();
        assert!(status.success(), "{after}: {status}: {said}");
        assert!(!said.contains("panicked"), "{after}: {said}");
    }
}

impl Drop for Program<'_> {
    fn drop(&mut self) {
        _ = self.child.kill();
        _ = self.child.wait();
    }
}

/// A display and a folder, or `None` if the test is skipped.
fn desktop(tools: &[&str]) -> Option<(Xvfb, TempDir)> {
    gpu()?;
    for tool in tools {
        let is_there = Command::new(tool)
            .arg("-version")
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status()
            .is_ok();
        require(tool, is_there).then_some(())?;
    }
    Some((Xvfb::start()?, tempfile::tempdir().expect("a folder")))
}

/// Copies a text file to the clipboard.
fn copy(program: &Program<'_>, text: &Path) {
    let mut xclip = program.tool("xclip");
    xclip.args(["-selection", "clipboard", "-in"]).arg(text);
    // xclip continues in the background to serve the text.
    let status = xclip.stdout(Stdio::null()).stderr(Stdio::null()).status();
    assert!(status.expect("xclip runs").success());
}

fn pasted(program: &Program<'_>) -> String {
    let mut xclip = program.tool("xclip");
    let output = xclip.args(["-selection", "clipboard", "-out"]).output();
    String::from_utf8_lossy(&output.expect("xclip runs").stdout).into_owned()
}

#[test]
fn a_path_can_be_pasted_and_an_inspection_can_be_copied() {
    let Some((xvfb, folder)) = desktop(&["xclip", "xdotool"]) else {
        return;
    };
    let mesh = folder.path().join("pasted.obj");
    std::fs::write(&mesh, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("written");
    let text = folder.path().join("text");
    std::fs::write(&text, mesh.to_str().expect("UTF-8")).expect("written");
    let mut program = Program::start(&xvfb, &folder);
    copy(&program, &text);
    program.wait("the pasted path's file", |program| {
        // While the field is open, Ctrl+O does nothing.
        for key in ["ctrl+o", "ctrl+a", "ctrl+v", "Return"] {
            program.xdotool(&["key", key]);
            std::thread::sleep(Duration::from_millis(200));
        }
        program.find_window("pasted.obj")
    });
    // The triangle is in the middle of the picture.
    let json = program.wait("the copied inspection", |program| {
        let move_to = ["mousemove", "--window", &program.id, "400", "380"];
        program.xdotool(&[&move_to[..], &["click", "1"]].concat());
        std::thread::sleep(Duration::from_millis(500));
        program.xdotool(&["key", "ctrl+p"]);
        std::thread::sleep(Duration::from_millis(200));
        program.xdotool(&["type", "as json"]);
        program.xdotool(&["key", "Return"]);
        // Closes the palette if the pixel wasn't inspected yet.
        program.xdotool(&["key", "Escape"]);
        std::thread::sleep(Duration::from_millis(200));
        Some(pasted(program)).filter(|text| text.contains("\"pixel\""))
    });
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert!(json["hit"]["t"].is_number(), "{json}");
}

#[test]
fn destroying_the_window_from_outside_ends_the_program_without_error_and_so_does_quitting() {
    let Some((xvfb, folder)) = desktop(&["xdotool"]) else {
        return;
    };
    let program = Program::start(&xvfb, &folder);
    program.xdotool(&["windowclose", &program.id]);
    program.ends_well("windowclose");
    let program = Program::start(&xvfb, &folder);
    program.quit();
}

#[test]
fn bad_stored_settings_do_not_keep_the_window_from_opening() {
    let Some((xvfb, folder)) = desktop(&["xdotool"]) else {
        return;
    };
    let stored = folder.path().join("hitscope");
    std::fs::create_dir(&stored).expect("made");
    let stored = stored.join("app.ron");
    for text in [
        r#"{
            "egui": "(options:(zoom_factor:0.0))",
            "settings": "{\"zoom\":1000.0,\"kernel\":\"none\",\"view\":\"none\",\"panel_width\":-1.0}",
            "window": "(normal_geometry:(outer_position_pixels:Some((x:1e9,y:NaN)),scale_factor:0.0,inner_size_points:(x:NaN,y:inf)),fullscreen:false,maximized:false)",
        }"#,
        "not RON",
    ] {
        std::fs::write(&stored, text).expect("written");
        let mut program = Program::start(&xvfb, &folder);
        let place = program.wait("a place on the display", |program| {
            let place = program.xdotool(&["getwindowgeometry", "--shell", &program.id]);
            place.contains("WIDTH=").then_some(place)
        });
        assert!(place.contains("X=0\nY=0\n"), "{place}");
        program.quit();
        let kept = std::fs::read_to_string(&stored).expect("written at the end");
        assert!(
            kept.contains(r#"\"kernel\":\"exact\""#) && !kept.contains("zoom_factor"),
            "{kept}"
        );
    }
}

/// A system font with letters that egui's own fonts lack.
const ARABIC_FONT: &str = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

#[test]
fn file_names_in_other_scripts_are_drawn_with_system_fonts() {
    let Some((xvfb, folder)) = desktop(&[]) else {
        return;
    };
    if !require(ARABIC_FONT, Path::new(ARABIC_FONT).exists()) {
        return;
    }
    // A bad face shows a warning with the file's name. Without a font both letters are the same box.
    let notes = ["\u{634}", "\u{639}"].map(|letter| {
        let mesh = folder.path().join(format!("{letter}.obj"));
        std::fs::write(&mesh, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 9\n").expect("written");
        let output = folder.path().join("window.png");
        let mut command = Command::new(env!("CARGO_BIN_EXE_hitscope"));
        let command = xvfb.environment(&mut command, &folder).arg(&mesh);
        let status = command.args(["--screenshot", "window.png"]).status();
        assert!(status.expect("the program runs").success());
        let image = image::open(output).expect("a PNG").to_rgba8();
        // The warning is at the top left of the picture.
        image::imageops::crop_imm(&image, 10, 40, 300, 120).to_image()
    });
    assert!(notes[0] != notes[1], "both letters look the same");
}
