//! The textures of a scene file.

use crate::mesh::{self, Encoding, Sampling, TextureMap};
use crate::obj::{self, Picture, shown};
use crate::progress::{Cancelled, Progress};
use crate::scene_file::{Place, SceneFile, Texture, TextureKind};
use glam::{DAffine2, DMat2, DVec2, DVec3};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// The textures that materials use, each once.
#[derive(Default)]
pub(super) struct Textures {
    list: Vec<mesh::Texture>,
    /// Indices by path; `None` for pictures that can't be read.
    pictures: HashMap<PathBuf, Option<u32>>,
    /// Indices of checkerboards by the bits of their colours.
    boards: HashMap<[u64; 6], u32>,
    /// What is wrong with pictures, and where they are named.
    pub warnings: Vec<(Place, String)>,
}

impl Textures {
    /// Loads the textures of a scene file with at most `max_bytes` of memory.
    ///
    /// # Errors
    /// [`Cancelled`] if `progress` was cancelled.
    pub fn load(file: &SceneFile, max_bytes: u64, progress: &Progress) -> Result<Self, Cancelled> {
        let mut textures = Self::default();
        for texture in file.textures() {
            progress.check()?;
            match &texture.kind {
                TextureKind::Bitmap(bitmap) => {
                    textures.add_picture(&bitmap.file, texture.place, max_bytes, progress);
                    progress.check()?;
                }
                TextureKind::Checkerboard(board) => textures.add_board(board.colours),
            }
        }
        Ok(textures)
    }

    fn add_board(&mut self, colours: [DVec3; 2]) {
        let next = self.list.len() as u32;
        if *self.boards.entry(bits(colours)).or_insert(next) == next {
            let colours = colours.map(|rgb| rgb.as_vec3());
            self.list.push(mesh::Texture::checkerboard(colours));
        }
    }

    fn add_picture(&mut self, path: &Path, place: Place, max_bytes: u64, progress: &Progress) {
        if self.pictures.contains_key(path) {
            return;
        }
        let left = max_bytes.saturating_sub(self.bytes());
        let mut warn = |what: &str| {
            let message = format!("texture {}: {what}", shown(path));
            self.warnings.push((place, message));
        };
        let index = match obj::read_picture(path, left, progress) {
            Ok(Picture { texture, fault }) => {
                if let Some(fault) = fault {
                    warn(&fault);
                }
                // Mitsuba ignores the alpha channel.
                self.list.push(texture.with_alpha(Vec::new()));
                Some(self.list.len() as u32 - 1)
            }
            Err(why) => {
                warn(&format!("{why}; the parameter's default is used"));
                None
            }
        };
        self.pictures.insert(path.to_owned(), index);
    }

    /// Size in bytes.
    pub fn bytes(&self) -> u64 {
        let bytes = self.list.iter().map(mesh::Texture::bytes);
        bytes.sum::<usize>() as u64
    }

    /// The paths of all pictures.
    pub fn files(&self) -> impl Iterator<Item = &PathBuf> {
        self.pictures.keys()
    }

    /// The map of a texture; `None` if its picture can't be read.
    pub fn map(&self, texture: &Texture) -> Option<TextureMap> {
        let (index, sampling) = match &texture.kind {
            TextureKind::Bitmap(bitmap) => {
                let encoding = if bitmap.is_raw {
                    Encoding::Linear
                } else {
                    Encoding::Srgb
                };
                let sampling = Sampling {
                    filter: bitmap.filter,
                    wrap: bitmap.wrap,
                    encoding,
                };
                (*self.pictures.get(&bitmap.file)?, sampling)
            }
            TextureKind::Checkerboard(board) => {
                let index = self.boards.get(&bits(board.colours)).copied();
                (index, Sampling::default())
            }
        };
        // The second coordinate points down in the file, and up in a mesh.
        let flip = DMat2::from_diagonal(DVec2::new(1.0, -1.0));
        let flipped = DAffine2::from_mat2_translation(flip, DVec2::Y);
        Some(TextureMap {
            transform: (flipped * texture.to_uv * flipped).as_affine2(),
            sampling,
            ..TextureMap::of(index?)
        })
    }

    /// The list that maps refer to.
    pub fn into_list(self) -> Vec<mesh::Texture> {
        self.list
    }
}

fn bits([a, b]: [DVec3; 2]) -> [u64; 6] {
    [a.x, a.y, a.z, b.x, b.y, b.z].map(f64::to_bits)
}
