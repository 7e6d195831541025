//! Elements of a scene by which users name a place: `triangle:123`, `face:4`, `vertex:7`, `line:1234` or a point.

use glam::{DVec3, Vec3};
use hitscope_core::Aabb;
use hitscope_core::loading::LoadedScene;
use hitscope_core::mesh::ElementPlace;
use hitscope_core::obj::{LoadError, VertexKey, VertexSource, vertex_source};
use hitscope_core::progress::Progress;
use std::fmt;
use std::io::{self, Read};
use std::path::Path;
use std::str::FromStr;

/// An element of a scene, or a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Element {
    /// A triangle, counted from 0.
    Triangle(usize),
    /// A face of the file, counted from 0.
    Face(usize),
    /// A vertex of the file, counted from 1 as in the file's faces.
    Vertex(usize),
    /// The face or vertex on a line of the file, counted from 1.
    Line(usize),
    /// A point in the file's coordinates.
    Point(DVec3),
}

/// Why there is nothing to go to.
#[derive(Debug, thiserror::Error)]
pub enum ElementError {
    /// The scene has no such element; the message says which there are.
    #[error("{0}")]
    Missing(String),
    /// The file can't be read again.
    #[error(transparent)]
    Load(#[from] LoadError),
}

/// A file that can be read again: its name for messages, and how to open it at its start.
#[derive(Clone, Copy)]
pub struct Rereadable<'a> {
    /// The name.
    pub path: &'a Path,
    /// Opens the file.
    pub open: &'a dyn Fn() -> io::Result<Box<dyn Read>>,
}

impl FromStr for Element {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let expected = || {
            "expected triangle:N, face:N, vertex:N, line:N or X,Y,Z, as in triangle:123".to_owned()
        };
        if let Some((kind, number)) = text.split_once(':') {
            let number = number.trim().parse().map_err(|_| expected())?;
            return match kind.trim() {
                "triangle" => Ok(Self::Triangle(number)),
                "face" => Ok(Self::Face(number)),
                "vertex" => Ok(Self::Vertex(number)),
                "line" => Ok(Self::Line(number)),
                _ => Err(expected()),
            };
        }
        let numbers: Result<Vec<f64>, _> =
            text.split(',').map(|word| word.trim().parse()).collect();
        match numbers.as_deref() {
            Ok([x, y, z]) if [x, y, z].iter().all(|x| x.is_finite()) => {
                Ok(Self::Point(DVec3::new(*x, *y, *z)))
            }
            _ => Err(expected()),
        }
    }
}

impl fmt::Display for Element {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Triangle(number) => write!(f, "triangle:{number}"),
            Self::Face(number) => write!(f, "face:{number}"),
            Self::Vertex(number) => write!(f, "vertex:{number}"),
            Self::Line(number) => write!(f, "line:{number}"),
            Self::Point(p) => write!(f, "{},{},{}", p.x, p.y, p.z),
        }
    }
}

impl Element {
    /// The place of the element in the scene's coordinates. `file` is read again if a vertex can't be found otherwise.
    ///
    /// # Errors
    /// See [`ElementError`].
    pub fn place(
        self,
        loaded: &LoadedScene,
        file: Rereadable<'_>,
    ) -> Result<ElementPlace, ElementError> {
        match self {
            Self::Triangle(number) => triangle(loaded, number),
            Self::Face(number) => face(loaded, number),
            Self::Vertex(number) => vertex(loaded, number, file),
            Self::Line(number) => line(loaded, number, file),
            Self::Point(p) => point(loaded, p),
        }
    }
}

fn missing(message: String) -> ElementError {
    ElementError::Missing(message)
}

fn triangle(loaded: &LoadedScene, number: usize) -> Result<ElementPlace, ElementError> {
    let mesh = loaded.scene.mesh();
    let place = u32::try_from(number).ok();
    let place = place.and_then(|number| mesh.place_of_triangle(number));
    place.ok_or_else(|| {
        missing(match mesh.triangles().len().checked_sub(1) {
            Some(last) => {
                format!("there is no triangle {number}: they are numbered from 0 to {last}")
            }
            None => "the scene has no triangles".to_owned(),
        })
    })
}

/// The number of the last face, which may have no triangle.
fn last_face(loaded: &LoadedScene) -> Option<usize> {
    let mesh = loaded.scene.mesh();
    let of_triangles = mesh.triangles().len().checked_sub(1);
    let of_triangles = of_triangles.map(|last| mesh.face_of(last as u32) as usize);
    let of_lines = loaded.report.face_lines.count().checked_sub(1);
    of_triangles.max(of_lines)
}

fn face(loaded: &LoadedScene, number: usize) -> Result<ElementPlace, ElementError> {
    let place = u32::try_from(number).ok();
    let place = place.and_then(|number| loaded.scene.mesh().place_of_face(number));
    place.ok_or_else(|| {
        missing(match last_face(loaded) {
            Some(last) if number <= last => {
                format!("face {number} has no triangle: it has no area, or it was dropped")
            }
            Some(last) => format!("there is no face {number}: they are numbered from 0 to {last}"),
            None => "the scene has no faces".to_owned(),
        })
    })
}

fn vertex(
    loaded: &LoadedScene,
    number: usize,
    file: Rereadable<'_>,
) -> Result<ElementPlace, ElementError> {
    let mesh = loaded.scene.mesh();
    let count = if loaded.description.is_some() {
        mesh.positions().len()
    } else {
        loaded.report.vertex_count
    };
    if count == 0 {
        return Err(missing("the scene has no vertices".to_owned()));
    }
    let unknown = || {
        missing(format!(
            "there is no vertex {number}: they are numbered from 1 to {count}"
        ))
    };
    let index = number.checked_sub(1).filter(|&index| index < count);
    let index = index.ok_or_else(unknown)?;
    // Vertices that no element uses aren't kept.
    if count == mesh.positions().len() {
        return mesh
            .place_of_vertex(index as u32)
            .ok_or_else(|| missing(format!("the coordinates of vertex {number} aren't finite")));
    }
    let source = read(file, VertexKey::Number(number))?.ok_or_else(unknown)?;
    vertex_place(loaded, source)
}

fn line(
    loaded: &LoadedScene,
    number: usize,
    file: Rereadable<'_>,
) -> Result<ElementPlace, ElementError> {
    if loaded.description.is_some() {
        let message = "lines are those of an OBJ file; name the triangle, the face or the vertex";
        return Err(missing(message.to_owned()));
    }
    let lines = &loaded.report.face_lines;
    if let Some(number) = lines.statement_on(number) {
        return face(loaded, number);
    }
    if let Some(source) = read(file, VertexKey::Line(number))? {
        return vertex_place(loaded, source);
    }
    let mut message = format!("neither a face nor a vertex starts on line {number}");
    if let Some(last) = lines.count().checked_sub(1) {
        let (first, last) = (lines.line(0), lines.line(last));
        message += &format!("; faces start on lines {first} to {last}");
    }
    Err(missing(message))
}

fn read(file: Rereadable<'_>, key: VertexKey) -> Result<Option<VertexSource>, ElementError> {
    let bytes = (file.open)().map_err(|source| LoadError::Unreadable {
        path: file.path.to_owned(),
        source,
    })?;
    Ok(vertex_source(bytes, file.path, key, &Progress::default())?)
}

/// The place of a vertex that was read from the file.
fn vertex_place(loaded: &LoadedScene, source: VertexSource) -> Result<ElementPlace, ElementError> {
    let mesh = loaded.scene.mesh();
    // As when it was loaded.
    let position = (source.position - mesh.origin()).as_vec3();
    mesh.place_of_point(position).ok_or_else(|| {
        let number = source.number;
        missing(format!("the coordinates of vertex {number} aren't finite"))
    })
}

/// The place of a point, with surroundings of a twentieth of the scene's size.
fn point(loaded: &LoadedScene, p: DVec3) -> Result<ElementPlace, ElementError> {
    const SURROUNDINGS: f64 = 0.05;
    let centre = p - loaded.scene.mesh().origin();
    let reach = Vec3::splat((SURROUNDINGS * loaded.scene.bounds().radius()) as f32);
    let at = centre.as_vec3();
    if !at.is_finite() {
        let message = "the point is too far away for 32-bit numbers, which end at 3.4e38";
        return Err(missing(message.to_owned()));
    }
    Ok(ElementPlace {
        centre,
        bounds: Aabb::around([at - reach, at + reach]),
        normal: DVec3::ZERO,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use hitscope_core::obj::{self, LoadOptions};
    use hitscope_core::scene::SceneOptions;

    /// A square, an unused vertex, a face without area, and a triangle.
    const FILE: &str = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 9 9 9\nv 0 0 3\n\
        f 1 2 3 4\nf 1 2 2\n# the last\nf 1 2 6\n";

    fn found(text: &str) -> Result<ElementPlace, String> {
        let (path, progress) = (Path::new("a.obj"), Progress::default());
        let none = |_: &str| Err(io::ErrorKind::NotFound.into());
        let loaded = obj::parse(
            FILE.as_bytes(),
            path,
            LoadOptions::default(),
            &none,
            &progress,
        );
        let loaded = LoadedScene::of(loaded.expect("good"), SceneOptions::default(), &progress);
        let open = || -> io::Result<Box<dyn Read>> { Ok(Box::new(FILE.as_bytes())) };
        let file = Rereadable { path, open: &open };
        let element: Element = text.parse()?;
        assert_eq!(element.to_string().parse(), Ok(element));
        let place = element.place(&loaded.expect("never cancelled"), file);
        place.map_err(|error| error.to_string())
    }

    #[test]
    fn elements_are_found_by_their_numbers_and_lines() {
        let centre = |text| found(text).expect(text).centre;
        let middle = DVec3::new(2.0, 2.0, 0.0);
        assert!((centre("face:0") - middle).length() < 1e-15);
        assert_eq!(centre("line:7"), centre("face:0"));
        assert_eq!(centre("line:10"), centre("triangle:2"));
        assert_eq!(centre("vertex:2"), DVec3::new(4.0, 0.0, 0.0));
        // After an unused vertex, and that vertex.
        assert_eq!(centre("vertex:6"), DVec3::new(0.0, 0.0, 3.0));
        assert_eq!(centre("line:6"), centre("vertex:6"));
        assert_eq!(centre("vertex:5"), DVec3::splat(9.0));
        assert_eq!(centre("-1,2.5,3e1"), DVec3::new(-1.0, 2.5, 30.0));
    }

    #[test]
    fn a_missing_element_is_refused_with_those_that_exist() {
        for (text, reason) in [
            (
                "triangle:3",
                "there is no triangle 3: they are numbered from 0 to 2",
            ),
            (
                "face:3",
                "there is no face 3: they are numbered from 0 to 2",
            ),
            (
                "face:1",
                "face 1 has no triangle: it has no area, or it was dropped",
            ),
            (
                "vertex:0",
                "there is no vertex 0: they are numbered from 1 to 6",
            ),
            (
                "vertex:7",
                "there is no vertex 7: they are numbered from 1 to 6",
            ),
            (
                "line:9",
                "neither a face nor a vertex starts on line 9; faces start on lines 7 to 10",
            ),
            (
                "triangle:99999999999",
                "there is no triangle 99999999999: they are",
            ),
            ("1e300,0,0", "the point is too far away"),
            ("edge:3", "expected triangle:N"),
            ("triangle:-1", "expected triangle:N"),
            ("1,2", "expected triangle:N"),
            ("1,2,inf", "expected triangle:N"),
        ] {
            let message = found(text).expect_err(text);
            assert!(message.starts_with(reason), "{text}: {message}");
        }
    }
}
