//! Errors of the kernels of combined solids in one case.
//!
//! Rays that lie in a surface of one of a solid's shapes aren't counted, as the oracle doesn't decide about them.

use super::cells::{Answers, ShapeCell, measure};
use super::rays::{Aim, Place, Target};
use super::solids::SampledSolid;
use crate::oracle::OracleSolid;
use glam::{DVec3, Vec3};
use hitscope_core::group::{CSG_KERNELS, SOLID_INFO};
use hitscope_core::kernel::{KernelChoice, KernelInfo, Tier};
use hitscope_core::random::Random;
use hitscope_core::shape::SurfacePoint;
use hitscope_core::{Hit, Intersector, Ray, Scene};

/// The depth of the trees of operations.
const DEPTH: u32 = 2;
/// Rays at each solid, because packing one takes longer than tracing it.
const RAYS_PER_SOLID: u32 = 8;

/// Measures all kernels of solids with the same rays at random bounded solids: a quarter of `n`, as the oracle takes time.
pub(super) fn measure_solids(
    case: &str,
    aim: Aim,
    distance: f64,
    n: u64,
    seed: u64,
) -> Vec<ShapeCell> {
    let names = CSG_KERNELS.map(|info| info.name);
    let mut current: Option<(MeasuredSolid, u32)> = None;
    let answers = |random: &mut Random| loop {
        let (solid, left) = current.get_or_insert_with(|| {
            let solid = MeasuredSolid::random(random, distance);
            (solid, RAYS_PER_SOLID)
        });
        *left -= 1;
        let is_last = *left == 0;
        let answers = solid.answers(random, aim);
        if is_last {
            current = None;
        }
        if let Some(answers) = answers {
            return answers;
        }
    };
    measure(
        case,
        (SOLID_INFO.name, &names),
        answers,
        n.div_ceil(4),
        seed,
    )
}

/// A random solid in a scene of its own, packed for each kernel.
struct MeasuredSolid {
    place: Place,
    solid: OracleSolid,
    /// Points of edges or of the surfaces of its shapes.
    points: Vec<DVec3>,
    /// An axis of each of its shapes.
    axes: Vec<Vec3>,
    scene: Scene,
    /// In the order of [`CSG_KERNELS`].
    intersectors: [Box<dyn Intersector>; 4],
    precise: Box<dyn Intersector>,
}

impl MeasuredSolid {
    fn random(random: &mut Random, distance: f64) -> Self {
        let place = Place::random(random, distance);
        let SampledSolid {
            solid,
            points,
            axes,
        } = SampledSolid::random_bounded(random, place.near, place.size, DEPTH);
        let scene = solid.scene();
        let packed = |info: &'static KernelInfo| scene.intersector(KernelChoice { info });
        let is_precise = |info: &&&KernelInfo| info.tier == Some(Tier::Precise);
        let precise = CSG_KERNELS.iter().find(is_precise);
        Self {
            intersectors: CSG_KERNELS.map(packed),
            precise: packed(precise.expect("every tier has a kernel")),
            place,
            solid,
            points,
            axes,
            scene,
        }
    }

    /// The answers to a random ray; `None` if it doesn't meet what it is aimed at, or lies in a surface.
    fn answers(&self, random: &mut Random, aim: Aim) -> Option<Answers> {
        let ray = self.place.ray(random, aim, self)?;
        let mut division = self.solid.division(&ray)?;
        let first = division.crossings().into_iter().next();
        let size = 0.5 * self.scene.bounds().extent().max_element();
        let hits = self.intersectors.iter();
        Some(Answers {
            t: first.map(|end| division.ends[end].to_f64()),
            length: f64::from(ray.dir.length()) / size,
            hits: hits.map(|packed| packed.closest_hit(&ray)).collect(),
        })
    }

    /// A point where the surfaces of two of its shapes meet, seen from a random place: between rays that hit one and the
    /// other. `None` if they meet at a silhouette instead.
    fn seam(&self, random: &mut Random) -> Option<DVec3> {
        /// Halves the angle between the rays to less than an ulp of f32.
        const HALVINGS: usize = 26;
        /// In sizes. Points on a seam are as near as the rays.
        const NEAR: f64 = 1e-4;
        let Place { near, size, .. } = self.place;
        let origin = (near + 3.0 * size * random.direction()).as_vec3();
        let mut target = || near + size * random.in_cube();
        let (mut a, mut b) = (target(), target());
        let towards = |p: DVec3| {
            let ray = Ray::new(origin, (p - origin.as_dvec3()).as_vec3()).ok()?;
            let hit = self.precise.closest_hit(&ray)?;
            Some((ray, hit))
        };
        let shape_of = |hit: &Hit| hit.v;
        let (mut at_a, mut at_b) = (towards(a)?, towards(b)?);
        if shape_of(&at_a.1) == shape_of(&at_b.1) {
            return None;
        }
        for _ in 0..HALVINGS {
            let middle = a.midpoint(b);
            let at_middle = towards(middle)?;
            if shape_of(&at_middle.1) == shape_of(&at_a.1) {
                (a, at_a) = (middle, at_middle);
            } else {
                (b, at_b) = (middle, at_middle);
            }
        }
        let [p, q] = [at_a, at_b].map(|(ray, hit)| {
            let surface = self.scene.surface(&ray, &hit);
            surface.position.as_dvec3()
        });
        (p.distance(q) < NEAR * size).then(|| p.midpoint(q))
    }
}

impl Target for MeasuredSolid {
    /// A point of a seam, or of an edge of one of its shapes.
    fn point_of_edge(&self, random: &mut Random) -> Option<DVec3> {
        if random.index(2) == 0 {
            return self.seam(random);
        }
        let count = self.points.len();
        (count > 0).then(|| self.points[random.index(count)])
    }

    fn some_axis(&self, random: &mut Random) -> Vec3 {
        self.axes[random.index(self.axes.len())]
    }

    fn first_surface(&self, ray: &Ray) -> Option<SurfacePoint> {
        let hit = self.precise.closest_hit(ray)?;
        Some(self.scene.surface(ray, &hit))
    }
}
