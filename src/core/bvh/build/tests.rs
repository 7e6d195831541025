//! Tests of both builders.

use super::*;
use glam::Vec3;

fn build(boxes: &[Aabb]) -> Bvh {
    let bounds_of = |primitive: u32| boxes[primitive as usize];
    Bvh::build(boxes.len(), &bounds_of, &|| Ok(())).expect("never cancelled")
}

fn build_quickly(boxes: &[Aabb]) -> Bvh {
    let bounds_of = |primitive: u32| boxes[primitive as usize];
    Bvh::build_quickly(boxes.len(), &bounds_of, &|| Ok(())).expect("never cancelled")
}

const BUILDERS: [fn(&[Aabb]) -> Bvh; 2] = [build, build_quickly];

/// Asserts that every primitive is in exactly one block, and every block within its ancestors' boxes.
fn assert_sound(bvh: &Bvh, boxes: &[Aabb], expected: usize) {
    let mut seen = vec![0; boxes.len()];
    let mut stack: Vec<(usize, Aabb, usize)> = vec![];
    if !bvh.nodes.is_empty() {
        stack.push((0, bvh.bounds, 1));
    }
    while let Some((index, outer, depth)) = stack.pop() {
        assert!(depth <= MAX_DEPTH);
        let node = &bvh.nodes[index];
        for slot in 0..WIDTH {
            let child = node.child[slot];
            if child == Child::NONE {
                continue;
            }
            let row =
                |first: usize| Vec3::from_array([0, 2, 4].map(|k| node.planes[first + k][slot]));
            let bounds = Aabb {
                min: row(0),
                max: row(1),
            };
            assert_eq!(outer.union(bounds), outer);
            if !child.is_leaf() {
                stack.push((child.node_index(), bounds, depth + 1));
                continue;
            }
            assert!(child.block_count() <= LEAF_BLOCKS);
            for block in child.first_block()..child.first_block() + child.block_count() {
                for &primitive in bvh.block(block) {
                    seen[primitive as usize] += 1;
                    let inner = boxes[primitive as usize];
                    assert_eq!(bounds.union(inner), bounds);
                }
            }
        }
    }
    assert!(seen.iter().all(|&n| n <= 1));
    assert_eq!(seen.iter().sum::<usize>(), expected);
}

fn scattered(n: u64) -> Vec<Aabb> {
    let at = |i: u64| (crate::sampler::mix(i) >> 40) as f32 / 1e4;
    (0..n)
        .map(|i| {
            let p = Vec3::new(at(3 * i), at(3 * i + 1), at(3 * i + 2));
            Aabb::around([p, p + at(i) * 1e-3])
        })
        .collect()
}

#[test]
fn every_primitive_is_in_one_leaf_and_every_box_encloses_its_children() {
    for n in [0, 1, 8, 9, 1000, 150_000] {
        let boxes = scattered(n);
        for build in BUILDERS {
            assert_sound(&build(&boxes), &boxes, n as usize);
        }
    }
}

#[test]
fn identical_boxes_and_extreme_extents_build() {
    let point = Aabb::around([Vec3::ONE]);
    let huge = Aabb::around([Vec3::splat(-3e38), Vec3::splat(3e38)]);
    let tiny = Aabb::around([Vec3::ZERO, Vec3::splat(1e-45)]);
    for case in [
        vec![point; 50_000],
        vec![huge; 100],
        vec![tiny, huge, point],
    ] {
        for build in BUILDERS {
            assert_sound(&build(&case), &case, case.len());
        }
    }
    // Centres in a geometric series put all but one into the first bin.
    let series: Vec<Aabb> = (0..250)
        .map(|i| Aabb::around([Vec3::splat(2f32.powi(i - 125))]))
        .collect();
    assert_sound(&build(&series), &series, series.len());
}

/// Clusters of 64 boxes; each cluster has half the size of the one before.
fn nested_clusters(count: i32) -> Vec<Aabb> {
    let cluster = |k: i32| {
        let scale = 2f32.powi(-k);
        scattered(64).into_iter().map(move |b| {
            let shift = Vec3::splat(scale);
            let moved = |p: Vec3| p * (scale / 2000.0) + shift;
            Aabb::around([moved(b.min), moved(b.max)])
        })
    };
    (0..count).flat_map(cluster).collect()
}

#[test]
fn a_scene_whose_nodes_would_be_too_deep_is_built_with_fewer_levels() {
    let boxes = nested_clusters(60);
    assert_sound(&build(&boxes), &boxes, boxes.len());
    let mut items = items_of(boxes.len(), &|primitive| boxes[primitive as usize]);
    let build = Build::new(&items, &|| Ok(()));
    let mut is_built = |levels: usize, max_depth: usize| {
        let part = build.collapsed(&mut items, levels, max_depth);
        part.expect("never cancelled").is_some()
    };
    // 480 blocks need ten levels.
    assert!(!is_built(USUAL_LEVELS, 12));
    assert!(is_built(12, 12));
    assert!(is_built(USUAL_LEVELS, MAX_DEPTH));
}

/// The number of children per node.
fn fill(bvh: &Bvh) -> f64 {
    let children = bvh.nodes.iter().flat_map(|node| node.child);
    let count = children.filter(|child| *child != Child::NONE).count();
    count as f64 / bvh.nodes.len() as f64
}

#[test]
fn nodes_are_filled_even_over_boxes_without_area() {
    let points = |at: fn(f32) -> Vec3| (0..10_000).map(move |k| Aabb::around([at(k as f32)]));
    // Nodes made by splitting the child of largest area until there are eight had 3.7 children in the bunny.
    for boxes in [
        scattered(10_000),
        points(|_| Vec3::splat(1000.0)).collect(),
        points(|x| Vec3::new(x, 0.0, 0.0)).collect(),
    ] {
        let fill = fill(&build(&boxes));
        assert!(fill > 6.0, "{fill}");
    }
}

#[test]
fn the_tree_does_not_depend_on_the_scenes_size() {
    let boxes = scattered(2000);
    let blocks = build(&boxes).blocks;
    for exponent in [-70, 70] {
        let scale = 2f32.powi(exponent);
        let scaled = |b: &Aabb| Aabb::around([b.min * scale, b.max * scale]);
        let boxes: Vec<Aabb> = boxes.iter().map(scaled).collect();
        assert_eq!(build(&boxes).blocks, blocks, "2^{exponent}");
    }
}

#[test]
fn boxes_that_no_ray_can_meet_are_omitted() {
    let valid = Aabb::around([Vec3::ZERO, Vec3::ONE]);
    let nan = Aabb {
        min: Vec3::splat(f32::NAN),
        max: Vec3::ONE,
    };
    let infinite = Aabb {
        min: Vec3::ZERO,
        max: Vec3::INFINITY,
    };
    let boxes = [nan, valid, Aabb::EMPTY, infinite];
    for build in BUILDERS {
        assert_sound(&build(&boxes), &boxes, 1);
    }
}

/// All four lanes of a register, including the one that isn't a coordinate.
#[cfg(target_arch = "x86_64")]
fn lanes(v: Vec3A) -> [f32; 4] {
    bytemuck::cast(std::arch::x86_64::__m128::from(v))
}

#[cfg(target_arch = "x86_64")]
#[test]
fn no_lane_that_the_builder_computes_with_is_subnormal() {
    // Multiplied, a subnormal number costs an Intel processor some 150 cycles.
    let boxes = scattered(1000);
    let items = items_of(boxes.len(), &|primitive| boxes[primitive as usize]);
    let far = Item::new(boxes[1], NO_PRIMITIVE - 1);
    for item in items.iter().chain([&far]) {
        assert!(item.index() < 1000 || item.index() == NO_PRIMITIVE - 1);
        let Bounds { lower, upper } = std::hint::black_box(item.bounds());
        for lane in lanes(lower).into_iter().chain(lanes(upper)) {
            assert!(!lane.is_subnormal(), "{lane:e} of item {}", item.index());
        }
    }
}

#[test]
fn an_item_keeps_any_index() {
    for index in [0, 0xffff, 0x1_0000, 0xdead_beef, NO_PRIMITIVE - 1] {
        assert_eq!(Item::new(Aabb::around([Vec3::ONE]), index).index(), index);
    }
}

#[test]
fn a_cancelled_build_returns_an_error() {
    let unit = |_| Aabb::around([Vec3::ZERO, Vec3::ONE]);
    assert!(Bvh::build(2000, &unit, &|| Err(Cancelled)).is_err());
    assert!(Bvh::build_quickly(2000, &unit, &|| Err(Cancelled)).is_err());
}

#[test]
fn the_tree_does_not_depend_on_the_number_of_threads() {
    for boxes in [scattered(150_000), nested_clusters(1000)] {
        assert_same_with_threads(&boxes);
    }
}

fn assert_same_with_threads(boxes: &[Aabb]) {
    let trees = [1, 3].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads").install(|| build(boxes))
    });
    assert_eq!(trees[0].blocks, trees[1].blocks);
    assert!(
        trees[0]
            .nodes
            .iter()
            .zip(&trees[1].nodes)
            .all(|(a, b)| a.planes == b.planes && a.child == b.child)
    );
}
