//! The box in which the user names an element to go to.

use crate::text_field::{select_all, text_field};
use egui::{Key, Modal, Modifiers};
use hitscope_core::obj::shortened;
use hitscope_lab::element::Element;

/// The forms of names.
const FORMS: &str = "triangle 123, face 4, vertex 7, line 1234, or a point x, y, z";

/// The state of the box.
#[derive(Default)]
pub struct GoToBox {
    is_open: bool,
    text: String,
    /// Why the last text names nothing.
    problem: Option<String>,
}

impl GoToBox {
    /// Opens the box with the last text, which is selected.
    pub fn open(&mut self) {
        (self.is_open, self.problem) = (true, None);
    }

    /// Closes the box. Returns whether it was open.
    pub fn dismiss(&mut self) -> bool {
        std::mem::take(&mut self.is_open)
    }

    /// Opens the box with a problem.
    pub fn refuse(&mut self, problem: String) {
        (self.is_open, self.problem) = (true, Some(problem));
    }

    /// Shows the box if it is open. Returns the element once it is entered.
    pub fn go_to_ui(&mut self, ctx: &egui::Context) -> Option<Element> {
        if !self.is_open {
            return None;
        }
        let is_enter = ctx.input_mut(|input| input.consume_key(Modifiers::NONE, Key::Enter));
        let mut is_entered = is_enter;
        let modal = Modal::new(egui::Id::unique("go to")).show(ctx, |ui| {
            ui.set_width((ui.ctx().content_rect().width() - 40.0).clamp(1.0, 360.0));
            let label = ui.label("Go to element");
            let field = text_field(&mut self.text)
                .hint_text(FORMS)
                .desired_width(f32::INFINITY);
            let field = ui.add(field).labelled_by(label.id);
            if ui.memory(|memory| memory.focused().is_none()) && !is_enter {
                field.request_focus();
                select_all(ui.ctx(), field.id, &self.text);
            }
            ui.label(format!(
                "{FORMS}. Triangles and faces count from 0, vertices and lines from 1."
            ));
            if let Some(problem) = &self.problem {
                ui.colored_label(ui.visuals().error_fg_color, problem);
            }
            is_entered |= ui.button("Go").clicked();
            if is_enter {
                // The next key is for the window.
                field.surrender_focus();
            }
        });
        if modal.backdrop_response.clicked() {
            self.is_open = false;
        }
        if !is_entered {
            return None;
        }
        match element(&self.text) {
            Ok(element) => {
                (self.is_open, self.problem) = (false, None);
                Some(element)
            }
            Err(problem) => {
                self.problem = Some(problem);
                None
            }
        }
    }
}

/// The element that a text names: a kind and a number, or three numbers.
fn element(text: &str) -> Result<Element, String> {
    let words: Vec<&str> = text
        .split([' ', '\t', ',', ':'])
        .filter(|word| !word.is_empty())
        .collect();
    let normal = match words[..] {
        [kind, number] => format!("{}:{number}", kind.to_lowercase()),
        _ => words.join(","),
    };
    normal
        .parse()
        .map_err(|_| format!("“{}” is no element: type {FORMS}", shortened(text)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn elements_are_named_as_people_type_them() {
        for (text, found) in [
            ("triangle 12", Element::Triangle(12)),
            (" Face: 4", Element::Face(4)),
            ("vertex:7", Element::Vertex(7)),
            ("line 1234", Element::Line(1234)),
            ("1, 2.5,-3e2", Element::Point(DVec3::new(1.0, 2.5, -300.0))),
            ("1 2 3", Element::Point(DVec3::new(1.0, 2.0, 3.0))),
        ] {
            assert_eq!(element(text), Ok(found), "{text}");
        }
        for bad in ["", "face", "edge 3", "1, 2", "face x", "1 2 3 4"] {
            assert!(element(bad).is_err(), "{bad}");
        }
    }
}
