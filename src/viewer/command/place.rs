//! Menus, and the places of commands in them.

/// A menu of the menu bar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Menu {
    /// Opening, reloading and saving files.
    File,
    /// Undo and redo; the clipboard; cancelling.
    Edit,
    /// The picture and its overlay.
    View,
    /// The camera.
    Camera,
    /// The picked pixel.
    Pick,
    /// The window's parts and looks.
    Window,
    /// Finding commands; facts about the program.
    Help,
}

impl Menu {
    /// All menus, from left to right.
    pub const ALL: [Self; 7] = [
        Self::File,
        Self::Edit,
        Self::View,
        Self::Camera,
        Self::Pick,
        Self::Window,
        Self::Help,
    ];

    /// The title in the menu bar.
    pub fn title(self) -> &'static str {
        match self {
            Self::File => "File",
            Self::Edit => "Edit",
            Self::View => "View",
            Self::Camera => "Camera",
            Self::Pick => "Pick",
            Self::Window => "Window",
            Self::Help => "Help",
        }
    }
}

/// The place of a command in the menu bar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// The menu.
    pub menu: Menu,
    /// The part of the menu, from the top; lines separate the parts.
    pub section: u8,
    /// The submenu, if it is in one.
    pub submenu: Option<&'static str>,
}

impl Place {
    /// A section of a menu.
    pub const fn new(menu: Menu, section: u8) -> Self {
        Self {
            menu,
            section,
            submenu: None,
        }
    }

    /// A submenu in a section.
    pub const fn submenu(menu: Menu, section: u8, title: &'static str) -> Self {
        Self {
            menu,
            section,
            submenu: Some(title),
        }
    }

    /// The title of the innermost menu.
    pub fn title(self) -> &'static str {
        self.submenu.unwrap_or_else(|| self.menu.title())
    }
}
