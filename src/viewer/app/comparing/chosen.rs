//! Commands of comparisons, and the tab *Compare*.

use crate::app::App;
use crate::command::Commands;
use crate::comparison::{Comparison, Mode, Rasterized, Side, Source};
use crate::panels::compare::{CompareView, compare_ui};
use crate::panels::kernel_name;
use crate::settings::Settings;
use crate::tab::Tab;
use hitscope_core::obj::shown;
use std::path::{Path, PathBuf};

impl App {
    /// The choices about the comparison.
    pub fn comparison(&self) -> &Comparison {
        &self.seen.comparison
    }

    /// Starts a comparison and shows its tab, or ends it.
    pub(crate) fn toggle_comparison(&mut self) {
        self.seen.comparison.is_on ^= true;
        if self.seen.comparison.is_on {
            self.preferences.tab = Tab::Compare;
        }
    }

    /// Starts a comparison in this mode, or changes its mode.
    pub(crate) fn compare_in(&mut self, mode: Mode) {
        let comparison = &mut self.seen.comparison;
        (comparison.is_on, comparison.mode) = (true, mode);
    }

    /// Compares with a side B from this source, and shows the tab.
    pub(crate) fn compare_with(&mut self, source: Source) {
        let comparison = &mut self.seen.comparison;
        (comparison.is_on, comparison.source) = (true, source);
        self.preferences.tab = Tab::Compare;
    }

    /// Rasterizes side A, or traces it again. Starts a comparison if there is none.
    pub(crate) fn toggle_rasterized_a(&mut self) {
        let comparison = &mut self.seen.comparison;
        comparison.is_a_rasterized = !(comparison.is_on && comparison.is_a_rasterized);
        comparison.is_on = true;
        self.preferences.tab = Tab::Compare;
    }

    /// Exchanges view, kernel and shading of both sides.
    pub(crate) fn swap_sides(&mut self) {
        self.seen.comparison.swap(&mut self.seen.settings);
    }

    /// Why no comparison is shown; `None` if one is.
    pub(crate) fn lacks_comparison(&self) -> Option<&'static str> {
        (!self.is_comparing()).then_some("Nothing is compared: press C to start")
    }

    /// Why the sides can't be swapped; `None` if they can.
    pub(crate) fn lacks_swap(&self) -> Option<&'static str> {
        let source = self.seen.comparison.source;
        let is_same_scene = matches!(source, Source::Traced | Source::Rasterized);
        let obstacle = "Only pictures of the open scene can be swapped";
        self.lacks_comparison()
            .or((!is_same_scene).then_some(obstacle))
    }

    /// Compares with another mesh or scene.
    pub(in crate::app) fn compare_with_mesh(&mut self, path: PathBuf) {
        self.seen.comparison.mesh_file = Some(path);
        // Reloads a file that may have changed.
        self.compared.drop_mesh();
        self.compare_with(Source::Mesh);
    }

    /// Compares with a picture.
    pub(in crate::app) fn compare_with_picture(&mut self, path: PathBuf) {
        self.seen.comparison.picture_file = Some(path);
        // Reloads a file that may have changed.
        self.compared.reference.reload();
        self.compare_with(Source::Picture);
    }

    /// The name of a side, with its view, kernel and shading.
    pub(super) fn name_of(&self, side: Side) -> String {
        let settings = match side {
            Side::A => self.seen.settings.clone(),
            Side::B => self.other_settings(),
        };
        let shading = Settings::shading_name(settings.is_smooth);
        let kernel = kernel_name(settings.kernel().info.name);
        let view = settings.view().title;
        let looks = format!("{view}, {kernel}, {shading}");
        let comparison = &self.seen.comparison;
        match (side, comparison.source) {
            (Side::A, _) if self.rasterizes_a() => {
                let view = Rasterized::title_of(settings.view());
                format!("A: {view}, rasterized, {shading}")
            }
            (Side::A, _) => format!("A: {looks}"),
            (Side::B, Source::Traced) => format!("B: {looks}"),
            (Side::B, Source::Rasterized) => {
                let view = Rasterized::title_of(settings.view());
                format!("B: {view}, rasterized, {shading}")
            }
            (Side::B, Source::Mesh) => match &comparison.mesh_file {
                Some(path) => format!("B: {}, {looks}", name_of_file(path)),
                None => "B: no file".to_owned(),
            },
            (Side::B, Source::Earlier) if self.compared.earlier.is_none() => {
                "B: no earlier version".to_owned()
            }
            (Side::B, Source::Earlier) => format!("B: earlier version, {looks}"),
            (Side::B, Source::Picture) => match &comparison.picture_file {
                Some(path) => format!("B: {}", name_of_file(path)),
                None => "B: no picture".to_owned(),
            },
        }
    }

    /// Why there is no side B; `None` if there is one, or will be once it is loaded.
    pub(super) fn lacks_b(&self) -> Option<&'static str> {
        let comparison = &self.seen.comparison;
        match comparison.source {
            Source::Mesh if comparison.mesh_file.is_none() => {
                Some("No file: choose one in the tab Compare")
            }
            Source::Picture if comparison.picture_file.is_none() => {
                Some("No picture: choose one in the tab Compare")
            }
            Source::Earlier if self.compared.earlier.is_none() => {
                Some("No earlier version: the file hasn't been reloaded")
            }
            _ => None,
        }
    }

    /// Shows the tab.
    pub(in crate::app) fn compare_tab_ui(&mut self, ui: &mut egui::Ui, commands: &Commands) {
        let scene = &self.open.document.loaded.scene;
        let is_rasterized = self.seen.comparison.has_rasterized();
        let mut comparison = self.seen.comparison.clone();
        let mut of_a = self.seen.settings.clone();
        let view = CompareView {
            kernels: scene.kernels(),
            names: [Side::A, Side::B].map(|side| self.name_of(side)),
            loading: self.compared.loading.as_ref(),
            is_loading_picture: self.compared.reference.is_loading(),
            not_drawn: Rasterized::not_drawn(scene).filter(|_| is_rasterized),
            lacks_earlier: self.compared.earlier.is_none(),
            sizes: self.sizes(),
            figures: self.figures(),
            are_figures_final: self.are_figures_final(),
            distances: self.mesh_distances(),
            map_status: self.map_status().filter(|_| self.shows(Mode::Distance)),
        };
        let is_cancelled = compare_ui(ui, (&mut of_a, &mut comparison), &view, commands);
        if let Some(loading) = self.compared.loading.as_ref().filter(|_| is_cancelled) {
            loading.cancel();
        }
        (self.seen.settings, self.seen.comparison) = (of_a, comparison);
    }

    /// Width and height of both sides, if they differ.
    fn sizes(&self) -> Option<[glam::UVec2; 2]> {
        let (a, _) = self.pixels_of_a()?;
        let (b, _) = self.compared.pixels()?;
        (a != b).then_some([a, b])
    }
}

fn name_of_file(path: &Path) -> String {
    shown(Path::new(path.file_name().unwrap_or_default()))
}
