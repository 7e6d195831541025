//! The choice of a kernel for each shape, by one name.

use super::{KernelInfo, KernelRow, KernelTable, Precision, Tier};
use crate::shape::Triangle;

/// A kernel chosen by name. Shapes whose tables lack the name use the kernel of a tier.
#[derive(Clone, Copy, Debug)]
pub struct KernelChoice {
    /// The description of the chosen kernel.
    pub info: &'static KernelInfo,
}

impl KernelChoice {
    /// The kernel of a shape.
    pub fn row<S: KernelTable>(self) -> &'static KernelRow<S> {
        S::kernel(self.info.name).unwrap_or_else(|| S::kernel_of(self.tier()))
    }

    /// The kernel of a shape, from the list of the shape's kernels.
    pub fn among(self, kernels: &[&'static KernelInfo]) -> Option<&'static KernelInfo> {
        let tier = self.tier();
        let find = |name: &str| {
            let mut kernels = kernels.iter();
            kernels.find(|kernel| kernel.answers_to(name)).copied()
        };
        find(self.info.name).or_else(|| find(tier.name()))
    }

    /// The tier that it serves; for a kernel without one, the tier of its precision.
    pub fn tier(self) -> Tier {
        self.info.tier.unwrap_or(match self.info.precision {
            Precision::F32 => Tier::Watertight,
            Precision::F64 => Tier::Precise,
            Precision::Adaptive => Tier::Exact,
        })
    }

    /// The kernel that this one is compared with by default: the exact kernel, or the fast one if this one is exact.
    pub fn default_second(self) -> Self {
        let tier = match self.tier() {
            Tier::Exact => Tier::Fast,
            _ => Tier::Exact,
        };
        Triangle::kernel_of(tier).into()
    }
}

impl<S> From<&'static KernelRow<S>> for KernelChoice {
    fn from(row: &'static KernelRow<S>) -> Self {
        Self { info: row.info }
    }
}

impl PartialEq for KernelChoice {
    fn eq(&self, other: &Self) -> bool {
        self.info.name == other.info.name
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::TRIANGLE_KERNELS;

    #[test]
    fn a_choice_leads_to_the_kernel_of_its_name() {
        for row in TRIANGLE_KERNELS.iter() {
            let choice = KernelChoice::from(row);
            assert!(std::ptr::eq(choice.row::<Triangle>(), row));
            let infos: Vec<_> = TRIANGLE_KERNELS.iter().map(|row| row.info).collect();
            let found = choice.among(&infos).expect("in the list");
            assert!(std::ptr::eq(found, row.info));
        }
    }

    #[test]
    fn no_kernel_is_compared_with_itself_by_default() {
        for row in TRIANGLE_KERNELS.iter() {
            let choice = KernelChoice::from(row);
            assert!(choice != choice.default_second(), "{}", row.info.name);
        }
    }
}
