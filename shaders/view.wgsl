// Projection of the mesh's points. Prepended to every other shader.

// Twin of `ViewUniform` in src/viewer/gpu/view.rs.
struct View {
    clip_from_eye: mat4x4f,
    // Origin of the camera's rays, in the mesh's coordinates.
    eye: vec3f,
    // Smallest w that is drawn: the near distance in perspective, otherwise 0.
    near_w: f32,
    // Width and height of the picture in pixels.
    viewport: vec2f,
};

@group(0) @binding(0) var<uniform> view: View;

// Subtract the eye first: both are exact in f32, so the difference is rounded only once, and a mesh far from
// the origin doesn't jitter.
fn clip_from_position(position: vec3f) -> vec4f {
    return view.clip_from_eye * vec4f(position - view.eye, 1.0);
}
