//! A grid at the lowest point of the scene, across the up axis, with its spacing and a scale bar.
//!
//! Grid lines are at multiples of the spacing in the file's coordinates. The spacing follows the view, so that cells have
//! about the same size in the picture at any distance.

use super::gather::Gather;
use super::input::OverlayInput;
use super::label::{Label, Place};
use super::spec::{Fade, LineSpec, OverlaySpec, OverlayStyle};
use super::step::Step;
use crate::gpu::lines::Line;
use glam::{DVec2, DVec3};
use hitscope_core::camera::{Projection, UpAxis};
use hitscope_core::{Aabb, Scene};

/// The overlay.
pub static GRID: OverlaySpec = OverlaySpec {
    name: "grid",
    title: "Ground grid",
    about: "A grid at the lowest point of the scene, with its spacing and a scale bar",
    style: OverlayStyle {
        colour: [128; 3],
        opacity: 0.7,
        width_px: 1.0,
    },
    lines: &[
        LineSpec {
            opacity: 0.5,
            fade: Fade::Dense,
            is_cut: false,
            ..LineSpec::new(|input, _| gather(input, GridLines::Minor))
        },
        LineSpec {
            fade: Fade::Dense,
            is_cut: false,
            ..LineSpec::new(|input, _| gather(input, GridLines::Major))
        },
    ],
    labels,
    ..OverlaySpec::SWITCH
};

/// The least size of a cell at the pivot, in points.
const CELL_POINTS: f64 = 40.0;
/// The greatest length of the scale bar in points.
const BAR_POINTS: f64 = 140.0;
/// Cells from the centre of the grid to its edge: more than half a picture of 4k.
const CELLS: i32 = 60;
/// Cells between major lines. Pieces of lines are as long, and the centre of the grid moves in steps of as much.
const MAJOR: i32 = 10;

/// Which lines of the grid.
#[derive(Clone, Copy, Debug, PartialEq)]
enum GridLines {
    /// Between major lines.
    Minor,
    /// Each tenth.
    Major,
}

/// The place of a grid.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Grid {
    spacing: Step,
    /// The same as a number.
    cell: f64,
    /// The axes in its plane, then the up axis.
    axes: [usize; 3],
    /// The coordinates of its centre along the axes in its plane, in cells from the file's origin.
    centre: DVec2,
}

fn gather(input: &OverlayInput, which: GridLines) -> Option<Gather> {
    let grid = Grid::of(input)?;
    let gather = Gather::new((grid, which), |scene, &(grid, which)| {
        grid.lines(scene, which)
    });
    Some(gather.within(grid.bounds(&input.scene)))
}

impl Grid {
    /// The grid for a view. `None` if the scene has no bounds, the camera is at the pivot, or 32-bit numbers don't reach
    /// the grid's edge.
    fn of(input: &OverlayInput) -> Option<Self> {
        if input.scene.bounds_with_elements().is_empty() {
            return None;
        }
        let least = CELL_POINTS * f64::from(input.scale) * input.pixel_size();
        let spacing = Step::at_least(least)?;
        let cell = spacing.value();
        let axes = match input.up_axis {
            UpAxis::Y => [0, 2, 1],
            UpAxis::Z => [0, 1, 2],
        };
        let pivot = input.pivot + input.scene.mesh().origin();
        let snap = f64::from(MAJOR) * cell;
        let cells = |axis: usize| (pivot[axis] / snap).round() * f64::from(MAJOR);
        let grid = Self {
            spacing,
            cell,
            axes,
            centre: DVec2::new(cells(axes[0]), cells(axes[1])),
        };
        let bounds = grid.bounds(&input.scene);
        let is_near = bounds.min.is_finite() && bounds.max.is_finite();
        is_near.then_some(grid)
    }

    fn bounds(&self, scene: &Scene) -> Aabb {
        let corner = |cells: i32| self.point(scene, [cells; 2]).as_vec3();
        Aabb::around([corner(-CELLS), corner(CELLS)])
    }

    /// A point of the grid in the scene's coordinates, in cells from its centre.
    fn point(&self, scene: &Scene, cells: [i32; 2]) -> DVec3 {
        let [u, v, up] = self.axes;
        let origin = scene.mesh().origin();
        let mut point = DVec3::ZERO;
        point[u] = (self.centre.x + f64::from(cells[0])) * self.cell - origin[u];
        point[v] = (self.centre.y + f64::from(cells[1])) * self.cell - origin[v];
        point[up] = scene.bounds_with_elements().min[up].into();
        point
    }

    /// The lines in pieces, as each piece fades as a whole.
    fn lines(&self, scene: &Scene, which: GridLines) -> Vec<Line> {
        let (step, is_wanted): (i32, fn(i32) -> bool) = match which {
            GridLines::Minor => (1, |cell| cell % MAJOR != 0),
            GridLines::Major => (MAJOR, |cell| cell % MAJOR == 0),
        };
        let across = (-CELLS..=CELLS).filter(|&cell| is_wanted(cell));
        let along = (-CELLS..CELLS).step_by(MAJOR as usize);
        let pieces = across.flat_map(|v| along.clone().map(move |u| [u, v]));
        let piece = |[u, v]: [i32; 2], swap: fn([i32; 2]) -> [i32; 2]| {
            let at = |cells| self.point(scene, swap(cells));
            let (start, next) = (at([u, v]), at([u, v + step]));
            Line {
                start: start.as_vec3(),
                end: at([u + MAJOR, v]).as_vec3(),
                gap: (next - start).as_vec3(),
            }
        };
        pieces
            .flat_map(|at| [piece(at, |cells| cells), piece(at, |[u, v]| [v, u])])
            .collect()
    }
}

/// The scale bar and the spacing.
fn labels(input: &OverlayInput) -> Vec<Label> {
    let (grid, pixel) = (Grid::of(input), input.pixel_size());
    let bar = Step::at_most(BAR_POINTS * f64::from(input.scale) * pixel);
    let Some((grid, bar)) = grid.zip(bar) else {
        return Vec::new();
    };
    let place = match input.camera.projection() {
        Projection::Perspective { .. } => " at the pivot",
        Projection::Orthographic { .. } => "",
    };
    vec![
        Label {
            place: Place::Corner { bar_px: None },
            text: format!("Grid: {}", grid.spacing.in_units()),
        },
        Label {
            place: Place::Corner {
                bar_px: Some(bar.value() / pixel),
            },
            text: format!("{}{place}", bar.in_units()),
        },
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::overlay::tests::input;
    use glam::{UVec2, Vec3};
    use hitscope_core::scene::scene;
    use hitscope_core::{Camera, TriangleMesh};
    use std::sync::Arc;

    /// A scene whose lowest points along y and z are -1 and -2, at this origin.
    fn scene_at(origin: DVec3) -> Arc<Scene> {
        let corners = vec![Vec3::ZERO, Vec3::new(1.0, -1.0, 0.0), Vec3::NEG_Z * 2.0];
        let mesh = TriangleMesh::new(corners, vec![[0, 1, 2]]);
        Arc::new(scene(mesh.with_origin(origin)))
    }

    #[test]
    fn the_grid_is_at_the_lowest_point_across_the_up_axis() {
        let mut input = input(&scene_at(DVec3::ZERO));
        for (up_axis, axis, lowest) in [(UpAxis::Y, 1, -1.0), (UpAxis::Z, 2, -2.0)] {
            input.up_axis = up_axis;
            let grid = Grid::of(&input).expect("a grid");
            for which in [GridLines::Minor, GridLines::Major] {
                for line in grid.lines(&input.scene, which) {
                    assert_eq!([line.start[axis], line.end[axis]], [lowest; 2]);
                    assert_eq!(line.gap[axis], 0.0);
                }
            }
        }
    }

    #[test]
    fn major_lines_are_multiples_of_ten_cells_of_the_file_and_minor_lines_the_others() {
        let origin = DVec3::new(1234.5, 0.0, -77.25);
        let input = input(&scene_at(origin));
        let grid = Grid::of(&input).expect("a grid");
        let spacing = grid.cell;
        let cells_of = |which| {
            let lines = grid.lines(&input.scene, which);
            let along_z = lines.into_iter().filter(|line| line.start.x == line.end.x);
            let mut cells: Vec<f64> = along_z
                .map(|line| (f64::from(line.start.x) + origin.x) / spacing)
                .collect();
            cells.dedup();
            cells
        };
        // The positions are f32 numbers of less than a hundred cells.
        let is_whole = |cells: f64| (cells - cells.round()).abs() < 1e-3;
        let (minor, major) = (cells_of(GridLines::Minor), cells_of(GridLines::Major));
        assert!(major.iter().all(|cells| is_whole(cells / 10.0)));
        assert!(minor.iter().all(|&cells| is_whole(cells)));
        assert!(!minor.iter().any(|cells| is_whole(cells / 10.0)));
        let count = |cells: Vec<f64>| {
            let mut cells: Vec<i64> = cells.into_iter().map(|x| x.round() as i64).collect();
            cells.sort_unstable();
            cells.dedup();
            cells.len() as i32
        };
        assert_eq!(count(major), 2 * CELLS / MAJOR + 1);
        assert_eq!(count(minor), 2 * CELLS - 2 * CELLS / MAJOR);
    }

    #[test]
    fn cells_have_about_the_same_size_on_any_screen() {
        let mut input = input(&scene_at(DVec3::ZERO));
        for scale in [1.0, 1.5, 2.0, 3.0] {
            input.scale = scale;
            let grid = Grid::of(&input).expect("a grid");
            let points = grid.cell / input.pixel_size() / f64::from(scale);
            // Steps grow by 2 or 2.5.
            assert!((40.0..100.0).contains(&points), "{points}");
        }
    }

    #[test]
    fn lines_are_kept_while_the_camera_moves_a_little() {
        let scene = scene_at(DVec3::ZERO);
        let mut input = input(&scene);
        // In perspective the spacing changes with the pivot's depth.
        let projection = Projection::Orthographic { height: 5.0 };
        let (eye, size) = (DVec3::new(4.0, 5.0, 6.0), UVec2::new(640, 480));
        let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, projection, size);
        input.camera = camera.expect("a camera");
        let gather = |input: &OverlayInput| gather(input, GridLines::Minor).expect("lines");
        let before = gather(&input);
        let spacing = Grid::of(&input).expect("a grid").cell;
        input.pivot = 4.0 * spacing * DVec3::X;
        assert!(before.key() == gather(&input).key());
        input.pivot = 6.0 * spacing * DVec3::X;
        assert!(before.key() != gather(&input).key());
    }

    #[test]
    fn the_bar_has_the_length_of_its_text() {
        let input = input(&scene_at(DVec3::ZERO));
        let labels = labels(&input);
        let bar = labels.iter().find_map(|label| match label.place {
            Place::Corner { bar_px: Some(px) } => Some((px, &label.text)),
            _ => None,
        });
        let (px, text) = bar.expect("a bar");
        let units: f64 = text
            .split(' ')
            .next()
            .and_then(|word| word.parse().ok())
            .expect("a number");
        assert!(
            (px * input.pixel_size() / units - 1.0).abs() < 1e-12,
            "{text}"
        );
        // At least two fifths of the most.
        assert!((56.0..=140.0).contains(&px), "{px}");
    }
}
