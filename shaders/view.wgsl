// Where a point of the mesh appears. Comes before every other shader.

// Twin of `ViewUniform` in src/viewer/gpu/view.rs.
struct View {
    clip_from_eye: mat4x4f,
    // The start of the camera's rays, in the mesh's coordinates.
    eye: vec3f,
    // Smallest w that is drawn: in perspective the near distance, else 0.
    near_w: f32,
    // Width and height of the picture in pixels.
    viewport: vec2f,
};

@group(0) @binding(0) var<uniform> view: View;

// Relative to the eye first: both are exact in f32, so the difference is rounded once, and a mesh
// far from the origin doesn't shake.
fn clip_from_position(position: vec3f) -> vec4f {
    return view.clip_from_eye * vec4f(position - view.eye, 1.0);
}
