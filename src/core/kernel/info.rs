//! Descriptions of kernels: tiers, arithmetic and promises.

/// A kernel's tier, from fast to exact.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Tier {
    /// The fastest; promises nothing beyond the measured figures.
    Fast,
    /// Hits and misses match exact arithmetic, so there are no gaps between triangles that share an edge or a
    /// vertex.
    Watertight,
    /// As [`Watertight`](Self::Watertight), with t correct to the last place of f32.
    Precise,
    /// Hits, misses and the order of hits match exact arithmetic.
    Exact,
}

impl Tier {
    /// The tier of the default kernel.
    pub const DEFAULT: Self = Self::Exact;

    /// All tiers.
    pub const ALL: [Self; 4] = [Self::Fast, Self::Watertight, Self::Precise, Self::Exact];

    /// The name that `--kernel` takes.
    pub fn name(self) -> &'static str {
        match self {
            Self::Fast => "fast",
            Self::Watertight => "watertight",
            Self::Precise => "precise",
            Self::Exact => "exact",
        }
    }
}

/// The arithmetic of a kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// 24 significant bits.
    F32,
    /// 53 significant bits, on the f32 mesh.
    F64,
    /// As many bits as the decision needs.
    Adaptive,
}

impl Precision {
    /// The name shown in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
            Self::Adaptive => "adaptive",
        }
    }
}

/// The guarantees of a kernel beyond the measured figures; the conformance suite tests them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Promises {
    /// No ray passes between adjacent triangles of a closed mesh.
    pub is_watertight: bool,
    /// Hits and misses match exact arithmetic, and t is within 0.51 ulp of f32.
    pub is_accurate: bool,
    /// Hits, misses and the order of two hits match exact arithmetic.
    pub is_exact: bool,
    /// Translating ray and triangle by the same vector changes no bit, provided that no coordinate is
    /// rounded.
    pub is_translation_invariant: bool,
}

impl Promises {
    /// The promises of a kernel that starts from differences of coordinates.
    pub(crate) const PLAIN: Self = Self {
        is_watertight: false,
        is_accurate: false,
        is_exact: false,
        is_translation_invariant: true,
    };
}

/// A kernel's description.
#[derive(Clone, Copy, Debug)]
pub struct KernelInfo {
    /// The name that `--kernel` takes.
    pub name: &'static str,
    /// The title shown in menus.
    pub title: &'static str,
    /// The tier it serves, if any.
    pub tier: Option<Tier>,
    /// Its arithmetic.
    pub precision: Precision,
    /// Author, title, year.
    pub source: &'static str,
    /// Its strengths and weaknesses in a sentence.
    pub summary: &'static str,
    /// The guarantees that the conformance suite tests.
    pub promises: Promises,
}

impl KernelInfo {
    /// Whether this is its name or the name of the tier that it serves.
    pub fn answers_to(&self, name: &str) -> bool {
        self.name == name || self.tier.is_some_and(|tier| tier.name() == name)
    }

    /// The name of its tier if it serves one, else its own name.
    pub fn short_name(&self) -> &'static str {
        self.tier.map_or(self.name, Tier::name)
    }
}
