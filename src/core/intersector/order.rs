//! The order of hits: by t, then by primitive.

use super::Crossing;
use super::method::Tester;
use crate::lane::LaneMask;
use fearless_simd::Simd;
use std::cmp::Ordering;

/// A comparison of two numbers, or of numbers in lanes.
#[derive(Clone, Copy)]
pub(super) struct Comparison<M> {
    pub is_less: M,
    pub is_equal: M,
}

impl From<Ordering> for Comparison<bool> {
    #[inline(always)]
    fn from(order: Ordering) -> Self {
        Self {
            is_less: order.is_lt(),
            is_equal: order.is_eq(),
        }
    }
}

/// Whether a hit precedes another one: by rank, then by t, then by primitive.
#[inline(always)]
pub(super) fn precedes<M: LaneMask>(
    rank: Comparison<M>,
    t: Comparison<M>,
    is_lower_primitive: M,
) -> M {
    rank.is_less | (rank.is_equal & (t.is_less | (t.is_equal & is_lower_primitive)))
}

/// The hits as crossings, ordered by t. Hits at equal t form one crossing, ordered by primitive.
pub(super) fn crossings<S: Simd, T: Tester<S>>(
    tester: &mut T,
    hits: Vec<T::Found>,
) -> Vec<Crossing> {
    let mut sorted = Vec::new();
    let compare = &mut |a: &mut _, b: &mut _| tester.compare(a, b);
    sort_into_crossings(hits, compare, T::primitive, &mut sorted);
    let crossing = |equal: Vec<T::Found>| Crossing {
        hit: tester.hit(equal[0].clone()),
        also: equal[1..].iter().map(T::primitive).collect(),
    };
    sorted.into_iter().map(crossing).collect()
}

/// A three-way quicksort: it compares each hit with few others, even if thousands are at equal t, as at the
/// tip of a fan or around an edge, where an exact comparison needs integers.
fn sort_into_crossings<F: Clone>(
    hits: Vec<F>,
    compare: &mut dyn FnMut(&mut F, &mut F) -> Ordering,
    primitive: fn(&F) -> u32,
    crossings: &mut Vec<Vec<F>>,
) {
    let Some(mut middle) = hits.get(hits.len() / 2).cloned() else {
        return;
    };
    let (mut nearer, mut equal, mut farther) = (Vec::new(), Vec::new(), Vec::new());
    for mut hit in hits {
        match compare(&mut hit, &mut middle) {
            Ordering::Less => nearer.push(hit),
            Ordering::Equal => equal.push(hit),
            Ordering::Greater => farther.push(hit),
        }
    }
    equal.sort_unstable_by_key(primitive);
    sort_into_crossings(nearer, compare, primitive, crossings);
    crossings.push(equal);
    sort_into_crossings(farther, compare, primitive, crossings);
}
