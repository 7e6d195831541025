//! Random choice with given probabilities in constant time.
//!
//! Source: M. D. Vose, "A Linear Algorithm for Generating Random Numbers with a Given Distribution", IEEE Transactions
//! on Software Engineering 17(9), 1991.

/// Chooses an index with a probability proportional to its weight.
#[derive(Clone, Debug, Default)]
pub struct AliasTable {
    slots: Vec<Slot>,
}

#[derive(Clone, Copy, Debug)]
struct Slot {
    /// The probability of the slot's own index.
    own: f32,
    /// Its index otherwise.
    other: u32,
    /// The probability of the slot's own index among all.
    probability: f32,
}

impl AliasTable {
    /// A table of weights. One that is negative or not finite counts as 0; if all are 0, nothing is chosen.
    pub fn new(weights: &[f64]) -> Self {
        let valid = |w: &f64| if w.is_finite() { w.max(0.0) } else { 0.0 };
        let weights: Vec<f64> = weights.iter().map(valid).collect();
        // The largest is divided out, so that the sum doesn't overflow.
        let largest = weights.iter().copied().fold(0.0, f64::max);
        if largest == 0.0 {
            return Self::default();
        }
        let sum: f64 = weights.iter().map(|w| w / largest).sum();
        let count = weights.len() as f64;
        let probabilities = weights.iter().map(|w| w / largest / sum);
        let mut slots: Vec<Slot> = probabilities
            .clone()
            .zip(0..)
            .map(|(p, index)| Slot {
                own: 1.0,
                other: index,
                probability: p as f32,
            })
            .collect();
        // The height of each slot, filled up to 1 from those above.
        let mut heights: Vec<f64> = probabilities.map(|p| p * count).collect();
        let (mut low, mut high): (Vec<usize>, Vec<usize>) =
            (0..slots.len()).partition(|&k| heights[k] < 1.0);
        while let (Some(&to), Some(&from)) = (low.last(), high.last()) {
            low.pop();
            slots[to].own = heights[to] as f32;
            slots[to].other = from as u32;
            heights[from] -= 1.0 - heights[to];
            if heights[from] < 1.0 {
                high.pop();
                low.push(from);
            }
        }
        // Slots that rounding left are full, unless their weight is 0.
        let fallback = weights.iter().position(|&w| w == largest).unwrap_or(0);
        for k in low.into_iter().filter(|&k| weights[k] == 0.0) {
            slots[k].own = 0.0;
            slots[k].other = fallback as u32;
        }
        Self { slots }
    }

    /// Whether no weight is positive, so that nothing is chosen.
    pub fn is_empty(&self) -> bool {
        self.slots.is_empty()
    }

    /// An index and its probability, for a uniform number in [0, 1).
    #[inline]
    pub fn sample(&self, at: f32) -> Option<(usize, f32)> {
        if let [single] = &self.slots[..] {
            return Some((0, single.probability));
        }
        let (index, probability, _) = self.sample_and_remap(at)?;
        Some((index, probability))
    }

    /// The same, and the number stretched to [0, 1) among those with the same index.
    pub fn sample_and_remap(&self, at: f32) -> Option<(usize, f32, f32)> {
        if self.slots.is_empty() {
            return None;
        }
        let scaled = f64::from(at) * self.slots.len() as f64;
        let own = (scaled as usize).min(self.slots.len() - 1);
        let rest = (scaled - own as f64) as f32;
        let slot = self.slots[own];
        let (index, rest) = if rest < slot.own {
            (own, rest / slot.own)
        } else {
            (slot.other as usize, (rest - slot.own) / (1.0 - slot.own))
        };
        let rest = rest.min(1.0 - f32::EPSILON / 2.0);
        Some((index, self.slots[index].probability, rest))
    }

    /// The probability of an index; 0 if there is no such index.
    pub fn probability(&self, index: usize) -> f32 {
        self.slots.get(index).map_or(0.0, |slot| slot.probability)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_index_is_chosen_as_often_as_its_weight_says() {
        for weights in [
            vec![1.0],
            vec![3.0, 0.0, 1.0, 4.0],
            vec![1e300, 1e300, 5e299],
        ] {
            let table = AliasTable::new(&weights);
            let mut counts = vec![0; weights.len()];
            const N: usize = 1 << 16;
            for k in 0..N {
                let at = (k as f32 + 0.5) / N as f32;
                let (index, probability, rest) = table.sample_and_remap(at).expect("weights");
                assert_eq!(probability, table.probability(index));
                assert!((0.0..1.0).contains(&rest));
                counts[index] += 1;
            }
            let largest = weights.iter().copied().fold(0.0, f64::max);
            let sum: f64 = weights.iter().map(|w| w / largest).sum();
            for (count, weight) in counts.iter().zip(&weights) {
                let expected = N as f64 * (weight / largest / sum);
                // Each of two parts of a slot is rounded to a whole number of points.
                let parts = 2.0 * weights.len() as f64;
                assert!((f64::from(*count) - expected).abs() <= parts, "{counts:?}");
            }
        }
    }

    #[test]
    fn without_a_positive_finite_weight_nothing_is_chosen() {
        for weights in [vec![], vec![0.0, 0.0], vec![f64::NAN, -1.0, f64::INFINITY]] {
            assert_eq!(AliasTable::new(&weights).sample(0.5), None);
        }
    }
}
