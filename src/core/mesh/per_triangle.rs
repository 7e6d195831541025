//! A value per triangle that many meshes don't have.

/// A value per triangle, stored up to the last triangle whose value isn't the default.
#[derive(Clone, Debug, PartialEq)]
pub struct PerTriangle<T> {
    default: T,
    values: Vec<T>,
}

impl<T: Copy + PartialEq> PerTriangle<T> {
    /// The default for every triangle.
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

    /// Whether every triangle has the default.
    pub fn is_default(&self) -> bool {
        self.values.is_empty()
    }

    /// Sets the value of a triangle, which must come after all that have been set.
    #[inline]
    pub fn push(&mut self, triangle: u32, value: T) {
        if value != self.default {
            self.values.resize(triangle as usize, self.default);
            self.values.push(value);
        }
    }

    /// Adds the values of later triangles, the first of which is `first`.
    pub(crate) fn append(&mut self, first: u32, mut later: Self) {
        if !later.values.is_empty() {
            self.values.resize(first as usize, self.default);
            self.values.append(&mut later.values);
        }
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
