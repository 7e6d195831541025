//! Sensors, with their films and samplers.

use super::features::read;
use super::warnings;
use glam::{DMat4, DVec3};
use hitscope_core::scene_file::{Crop, FieldOfView, Film, FovAxis, SensorKind};

#[test]
fn sensors_are_read() {
    let scene = read(
        "<sensor type='thinlens' id='s'>
         <float name='fov' value='40'/><string name='fov_axis' value='smaller'/>
         <float name='aperture_radius' value='0.1'/><float name='focus_distance' value='3'/>
         <float name='near_clip' value='1'/>
         <transform name='to_world'><translate x='1'/></transform>
         <film type='hdrfilm'><integer name='width' value='300'/><integer name='height' value='200'/>
         <integer name='crop_offset_x' value='10'/><integer name='crop_width' value='20'/>
         <string name='pixel_format' value='rgb'/><rfilter type='gaussian'/></film>
         <sampler type='multijitter'><integer name='sample_count' value='16'/></sampler>
         </sensor>
         <sensor type='orthographic'><film type='hdrfilm'><rfilter type='box'/></film></sensor>
         <sensor type='radiancemeter'/>",
    );
    let [thin_lens, orthographic] = &scene.sensors[..] else {
        panic!("{:?}", scene.sensors);
    };
    let expected = SensorKind::ThinLens {
        fov: FieldOfView {
            degrees: 40.0,
            axis: FovAxis::Smaller,
        },
        aperture_radius: 0.1,
        focus_distance: 3.0,
    };
    assert_eq!(
        (thin_lens.kind, thin_lens.id.as_deref()),
        (expected, Some("s"))
    );
    assert_eq!(thin_lens.to_world, DMat4::from_translation(DVec3::X));
    let crop = Crop {
        x: 10,
        y: 0,
        width: 20,
        height: 200,
    };
    let expected = Film {
        width: 300,
        height: 200,
        crop: Some(crop),
    };
    assert_eq!((thin_lens.film, thin_lens.sample_count), (expected, 16));
    assert_eq!(orthographic.kind, SensorKind::Orthographic);
    assert_eq!(
        (orthographic.film.width, orthographic.film.height),
        (768, 576)
    );
    assert_eq!(
        (orthographic.film.crop, orthographic.sample_count),
        (None, 4)
    );
    let expected = [
        "line 9: rfilter “gaussian” isn't supported; “box” is used",
        "line 8: film “hdrfilm”: the crop window isn't used; the whole film is shown",
        "line 9: film “hdrfilm”: parameter “pixel_format” isn't used",
        "line 2: sensor “thinlens”: the lens isn't used; everything is in focus",
        "line 5: sensor “thinlens”: parameter “near_clip” isn't used",
        "line 13: sensor “radiancemeter” isn't supported",
    ];
    assert_eq!(warnings(&scene), expected);
}

#[test]
fn a_thin_lens_is_focused_far_away_unless_told_otherwise() {
    let scene = read("<sensor type='thinlens'><float name='aperture_radius' value='0'/></sensor>");
    let SensorKind::ThinLens { focus_distance, .. } = scene.sensors[0].kind else {
        panic!("{:?}", scene.sensors);
    };
    assert_eq!(focus_distance, 10_000.0);
    assert!(warnings(&scene).is_empty(), "a pinhole has no lens");
}
