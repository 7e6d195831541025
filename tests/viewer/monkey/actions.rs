//! The monkey's actions, chosen at random.

use super::files;
use super::inputs::{KEYS, MODIFIERS, PASTES, TEXTS};
use crate::harness::{Window, pointer, run_command, say};
use egui::{
    Event, Key, MouseWheelSource, MouseWheelUnit, PointerButton, Pos2, TouchPhase, Vec2, pos2, vec2,
};
use egui_kittest::kittest::NodeT as _;
use hitscope::command::Commands;
use hitscope_core::random::Random;
use std::collections::VecDeque;
use std::path::{Path, PathBuf};

/// Does random things to a window. Prints the last ones if one panics.
pub struct Monkey {
    random: Random,
    seed: u64,
    count: usize,
    folder: PathBuf,
    files: Vec<PathBuf>,
    size: Vec2,
    done: VecDeque<String>,
}

impl Drop for Monkey {
    fn drop(&mut self) {
        if std::thread::panicking() {
            say(&format!("seed {}, action {}:", self.seed, self.count));
            self.done.iter().for_each(|action| say(action));
        }
    }
}

/// An action, and how often it is chosen.
type Action = (usize, fn(&mut Monkey, &mut Window) -> String);

const ACTIONS: &[Action] = &[
    (12, Monkey::press_key),
    (10, Monkey::run_command),
    (12, Monkey::click_anywhere),
    (22, Monkey::click_control),
    (14, Monkey::drag),
    (8, Monkey::scroll),
    (10, Monkey::type_text),
    (2, Monkey::paste),
    (4, Monkey::drop_file),
    (1, Monkey::edit_file),
    (3, Monkey::resize),
    (1, Monkey::scale),
    (8, Monkey::wait),
    (2, Monkey::draw),
    (3, Monkey::escape),
];

impl Monkey {
    pub fn new(seed: u64, folder: &Path) -> Self {
        Self {
            random: Random::new(seed),
            seed,
            count: 0,
            files: files::all(folder),
            folder: folder.to_owned(),
            size: vec2(800.0, 600.0),
            done: VecDeque::new(),
        }
    }

    /// Does one thing.
    pub fn act(&mut self, window: &mut Window) {
        self.count += 1;
        let all: usize = ACTIONS.iter().map(|(weight, _)| weight).sum();
        let mut index = self.random.index(all);
        let chosen = ACTIONS.iter().find(|(weight, _)| {
            let is_here = index < *weight;
            index = index.saturating_sub(*weight);
            is_here
        });
        let (_, action) = chosen.expect("the index is less than the sum");
        self.done.push_back("(unfinished)".to_owned());
        let text = action(self, window);
        self.done.pop_back();
        self.done.push_back(text);
        if self.done.len() > 30 {
            self.done.pop_front();
        }
        window.step();
    }

    /// Notes what is about to be done.
    fn note(&mut self, text: &str) {
        if let Some(last) = self.done.back_mut() {
            *last = format!("{text} (unfinished)");
        }
    }

    fn choose<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.random.index(of.len())]
    }

    fn up_to(&mut self, most: f32) -> f32 {
        self.random.unit() as f32 * most
    }

    fn place(&mut self) -> Pos2 {
        pos2(self.up_to(self.size.x), self.up_to(self.size.y))
    }

    /// A control of the window; a random place if there is none.
    fn control(&mut self, window: &Window) -> (String, Pos2) {
        let screen = egui::Rect::from_min_size(Pos2::ZERO, self.size);
        let controls: Vec<(String, Pos2)> = window
            .root()
            .children_recursive()
            .filter_map(|node| {
                let is_placed = node.accesskit_node().raw_bounds().is_some();
                let place = is_placed.then(|| node.rect().center())?;
                let node = node.accesskit_node();
                let is_control = node.data().supports_action(egui::accesskit::Action::Focus);
                (is_control && screen.contains(place)).then(|| {
                    let name = node.label().unwrap_or_default();
                    (format!("{:?} {name}", node.role()), place)
                })
            })
            .collect();
        match controls.len() {
            0 => ("nothing".to_owned(), self.place()),
            count => controls[self.random.index(count)].clone(),
        }
    }

    fn press_key(&mut self, window: &mut Window) -> String {
        let (key, modifiers) = (self.choose(KEYS), self.choose(MODIFIERS));
        self.note(&format!("key {modifiers:?} {key:?}"));
        window.key_press_modifiers(modifiers, key);
        format!("key {modifiers:?} {key:?}")
    }

    fn run_command(&mut self, window: &mut Window) -> String {
        let commands = Commands::of(window.state());
        let entries = commands.entries();
        let title = entries[self.random.index(entries.len())].full_title();
        self.note(&title);
        window.key_press(Key::Escape);
        window.step();
        run_command(window, &title);
        format!("command {title}")
    }

    fn click(&mut self, window: &mut Window, at: Pos2) -> String {
        let buttons = [
            PointerButton::Primary,
            PointerButton::Primary,
            PointerButton::Secondary,
            PointerButton::Middle,
        ];
        let (button, modifiers) = (self.choose(&buttons), self.choose(MODIFIERS));
        let times = 1 + self.random.index(4) / 3;
        let text = format!("{times} × {button:?} {modifiers:?} at {at:?}");
        self.note(&text);
        window.event(Event::PointerMoved(at));
        for _ in 0..times {
            pointer(window, at, button, true, modifiers);
            pointer(window, at, button, false, modifiers);
            window.step();
        }
        text
    }

    fn click_anywhere(&mut self, window: &mut Window) -> String {
        let at = self.place();
        self.click(window, at)
    }

    fn click_control(&mut self, window: &mut Window) -> String {
        let (name, at) = self.control(window);
        let text = self.click(window, at);
        format!("{name}: {text}")
    }

    fn drag(&mut self, window: &mut Window) -> String {
        let (name, from) = if self.random.index(3) == 0 {
            self.control(window)
        } else {
            ("picture".to_owned(), self.place())
        };
        let buttons = [
            PointerButton::Primary,
            PointerButton::Secondary,
            PointerButton::Middle,
        ];
        let (button, modifiers) = (self.choose(&buttons), self.choose(MODIFIERS));
        let text = format!("drag of {name} by {button:?} {modifiers:?} from {from:?}");
        self.note(&text);
        window.event(Event::PointerMoved(from));
        pointer(window, from, button, true, modifiers);
        window.step();
        let mut at = from;
        for _ in 0..1 + self.random.index(5) {
            at += 60.0 * vec2(self.random.signed() as f32, self.random.signed() as f32);
            window.event(Event::PointerMoved(at));
            window.step();
        }
        // Now and then a key is pressed during the drag, and the pointer leaves the window.
        match self.random.index(12) {
            0 => window.key_press(self.choose(KEYS)),
            1 => window.event(Event::PointerGone),
            _ => {}
        }
        pointer(window, at, button, false, modifiers);
        text
    }

    fn scroll(&mut self, window: &mut Window) -> String {
        let at = self.place();
        let scale = self.choose(&[1.0, 50.0, 1000.0]);
        let delta = scale * vec2(self.random.signed() as f32, self.random.signed() as f32);
        let modifiers = self.choose(MODIFIERS);
        let text = format!("scroll {delta:?} {modifiers:?} at {at:?}");
        self.note(&text);
        window.event(Event::PointerMoved(at));
        if self.random.index(5) == 0 {
            let factor = (self.random.signed() as f32).exp2();
            window.event(Event::Zoom(factor));
            return format!("zoom {factor}");
        }
        window.event_modifiers(
            Event::MouseWheel {
                unit: self.choose(&[MouseWheelUnit::Point, MouseWheelUnit::Line]),
                delta,
                phase: TouchPhase::Move,
                source: MouseWheelSource::Unknown,
                modifiers,
            },
            modifiers,
        );
        text
    }

    fn type_text(&mut self, window: &mut Window) -> String {
        let text = match self.random.index(4) {
            0 => {
                let file = self.random.index(self.files.len());
                self.files[file].to_string_lossy().into_owned()
            }
            _ => self.choose(TEXTS).to_owned(),
        };
        self.note(&text);
        window.event(Event::Text(text.clone()));
        let key = self.choose(&[Key::Enter, Key::Enter, Key::Tab, Key::Escape]);
        window.key_press(key);
        format!("text {text:?} and {key:?}")
    }

    fn paste(&mut self, window: &mut Window) -> String {
        let text = self.choose(PASTES);
        self.note(text);
        window.event(Event::Paste(text.to_owned()));
        format!("paste {text}")
    }

    fn drop_file(&mut self, window: &mut Window) -> String {
        let file = self.random.index(self.files.len());
        let path = self.files[file].clone();
        self.note(&format!("{path:?}"));
        crate::app::drop_file(window, path.clone());
        format!("drop {path:?}")
    }

    /// Changes a file, for automatic reloading.
    fn edit_file(&mut self, _: &mut Window) -> String {
        let path = self.folder.join("triangle.obj");
        let text = self.choose(&[
            "v 0 0 0\nv 2 0 0\nv 0 2 0\nf 1 2 3\n",
            "v 0 0",
            "",
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\n",
        ]);
        std::fs::write(&path, text).expect("written");
        format!("write {text:?}")
    }

    fn resize(&mut self, window: &mut Window) -> String {
        self.size = match self.random.index(4) {
            0 => vec2(1.0 + self.up_to(60.0), 1.0 + self.up_to(60.0)),
            1 => vec2(800.0, 600.0),
            _ => vec2(200.0 + self.up_to(1000.0), 200.0 + self.up_to(600.0)),
        };
        self.note(&format!("{:?}", self.size));
        window.set_size(self.size);
        format!("size {:?}", self.size)
    }

    fn scale(&mut self, window: &mut Window) -> String {
        let scale = self.choose(&[1.0, 1.0, 1.25, 1.5, 2.0, 3.0]);
        window.set_pixels_per_point(scale);
        format!("scale {scale}")
    }

    fn wait(&mut self, window: &mut Window) -> String {
        let steps = 1 + self.random.index(20);
        for _ in 0..steps {
            window.step();
            std::thread::sleep(std::time::Duration::from_millis(2));
        }
        format!("wait {steps}")
    }

    /// Draws the window, too.
    fn draw(&mut self, window: &mut Window) -> String {
        self.note("draw");
        window.render().expect("drawn");
        "draw".to_owned()
    }

    fn escape(&mut self, window: &mut Window) -> String {
        window.key_press(Key::Escape);
        "escape".to_owned()
    }
}
