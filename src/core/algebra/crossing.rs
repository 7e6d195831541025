//! Crossings of a ray with a shape.
//!
//! A shape describes where a ray meets it by pieces: a polynomial in t that is 0 on the surface, and
//! polynomials that are not negative on the part of the surface that belongs to the shape. A crossing is a root
//! of the first at which none of the others is negative. Intervals decide about most pieces; where they leave
//! anything open, exact numbers decide about that root or that piece.
//!
//! Long functions are never inlined: each would be compiled into several copies of a tree's walk.

use super::algebraic::Algebraic;
use super::exact_piece::ExactPiece;
use super::interval::Interval;
use super::interval_roots::isolated_roots;
use super::pieces::{Piece, Pieces, RayIn};
use super::quick_line::QuickLine;
use crate::ray::Ray;
use glam::Vec3;
use std::cmp::Ordering;

/// A point at which a ray crosses a shape.
#[derive(Clone, Debug)]
pub struct Crossing {
    /// Contains t.
    t: Interval,
    part: u8,
    is_tangent: bool,
    piece: usize,
    /// Number of the root of the piece's polynomial.
    root: usize,
    /// Whether that polynomial is squarefree, and has no other root in the bounds of t.
    is_isolated: bool,
    exact: Option<Box<Algebraic>>,
}

impl Crossing {
    /// Bounds of t.
    pub fn t(&self) -> Interval {
        self.t
    }

    /// The part of the shape; of several with the same t, the one with the lowest number.
    pub fn part(&self) -> u8 {
        self.part
    }

    /// Whether the part's polynomial has a root of even multiplicity: the ray touches the surface without
    /// passing through it.
    pub fn is_tangent(&self) -> bool {
        self.is_tangent
    }
}

/// How often intervals didn't suffice.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AlgebraCounters {
    /// Pieces, one for each ray and part.
    pub pieces: u64,
    /// Pieces whose roots were computed exactly.
    pub exact_pieces: u64,
    /// Other roots that were computed exactly, for their conditions, the ray's interval, order or rounding.
    pub exact_roots: u64,
}

/// Finds and compares the crossings of one ray.
#[derive(Clone, Debug)]
pub struct CrossingSolver<'a> {
    ray: &'a Ray,
    interval: [f64; 2],
    line: QuickLine,
    pub work: AlgebraCounters,
}

impl<'a> CrossingSolver<'a> {
    #[inline(always)]
    pub fn new(ray: &'a Ray) -> Self {
        Self {
            ray,
            interval: ray.finite_interval().map(f64::from),
            line: QuickLine::of(ray),
            work: AlgebraCounters::default(),
        }
    }

    /// The first of the [`crossings`](Self::crossings).
    #[inline(always)]
    pub fn first<P: Pieces>(&mut self, shape: &P) -> Option<Crossing> {
        let Some(roots) = shape.quick_roots(&self.line) else {
            return self.crossings(shape).into_iter().next();
        };
        let [start, end] = self.interval;
        for (root, &t) in roots.iter().enumerate() {
            if start < t.lo && t.hi < end {
                self.work.pieces += 1;
                return Some(Crossing {
                    t,
                    part: 0,
                    is_tangent: false,
                    piece: 0,
                    root,
                    is_isolated: true,
                    exact: None,
                });
            }
            if start < t.hi && t.lo < end {
                return self.crossings(shape).into_iter().next();
            }
        }
        self.work.pieces += 1;
        None
    }

    /// All crossings with t in the ray's open interval, in ascending order of t. Crossings with the same t are
    /// one, of the part with the lowest number.
    #[inline(never)]
    pub fn crossings<P: Pieces>(&mut self, shape: &P) -> Vec<Crossing> {
        let shift = self.shift(shape.centre());
        let mut found = Vec::new();
        let mut index = 0;
        shape.pieces(&self.shifted_ray(shift), &mut |piece: Piece<Interval>| {
            self.work.pieces += 1;
            match isolated_roots(piece.surface) {
                Some(roots) => {
                    // Roots that are close to each other aren't apart any more if the shift is large.
                    let t = |x: Interval| (x + Interval::point(shift)).without_nan();
                    let mut pairs = roots.windows(2);
                    let is_isolated = pairs.all(|pair| t(pair[0]).hi < t(pair[1]).lo);
                    for (root, x) in roots.iter().enumerate() {
                        let crossing = Crossing {
                            t: t(*x),
                            part: piece.part,
                            is_tangent: false,
                            piece: index,
                            root,
                            is_isolated,
                            exact: None,
                        };
                        found.extend(self.filtered(shape, &piece, *x, crossing));
                    }
                }
                None => self.add_exact_piece(shape, index, &mut found),
            }
            index += 1;
        });
        self.sorted(shape, found)
    }

    /// The same crossings, without use of intervals.
    #[cfg_attr(not(test), expect(dead_code, reason = "tests compare with it"))]
    pub fn exact_crossings<P: Pieces>(&mut self, shape: &P) -> Vec<Crossing> {
        let mut count = 0;
        shape.pieces(&self.shifted_ray(0.0), &mut |_: Piece<Interval>| count += 1);
        let mut found = Vec::new();
        for index in 0..count {
            self.work.pieces += 1;
            self.add_exact_piece(shape, index, &mut found);
        }
        self.sorted(shape, found)
    }

    /// Compares two crossings by t.
    #[inline(always)]
    pub fn compare<P: Pieces, Q: Pieces>(
        &mut self,
        first: (&P, &mut Crossing),
        second: (&Q, &mut Crossing),
    ) -> Ordering {
        match first.1.t.order(second.1.t) {
            Some(order) => order,
            None => self.compare_exactly(first, second),
        }
    }

    #[inline(never)]
    fn compare_exactly<P: Pieces, Q: Pieces>(
        &mut self,
        (p, a): (&P, &mut Crossing),
        (q, b): (&Q, &mut Crossing),
    ) -> Ordering {
        self.exact(p, a).compare(self.exact(q, b))
    }

    /// Compares a crossing's t with another number.
    #[cfg_attr(not(test), expect(dead_code, reason = "tests compare with it"))]
    pub fn compare_with<P: Pieces>(
        &mut self,
        shape: &P,
        crossing: &mut Crossing,
        t: &mut Algebraic,
    ) -> Ordering {
        let by_bounds = crossing.t.order(t.enclosure());
        by_bounds.unwrap_or_else(|| self.exact(shape, crossing).compare(t))
    }

    /// Compares a crossing's t with a finite f64 or f32.
    #[cfg_attr(not(test), expect(dead_code, reason = "tests compare with it"))]
    pub fn compare_with_number<P: Pieces>(
        &mut self,
        shape: &P,
        crossing: &mut Crossing,
        t: f64,
    ) -> Ordering {
        let by_bounds = crossing.t.order(Interval::point(t));
        by_bounds.unwrap_or_else(|| self.exact(shape, crossing).compare_with(&t.into()))
    }

    /// t, correctly rounded to f64.
    #[inline(never)]
    pub fn t_in_f64<P: Pieces>(&mut self, shape: &P, crossing: &mut Crossing) -> f64 {
        let Interval { lo, hi } = crossing.t;
        if lo == hi {
            return lo;
        }
        self.exact(shape, crossing).nearest_f64()
    }

    /// t, correctly rounded to f32.
    #[inline(never)]
    pub fn t_in_f32<P: Pieces>(&mut self, shape: &P, crossing: &mut Crossing) -> f32 {
        let Interval { lo, hi } = crossing.t;
        if lo as f32 == hi as f32 {
            // Adding 0 turns −0 into 0.
            return lo as f32 + 0.0;
        }
        self.exact(shape, crossing).nearest_f32()
    }

    /// The exact t.
    #[inline(never)]
    pub fn exact<'c, P: Pieces>(
        &mut self,
        shape: &P,
        crossing: &'c mut Crossing,
    ) -> &'c mut Algebraic {
        let work = &mut self.work;
        crossing.exact.get_or_insert_with(|| {
            work.exact_roots += 1;
            let piece = ExactPiece::of(self.ray, shape, crossing.piece);
            let mut root = None;
            if crossing.is_isolated {
                root = Algebraic::between(&piece.surface, crossing.t);
            }
            let root = root.unwrap_or_else(|| piece.roots().swap_remove(crossing.root).value);
            Box::new(root)
        })
    }

    /// The distance along the ray of the point nearest to the centre. Polynomials in the distance from there
    /// have small coefficients, which intervals need if the ray starts far away.
    fn shift(&self, centre: Vec3) -> f64 {
        let (origin, dir) = (self.ray.origin.as_dvec3(), self.ray.dir.as_dvec3());
        let shift = (centre.as_dvec3() - origin).dot(dir) / dir.length_squared();
        if shift.is_finite() { shift } else { 0.0 }
    }

    fn shifted_ray(&self, shift: f64) -> RayIn<Interval> {
        let RayIn { origin, dir } = RayIn::<Interval>::of(self.ray);
        let shift = Interval::point(shift);
        RayIn {
            origin: std::array::from_fn(|i| origin[i] + shift * dir[i]),
            dir,
        }
    }

    /// The crossing, if t is in the ray's interval and no condition is negative. `x` is t minus the shift.
    #[inline(never)]
    fn filtered<P: Pieces>(
        &mut self,
        shape: &P,
        piece: &Piece<Interval>,
        x: Interval,
        mut crossing: Crossing,
    ) -> Option<Crossing> {
        let [start, end] = self.interval;
        if crossing.t.hi <= start || crossing.t.lo >= end {
            return None;
        }
        let mut is_certain = true;
        for condition in piece.conditions {
            let value = condition.at(&x);
            if value.hi < 0.0 {
                return None;
            }
            is_certain &= value.lo >= 0.0;
        }
        if !(start < crossing.t.lo && crossing.t.hi < end) {
            let exact = self.exact(shape, &mut crossing);
            if !is_between(exact, [start, end]) {
                return None;
            }
        }
        if !is_certain {
            let piece = ExactPiece::of(self.ray, shape, crossing.piece);
            let bounds = crossing.t;
            if !piece.contains(self.exact(shape, &mut crossing), bounds) {
                return None;
            }
        }
        Some(crossing)
    }

    #[inline(never)]
    fn add_exact_piece<P: Pieces>(&mut self, shape: &P, index: usize, found: &mut Vec<Crossing>) {
        self.work.exact_pieces += 1;
        let piece = ExactPiece::of(self.ray, shape, index);
        for (number, root) in piece.roots().into_iter().enumerate() {
            if !is_between(&root.value, self.interval) {
                continue;
            }
            let is_tangent = root.has_even_multiplicity();
            let mut value = root.value;
            let t = value.enclosure();
            if piece.contains(&value, t) {
                found.push(Crossing {
                    t,
                    part: piece.part,
                    is_tangent,
                    piece: index,
                    root: number,
                    is_isolated: false,
                    exact: Some(Box::new(value)),
                });
            }
        }
    }

    /// Sorts by t, then by part, and keeps one crossing of each t.
    #[inline(never)]
    fn sorted<P: Pieces>(&mut self, shape: &P, mut found: Vec<Crossing>) -> Vec<Crossing> {
        let mut pairs = found.windows(2);
        if pairs.all(|pair| pair[0].t.order(pair[1].t) == Some(Ordering::Less)) {
            return found;
        }
        // Insertion: there are few, and each piece's are sorted.
        let mut sorted: Vec<Crossing> = Vec::with_capacity(found.len());
        for mut crossing in found.drain(..) {
            let mut place = sorted.len();
            let mut order = Ordering::Greater;
            while place > 0 {
                let before = &mut sorted[place - 1];
                order = self.compare((shape, &mut crossing), (shape, before));
                if order != Ordering::Less {
                    break;
                }
                place -= 1;
            }
            if place == 0 || order == Ordering::Greater {
                sorted.insert(place, crossing);
            } else if crossing.part < sorted[place - 1].part {
                sorted[place - 1] = crossing;
            }
        }
        sorted
    }
}

/// Whether a number is in an open interval.
pub fn is_between(t: &Algebraic, [start, end]: [f64; 2]) -> bool {
    t.compare_with(&start.into()) == Ordering::Greater
        && t.compare_with(&end.into()) == Ordering::Less
}
