//! Storage for optional per-triangle values.

/// One value per triangle, stored up to the last triangle whose value differs from the default.
#[derive(Clone, Debug, PartialEq)]
pub struct PerTriangle<T> {
    default: T,
    values: Vec<T>,
}

impl<T: Copy + PartialEq> PerTriangle<T> {
    /// Creates the list with the default value for every triangle.
    pub fn new(default: T) -> Self {
        let values = Vec::new();
        Self { default, values }
    }

    /// The value of a triangle.
    #[inline]
    pub fn of(&self, triangle: u32) -> T {
        let value = self.values.get(triangle as usize);
        value.copied().unwrap_or(self.default)
    }

    /// Whether every triangle has the default value.
    pub fn is_default(&self) -> bool {
        self.values.is_empty()
    }

    /// Sets the value of a triangle. Triangles left out have the default.
    ///
    /// # Panics
    /// If the value isn't the default, and that of this or a later triangle is set already.
    #[inline]
    pub fn push(&mut self, triangle: u32, value: T) {
        if value != self.default {
            assert!(triangle as usize >= self.values.len(), "set before");
            self.values.resize(triangle as usize, self.default);
            self.values.push(value);
        }
    }

    /// Appends the values of later triangles. Triangle 0 of `later` becomes triangle `first`.
    pub(crate) fn append(&mut self, first: u32, mut later: Self) {
        if !later.values.is_empty() {
            assert!(first as usize >= self.values.len(), "set before");
            self.values.resize(first as usize, self.default);
            self.values.append(&mut later.values);
        }
    }

    /// One more than the last triangle whose value isn't the default.
    pub(super) fn end(&self) -> usize {
        self.values.len()
    }

    /// Releases unused memory.
    pub(crate) fn shrink(&mut self) {
        self.values.shrink_to_fit();
    }

    /// Size in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&self.values[..])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_without_a_value_have_the_default() {
        let mut values = PerTriangle::new(7);
        values.push(0, 7);
        assert!(values.is_default());
        values.push(2, 5);
        values.push(3, 7);
        let mut later = PerTriangle::new(7);
        later.push(1, 6);
        values.append(5, later);
        values.append(9, PerTriangle::new(7));
        let of = |triangle| values.of(triangle);
        assert_eq!([0, 1, 2, 3, 4, 5, 6, 7].map(of), [7, 7, 5, 7, 7, 7, 6, 7]);
        assert_eq!(values.bytes(), 7 * size_of::<i32>());
    }
}
