//! Makes the scene that the viewer shows without a file: `assets/default.obj` and `default.mtl`.
//!
//! Run `cargo run -p hitscope-core --example default_scene` after a change; it prints the paths that
//! it wrote. A knot of rough copper shows flat against smooth, a gem of glass is meant to be flat, a shell is made
//! of thin triangles, and the floor of two large ones.

use glam::DVec3;
use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;

fn main() -> std::io::Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../assets");
    for (name, text) in [("default.obj", scene()), ("default.mtl", materials())] {
        let path = folder.join(name);
        std::fs::write(&path, text)?;
        eprintln!("wrote {}", path.display());
    }
    Ok(())
}

fn materials() -> String {
    let materials = [
        ("floor", [0.32, 0.33, 0.35], "Pr 0.35\nPm 0"),
        ("knot", [0.93, 0.56, 0.36], "Pr 0.22\nPm 1"),
        ("gem", [0.25, 0.48, 0.72], "illum 7\nNi 1.5\nTf 0.7 0.88 1"),
        ("shell", [0.46, 0.62, 0.34], "Pr 0.6\nPm 0"),
    ];
    let material = |(name, [r, g, b], finish): (&str, [f64; 3], &str)| {
        format!("newmtl {name}\nKd {r} {g} {b}\n{finish}\n")
    };
    materials.into_iter().map(material).collect()
}

fn scene() -> String {
    let mut obj = Obj::default();
    obj.text += "# Made by assets/default_scene.rs\nmtllib default.mtl\n";
    floor(&mut obj);
    knot(&mut obj);
    gem(&mut obj);
    shell(&mut obj);
    obj.text
}

/// The text of an OBJ file, and how many vertices it has so far.
#[derive(Default)]
struct Obj {
    text: String,
    vertex_count: usize,
}

impl Obj {
    /// Starts an object, whose material has the same name. Smooth shading leaves the edges of one that isn't smooth.
    fn object(&mut self, name: &str, is_smooth: bool) {
        let smoothing = if is_smooth { "1" } else { "off" };
        _ = writeln!(self.text, "o {name}\nusemtl {name}\ns {smoothing}");
    }

    /// Adds a vertex, and returns its index.
    fn vertex(&mut self, p: DVec3) -> usize {
        // Rounded, so that the last digits of a sine don't depend on the machine; no "-0".
        let [x, y, z] = p.to_array().map(|c| (c * 1e5).round() / 1e5 + 0.0);
        _ = writeln!(self.text, "v {x} {y} {z}");
        self.vertex_count += 1;
        self.vertex_count
    }

    fn face(&mut self, corners: &[usize]) {
        self.text += "f";
        for corner in corners {
            _ = write!(self.text, " {corner}");
        }
        self.text += "\n";
    }
}

/// One large quad.
fn floor(obj: &mut Obj) {
    obj.object("floor", false);
    let corners = [(-3.2, -2.4), (-3.2, 2.4), (3.2, 2.4), (3.2, -2.4)];
    let corners = corners.map(|(x, z)| obj.vertex(DVec3::new(x, 0.0, z)));
    obj.face(&corners);
}

/// A tube along the (2, 3) torus knot.
fn knot(obj: &mut Obj) {
    const ALONG: usize = 160;
    const AROUND: usize = 16;
    const TUBE: f64 = 0.21;
    obj.object("knot", true);
    let centre = |s: f64| {
        let (p, q) = (2.0 * s, 3.0 * s);
        let r = 0.68 + 0.27 * q.cos();
        DVec3::new(r * p.cos(), 1.18 + r * p.sin(), 0.34 * q.sin())
    };
    let first = obj.vertex_count + 1;
    for i in 0..ALONG {
        let s = TAU * i as f64 / ALONG as f64;
        let tangent = (centre(s + 1e-4) - centre(s - 1e-4)).normalize();
        // The knot winds around the z axis, so this never vanishes.
        let side = tangent.cross(DVec3::Z).normalize();
        let up = side.cross(tangent);
        for k in 0..AROUND {
            let (sin, cos) = (TAU * k as f64 / AROUND as f64).sin_cos();
            obj.vertex(centre(s) + TUBE * (cos * side + sin * up));
        }
    }
    let at = |i: usize, k: usize| first + (i % ALONG) * AROUND + k % AROUND;
    for i in 0..ALONG {
        for k in 0..AROUND {
            obj.face(&[at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)]);
        }
    }
}

/// An icosahedron with its corners cut off: pentagons and hexagons.
fn gem(obj: &mut Obj) {
    obj.object("gem", false);
    let golden = (1.0 + 5f64.sqrt()) / 2.0;
    let mut points = Vec::new();
    for (a, b, c) in [
        (0.0, 1.0, 3.0 * golden),
        (1.0, 2.0 + golden, 2.0 * golden),
        (2.0, 1.0 + 2.0 * golden, golden),
    ] {
        for signs in 0..8u8 {
            let sign = |bit: u8| if signs >> bit & 1 == 0 { 1.0 } else { -1.0 };
            let p = DVec3::new(sign(0) * a, sign(1) * b, sign(2) * c);
            if a == 0.0 && signs & 1 == 1 {
                continue;
            }
            points.extend([p, DVec3::new(p.z, p.x, p.y), DVec3::new(p.y, p.z, p.x)]);
        }
    }
    let place = |p: DVec3| DVec3::new(-1.75, 0.62, 0.75) + 0.62 * p / points[0].length();
    let first = obj.vertex_count + 1;
    for &p in &points {
        obj.vertex(place(p));
    }
    for face in convex_faces(&points) {
        let corners: Vec<usize> = face.into_iter().map(|i| first + i).collect();
        obj.face(&corners);
    }
}

/// The faces of the convex polyhedron with these corners, counter-clockwise from outside.
fn convex_faces(points: &[DVec3]) -> Vec<Vec<usize>> {
    let mut faces: Vec<Vec<usize>> = Vec::new();
    let n = points.len();
    for (i, j, k) in
        (0..n).flat_map(|i| (i + 1..n).flat_map(move |j| (j + 1..n).map(move |k| (i, j, k))))
    {
        let normal = (points[j] - points[i]).cross(points[k] - points[i]);
        if normal.length() < 1e-9 {
            continue;
        }
        let normal = normal.normalize() * normal.dot(points[i]).signum();
        let height = normal.dot(points[i]);
        if points.iter().any(|p| normal.dot(*p) > height + 1e-9) {
            continue;
        }
        let mut face: Vec<usize> = (0..n)
            .filter(|&p| normal.dot(points[p]) > height - 1e-9)
            .collect();
        if faces
            .iter()
            .any(|f| f.contains(&i) && f.contains(&j) && f.contains(&k))
        {
            continue;
        }
        let x = (points[face[0]] - height * normal).normalize();
        let y = normal.cross(x);
        let angle = |p: &usize| points[*p].dot(y).atan2(points[*p].dot(x));
        face.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
        faces.push(face);
    }
    faces
}

/// A cone of thin triangles, two for each of its ribs.
fn shell(obj: &mut Obj) {
    const RIBS: usize = 96;
    obj.object("shell", false);
    let axis = DVec3::new(-0.25, 0.35, 0.9).normalize();
    let side = axis.cross(DVec3::Y).normalize();
    let up = side.cross(axis);
    let centre = DVec3::new(1.85, 0.98, 0.3);
    let hub = obj.vertex(centre + 0.32 * axis);
    let first = obj.vertex_count + 1;
    for i in 0..2 * RIBS {
        let (sin, cos) = (TAU * i as f64 / (2 * RIBS) as f64).sin_cos();
        // Every other rib stands back, which makes a fold.
        let (radius, depth) = if i % 2 == 0 {
            (0.92, 0.0)
        } else {
            (0.86, -0.05)
        };
        obj.vertex(centre + radius * (cos * side + sin * up) + depth * axis);
    }
    for i in 0..2 * RIBS {
        obj.face(&[hub, first + (i + 1) % (2 * RIBS), first + i]);
    }
}
