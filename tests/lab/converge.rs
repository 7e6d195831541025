//! `converge`: the error of pictures against time.

use crate::folder::Folder;
use hitscope_lab::commands::ConvergeArgs;
use serde_json::Value;

/// A grey sphere on a grey disk under even light.
const SCENE: &str = r#"<scene version="3.0.0"><sensor type="perspective"><float name="fov" value="40"/>
  <transform name="to_world"><lookat origin="0,-4,2" target="0,0,0.5" up="0,0,1"/></transform>
  <film type="hdrfilm"><integer name="width" value="12"/><integer name="height" value="8"/></film></sensor>
<emitter type="constant"/>
<shape type="sphere"><point name="center" x="0" y="0" z="1"/><bsdf type="twosided"><bsdf type="diffuse"/></bsdf></shape>
<shape type="disk"><bsdf type="twosided"><bsdf type="diffuse"/></bsdf>
  <transform name="to_world"><scale value="9"/></transform></shape></scene>"#;

fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("scene.xml", SCENE);
    folder
}

#[test]
fn errors_decrease_with_samples_unless_a_setting_converges_to_another_picture() {
    let folder = folder();
    let line =
        "@scene.xml --reference 64 --seconds 1000 --setting path --setting path,depth=0 --json";
    let json = folder.json(|f, out| f.args::<ConvergeArgs>(line).run(out));
    let measured = &json["convergence"];
    assert_eq!(measured["size"], serde_json::json!([12, 8]));
    let reference = &measured["reference"];
    assert_eq!(
        (&reference["setting"], &reference["samples"]),
        (&"path".into(), &64.into())
    );
    let own_error = reference["relative_error"].as_f64().expect("a number");
    assert!(own_error > 0.0);
    let points = measured["points"].as_array().expect("a list");
    let of = |setting: &str, field: &str| -> Vec<f64> {
        let own = points.iter().filter(|point| point["setting"] == setting);
        own.filter_map(|point| point[field].as_f64()).collect()
    };
    for setting in ["path", "path,depth=0"] {
        // A sixteenth of the reference's.
        assert_eq!(of(setting, "samples"), [1.0, 2.0, 4.0], "{setting}");
        assert!(of(setting, "cpu_s").iter().all(|&secs| secs > 0.0));
    }
    let error = of("path", "relative_rmse");
    assert!(error[2] < error[0], "{error:?}");
    // Half of the picture or more is black.
    let without_reflection = of("path,depth=0", "relative_rmse");
    assert!(
        without_reflection[2] > 2.0 * error[2],
        "{without_reflection:?}"
    );
}

#[test]
fn a_setting_ends_at_its_time_and_the_report_has_the_figures() {
    let folder = folder();
    let args = folder.args::<ConvergeArgs>(
        "@scene.xml --reference 64 --seconds 1e-9 --setting direct --out @report",
    );
    let text = folder.text(|_, out| args.run(out));
    // Machine, picture, header and one picture.
    assert_eq!(text.lines().count(), 4, "{text}");
    assert!(text.contains("relative standard error"), "{text}");
    let out = args.out.expect("given");
    let data = std::fs::read_to_string(out.join("lab.json")).expect("written");
    let data: Value = serde_json::from_str(&data).expect("JSON");
    assert_eq!(data["convergence"]["points"][0]["setting"], "direct");
    let page = std::fs::read_to_string(out.join("report.html")).expect("written");
    assert!(page.contains("relative_rmse") && !page.contains("/*SCRIPT*/"));
}

#[test]
fn impossible_settings_are_refused() {
    let folder = folder();
    for (setting, why) in [
        (
            "normal",
            "the colours of “normal” aren't light; expected shaded, direct, whitted or path",
        ),
        (
            "ao",
            "the colours of “ao” aren't light; expected shaded, direct, whitted or path",
        ),
        (
            "pth",
            "there is no view “pth”; expected shaded, direct, whitted or path",
        ),
        ("path,depth=x", "depth is a whole number, not “x”"),
        ("direct,depth=2", "depth has no effect on the view “direct”"),
        (
            "path,speed=2",
            "“speed=2” is none of depth=N, spawn=POLICY and kernel=KERNEL",
        ),
        (
            "path,kernel=fsat",
            "“kernel=fsat”: did you mean fast? `hitscope lab --help` lists all kernels",
        ),
        (
            "path,depth",
            "“depth” is none of depth=N, spawn=POLICY and kernel=KERNEL",
        ),
    ] {
        let line = format!("@scene.xml --setting {setting}");
        let result = folder.args::<ConvergeArgs>(&line).run(&mut Vec::new());
        let error = result.expect_err(setting);
        assert!(error.is_usage(), "{error}");
        assert_eq!(error.to_string(), format!("setting “{setting}”: {why}"));
    }
}
