//! The choice of the display server for the window.
//!
//! winit uses the Wayland server that the environment names and fails if it doesn't answer, even if there is an X
//! server. [`DisplayServer::from_env`] checks this beforehand.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

/// The display server to open a window on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DisplayServer {
    /// The server that winit chooses.
    Any,
    /// The X server, because the Wayland server doesn't answer.
    X11 {
        /// The fault of the Wayland server.
        warning: String,
    },
}

/// The environment variables that name display servers.
struct Names {
    wayland_display: Option<OsString>,
    wayland_socket: Option<OsString>,
    runtime_dir: Option<OsString>,
    display: Option<OsString>,
}

impl Names {
    fn from_env() -> Self {
        // As in winit, an empty variable counts as unset.
        let name = |variable| std::env::var_os(variable).filter(|value| !value.is_empty());
        Self {
            wayland_display: name("WAYLAND_DISPLAY"),
            wayland_socket: name("WAYLAND_SOCKET"),
            runtime_dir: name("XDG_RUNTIME_DIR"),
            display: name("DISPLAY"),
        }
    }

    /// The path of the Wayland server's socket; an error if the name is relative and `XDG_RUNTIME_DIR` isn't absolute.
    fn socket(&self, name: &OsStr) -> Result<PathBuf, String> {
        let name = Path::new(name);
        match &self.runtime_dir {
            _ if name.is_absolute() => Ok(name.to_owned()),
            Some(folder) if Path::new(folder).is_absolute() => Ok(Path::new(folder).join(name)),
            _ => Err("XDG_RUNTIME_DIR isn't set to an absolute path".to_owned()),
        }
    }

    /// The fault of the named Wayland server, if there is one.
    fn wayland_fault(&self) -> Option<String> {
        // An inherited socket can't be tested without consuming it.
        if self.wayland_socket.is_some() {
            return None;
        }
        let name = self.wayland_display.as_deref()?;
        let answer = self.socket(name).and_then(|path| connect(&path));
        let fault = answer.err()?;
        Some(format!(
            "WAYLAND_DISPLAY={} can't be used: {fault}",
            name.display()
        ))
    }

    fn choose(&self) -> DisplayServer {
        match (self.wayland_fault(), &self.display) {
            (Some(warning), Some(_)) => DisplayServer::X11 { warning },
            _ => DisplayServer::Any,
        }
    }

    /// Names the servers and explains why none can be used; `reason` is winit's error for the last one.
    fn explain(&self, reason: &str) -> String {
        let wayland = self.wayland_fault();
        let x11 = self.display.as_deref();
        let x11 = x11.map(|name| format!("DISPLAY={} can't be used: {reason}", name.display()));
        match (wayland, x11) {
            (Some(wayland), Some(x11)) => format!("{wayland}; {x11}"),
            (Some(wayland), None) => wayland,
            (None, Some(x11)) if self.wayland_display.is_none() => x11,
            (None, None) if self.wayland_display.is_none() && self.wayland_socket.is_none() => {
                "neither WAYLAND_DISPLAY nor DISPLAY is set".to_owned()
            }
            _ => reason.to_owned(),
        }
    }
}

#[cfg(unix)]
fn connect(path: &Path) -> Result<(), String> {
    let stream = std::os::unix::net::UnixStream::connect(path);
    stream.map(|_| ()).map_err(|error| error.to_string())
}

#[cfg(not(unix))]
fn connect(_path: &Path) -> Result<(), String> {
    Ok(())
}

impl DisplayServer {
    /// The first server in the environment that answers.
    pub fn from_env() -> Self {
        Names::from_env().choose()
    }

    /// A hook that makes winit use this server; `None` if winit chooses.
    #[cfg(all(unix, not(target_os = "macos")))]
    pub fn event_loop_builder(&self) -> Option<eframe::EventLoopBuilderHook> {
        use winit::platform::x11::EventLoopBuilderExtX11 as _;
        matches!(self, Self::X11 { .. }).then(|| -> eframe::EventLoopBuilderHook {
            Box::new(|builder| {
                builder.with_x11();
            })
        })
    }

    /// A hook that makes winit use this server; `None` if winit chooses.
    #[cfg(not(all(unix, not(target_os = "macos"))))]
    pub fn event_loop_builder(&self) -> Option<eframe::EventLoopBuilderHook> {
        None
    }
}

/// Explains why no window could be opened.
pub fn explain(error: &eframe::Error) -> String {
    match error {
        eframe::Error::WinitEventLoop(error) => {
            Names::from_env().explain(without_source_location(&error.to_string()))
        }
        error => error.to_string(),
    }
}

/// winit's message without its prefix “os error at src/x.rs:123: ”.
fn without_source_location(message: &str) -> &str {
    let place = message.rsplit_once(".rs:");
    place
        .and_then(|(_, rest)| rest.split_once(": "))
        .map_or(message, |(_, reason)| reason)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::net::UnixListener;

    fn names(wayland_display: Option<&OsStr>, display: Option<&str>) -> Names {
        Names {
            wayland_display: wayland_display.map(OsStr::to_owned),
            wayland_socket: None,
            runtime_dir: Some("/nonexistent".into()),
            display: display.map(OsString::from),
        }
    }

    #[test]
    fn a_wayland_server_that_answers_is_used() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("wayland-7");
        let server = UnixListener::bind(&path).expect("a socket");
        let mut names = names(Some(path.as_os_str()), Some(":1"));
        assert_eq!(names.choose(), DisplayServer::Any);
        names.wayland_display = Some("wayland-7".into());
        names.runtime_dir = Some(folder.path().into());
        assert_eq!(names.choose(), DisplayServer::Any);
        // The socket of a killed server refuses connections.
        drop(server);
        let DisplayServer::X11 { warning } = names.choose() else {
            panic!("no server answers");
        };
        assert!(
            warning.starts_with("WAYLAND_DISPLAY=wayland-7 can't be used: "),
            "{warning}"
        );
    }

    #[test]
    fn without_an_x_server_winit_chooses_and_the_message_names_the_servers() {
        let dead = OsStr::new("wayland-7");
        assert_eq!(names(Some(dead), None).choose(), DisplayServer::Any);
        assert_eq!(names(None, Some(":1")).choose(), DisplayServer::Any);
        for (wayland, display, expected) in [
            (None, None, "neither WAYLAND_DISPLAY nor DISPLAY is set"),
            (None, Some(":1"), "DISPLAY=:1 can't be used: no answer"),
        ] {
            assert_eq!(names(wayland, display).explain("no answer"), expected);
        }
        let both = names(Some(dead), Some(":1")).explain("no answer");
        assert!(
            both.starts_with("WAYLAND_DISPLAY=wayland-7 can't be used: "),
            "{both}"
        );
        assert!(
            both.ends_with("; DISPLAY=:1 can't be used: no answer"),
            "{both}"
        );
        let relative = Names {
            runtime_dir: None,
            ..names(Some(dead), None)
        };
        assert_eq!(
            relative.explain(""),
            "WAYLAND_DISPLAY=wayland-7 can't be used: XDG_RUNTIME_DIR isn't set to an absolute path"
        );
    }

    #[test]
    fn winits_source_location_is_removed_from_messages() {
        let message = "os error at /home/x/winit-0.30/src/mod.rs:787: Failed to open connection";
        assert_eq!(
            without_source_location(message),
            "Failed to open connection"
        );
        assert_eq!(without_source_location("no place"), "no place");
    }
}
