//! Buttons and check boxes of commands. Their tooltips end in the keys.

use super::keys::key_text;
use super::{Commands, Entry};
use egui::accesskit::Role;
use egui::{Atom, Button, Checkbox, Response, Shape, Stroke, WidgetInfo, vec2};

/// Width and height of a check mark in a menu, in points.
const CHECK_MARK: f32 = 10.0;

impl Entry {
    /// The effect, with the keys in parentheses.
    fn hint(&self, ctx: &egui::Context) -> String {
        match key_text(self.keys(), ctx) {
            keys if keys.is_empty() => self.tooltip.clone().into_owned(),
            keys => format!("{} ({keys})", self.tooltip),
        }
    }
}

impl Commands {
    /// Shows a button of the command with this name; a selectable one if it turns something on and off.
    pub fn button_ui(&self, ui: &mut egui::Ui, name: &str) {
        let entry = self.named(name);
        match entry.is_on {
            Some(_) => self.choice_ui(ui, entry),
            None => _ = self.add(ui, entry, Button::new(&*entry.title)),
        }
    }

    /// Shows a small button of the command with this name.
    pub fn small_button_ui(&self, ui: &mut egui::Ui, name: &str) {
        let entry = self.named(name);
        self.add(ui, entry, Button::new(&*entry.title).small());
    }

    /// Shows a check box of the command with this name, which turns something on and off.
    pub fn check_box_ui(&self, ui: &mut egui::Ui, name: &str) {
        self.switch_ui(ui, self.named(name));
    }

    /// Shows a check box.
    pub fn switch_ui(&self, ui: &mut egui::Ui, entry: &Entry) {
        let mut is_on = entry.is_on.unwrap_or_default();
        self.add(ui, entry, Checkbox::new(&mut is_on, &*entry.title));
    }

    /// Shows a selectable button.
    pub fn choice_ui(&self, ui: &mut egui::Ui, entry: &Entry) {
        let is_on = entry.is_on.unwrap_or_default();
        self.add(ui, entry, Button::selectable(is_on, &*entry.title));
    }

    /// Shows a button of the tool bar with a text that may be shorter than the title.
    pub(super) fn tool_ui(&self, ui: &mut egui::Ui, name: &str, text: Option<&str>) {
        let entry = self.named(name);
        let text = text.unwrap_or(&entry.title);
        let button = match entry.is_on {
            Some(is_on) => Button::selectable(is_on, text),
            None => Button::new(text),
        };
        let response = self.add(ui, entry, button);
        response.widget_info(|| {
            let mut info = WidgetInfo::labeled(Role::Button, entry.is_enabled(), &*entry.title);
            info.selected = entry.is_on;
            info
        });
    }

    fn add(&self, ui: &mut egui::Ui, entry: &Entry, widget: impl egui::Widget) -> Response {
        let response = ui.add_enabled(entry.is_enabled(), widget);
        self.finish(&response, entry);
        response
    }

    /// Shows a row of a menu: a check mark if the command is on, its title, and its keys at the right.
    pub(super) fn menu_row_ui(&self, ui: &mut egui::Ui, entry: &Entry) {
        let role = match entry.is_on {
            Some(_) => Role::MenuItemCheckBox,
            None => Role::MenuItem,
        };
        let button = row(ui, entry, &entry.title);
        let response = ui.add_enabled(entry.is_enabled(), button);
        // egui's own text of the button includes the keys.
        response.widget_info(|| {
            let mut info = WidgetInfo::labeled(role, entry.is_enabled(), &*entry.title);
            info.selected = entry.is_on;
            info
        });
        self.finish(&response, entry);
    }

    /// Shows a row of the palette, like that of a menu, with the title of its menu; the selected one is highlighted.
    pub(super) fn palette_row_ui(
        &self,
        ui: &mut egui::Ui,
        entry: &Entry,
        is_selected: bool,
    ) -> Response {
        let title = entry.full_title();
        let button = row(ui, entry, &title)
            .selected(is_selected)
            .frame_when_inactive(is_selected);
        let response = ui.add_enabled(entry.is_enabled(), button);
        response.widget_info(|| {
            let role = Role::ListBoxOption;
            WidgetInfo::selected(role, entry.is_enabled(), is_selected, &*title)
        });
        self.finish(&response, entry);
        response
    }

    /// Adds the tooltip, and chooses the command if its widget was clicked.
    fn finish(&self, response: &Response, entry: &Entry) {
        if response.clicked() {
            self.choose(entry);
        }
        let hint = entry.hint(&response.ctx);
        let response = response.clone();
        match entry.obstacle {
            None => _ = response.on_hover_text(hint),
            Some(obstacle) => _ = response.on_disabled_hover_text(format!("{obstacle}\n{hint}")),
        }
    }
}

/// A check mark if the command is on, a title, and the keys at the right.
fn row<'t>(ui: &egui::Ui, entry: &Entry, title: &'t str) -> Button<'t> {
    let is_on = entry.is_on == Some(true);
    Button::new((check_mark(is_on), title))
        .right_text(key_text(entry.keys(), ui.ctx()))
        .wrap_mode(egui::TextWrapMode::Extend)
}

/// A check mark, or the space that it would take.
fn check_mark(is_on: bool) -> Atom<'static> {
    Atom::paint(vec2(CHECK_MARK, CHECK_MARK), move |ui, args| {
        if is_on {
            let corners = [[0.05, 0.55], [0.4, 0.9], [0.95, 0.15]];
            let points = corners.map(|[x, y]| args.rect.lerp_inside(vec2(x, y)));
            let stroke = Stroke::new(1.5, args.fallback_text_color);
            ui.painter().add(Shape::line(points.to_vec(), stroke));
        }
    })
}
