//! The commands of a frame: rows of the table, and rows made from other tables.

use super::{Command, Menu, OTHER_TABLES, Place, all};
use crate::app::App;
use egui::KeyboardShortcut;
use std::borrow::Cow;
use std::cell::RefCell;
use std::rc::Rc;

/// What a command does to the app.
type Run = dyn Fn(&mut App, &egui::Context, &eframe::Frame);

/// A command with its state in this frame.
#[derive(Clone)]
pub struct Entry {
    /// The row of the table; `None` for an entry made from another table.
    pub row: Option<&'static Command>,
    /// The title on buttons and in menus.
    pub title: Cow<'static, str>,
    /// The effect, without the keys.
    pub tooltip: Cow<'static, str>,
    /// The place in the menu bar.
    pub place: Place,
    /// Whether it is on, for one that turns something on and off or chooses one of several.
    pub is_on: Option<bool>,
    /// Why it can't be run now; `None` if it can.
    pub obstacle: Option<&'static str>,
    run: Rc<Run>,
}

impl Entry {
    /// A row of the table in the app's current state.
    pub fn of(row: &'static Command, app: &App) -> Self {
        Self {
            row: Some(row),
            title: row.title.into(),
            tooltip: row.tooltip.into(),
            place: row.place,
            is_on: row.is_on.map(|is_on| is_on(app)),
            obstacle: (row.obstacle)(app),
            run: Rc::new(row.run),
        }
    }

    /// An entry that opens something; it is neither on nor off.
    pub fn action(
        place: Place,
        title: impl Into<Cow<'static, str>>,
        tooltip: impl Into<Cow<'static, str>>,
        run: impl Fn(&mut App, &egui::Context) + 'static,
    ) -> Self {
        Self {
            row: None,
            title: title.into(),
            tooltip: tooltip.into(),
            place,
            is_on: None,
            obstacle: None,
            run: Rc::new(
                move |app: &mut App, ctx: &egui::Context, _: &eframe::Frame| {
                    run(app, ctx);
                },
            ),
        }
    }

    /// An entry that chooses one of several values, or turns something on and off.
    pub fn choice(
        place: Place,
        title: impl Into<Cow<'static, str>>,
        tooltip: impl Into<Cow<'static, str>>,
        is_on: bool,
        run: impl Fn(&mut App, &egui::Context) + 'static,
    ) -> Self {
        Self {
            is_on: Some(is_on),
            ..Self::action(place, title, tooltip, run)
        }
    }

    /// The keys.
    pub fn keys(&self) -> &'static [KeyboardShortcut] {
        self.row.map_or(&[], |row| row.keys)
    }

    /// Whether it can be run now.
    pub fn is_enabled(&self) -> bool {
        self.obstacle.is_none()
    }

    /// The title after that of its menu, such as `View: Normal`.
    pub fn full_title(&self) -> String {
        format!("{}: {}", self.place.title(), self.title)
    }

    /// Runs the command, or shows why it can't be run.
    pub fn run(&self, app: &mut App, ctx: &egui::Context, frame: &eframe::Frame) {
        match self.row {
            Some(row) if !self.is_enabled() => app.refuse_command(row.obstacle),
            _ => (self.run)(app, ctx, frame),
        }
        ctx.request_repaint();
    }
}

/// All commands in their current state, and those that the user chooses in this frame.
pub struct Commands {
    entries: Vec<Entry>,
    chosen: RefCell<Vec<Entry>>,
}

impl Commands {
    /// The commands in the app's current state.
    pub fn of(app: &App) -> Self {
        let rows = all().map(|row| Entry::of(row, app));
        let others = OTHER_TABLES.iter().flat_map(|table| table(app));
        Self {
            entries: rows.chain(others).collect(),
            chosen: RefCell::default(),
        }
    }

    /// All commands: the table's, then those of other tables.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// The table's command of this name.
    ///
    /// # Panics
    /// If there is none.
    pub fn named(&self, name: &str) -> &Entry {
        let has_name = |entry: &&Entry| entry.row.is_some_and(|row| row.name == name);
        let found = self.entries.iter().find(has_name);
        found.unwrap_or_else(|| panic!("no command is called {name}"))
    }

    /// The commands at a place of the menu bar.
    pub fn at(&self, place: Place) -> impl Iterator<Item = &Entry> {
        self.entries
            .iter()
            .filter(move |entry| entry.place == place)
    }

    /// The commands of a menu.
    pub(super) fn of_menu(&self, menu: Menu) -> impl Iterator<Item = &Entry> {
        let entries = self.entries.iter();
        entries.filter(move |entry| entry.place.menu == menu)
    }

    /// Runs a command at the end of the frame.
    pub fn choose(&self, entry: &Entry) {
        self.chosen.borrow_mut().push(entry.clone());
    }

    /// The commands to run.
    pub fn into_chosen(self) -> Vec<Entry> {
        self.chosen.into_inner()
    }
}
