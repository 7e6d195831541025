//! Tests of `trace` on a pipe.

use serde_json::Value;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

const PLANE: &str = "v -2 -2 0\nv 4 -2 0\nv -2 4 0\nf 1 2 3\n";
/// Time limit for an answer, so that a program that doesn't answer fails instead of hanging.
const TIMEOUT: Duration = Duration::from_secs(300);

/// A dialogue with `hitscope trace` over pipes.
struct Talk {
    child: Child,
    input: ChildStdin,
    answers: Receiver<String>,
    _folder: tempfile::TempDir,
}

impl Talk {
    fn begin(options: &[&str]) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let mesh = folder.path().join("plane.obj");
        std::fs::write(&mesh, PLANE).expect("written");
        let mut child = Command::new(env!("CARGO_BIN_EXE_hitscope"))
            .arg("trace")
            .arg(mesh)
            .args(["--rays", "-"])
            .args(options)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the program runs");
        let (sender, answers) = channel();
        let output = BufReader::new(child.stdout.take().expect("piped"));
        std::thread::spawn(move || {
            output
                .lines()
                .map_while(Result::ok)
                .try_for_each(|line| sender.send(line))
        });
        Self {
            input: child.stdin.take().expect("piped"),
            child,
            answers,
            _folder: folder,
        }
    }

    fn say(&mut self, bytes: &[u8]) {
        self.input.write_all(bytes).expect("it listens");
        self.input.flush().expect("it listens");
    }

    fn answer(&self) -> Value {
        let line = self.answers.recv_timeout(TIMEOUT).expect("an answer");
        serde_json::from_str(&line).expect("JSON")
    }

    /// Closes the input. Returns the remaining answers.
    fn end(mut self) -> Vec<String> {
        drop(self.input);
        assert!(self.child.wait().expect("it ends").success());
        self.answers.iter().collect()
    }
}

#[test]
fn each_ray_is_answered_without_waiting_for_more_input() {
    let mut talk = Talk::begin(&[]);
    for k in 1..=50 {
        talk.say(format!("0.25 0.5 {k} 0 0 -1\n").as_bytes());
        let answer = talk.answer();
        assert_eq!(
            (&answer["t"], &answer["line"]),
            (&f64::from(k).into(), &k.into())
        );
    }
    // A line in two halves, several lines at once, and a line that ends with CR only.
    talk.say(b"0.25 0.5 7 0");
    talk.say(b" 0 -1\n0 0 1 0 0 1\r");
    assert_eq!(talk.answer()["t"], 7.0);
    assert_eq!(talk.answer()["hit"], false);
    // A last line without a line end.
    talk.say(b"0.25 0.5 9 0 0 -1");
    let rest = talk.end();
    assert!(rest.len() == 1 && rest[0].contains("\"t\":9.0"), "{rest:?}");
}

#[test]
fn a_line_that_is_too_long_is_refused_before_it_ends() {
    let mut talk = Talk::begin(&[]);
    talk.say(&[b'7'; 1 << 17]);
    let answer = talk.answer();
    assert_eq!(answer["error"], "the line is longer than 65536 bytes");
    assert_eq!(answer["line"], 1);
    talk.say(&[b'7'; 1 << 17]);
    talk.say(b"\n0.25 0.5 3 0 0 -1\n");
    let answer = talk.answer();
    assert_eq!((&answer["t"], &answer["line"]), (&3.0.into(), &2.into()));
    assert!(talk.end().is_empty());
}

#[test]
fn a_large_input_is_answered_completely_and_in_order() {
    let mut talk = Talk::begin(&["--threads", "2"]);
    let count = 200_000;
    let rays: String = (0..count)
        .map(|k| format!("0.25 0.5 {} 0 0 -1\n", k % 1000 + 1))
        .collect();
    talk.say(rays.as_bytes());
    let lines = talk.end();
    assert_eq!(lines.len(), count);
    for (k, line) in lines.iter().enumerate() {
        assert!(
            line.starts_with(&format!("{{\"hit\":true,\"t\":{}.0,", k % 1000 + 1)),
            "{line}"
        );
        assert!(line.contains(&format!("\"line\":{},", k + 1)), "{line}");
    }
}
