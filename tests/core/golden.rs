//! 64×64 pictures of a torus in every view, compared exactly.
//!
//! To regenerate them, look at the differences first, then run:
//!
//! ```sh
//! HITSCOPE_GOLDEN=write cargo test -p hitscope-core --test core golden
//! ```
//!
//! If a picture differs, the actual one is saved in the system's temporary folder, and the message gives its
//! path. Shading is flat unless the name says smooth.

use glam::{DVec3, UVec2, Vec3};
use hitscope_core::camera::Projection;
use hitscope_core::integrator::{
    Comparison, Context, INTEGRATORS, Lighting, ViewOptions, integrator,
};
use hitscope_core::kernel::{
    KernelTable as _, Tier, default_triangle_kernel, exact_triangle_kernel,
};
use hitscope_core::light::{DirectionalLight, Environment, Light, Lights};
use hitscope_core::mesh::shapes::{Placement, torus};
use hitscope_core::mesh::{Assigned, Attributes, Illumination, Material, Runs};
use hitscope_core::plan::Plan;
use hitscope_core::render::{Job, render};
use hitscope_core::scene::Shading;
use hitscope_core::scene::scene;
use hitscope_core::shape::Triangle;
use hitscope_core::spawn::SPAWN_POLICIES;
use hitscope_core::{Camera, Clip, Film, Intersector, TriangleMesh};
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;

const SIZE: UVec2 = UVec2::splat(64);
const PERSPECTIVE: Projection = Projection::Perspective {
    fov_y_radians: 0.75,
};
const ORTHOGRAPHIC: Projection = Projection::Orthographic { height: 2.5 };

/// The torus; half a mirror in the view *Recursive*, which would look like *Direct light* without one.
fn mesh(view: &str) -> TriangleMesh {
    let mesh = torus(24, 12, Placement::UNIT);
    if view != "whitted" {
        return mesh;
    }
    let mirror = Material {
        diffuse: Some(Vec3::splat(0.3)),
        specular: Vec3::splat(0.6),
        illumination: Illumination::Mirror,
        ..Material::default()
    };
    mesh.with_attributes(Attributes {
        materials: Assigned::new(vec![mirror], Runs::default()),
        ..Attributes::default()
    })
}

/// A job that draws a torus from above in the named view.
pub fn job(view: &str, shading: Shading, projection: Projection, plan: Plan) -> Job {
    let scene = Arc::new(scene(mesh(view)));
    let view = integrator(view).expect("a view");
    // The exact kernel would leave the pictures of errors blank.
    let kernel = match view.needs.second {
        Comparison::Nothing => default_triangle_kernel(),
        Comparison::Exact | Comparison::Second => Triangle::kernel_of(Tier::Watertight),
    };
    let intersector: Arc<dyn Intersector> = scene.intersector(kernel).into();
    let eye = DVec3::new(1.25, -2.0, 2.25);
    let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Z, projection, plan.size());
    let lamp = DirectionalLight {
        to_light: Vec3::new(0.6, 0.0, 0.8),
        irradiance: Vec3::new(1.5, 1.4, 1.2),
    };
    let sky = Environment::Constant(Vec3::new(0.3, 0.4, 0.5));
    let others = vec![Light::Directional(lamp), Light::Environment(sky)];
    let lighting = Lighting {
        lights: Arc::new(Lights::new(&scene, others)),
        second_spawn: &SPAWN_POLICIES[0],
        ..Lighting::default()
    };
    Job {
        context: Context {
            second: view.second(&scene, &intersector, exact_triangle_kernel().into()),
            scene,
            intersector,
            camera: camera.expect("a camera"),
            shading,
            background: Vec3::new(0.05, 0.1, 0.2),
            lighting,
            options: ViewOptions::default(),
        },
        integrator: view,
        plan,
    }
}

/// The same picture of the half in front of a slanted plane through the torus.
pub fn clipped(job: Job) -> Job {
    let context = job.context;
    let clip = Clip::plane(DVec3::new(0.3, -1.0, 0.2), 0.1).expect("a plane");
    let scene = Arc::new(context.scene.with_clip(Some(clip)));
    Job {
        context: Context {
            intersector: scene.clipped(context.intersector),
            second: scene.clipped(context.second),
            scene,
            ..context
        },
        ..job
    }
}

#[test]
fn every_view_matches_its_golden_picture() {
    let mut different = Vec::new();
    let mut check = |name: &str, view: &str, shading, projection, samples| {
        let job = job(view, shading, projection, Plan::new(SIZE, 4, samples));
        let film = render(job, 2).expect("no panic");
        different.extend(compare(name, &film));
    };
    for view in INTEGRATORS {
        check(view.name, view.name, Shading::Flat, PERSPECTIVE, 1);
    }
    for view in ["shaded", "normal"] {
        check(
            &format!("{view}-smooth"),
            view,
            Shading::Smooth,
            PERSPECTIVE,
            1,
        );
    }
    // Several samples, too: the sample positions in a pixel affect the picture.
    check(
        "shaded-orthographic",
        "shaded",
        Shading::Smooth,
        ORTHOGRAPHIC,
        4,
    );
    for view in CLIPPED {
        let plan = Plan::new(SIZE, 4, 1);
        let job = clipped(job(view, Shading::Flat, PERSPECTIVE, plan));
        let film = render(job, 2).expect("no panic");
        different.extend(compare(&format!("{view}-clipped"), &film));
    }
    assert!(different.is_empty(), "\n{}", different.join("\n"));
}

/// The views with a picture of the clipped torus: back faces are visible.
const CLIPPED: [&str; 2] = ["shaded", "orientation"];

#[test]
fn golden_pictures_differ_from_each_other() {
    if is_writing() {
        return;
    }
    let names = INTEGRATORS.iter().map(|view| view.name);
    let names = names.chain(["shaded-smooth", "normal-smooth", "shaded-orthographic"]);
    let names = names.map(str::to_owned);
    let names = names.chain(CLIPPED.map(|view| format!("{view}-clipped")));
    let pictures: Vec<Vec<u8>> = names.map(|name| read_ppm(&golden_path(&name))).collect();
    for (k, picture) in pictures.iter().enumerate() {
        let same = pictures[..k].iter().position(|earlier| earlier == picture);
        assert_eq!(same, None, "picture {k} equals an earlier one");
    }
}

/// Describes the difference from the golden picture, or `None`. With HITSCOPE_GOLDEN=write, writes the
/// picture instead.
fn compare(name: &str, film: &Film) -> Option<String> {
    let actual: Vec<u8> = film.pixels().iter().flat_map(|p| p[..3].to_vec()).collect();
    if is_writing() {
        fs::write(golden_path(name), ppm(&actual)).expect("the folder can be written");
        return None;
    }
    let expected = read_ppm(&golden_path(name));
    let is_same = |(a, b): &(&[u8], &[u8])| a == b;
    let count = actual
        .chunks(3)
        .zip(expected.chunks(3))
        .filter(|pair| !is_same(pair))
        .count();
    if count == 0 {
        return None;
    }
    let folder = std::env::temp_dir().join("hitscope-golden");
    fs::create_dir_all(&folder).expect("a temporary folder");
    let path = folder.join(format!("{name}.ppm"));
    fs::write(&path, ppm(&actual)).expect("a temporary file");
    Some(format!(
        "{name}: {count} pixels differ; the actual picture is {}",
        path.display()
    ))
}

fn is_writing() -> bool {
    std::env::var_os("HITSCOPE_GOLDEN").is_some_and(|value| value == "write")
}

fn golden_path(name: &str) -> PathBuf {
    // The crate's manifest is in src/core.
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../tests/core/golden");
    folder.join(format!("{name}.ppm"))
}

/// The header of a PPM file of this size; no other header can be read back.
fn header() -> String {
    format!("P6\n{} {}\n255\n", SIZE.x, SIZE.y)
}

fn ppm(rgb: &[u8]) -> Vec<u8> {
    [header().as_bytes(), rgb].concat()
}

fn read_ppm(path: &PathBuf) -> Vec<u8> {
    let bytes = fs::read(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let rgb = bytes.strip_prefix(header().as_bytes());
    let rgb = rgb.unwrap_or_else(|| panic!("{}: not a 64×64 PPM", path.display()));
    assert_eq!(
        rgb.len(),
        3 * SIZE.element_product() as usize,
        "{}",
        path.display()
    );
    rgb.to_vec()
}
