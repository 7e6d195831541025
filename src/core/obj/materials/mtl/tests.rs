//! Tests of the material library parser.

use super::super::map_file;
use super::*;
use glam::Vec2;

/// The materials and warnings of a library.
fn messages(text: &str) -> (Vec<Definition>, Vec<String>) {
    let parsed = parse(text.as_bytes(), "m.mtl", |_| true, &Progress::default());
    let library = parsed.expect("not cancelled").expect("a library");
    let warnings = library.warnings.iter().map(ToString::to_string);
    (library.definitions, warnings.collect())
}

#[test]
fn unusual_statements_do_not_affect_other_materials() {
    let (materials, warnings) = messages(
        "newmtl a #1\rKd 0.5 # grey\r\nKd spectral f.rfl\nillum 999\nmap_Kd\nnewmtl c\nKd 1 0 0\nKd\nnewmtl d\nKd nan 0 0\nPs 1\n",
    );
    let named: Vec<&str> = materials.iter().map(|m| m.material.name.as_str()).collect();
    assert_eq!(named, ["a #1", "c", "d"]);
    let diffuse: Vec<_> = materials.iter().map(|m| m.material.diffuse).collect();
    assert_eq!(diffuse, [Some(Vec3::splat(0.5)), Some(Vec3::X), None]);
    let skipped = |n: u32, keyword: &str, why: &str, line: u32| {
        let (ending, first) = if n == 1 {
            ("", "")
        } else {
            ("s", "the first ")
        };
        format!(
            "material library “m.mtl”: {n} “{keyword}” statement{ending} skipped{why}, {first}on line {line}"
        )
    };
    let colour = ": a colour is one or three numbers that aren't negative";
    let illum = ": illum is a whole number from 0 to 10";
    assert_eq!(
        warnings,
        [
            skipped(3, "Kd", colour, 3),
            skipped(1, "illum", illum, 4),
            skipped(1, "map_Kd", "", 5),
            skipped(1, "Ps", "", 11)
        ]
    );
}

#[test]
fn a_file_that_is_not_a_library_is_not_quoted() {
    let parse = |text: &str| parse(text.as_bytes(), "m.mtl", |_| true, &Progress::default());
    for text in ["root:x:0:0\nKd 1 1 1\n", "\0\0\0", "secret 1\n"] {
        assert!(parse(text).expect("not cancelled").is_none(), "{text}");
    }
    for text in ["", "# Material Count: 0\n\n"] {
        let library = parse(text)
            .expect("not cancelled")
            .expect("an empty library");
        assert_eq!(library.warnings, [], "{text}");
    }
    let (_, warnings) = messages("newmtl a\nsecret 1\nroot:x\nPS 1\n");
    let expected = [
        "material library “m.mtl”: 2 unknown statements skipped, the first on line 2",
        "material library “m.mtl”: 1 “PS” statement skipped, on line 4",
    ];
    assert_eq!(warnings, expected);
}

#[test]
fn every_property_used_by_shading_is_read() {
    let (materials, warnings) = messages(
        "newmtl glass\nKs .1 .2 .3\nKe 2 0 0\nNs 50\nillum 1\nTr 0.75\nnewmtl b\nd -halo 0.5\nTr 1\nKa 1 1 1\nNi 1.5\n",
    );
    assert_eq!(warnings, [""; 0]);
    let expected = Material {
        specular: Vec3::new(0.1, 0.2, 0.3),
        emission: Vec3::new(2.0, 0.0, 0.0),
        shininess: 50.0,
        illumination: Illumination::Diffuse,
        opacity: 0.25,
        ..Material::named("glass")
    };
    assert_eq!(materials[0].material, expected);
    assert_eq!(materials[1].material.opacity, 0.5);
}

#[test]
fn every_property_used_by_light_is_read() {
    let (materials, warnings) = messages(
        "newmtl glass\nillum 7\nNi 1.5\nTf 1 .5 2\nnewmtl metal\nPr .25\nPm 1\nillum 3\nmap_Pr r.png\nmap_d #1.png\nNi 0\nnewmtl lamp\nmap_Ke old.png\nmap_Ke e.png\nnewmtl f\nillum 5\n",
    );
    let clamped =
        "material library “m.mtl”: 1 “Tf” statement with a value above 1 clamped, on line 4";
    assert_eq!(warnings, [clamped]);
    let glass = &materials[0].material;
    assert_eq!(
        (glass.illumination, glass.refraction, glass.filter),
        (Illumination::Glass, 1.5, Some(Vec3::new(1.0, 0.5, 1.0)))
    );
    let metal = &materials[1].material;
    assert_eq!(
        (
            metal.roughness,
            metal.metalness,
            metal.illumination,
            metal.refraction
        ),
        (Some(0.25), Some(1.0), Illumination::Mirror, 1.0)
    );
    let maps = |definition: &Definition| -> Vec<(Property, String)> {
        let maps = definition.further_maps.iter();
        maps.map(|(property, map)| (*property, map.name.clone()))
            .collect()
    };
    assert_eq!(
        maps(&materials[1]),
        [
            (Property::Roughness, "r.png".to_owned()),
            (Property::Opacity, "#1.png".to_owned())
        ]
    );
    assert_eq!(
        maps(&materials[2]),
        [(Property::Emission, "e.png".to_owned())]
    );
    assert_eq!(materials[2].material.emission, Vec3::ONE);
    assert_eq!(
        materials[3].material.illumination,
        Illumination::FresnelMirror
    );
}

#[test]
fn a_normal_map_has_precedence_over_heights_and_multipliers_are_read() {
    let (materials, warnings) = messages(
        "newmtl a\nnorm -bm 2 n #1.png\nmap_Bump h.png\nnewmtl b\nbump -bm .25 -s 2 2 h.png\nmap_Kd -bm 1 k.png\nnewmtl c\nbump old.png\nmap_bump new.png\n",
    );
    let relief = |definition: &Definition| {
        let (statement, map) = definition.relief.clone().expect("a relief");
        (statement, map.name, map.multiplier)
    };
    let found: Vec<_> = materials.iter().map(relief).collect();
    assert_eq!(
        found,
        [
            (ReliefStatement::Normals, "n #1.png".to_owned(), 2.0),
            (ReliefStatement::Bump, "h.png".to_owned(), 0.25),
            (ReliefStatement::Bump, "new.png".to_owned(), 1.0),
        ]
    );
    let skipped = "material library “m.mtl”: 1 “map_Kd -bm” statement skipped, on line 6";
    assert_eq!(warnings, [skipped]);
}

#[test]
fn light_that_no_picture_can_hold_is_clamped_with_a_warning() {
    let (materials, warnings) = messages("newmtl sun\nKe 1e20 1 0\n");
    let emission = materials[0].material.emission;
    assert_eq!(emission, Vec3::new(MAX_BRIGHTNESS, 1.0, 0.0));
    let clamped =
        "material library “m.mtl”: 1 “Ke” statement with a value above 2.8e14 clamped, on line 2";
    assert_eq!(warnings, [clamped]);
}

#[test]
fn map_options_precede_the_file_name() {
    let map = |name: &str, scale, offset| Some((name.to_owned(), scale, offset));
    let (one, zero) = (Vec2::ONE, Vec2::ZERO);
    for (text, expected) in [
        ("wood.png", map("wood.png", one, zero)),
        ("maps\\old wood.png", map("maps/old wood.png", one, zero)),
        (
            "-s 2 3 1 a b.png",
            map("a b.png", Vec2::new(2.0, 3.0), zero),
        ),
        ("-s 2 a.png", map("a.png", Vec2::splat(2.0), zero)),
        (
            "-o 0.5 -bm 1 -clamp on -mm 0 1 a.png",
            map("a.png", one, Vec2::new(0.5, 0.0)),
        ),
        ("-odd-name.png", map("-odd-name.png", one, zero)),
        ("-s 2 3", None),
    ] {
        let found = map_file::parse(text).map(|(map, _)| (map.name, map.scale, map.offset));
        assert_eq!(found, expected, "{text}");
    }
}
