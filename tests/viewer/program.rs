//! The program, run in a folder with some meshes and without a display.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// A folder with a good and a bad mesh, in which the program runs.
pub struct Program(TempDir);

impl Program {
    pub fn new() -> Self {
        let program = Self(tempfile::tempdir().expect("a folder"));
        program.write("good.obj", TRIANGLE);
        program.write("bad.obj", "v 0 0 0\nf 1 1 7\n");
        program
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::write(self.path(name), content).expect("written");
    }

    /// The names of all files in the folder, including hidden ones.
    pub fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).expect("a folder");
        let name = |entry: std::io::Result<fs::DirEntry>| {
            let name = entry.expect("an entry").file_name();
            name.into_string().expect("UTF-8")
        };
        let mut names: Vec<String> = entries.map(name).collect();
        names.sort();
        names
    }

    /// The program's command, without arguments.
    pub fn command(&self) -> Command {
        self.in_folder(Path::new(env!("CARGO_BIN_EXE_hitscope")))
    }

    /// Runs the program with arguments that contain no spaces.
    pub fn run(&self, line: &str) -> Output {
        let mut command = self.command();
        command.args(line.split_whitespace());
        command.output().expect("the program runs")
    }

    /// Runs the program with this standard input.
    pub fn run_with_input(&self, line: &str, input: &str) -> Output {
        let mut command = self.command();
        command.args(line.split_whitespace());
        let pipe = command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = pipe.stderr(Stdio::piped()).spawn().expect("it runs");
        let mut stdin = child.stdin.take().expect("piped");
        // The program may end without reading, if it refuses its arguments.
        _ = stdin.write_all(input.as_bytes());
        drop(stdin);
        child.wait_with_output().expect("it ends")
    }

    /// Runs a shell script in which `$hitscope` is the program.
    pub fn shell(&self, script: &str) -> Output {
        let mut shell = self.in_folder(Path::new("sh"));
        shell.args(["-c", script]);
        shell.env("hitscope", env!("CARGO_BIN_EXE_hitscope"));
        shell.output().expect("a shell")
    }

    fn in_folder(&self, program: &Path) -> Command {
        let mut command = Command::new(program);
        command.current_dir(self.0.path());
        for display in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
            command.env_remove(display);
        }
        command
    }
}

pub fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

pub fn stdout(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Checks the exit status, and that stderr is one line that starts with `message`.
#[track_caller]
pub fn assert_fails(output: &Output, status: i32, message: &str) {
    let said = stderr(output);
    assert_eq!(output.status.code(), Some(status), "{said}");
    assert!(said.starts_with(message), "{said}");
    if status == 1 {
        assert_eq!(said.lines().count(), 1, "{said}");
    }
}
