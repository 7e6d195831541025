//! Placement of labels beside the points of a plot or a picture, without overlaps.

use egui::{Pos2, Rect, Vec2};

/// The space around a point that labels leave free.
pub fn around(point: &Pos2) -> Rect {
    Rect::from_center_size(*point, Vec2::splat(10.0))
}

/// Places each label as close to its point as possible without covering an obstacle or an earlier label.
pub fn place(points: &[Pos2], sizes: &[Vec2], obstacles: &[Rect], within: Rect) -> Vec<Rect> {
    let mut placed: Vec<Rect> = Vec::new();
    for (&point, &size) in points.iter().zip(sizes) {
        let is_free = |rect: &Rect| {
            let is_clear = |other: &Rect| !rect.intersects(*other);
            within.contains_rect(*rect)
                && placed.iter().all(is_clear)
                && obstacles.iter().all(is_clear)
        };
        // If no place is free, the label goes where it hides the fewest others.
        let hidden = |rect: &Rect| {
            placed
                .iter()
                .filter(|other| rect.intersects(**other))
                .count()
        };
        let free = candidates(point, size).find(is_free);
        let least = || candidates(point, size).min_by_key(hidden);
        placed.extend(free.or_else(least));
    }
    placed
}

/// Candidate places around a point, from near to far.
fn candidates(point: Pos2, size: Vec2) -> impl Iterator<Item = Rect> {
    /// Distance from a point's centre to its label, in points.
    const GAP: f32 = 8.0;
    const SIDES: [[f32; 2]; 8] = [
        [1.0, 0.0],
        [-1.0, 0.0],
        [0.0, -1.0],
        [0.0, 1.0],
        [1.0, -1.0],
        [-1.0, -1.0],
        [1.0, 1.0],
        [-1.0, 1.0],
    ];
    (0..40).flat_map(move |ring| {
        SIDES.into_iter().map(move |[x, y]| {
            let away = egui::vec2(GAP, GAP + ring as f32 * 0.5 * size.y);
            let middle = point + egui::vec2(x, y) * (0.5 * size + away);
            Rect::from_center_size(middle, size)
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const WITHIN: Rect = Rect::from_min_max(Pos2::ZERO, Pos2::new(330.0, 240.0));

    #[test]
    fn labels_of_points_at_the_same_place_do_not_overlap() {
        for at in [
            Pos2::new(160.0, 120.0),
            Pos2::new(2.0, 2.0),
            Pos2::new(329.0, 239.0),
        ] {
            let points = [at; 6];
            let sizes = [
                [70.0, 14.0],
                [40.0, 14.0],
                [60.0, 14.0],
                [30.0, 14.0],
                [50.0, 14.0],
                [90.0, 14.0],
            ];
            let sizes = sizes.map(|[x, y]| Vec2::new(x, y));
            let others = [at, at + Vec2::new(-30.0, 4.0)];
            let placed = place(&points, &sizes, &others.each_ref().map(around), WITHIN);
            assert_eq!(placed.len(), points.len());
            for (i, a) in placed.iter().enumerate() {
                assert!(WITHIN.contains_rect(*a), "{a:?}");
                assert!(others.iter().all(|point| !a.contains(*point)), "{a:?}");
                for b in &placed[i + 1..] {
                    assert!(!a.intersects(*b), "{a:?} {b:?}");
                }
            }
        }
    }

    #[test]
    fn a_single_label_is_placed_next_to_its_point() {
        let [label] = place(
            &[Pos2::new(100.0, 100.0)],
            &[Vec2::new(40.0, 14.0)],
            &[],
            WITHIN,
        )[..] else {
            panic!("one label");
        };
        assert_eq!(label.left_center(), Pos2::new(108.0, 100.0));
    }
}
