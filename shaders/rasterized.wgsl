// Finds the triangle visible at each pixel's centre, and the barycentric coordinates there.

struct Fragment {
    @builtin(position) projected: vec4f,
    @location(0) position: vec3f,
    // Barycentric coordinates of the second and third corner, with perspective-correct interpolation.
    @location(1) weights: vec2f,
    // The triangle's number, counted from 1.
    @location(2) @interpolate(flat) triangle: u32,
};

// Buffers and draws begin with the first corner of a triangle.
@vertex
fn vs_main(
    @location(0) position: vec3f,
    @location(1) triangle: u32,
    @builtin(vertex_index) index: u32,
) -> Fragment {
    let corner = index % 3u;
    let weights = vec2f(f32(corner == 1u), f32(corner == 2u));
    return Fragment(clip_from_position(position), position, weights, triangle);
}

@fragment
fn fs_main(fragment: Fragment) -> @location(0) vec4u {
    if !is_kept(fragment.position) {
        discard;
    }
    let weights = bitcast<vec2u>(fragment.weights);
    return vec4u(fragment.triangle, weights, 0u);
}
