//! Settings of overlays from versions that had fields for two overlays instead of a map of all.

use serde_json::{Map, Value, json};

/// Replaces the fields by the map of overlays, unless there is one.
pub fn convert(stored: &mut Map<String, Value>) {
    if stored.contains_key("overlays") {
        return;
    }
    let mut old = |name| stored.remove(name).unwrap_or_default();
    // The kind of normals followed the shading.
    let (is_on, length) = (old("shows_normals"), old("normal_length"));
    let wireframe = json!({
        "is_on": old("shows_wireframe"),
        "colour": old("wire_colour"),
        "options": { "diagonals": u8::from(old("shows_diagonals") == true) },
    });
    let is_smooth = stored
        .get("is_smooth")
        .is_some_and(|smooth| *smooth == true);
    let normals = |is_of_shading: bool| {
        json!({
            "is_on": is_on == true && is_of_shading,
            "options": { "length": length },
        })
    };
    let overlays = json!({
        "wireframe": wireframe,
        "face-normals": normals(!is_smooth),
        "vertex-normals": normals(is_smooth),
    });
    stored.insert("overlays".to_owned(), overlays);
}

#[cfg(test)]
mod tests {
    use crate::overlay::face_normals::FACE_NORMALS;
    use crate::overlay::normals::LENGTH;
    use crate::overlay::vertex_normals::VERTEX_NORMALS;
    use crate::overlay::wireframe::{DIAGONALS, WIREFRAME};
    use crate::storage::{Kept, from_json};

    #[test]
    fn overlays_of_older_versions_are_read() {
        let text = r#"{"is_smooth": true, "shows_wireframe": true, "shows_diagonals": true,
            "wire_colour": [200, 100, 50], "shows_normals": true, "normal_length": 0.25}"#;
        let overlays = from_json(text).settings.overlays;
        let wireframe = overlays.state(&WIREFRAME);
        assert!(wireframe.is_on && wireframe.is_set(&DIAGONALS));
        assert_eq!(wireframe.colour, [200, 100, 50]);
        assert!(overlays.is_on(&VERTEX_NORMALS) && !overlays.is_on(&FACE_NORMALS));
        for normals in [&VERTEX_NORMALS, &FACE_NORMALS] {
            assert_eq!(overlays.state(normals).value(&LENGTH), 0.25);
        }
        let flat = from_json(r#"{"shows_normals": true, "normal_length": 7}"#)
            .settings
            .overlays;
        assert!(flat.is_on(&FACE_NORMALS) && !flat.is_on(&VERTEX_NORMALS));
        assert_eq!(flat.state(&FACE_NORMALS).value(&LENGTH), LENGTH.default);
        let bad =
            r#"{"shows_wireframe": 3, "wire_colour": "red", "normal_length": [], "zoom": 1.5}"#;
        let mut expected = Kept::default();
        expected.preferences.zoom = 1.5;
        assert_eq!(from_json(bad), expected);
    }
}
