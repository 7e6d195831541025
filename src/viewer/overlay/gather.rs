//! Gathering of an overlay's lines, and the key that tells whether gathered lines are still right.

use crate::gpu::lines::Line;
use hitscope_core::{Aabb, Scene};
use std::any::Any;
use std::sync::Arc;

/// How lines are gathered: a function of the scene's shapes and of some data.
#[derive(Clone)]
pub struct Gather {
    key: Key,
    lines: Arc<LinesOf>,
    bounds: Aabb,
}

/// Gathers the lines of a scene.
type LinesOf = dyn Fn(&Scene) -> Vec<Line> + Send + Sync;

/// The data that lines depend on, besides the scene's shapes. Lines are kept while it stays equal.
#[derive(Clone)]
pub struct Key(Arc<dyn Data>);

trait Data: Any + Send + Sync {
    fn is_equal(&self, other: &dyn Any) -> bool;
}

impl<T: PartialEq + Send + Sync + 'static> Data for T {
    fn is_equal(&self, other: &dyn Any) -> bool {
        other.downcast_ref() == Some(self)
    }
}

impl PartialEq for Key {
    fn eq(&self, other: &Self) -> bool {
        let other: &dyn Any = &*other.0;
        self.0.is_equal(other)
    }
}

impl Gather {
    /// Gathers lines by this function, which a background thread calls. It captures nothing, so that `data` holds all that
    /// the lines depend on. What changes while the shapes stay, such as creases, belongs to `data`.
    pub fn new<T: PartialEq + Send + Sync + 'static>(
        data: T,
        lines: fn(&Scene, &T) -> Vec<Line>,
    ) -> Self {
        let data = Arc::new(data);
        Self {
            key: Key(data.clone()),
            lines: Arc::new(move |scene| lines(scene, &data)),
            bounds: Aabb::EMPTY,
        }
    }

    /// The same lines with their bounds. Only lines that reach far beyond the scene need them: without them, an
    /// orthographic picture cuts off what is behind the scene.
    #[must_use]
    pub fn within(self, bounds: Aabb) -> Self {
        Self { bounds, ..self }
    }

    /// The bounds of lines that reach far beyond the scene, else empty.
    pub fn bounds(&self) -> Aabb {
        self.bounds
    }

    /// What the lines depend on.
    pub fn key(&self) -> &Key {
        &self.key
    }

    /// Gathers the lines.
    pub fn lines(&self, scene: &Scene) -> Vec<Line> {
        (self.lines)(scene)
    }
}

/// Shared data that is equal only to itself.
pub struct Same<T>(pub Arc<T>);

impl<T> PartialEq for Same<T> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_equal_if_their_data_are() {
        let of_number = |x: u32| Gather::new(x, |_, _| Vec::new());
        assert!(of_number(1).key() == of_number(1).key());
        assert!(of_number(1).key() != of_number(2).key());
        let of_text = Gather::new("1", |_, _| Vec::new());
        assert!(of_number(1).key() != of_text.key());
        let shared = Arc::new(3);
        let of = |data: &Arc<i32>| Gather::new(Same(Arc::clone(data)), |_, _| Vec::new());
        assert!(of(&shared).key() == of(&shared).key());
        assert!(of(&shared).key() != of(&Arc::new(3)).key());
    }
}
