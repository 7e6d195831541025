//! A temporary folder with a mesh, and helpers that run commands in it.

use clap::{Args, Parser};
use hitscope_lab::commands::{CommandError, TraceArgs};
use serde_json::Value;
use std::path::PathBuf;
use tempfile::TempDir;

/// A unit cube at the origin as six quads; the front one has a group and a material.
pub const CUBE: &str = "\
v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1
f 4 3 2 1\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\ng front\nusemtl red\nf 5 6 7 8\n";

#[derive(Parser)]
struct Cli<A: Args> {
    #[command(flatten)]
    args: A,
}

/// A temporary folder with `cube.obj` and files of the test.
pub struct Folder(TempDir);

impl Folder {
    pub fn new() -> Self {
        let folder = Self(tempfile::tempdir().expect("a folder"));
        folder.write("cube.obj", CUBE);
        folder
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, text: &str) -> PathBuf {
        let path = self.path(name);
        std::fs::write(&path, text).expect("written");
        path
    }

    /// Parses a command line in which `@name` stands for a file of this folder.
    pub fn args<A: Args>(&self, line: &str) -> A {
        let word = |word: &str| match word.strip_prefix('@') {
            Some(name) => self.0.path().join(name).into_os_string(),
            None => word.into(),
        };
        let words = std::iter::once("hitscope".into()).chain(line.split_whitespace().map(word));
        Cli::parse_from(words).args
    }

    pub fn trace(&self, options: &str, rays: &str) -> Vec<Value> {
        self.write("rays.txt", rays);
        let args: TraceArgs = self.args(&format!("@cube.obj --rays @rays.txt {options}"));
        let mut out = Vec::new();
        args.run(&mut out).expect("traced");
        let text = String::from_utf8(out).expect("UTF-8");
        text.lines()
            .map(|line| serde_json::from_str(line).expect("JSON"))
            .collect()
    }

    /// The output of a command.
    pub fn text(
        &self,
        run: impl FnOnce(&Self, &mut Vec<u8>) -> Result<(), CommandError>,
    ) -> String {
        let mut out = Vec::new();
        run(self, &mut out).expect("done");
        String::from_utf8(out).expect("UTF-8")
    }

    pub fn json(&self, run: impl FnOnce(&Self, &mut Vec<u8>) -> Result<(), CommandError>) -> Value {
        let mut out = Vec::new();
        run(self, &mut out).expect("done");
        serde_json::from_slice(&out).expect("JSON")
    }
}
