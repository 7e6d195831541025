// Depth and outlines of shapes, from one traced ray per pixel.

// Twin of `StyleUniform` in src/viewer/gpu/lines.rs; only the colour is used.
struct Outline {
    // sRGB, not premultiplied.
    colour: vec4f,
    unused: vec4f,
};

// Red: the depth that hides lines. Green: the depth of an outline in this pixel, or -1.
@group(1) @binding(0) var traced: texture_2d<f32>;
@group(2) @binding(0) var<uniform> outline: Outline;

struct Traced {
    @builtin(frag_depth) depth: f32,
    @location(0) colour: vec4f,
};

// One triangle that covers the viewport.
@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    let at = 2.0 * vec2f(f32(vertex & 1u), f32(vertex >> 1u));
    return vec4f(2.0 * at.x - 1.0, 1.0 - 2.0 * at.y, 0.0, 1.0);
}

@fragment
fn fs_depth(@builtin(position) position: vec4f) -> @builtin(frag_depth) f32 {
    return textureLoad(traced, vec2i(position.xy), 0).r;
}

// Premultiplied colour, sRGB-encoded like the picture below.
@fragment
fn fs_outline(@builtin(position) position: vec4f) -> Traced {
    let depth = textureLoad(traced, vec2i(position.xy), 0).g;
    if depth < 0.0 {
        discard;
    }
    let alpha = outline.colour.a;
    return Traced(depth, vec4f(outline.colour.rgb * alpha, alpha));
}
