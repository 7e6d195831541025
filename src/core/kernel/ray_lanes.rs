//! Rays side by side.

use crate::lane::{Lane, LaneMask, longest_axis};
use crate::ray::Ray;

/// One ray in every lane, or as many rays as there are lanes, all of which look along the same axis.
#[derive(Clone, Copy)]
pub(crate) struct RayLanes<L> {
    /// Where they start.
    pub origin: [L; 3],
    /// Where they go.
    pub dir: [L; 3],
    /// The ends of their intervals.
    pub interval: [L; 2],
    /// Which coordinates to take as x, y and z: z is the direction's longest one, the next two are x and
    /// y, swapped where z looks backwards, which keeps the triangles' winding.
    pub axes: [usize; 3],
}

impl<L: Lane> RayLanes<L> {
    /// The same ray in every lane.
    #[inline(always)]
    pub fn of(token: L::Token, ray: &Ray) -> Self {
        let ([x, y, z], [i, j, k]) = (ray.origin.to_array(), ray.dir.to_array());
        let dir = [i, j, k];
        Self {
            origin: [L::of(token, x), L::of(token, y), L::of(token, z)],
            dir: [L::of(token, i), L::of(token, j), L::of(token, k)],
            interval: [L::of(token, ray.t_min), L::of(token, ray.t_max)],
            axes: axes_of(dir),
        }
    }

    /// A ray in each lane; `None` if they don't all look along the same axis.
    #[inline(always)]
    pub fn side_by_side(origin: [L; 3], dir: [L; 3], interval: [L; 2]) -> Option<Self> {
        let size = [dir[0].abs(), dir[1].abs(), dir[2].abs()];
        let is_x = size[1].le(size[0]) & size[2].le(size[0]);
        let is_y = size[2].le(size[1]);
        let z = match (is_x.any(), is_y.any()) {
            _ if is_x.all() => 0,
            (false, _) if is_y.all() => 1,
            (false, false) => 2,
            _ => return None,
        };
        let is_backward = dir[z].lt(L::of(dir[z].token(), 0.0));
        if is_backward.any() != is_backward.all() {
            return None;
        }
        Some(Self {
            origin,
            dir,
            interval,
            axes: axes_along(z, is_backward.any()),
        })
    }
}

/// See [`RayLanes::axes`].
#[inline(always)]
pub(crate) fn axes_of(dir: [f32; 3]) -> [usize; 3] {
    let z = longest_axis(dir);
    axes_along(z, dir[z] < 0.0)
}

#[inline(always)]
fn axes_along(z: usize, is_backward: bool) -> [usize; 3] {
    let (x, y) = ((z + 1) % 3, (z + 2) % 3);
    if is_backward { [y, x, z] } else { [x, y, z] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn the_axes_keep_the_winding_whichever_way_the_ray_looks() {
        for dir in [Vec3::X, Vec3::Y, Vec3::Z] {
            for sign in [1.0, -1.0] {
                let d = (dir * sign).to_array();
                let [x, y, z] = axes_of(d);
                let unit = |i: usize| {
                    Vec3::from_array(std::array::from_fn(|k| f32::from(u8::from(k == i))))
                };
                assert_eq!(unit(x).cross(unit(y)).dot(unit(z)), sign, "{d:?}");
            }
        }
    }
}
