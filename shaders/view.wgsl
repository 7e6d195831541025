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
    // Normal of each of the clip's planes, and its offset, with the rounding of positions; a point p is kept if
    // dot(normal, p) is at most the offset. Unused planes keep every point.
    planes: array<vec4f, PLANE_COUNT>,
};

// Not a uniform, because a driver may recompile a shader for each value of a uniform that a branch or a loop depends
// on. Mesa's lavapipe 22.3 does that for each drawing, and keeps every result.
const PLANE_COUNT = 16u;

@group(0) @binding(0) var<uniform> view: View;

// Subtract the eye first: both are exact in f32, so the difference is rounded only once, and a mesh far from
// the origin doesn't jitter.
fn clip_from_position(position: vec3f) -> vec4f {
    return view.clip_from_eye * vec4f(position - view.eye, 1.0);
}

// Whether the clip keeps a point.
fn is_kept(position: vec3f) -> bool {
    for (var k = 0u; k < PLANE_COUNT; k += 1u) {
        if dot(view.planes[k].xyz, position) > view.planes[k].w {
            return false;
        }
    }
    return true;
}
