//! The tool bar: the commands that are used most.

use super::{Commands, Place, VIEWS};
use crate::theme::panel_frame;
use egui::accesskit::Role;
use egui::{ComboBox, Margin, Panel, WidgetInfo};

/// An item of the tool bar.
enum Tool {
    /// A button of the command with this name, and a shorter text if its title is long.
    Button(&'static str, Option<&'static str>),
    /// A drop-down with a title for assistive technology, and the choices at a place of the menus.
    DropDown(&'static str, Place),
}

/// The items, from left to right.
static TOOLS: &[Tool] = &[
    Tool::Button("open", None),
    Tool::Button("frame", None),
    Tool::DropDown("View", VIEWS),
    Tool::Button("smooth", Some("Smooth")),
    Tool::Button("wireframe", None),
    Tool::Button("normals", None),
    Tool::Button("noise", None),
    Tool::Button("orthographic", Some("Ortho")),
    Tool::Button("auto-rotation", Some("Rotate")),
    Tool::Button("pause", None),
    Tool::Button("panel", Some("Panel")),
];

/// Shows the tool bar: one row in a window of 800 points, several in a narrower one.
pub fn tool_bar_ui(ui: &mut egui::Ui, commands: &Commands) {
    /// Height in points below which the window has no tool bar, so that the side panel has room: of 200 points, as of
    /// 800×600 pixels at 300 %, three rows of buttons take 75.
    const LOWEST_WINDOW: f32 = 250.0;
    if ui.ctx().content_rect().height() < LOWEST_WINDOW {
        return;
    }
    let frame = panel_frame(ui.style()).inner_margin(Margin::symmetric(6, 4));
    Panel::top("toolbar").frame(frame).show(ui, |ui| {
        ui.horizontal_wrapped(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            for tool in TOOLS {
                match *tool {
                    Tool::Button(name, text) => commands.tool_ui(ui, name, text),
                    Tool::DropDown(title, place) => drop_down_ui(ui, title, place, commands),
                }
            }
        });
    });
}

fn drop_down_ui(ui: &mut egui::Ui, title: &'static str, place: Place, commands: &Commands) {
    let chosen = commands.at(place).find(|entry| entry.is_on == Some(true));
    ComboBox::from_id_salt(title)
        .selected_text(chosen.map_or("", |entry| &entry.title))
        .width(92.0)
        .height(400.0)
        .show_ui(ui, |ui| {
            for entry in commands.at(place) {
                commands.choice_ui(ui, entry);
            }
        })
        .response
        .widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, title));
}

/// The names of the commands that have a button.
pub fn names() -> impl Iterator<Item = &'static str> {
    TOOLS.iter().filter_map(|tool| match tool {
        Tool::Button(name, _) => Some(*name),
        Tool::DropDown(..) => None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_button_is_that_of_a_command() {
        for name in names() {
            let found = crate::command::all().any(|command| command.name == name);
            assert!(found, "{name}");
        }
    }
}
