//! The commands' options of the clip: rays, inspections and pictures show the same part.

use crate::folder::Folder;
use glam::{DVec3, UVec2};
use hitscope_core::camera::Turntable;
use hitscope_core::integrator::palette::id_colour;
use hitscope_core::kernel::exact_triangle_kernel;
use hitscope_core::mesh::shapes;
use hitscope_core::progress::Progress;
use hitscope_core::scene::{Shading, scene};
use hitscope_core::tone::Display;
use hitscope_core::{Clip, Scene};
use hitscope_lab::commands::{BenchArgs, ConvergeArgs, InspectArgs, RenderArgs};
use hitscope_lab::inspection::Inspection;
use hitscope_lab::measure::scene::{SceneSizes, measure};
use serde_json::Value;

fn ts(answer: &Value) -> Vec<f64> {
    let hits = answer["hits"].as_array().expect("a list");
    hits.iter().filter_map(|hit| hit["t"].as_f64()).collect()
}

#[test]
fn trace_drops_crossings_outside_of_the_clip() {
    // Through the cube's faces z = 1 and z = 0, from above.
    let ray = "0.25 0.75 3 0 0 -1";
    for (clip, expected) in [
        ("", vec![2.0, 3.0]),
        ("--clip-plane 0,0,1,0.5", vec![3.0]),
        ("--clip-plane 0,0,-1,-0.5", vec![2.0]),
        // A face in the plane belongs to both sides of it.
        ("--clip-plane 0,0,2,2", vec![2.0, 3.0]),
        ("--clip-plane 0,0,-2,-2", vec![2.0]),
        ("--clip-plane 0,0,1,0.5 --clip-plane 0,0,-1,-0.2", vec![]),
        ("--clip-box 0,0,0.5,1,1,2", vec![2.0]),
        ("--clip-box 0,0,-1,0.2,1,2", vec![]),
        ("--clip-box 0,0,-1,1,1,2 --clip-plane 0,0,1,0.5", vec![3.0]),
    ] {
        for kernel in ["fast", "watertight", "precise", "exact"] {
            let folder = Folder::new();
            let options = format!("{clip} --kernel {kernel}");
            let all = folder.trace(&format!("{options} --all"), ray);
            assert_eq!(ts(&all[0]), expected, "{options}");
            let closest = &folder.trace(&options, ray)[0];
            assert_eq!(
                closest["t"].as_f64(),
                expected.first().copied(),
                "{options}"
            );
            let any = &folder.trace(&format!("{options} --any"), ray)[0];
            assert_eq!(any["hit"], !expected.is_empty(), "{options}");
        }
    }
}

#[test]
fn a_clip_is_in_the_files_coordinates_for_a_distant_mesh_and_in_either_frame() {
    let folder = Folder::new();
    let far: String = crate::folder::CUBE
        .lines()
        .map(|line| match line.strip_prefix("v ") {
            Some(rest) => {
                let p: Vec<f64> = rest.split(' ').filter_map(|x| x.parse().ok()).collect();
                format!("v {} {} {}\n", p[0] + 1_048_576.25, p[1] - 1e6, p[2] + 1e6)
            }
            None => format!("{line}\n"),
        })
        .collect();
    folder.write("cube.obj", &far);
    let ray = "1048576.5 -999999.25 1000003 0 0 -1";
    for recentre in ["on", "off"] {
        for (plane, expected) in [("0,0,1,1000000.5", 3.0), ("0,0,-1,-1000000.5", 2.0)] {
            let options = format!("--recentre {recentre} --clip-plane {plane}");
            let found = &folder.trace(&options, ray)[0];
            assert_eq!(found["t"], expected, "{options}");
        }
    }
}

#[test]
fn inspections_are_of_the_part_that_is_shown() {
    let folder = Folder::new();
    let line = "@cube.obj --pixel 50,30 --size 101x61 --eye 0.4,0.5,5 --target 0.4,0.5,0 --json";
    let inspect = |clip: &str| {
        let line = format!("{line} {clip}");
        folder.json(|f, out| f.args::<InspectArgs>(&line).run(out))
    };
    let whole = inspect("");
    let below = inspect("--clip-plane 0,0,1,0.5");
    assert_eq!(
        (&whole["hit"]["t"], &below["hit"]["t"]),
        (&4.0.into(), &5.0.into())
    );
    assert_eq!(
        below["hit"]["side"], "back",
        "the cube's floor, from inside"
    );
    assert_eq!(below["exact"]["t"], 5.0);
    let crossings = |found: &Value| found["crossings"].as_array().map(Vec::len);
    assert_eq!([&whole, &below].map(crossings), [Some(2), Some(1)]);
    for kernel in below["kernels"].as_array().expect("a list") {
        assert_eq!(
            (&kernel["t"], &kernel["t_error_ulps"]),
            (&5.0.into(), &0.0.into())
        );
    }
    let nothing = inspect("--clip-plane 0,0,1,-0.5");
    assert_eq!(
        (&nothing["hit"], &nothing["exact"]),
        (&Value::Null, &Value::Null)
    );
    let kernels = nothing["kernels"].as_array().expect("a list");
    assert!(kernels.iter().all(|kernel| kernel["hit"] == false));
}

#[test]
fn each_pixel_shows_the_primitive_that_its_inspection_hits() {
    let folder = Folder::new();
    folder.write(
        "scene.xml",
        r#"<scene version="3.0.0"><shape type="obj"><string name="filename" value="cube.obj"/></shape>
        <shape type="sphere"><point name="center" x="0.5" y="0.5" z="1"/><float name="radius" value="0.4"/></shape></scene>"#,
    );
    for clip in [
        "--clip-plane 1,0.5,0.25,0.9",
        "--clip-box 0.1,0.2,0.3,0.8,2,1.2",
    ] {
        let line = format!(
            "@scene.xml -o @out.png --size 24x18 --eye 3,2,4 --samples 1 --view triangle {clip}"
        );
        let args = folder.args::<RenderArgs>(&line);
        let rendered = args.trace().expect("rendered");
        let scene = &rendered.loaded.scene;
        assert!(scene.clip().is_some());
        let intersector = args.picture.scene.intersector(scene);
        let size = rendered.film.size();
        let mut shown = Vec::new();
        for (y, x) in (0..size.y).flat_map(|y| (0..size.x).map(move |x| (y, x))) {
            let (camera, pixel) = (&rendered.camera, UVec2::new(x, y));
            let found = Inspection::of_pixel(scene, &*intersector, Shading::Flat, camera, pixel);
            let exact = found.exact.as_ref().map(|exact| exact.primitive);
            let hit = found.hit.map(|hit| hit.primitive);
            // Watertight decides as exact arithmetic does.
            assert_eq!(hit, exact, "{pixel} {clip}");
            if let Some(primitive) = hit {
                let colour = Display::default().encode(id_colour(primitive));
                let in_picture = rendered.film.pixels()[(y * size.x + x) as usize];
                assert_eq!(in_picture, colour, "{pixel} {clip}");
                shown.push(primitive);
            }
        }
        shown.sort_unstable();
        shown.dedup();
        // The sphere, and triangles seen from inside the cube.
        assert!(shown.len() > 3 && shown.contains(&12), "{shown:?}");
    }
}

#[test]
fn bench_and_converge_trace_the_part_that_the_clip_keeps() {
    let folder = Folder::new();
    let bench = |clip: &str| {
        let line =
            format!("@cube.obj --size 32x24 --rounds 1 --threads 1 --kernel exact --json {clip}");
        let report = folder.json(|folder, out| folder.args::<BenchArgs>(&line).run(out));
        let row = &report["workloads"][0];
        assert_eq!(
            (&row["name"], &row["rays"]),
            (&"primary".into(), &768.into())
        );
        row["hits"].as_u64().expect("a number")
    };
    let whole = bench("");
    let part = bench("--clip-box 0,0,0,0.5,0.5,0.5");
    assert!(0 < part && part < whole, "{part} of {whole}");
    assert_eq!(bench("--clip-plane 0,0,1,-0.5"), 0);

    let mean_error = |clip: &str| {
        let line = format!(
            "@cube.obj --size 8x8 --reference 16 --seconds 100 --setting path,depth=0 --json {clip}"
        );
        let report = folder.json(|folder, out| folder.args::<ConvergeArgs>(&line).run(out));
        let points = report["convergence"]["points"].as_array().expect("a list");
        points[0]["relative_rmse"].as_f64().expect("a number")
    };
    // Without reflection the surface is black; without surface there is only the environment.
    assert!(mean_error("") > 0.0);
    assert_eq!(mean_error("--clip-plane 0,0,1,-0.5"), 0.0);
}

#[test]
fn measuring_a_clipped_scene_checks_rays_against_the_part_that_is_kept() {
    let mesh = shapes::sphere(3, shapes::Placement::UNIT);
    let whole = scene(mesh);
    let camera = Turntable::framing(whole.bounds(), UVec2::new(64, 48)).camera(UVec2::new(64, 48));
    // A box within the hollow sphere.
    let (centre, half) = (whole.bounds().centre().as_dvec3(), DVec3::splat(0.1));
    let clip = Clip::axis_box(centre - half, centre + half).expect("a box");
    let sizes = SceneSizes {
        checked: 3000,
        timed: 3000,
        rounds: 1,
    };
    let exact = |scene: &Scene| {
        let mut rows = Vec::new();
        let never = Progress::default();
        measure(scene, &camera, sizes, &never, |row| rows.push(row)).expect("never cancelled");
        let exact = rows
            .into_iter()
            .find(|row| row.kernel == exact_triangle_kernel().info.name);
        exact.expect("a row")
    };
    let [whole, part] = [exact(&whole), exact(&whole.with_clip(Some(clip)))];
    for row in [&whole, &part] {
        assert_eq!(row.wrong_per_million, 0.0);
    }
    assert!(whole.hits > 0);
    assert!(part.n > 0 && part.n < whole.n, "{} of {}", part.n, whole.n);
    assert_eq!(part.hits, 0);
}
