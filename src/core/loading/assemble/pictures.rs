//! The pictures that a scene file names: textures and the environment.

use super::Contents;
use crate::brightness::{check_brightness, too_bright};
use crate::light::{EnvironmentMap, LoadedMap};
use crate::loading::refusal::{Refusal, in_object};
use crate::loading::textures::Textures;
use crate::obj::LoadError;
use crate::progress::{Cancelled, Progress};
use crate::scene_file::{EmitterKind, SceneFile};
use glam::DVec3;

impl Contents {
    /// Loads the textures of materials.
    pub(super) fn load_textures(
        &mut self,
        file: &SceneFile,
        progress: &Progress,
    ) -> Result<(), Cancelled> {
        let limit = self.options.max_memory.saturating_sub(self.bytes());
        self.textures = Textures::load(file, limit, progress)?;
        self.needs.merged += self.textures.bytes();
        for (place, message) in std::mem::take(&mut self.textures.warnings) {
            self.warn(file, place, message);
        }
        self.report.files.extend(self.textures.files().cloned());
        Ok(())
    }

    /// Loads the picture of the environment.
    pub(super) fn load_environment(
        &mut self,
        file: &SceneFile,
        progress: &Progress,
    ) -> Result<(), LoadError> {
        for emitter in &file.emitters {
            if let EmitterKind::Envmap {
                file: path, scale, ..
            } = &emitter.kind
            {
                let limit = self.options.max_memory.saturating_sub(self.bytes());
                let loaded = EnvironmentMap::load(path, limit, progress);
                let named = |error| in_object(file, emitter.place, "emitter “envmap”", error);
                let LoadedMap { map, warnings } = loaded.map_err(named)?;
                if check_brightness(DVec3::splat(scale * f64::from(map.brightest()))).is_err() {
                    let message = format!("the picture times “scale” {}", too_bright());
                    return Err(Refusal::new(emitter.place, message).in_file(file));
                }
                self.map = Some(map);
                self.take_messages(path, warnings, Vec::new());
            }
        }
        Ok(())
    }
}
