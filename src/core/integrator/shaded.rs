//! The view *Shaded*: the file's materials, or clay, under studio lamps fixed to the camera.

use super::options::back_face_colour;
use super::transport::INVISIBLE;
use super::{Context, Integrator, Needs, Setting, Source};
use crate::appearance::Appearance;
use crate::interaction::SurfaceInteraction;
use crate::light::studio::{self, AMBIENT, Lamp};
use crate::mesh::Illumination;
use crate::ray::{Hit, Ray};
use crate::sampler::Sampler;
use crate::spawn::{Departure, default_spawn_policy};
use glam::Vec3;

/// The row of the view.
pub(super) static SHADED: Integrator = Integrator {
    name: "shaded",
    title: "Shaded",
    about: "Lit by a studio light that moves with the camera.",
    needs: Needs {
        settings: &[Setting::Exposure, Setting::BackFaces, Setting::PartColours],
        ..Needs::VERTEX_NORMALS
    },
    legend: Vec::new,
    source: Source::Colour(radiance),
};

/// Maximum number of transparent surfaces along a ray; behind the last one it sees the background.
const MOST_LAYERS: usize = 32;

/// Light of the lamps reflected by both sides of surfaces, and emission; through transparent surfaces also what is
/// behind them. The lamps cast no shadows.
fn radiance(context: &Context, ray: &Ray, hit: Option<Hit>, _: &mut Sampler) -> Vec3 {
    let (mut ray, mut hit) = (*ray, hit);
    let (mut light, mut left) = (Vec3::ZERO, 1.0);
    for _ in 0..MOST_LAYERS {
        let Some(nearest) = hit else { break };
        let (of_surface, opacity) = reflection(context, &ray, nearest);
        light += left * opacity * of_surface;
        left *= 1.0 - opacity;
        if left < INVISIBLE {
            return light;
        }
        let departure = Departure {
            arrived_by: &ray,
            hit: &nearest,
            surface: &context.scene.surface(&ray, &nearest),
            corners: None,
            dir: ray.dir,
            offset: Vec3::ZERO,
        };
        let Ok(onward) = default_spawn_policy().spawn(&departure) else {
            break;
        };
        ray = onward;
        hit = context.intersector.closest_hit(&ray);
    }
    light + left * context.background
}

/// The light that a surface reflects and emits towards the eye, and its opacity.
///
/// Source: Blinn, "Models of Light Reflection for Computer Synthesized Pictures", SIGGRAPH 1977, for the
/// highlights.
fn reflection(context: &Context, ray: &Ray, hit: Hit) -> (Vec3, f32) {
    let mesh = context.scene.mesh();
    let point = context.scene.surface(ray, &hit);
    let surface = SurfaceInteraction::of_surface(&context.scene, &point, hit, context.shading);
    let material = mesh.attributes().materials.get(surface.material);
    let appearance = Appearance::new(&context.scene, material, point.position, &hit);
    let is_front = surface.geometric_normal.dot(ray.dir) <= 0.0;
    let tint = if is_front {
        None
    } else {
        back_face_tint(context, ray)
    };
    let own = context.options.surface_colours.as_ref();
    let own = own.and_then(|colours| colours.of(hit.primitive));
    let diffuse = own.unwrap_or_else(|| appearance.diffuse());
    let diffuse = tint.map_or(diffuse, |tint| diffuse.lerp(tint, TINT_PART));
    let emission = appearance.emission_of_side(is_front);
    let opacity = appearance.opacity();
    let illumination = material.map_or(Illumination::Diffuse, |m| m.illumination);
    if illumination == Illumination::Constant {
        return (diffuse + emission, opacity);
    }

    let normal = appearance.facing_normal(&surface, ray);
    let lamps = studio::lamps(&context.camera);
    let of_lamp = |lamp: Lamp| lamp.strength * normal.dot(lamp.to_lamp).max(0.0);
    let light = AMBIENT + lamps.into_iter().map(of_lamp).sum::<f32>();
    let mut sum = light * diffuse + emission;
    if let Some(material) = material
        && illumination.has_highlights()
        && material.specular != Vec3::ZERO
        // Programs write an exponent of 0 for matt materials; taken literally, it would light everything.
        && material.shininess > 0.0
    {
        let to_eye = (-ray.dir).normalize_or_zero();
        let highlight = |lamp: Lamp| {
            let halfway = (lamp.to_lamp + to_eye).normalize_or_zero();
            let is_lit = normal.dot(lamp.to_lamp) > 0.0;
            let size = normal.dot(halfway).max(0.0).powf(material.shininess);
            if is_lit { lamp.strength * size } else { 0.0 }
        };
        sum += appearance.specular() * lamps.into_iter().map(highlight).sum::<f32>();
    }
    (sum, opacity)
}

/// The part of a tint in the colour of a tinted surface.
const TINT_PART: f32 = 0.7;

/// The tint of back faces along a ray: the user's, or that of surfaces that the clip opens.
fn back_face_tint(context: &Context, ray: &Ray) -> Option<Vec3> {
    let is_opened = || context.scene.cuts_start(ray).then(back_face_colour);
    context.options.back_face_tint.or_else(is_opened)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{Camera, Projection};
    use crate::integrator::{Lighting, SurfaceColours, ViewOptions};
    use crate::kernel::default_triangle_kernel;
    use crate::mesh::{
        Assigned, Attributes, CornerValues, Material, Runs, Texture, TextureMap, shapes,
    };
    use crate::scene::Shading;
    use glam::{DVec3, UVec2, Vec2};
    use std::sync::Arc;

    const BACKGROUND: Vec3 = Vec3::new(0.0, 0.25, 0.0);

    /// The colour of a ray straight down through layers of triangles, each with its own material, the first one
    /// on top.
    fn seen(materials: &[Material], others: Attributes) -> Vec3 {
        let (context, ray) = layers(materials, others);
        colour(&context, &ray)
    }

    fn colour(context: &Context, ray: &Ray) -> Vec3 {
        let hit = context.intersector.closest_hit(ray);
        radiance(context, ray, hit, &mut Sampler::new(UVec2::ZERO, 0))
    }

    /// The layers, 1 apart, and a ray from 1 above the first one.
    fn layers(materials: &[Material], others: Attributes) -> (Context, Ray) {
        let layer = |k: usize| [Vec3::ZERO, Vec3::X, Vec3::Y].map(|p| p - Vec3::Z * k as f32);
        let corners: Vec<_> = (0..materials.len()).map(layer).collect();
        let mut indices = Runs::default();
        for k in 0..materials.len() as u32 {
            indices.begin(k, k);
        }
        let mesh = shapes::soup(&corners).with_attributes(Attributes {
            materials: Assigned::new(materials.to_vec(), indices),
            ..others
        });
        let scene = Arc::new(crate::scene::scene(mesh));
        let intersector: Arc<dyn crate::Intersector> =
            Arc::from(scene.intersector(default_triangle_kernel()));
        let projection = Projection::Perspective { fov_y_radians: 1.0 };
        let (eye, middle) = (DVec3::new(0.25, 0.25, 1.0), DVec3::new(0.25, 0.25, 0.0));
        let camera = Camera::look_at(eye, middle, DVec3::Y, projection, UVec2::splat(2));
        let context = Context {
            second: Arc::clone(&intersector),
            intersector,
            scene,
            camera: camera.expect("a camera"),
            shading: Shading::Flat,
            background: BACKGROUND,
            lighting: Lighting::default(),
            options: ViewOptions::default(),
        };
        let ray = Ray::new(eye.as_vec3(), Vec3::NEG_Z).expect("a ray");
        (context, ray)
    }

    fn constant(diffuse: Vec3, opacity: f32) -> Material {
        Material {
            diffuse: Some(diffuse),
            opacity,
            illumination: Illumination::Constant,
            ..Material::default()
        }
    }

    #[test]
    fn transparent_layers_are_blended_in_order() {
        let (red, blue) = (constant(Vec3::X, 0.5), constant(Vec3::Z, 0.25));
        let light = seen(&[red, blue], Attributes::default());
        let expected = 0.5 * Vec3::X + 0.5 * (0.25 * Vec3::Z + 0.75 * BACKGROUND);
        assert!((light - expected).length() < 1e-6, "{light}");
        assert_eq!(
            seen(&[constant(Vec3::X, 1.0)], Attributes::default()),
            Vec3::X
        );
    }

    #[test]
    fn an_own_colour_replaces_that_of_the_material_of_its_primitives_alone() {
        let (red, blue) = (constant(Vec3::X, 0.5), constant(Vec3::Z, 1.0));
        let (mut context, ray) = layers(&[red, blue], Attributes::default());
        let colours = SurfaceColours::new(vec![0, 1], vec![Vec3::Y]);
        context.options.surface_colours = Some(colours.clone());
        assert_eq!(colour(&context, &ray), 0.5 * Vec3::X + 0.5 * Vec3::Y);
        let colours = colours.recoloured(vec![Vec3::ONE]);
        context.options.surface_colours = Some(colours);
        assert_eq!(colour(&context, &ray), 0.5 * Vec3::X + 0.5 * Vec3::ONE);
    }

    #[test]
    fn back_faces_are_tinted_where_asked_and_where_a_clip_opens_a_surface() {
        let white = constant(Vec3::ONE, 1.0);
        let (plain, down) = layers(&[white.clone(), white], Attributes::default());
        // The triangles' fronts are above.
        let up = Ray::new(Vec3::new(0.25, 0.25, -3.0), Vec3::Z).expect("a ray");
        let tinted = Context {
            options: ViewOptions {
                back_face_tint: Some(Vec3::Y),
                ..ViewOptions::default()
            },
            ..plain.clone()
        };
        let of = |tint: Vec3| Vec3::ONE.lerp(tint, TINT_PART);
        for (ray, expected) in [(&down, [Vec3::ONE; 2]), (&up, [Vec3::ONE, of(Vec3::Y)])] {
            assert_eq!(
                [&plain, &tinted].map(|context| colour(context, ray)),
                expected
            );
        }
        // A clip between the layers removes the lower one: the ray from below now enters through the cut.
        let clip = crate::Clip::plane(DVec3::NEG_Z, 0.5).expect("a plane");
        let clipped = |context: &Context| {
            let scene = Arc::new(context.scene.with_clip(Some(clip.clone())));
            Context {
                intersector: scene.clipped(Arc::clone(&context.intersector)),
                scene,
                ..context.clone()
            }
        };
        assert_eq!(colour(&clipped(&plain), &up), of(back_face_colour()));
        assert_eq!(colour(&clipped(&tinted), &up), of(Vec3::Y));
        assert_eq!(colour(&clipped(&plain), &down), Vec3::ONE);
    }

    #[test]
    fn highlights_and_emission_are_added() {
        let plain = Material {
            diffuse: Some(Vec3::splat(0.5)),
            ..Material::default()
        };
        let shiny = Material {
            specular: Vec3::ONE,
            ..plain.clone()
        };
        let matt = Material {
            illumination: Illumination::Diffuse,
            ..shiny.clone()
        };
        let glowing = Material {
            emission: Vec3::Y,
            ..plain.clone()
        };
        let of = |material: &Material| seen(std::slice::from_ref(material), Attributes::default());
        let base = of(&plain);
        assert_eq!(of(&matt), base);
        assert!(of(&shiny).min_element() > base.max_element());
        assert_eq!(of(&glowing), base + Vec3::Y);
    }

    #[test]
    fn texture_and_vertex_colours_multiply_the_materials_colour() {
        let mapped = Material {
            diffuse_map: Some(TextureMap::of(0)),
            ..constant(Vec3::new(1.0, 0.5, 1.0), 1.0)
        };
        // Magenta to the left of x = 0.5, where the ray comes down.
        let texels = [[255, 0, 255], [255, 0, 255], [0; 3], [0; 3]];
        let texels = texels.as_flattened().to_vec();
        let texture = Texture::new("t", UVec2::new(4, 1), texels);
        let uv = vec![Vec2::ZERO, Vec2::X, Vec2::Y];
        let painted = Attributes {
            textures: texture.into_iter().collect(),
            texture_coordinates: CornerValues::new(uv, [[0, 1, 2]]),
            ..Attributes::default()
        };
        assert_eq!(
            seen(std::slice::from_ref(&mapped), painted.clone()),
            Vec3::new(1.0, 0.0, 1.0)
        );
        let both = Attributes {
            colours: vec![Vec3::X; 3],
            ..painted
        };
        assert_eq!(seen(&[mapped], both), Vec3::X);
    }
}
