//! `hitscope info`: prints the contents of a file and the kernel tier that they require.

use super::args::MeshArgs;
use super::input::is_stdin;
use super::inspect::at_most;
use super::lights::LightInfo;
use super::materials::MaterialInfo;
use super::{CommandError, file_error};
use crate::json;
use crate::measure::speed::default_camera;
use crate::requirement::{Requirement, required_tier};
use crate::second_opinion::{SecondOpinion, compare};
use clap::Args;
use hitscope_core::counts::{counted, counted_as, grouped};
use hitscope_core::group::Group;
use hitscope_core::kernel::default_triangle_kernel;
use hitscope_core::loading::{LoadedScene, StartView, scene_text};
use hitscope_core::mesh::{FLAWS, Health, bytes_as};
use hitscope_core::obj::{self, Recentre};
use hitscope_core::{Aabb, TriangleMesh};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Show the contents of a file: counts, bounds, materials, lights, memory, mesh health, required kernel tier
#[derive(Args, Clone, Debug)]
#[command(after_help = "\
Examples:
  hitscope info bunny.obj
  gunzip -c bunny.obj.gz | hitscope info - --json
  hitscope info bunny.obj --xml > scene.xml")]
pub struct InfoArgs {
    /// OBJ file, plain or gzipped, or scene file (.xml); - for an OBJ on standard input
    pub file: PathBuf,
    /// How the mesh is loaded.
    #[command(flatten)]
    pub mesh: MeshArgs,
    /// Also read the file with the library tobj, and list where the results differ
    #[arg(long)]
    pub check: bool,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
    /// Print a scene file with the same contents instead; its first sensor is the file's, or the window's first view
    #[arg(long, conflicts_with_all = ["json", "check"])]
    pub xml: bool,
}

#[derive(Serialize)]
struct Info {
    vertices: usize,
    triangles: usize,
    polygons: usize,
    /// The length of the list.
    materials: usize,
    /// The materials with their use: those that primitives have, and all that have a name.
    material_list: Vec<MaterialInfo>,
    groups: usize,
    /// Segments of the file's polylines.
    lines: usize,
    points: usize,
    /// The groups of primitives, one per shape; none if the scene is empty.
    shapes: Vec<ShapeGroup>,
    /// Empty if nothing emits light.
    lights: Vec<LightInfo>,
    /// Null if nothing has a box: the scene is empty, or only of infinite planes and of empty or infinite solids.
    bounds: Option<Bounds>,
    origin: [f64; 3],
    /// Largest difference per coordinate between the file's decimals and the vertices of the traced mesh.
    max_rounding: f64,
    bytes: BTreeMap<&'static str, usize>,
    /// Memory of the same surface in other representations.
    bytes_as: BTreeMap<&'static str, usize>,
    dropped: BTreeMap<&'static str, usize>,
    warnings: Vec<String>,
    /// Only with `--check`.
    #[serde(skip_serializing_if = "Option::is_none")]
    check: Option<SecondOpinion>,
    health: HealthReport,
    tier: Requirement,
    load_ms: f64,
    build_ms: f64,
}

/// In the file's coordinates.
#[derive(Serialize)]
struct Bounds {
    min: [f64; 3],
    max: [f64; 3],
}

impl Bounds {
    /// `None` if the box is empty.
    fn of(bounds: Aabb, mesh: &TriangleMesh) -> Option<Self> {
        let in_file = |p: glam::Vec3| mesh.vertex_in_file(p).to_array();
        (!bounds.is_empty()).then(|| Self {
            min: in_file(bounds.min),
            max: in_file(bounds.max),
        })
    }

    /// Two lines after a title; `missing` if there are none.
    fn print(
        bounds: Option<&Self>,
        title: &str,
        missing: &str,
        out: &mut dyn Write,
    ) -> std::io::Result<()> {
        let Some(Self { min, max }) = bounds else {
            return writeln!(out, "{title:<20}{missing}");
        };
        writeln!(out, "{title:<20}{min:?}")?;
        writeln!(out, "{:<20}{max:?}", "")
    }
}

/// The primitives of one shape with their tree.
#[derive(Serialize)]
struct ShapeGroup {
    shape: &'static str,
    count: usize,
    tree_bytes: usize,
    build_ms: f64,
    /// How many primitives have normals that are the opposite of their shape's.
    reversed_normals: usize,
    /// Null if there is none, as for planes, which are infinite, and for empty solids.
    bounds: Option<Bounds>,
    /// Whether the tree orders the primitives. Rays visit all primitives of a group with infinite ones.
    #[serde(skip)]
    has_tree: bool,
    #[serde(skip)]
    text: String,
}

impl ShapeGroup {
    fn of(group: &dyn Group, mesh: &TriangleMesh) -> Self {
        let (shape, bounds) = (group.shape(), group.bounds());
        let primitives = 0..group.count() as u32;
        let reversed_normals = primitives.filter(|&index| group.is_flipped(index)).count();
        let reversed = match reversed_normals {
            0 => String::new(),
            count => format!(", normals of {} reversed", grouped(count)),
        };
        Self {
            shape: shape.name,
            count: group.count(),
            tree_bytes: group.bvh().bytes(),
            build_ms: group.build_time().as_secs_f64() * 1e3,
            bounds: Bounds::of(bounds, mesh),
            has_tree: group.is_bounded(),
            reversed_normals,
            text: counted_as(group.count(), shape.name, shape.plural) + &reversed,
        }
    }
}

#[derive(Serialize)]
struct HealthReport {
    degenerate: usize,
    non_finite: usize,
    bad_index: usize,
    /// Number of each of [`FLAWS`]; null if not checked.
    #[serde(flatten)]
    flaws: BTreeMap<&'static str, Option<usize>>,
    max_aspect: f64,
}

impl InfoArgs {
    /// Loads the file and prints its contents.
    ///
    /// # Errors
    /// See [`CommandError`].
    pub fn run(&self, out: &mut dyn Write) -> Result<(), CommandError> {
        if self.check && is_stdin(&self.file) {
            let message = "--check reads the file twice, which isn't possible with standard input";
            return Err(CommandError::Usage(message.to_owned()));
        }
        if self.xml && is_stdin(&self.file) {
            let message = "--xml names the file, which isn't possible with standard input";
            return Err(CommandError::Usage(message.to_owned()));
        }
        let loaded = self.mesh.load(&self.file, Recentre::Auto)?;
        if self.xml {
            return self.print_xml(&loaded, out);
        }
        let scene = &loaded.scene;
        let intersector = scene.intersector(default_triangle_kernel());
        self.mesh.memory.require(
            Health::bytes(scene.mesh()),
            scene,
            intersector.bytes(),
            format_args!("checking the mesh"),
        )?;
        let mut info = Info::of(&loaded, intersector.bytes());
        if self.check {
            let bytes = File::open(&self.file).and_then(obj::decoded);
            let bytes = bytes.map_err(|source| file_error(&self.file, source))?;
            info.check = Some(compare(&bytes, scene.mesh(), &loaded.report));
        }
        if self.json {
            writeln!(out, "{}", json::to_pretty(&info))?;
        } else {
            info.print(out)?;
        }
        Ok(())
    }

    fn print_xml(&self, loaded: &LoadedScene, out: &mut dyn Write) -> Result<(), CommandError> {
        let scene = &loaded.scene;
        let first = || StartView::of_camera(&default_camera(scene), scene.mesh().origin());
        let view = loaded.view.unwrap_or_else(first);
        // File names become relative to the current directory.
        let text = scene_text(loaded, &self.file, &view, Path::new(""));
        let text = text.map_err(|error| CommandError::Other(error.to_string()))?;
        Ok(out.write_all(text.as_bytes())?)
    }
}

impl Info {
    fn of(loaded: &LoadedScene, packed_bytes: usize) -> Self {
        let scene = &loaded.scene;
        let mesh = scene.mesh();
        let bounds = scene.bounds_with_elements();
        let mut bytes = BTreeMap::from(mesh.bytes());
        bytes.insert("tree", scene.tree_bytes());
        bytes.insert("packed primitives", packed_bytes);
        let health = Health::of(mesh);
        let material_list = MaterialInfo::of(scene);
        let groups = scene.groups().iter().filter(|group| group.count() > 0);
        Self {
            vertices: loaded.report.vertex_count,
            triangles: mesh.triangles().len(),
            polygons: mesh.face_count(),
            materials: material_list.len(),
            material_list,
            groups: mesh.named_group_count(),
            lines: mesh.attributes().lines.len(),
            points: mesh.attributes().points.len(),
            shapes: groups.map(|group| ShapeGroup::of(&**group, mesh)).collect(),
            lights: LightInfo::of(loaded),
            bounds: Bounds::of(bounds, mesh),
            origin: mesh.origin().to_array(),
            max_rounding: loaded.report.max_rounding,
            bytes,
            dropped: BTreeMap::from([
                ("zero_area", loaded.report.dropped.zero_area),
                ("non_finite", loaded.report.dropped.non_finite),
                ("bad_index", loaded.report.dropped.bad_index),
                ("lines_and_points", loaded.report.dropped.elements),
            ]),
            bytes_as: BTreeMap::from(bytes_as(mesh)),
            warnings: loaded
                .report
                .warnings
                .iter()
                .map(ToString::to_string)
                .collect(),
            check: None,
            tier: required_tier(scene, &health),
            health: HealthReport {
                degenerate: loaded.report.dropped.zero_area,
                non_finite: loaded.report.dropped.non_finite,
                bad_index: loaded.report.dropped.bad_index,
                flaws: FLAWS
                    .iter()
                    .map(|info| (info.name, health.places(info.flaw).count()))
                    .collect(),
                max_aspect: health.max_aspect,
            },
            load_ms: loaded.report.duration.as_secs_f64() * 1e3,
            build_ms: scene.build_time().as_secs_f64() * 1e3,
        }
    }

    fn print(&self, out: &mut dyn Write) -> std::io::Result<()> {
        for (title, count) in [
            ("vertices", self.vertices),
            ("triangles", self.triangles),
            ("polygons", self.polygons),
            ("materials", self.materials),
            ("groups", self.groups),
        ] {
            writeln!(out, "{title:<20}{}", grouped(count))?;
        }
        let [lines, points] = [self.lines, self.points].map(grouped);
        writeln!(out, "lines, points       {lines}, {points}")?;
        self.print_shapes(out)?;
        self.print_materials(out)?;
        for light in &self.lights {
            writeln!(out, "light               {light}")?;
        }
        Bounds::print(self.bounds.as_ref(), "bounds", "none", out)?;
        writeln!(out, "origin              {:?}", self.origin)?;
        self.print_memory(out)?;
        for (reason, count) in &self.dropped {
            writeln!(out, "dropped             {} {reason}", grouped(*count))?;
        }
        if self.triangles > 0 {
            self.print_mesh(out)?;
        }
        writeln!(
            out,
            "load, build         {:.1} ms, {:.1} ms",
            self.load_ms, self.build_ms
        )?;
        writeln!(out, "tier                {}", self.tier.tier)?;
        for reason in &self.tier.reasons {
            writeln!(out, "                    {reason}")?;
        }
        match &self.check {
            Some(check) => print_check(check, out),
            None => Ok(()),
        }
    }

    fn print_shapes(&self, out: &mut dyn Write) -> std::io::Result<()> {
        if self.shapes.is_empty() {
            return writeln!(out, "shape               none: the scene is empty");
        }
        for group in &self.shapes {
            let tree = if group.has_tree {
                let (bytes, ms) = (grouped(group.tree_bytes), group.build_ms);
                format!("tree of {bytes} bytes in {ms:.1} ms")
            } else {
                "no tree".to_owned()
            };
            writeln!(out, "shape               {}: {tree}", group.text)?;
            Bounds::print(group.bounds.as_ref(), "", "no bounds", out)?;
        }
        Ok(())
    }

    fn print_materials(&self, out: &mut dyn Write) -> std::io::Result<()> {
        /// As many as fit on a screen or two.
        const MAX_LISTED: usize = 100;
        for material in self.material_list.iter().take(MAX_LISTED) {
            writeln!(out, "material            {material}")?;
        }
        match self.material_list.len().saturating_sub(MAX_LISTED) {
            0 => Ok(()),
            more => writeln!(out, "                    and {} more", grouped(more)),
        }
    }

    fn print_memory(&self, out: &mut dyn Write) -> std::io::Result<()> {
        for (part, bytes) in &self.bytes {
            writeln!(out, "bytes               {} {part}", grouped(*bytes))?;
        }
        Ok(())
    }

    /// What holds for triangles alone.
    fn print_mesh(&self, out: &mut dyn Write) -> std::io::Result<()> {
        let rounding = at_most(self.max_rounding);
        writeln!(out, "vertices rounded by {rounding}")?;
        for (way, bytes) in &self.bytes_as {
            writeln!(out, "{:<20}{} bytes", format!("as {way}"), grouped(*bytes))?;
        }
        for info in &FLAWS {
            let title = info.title.to_lowercase();
            match self.health.flaws[info.name] {
                Some(count) => writeln!(out, "{title:<20}{}", grouped(count))?,
                None => writeln!(out, "{title:<20}not checked: too many border edges")?,
            }
        }
        writeln!(out, "max aspect ratio    {:.1}", self.health.max_aspect)
    }
}

fn print_check(check: &SecondOpinion, out: &mut dyn Write) -> std::io::Result<()> {
    match &check.refused {
        Some(why) => writeln!(out, "check               tobj can't read the file: {why}")?,
        None => writeln!(
            out,
            "check               {} compared with tobj, {}",
            counted(check.triangles, "triangle"),
            counted(check.difference_count, "difference")
        )?,
    }
    for difference in &check.differences {
        writeln!(out, "                    {difference}")?;
    }
    Ok(())
}
