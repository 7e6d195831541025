// Draws the traced picture and the overlay, pixel for pixel or magnified.

@group(0) @binding(0) var picture: texture_2d<f32>;
// Premultiplied, of the picture's size. Read by fs_with_overlay only.
@group(0) @binding(1) var overlay: texture_2d<f32>;
// Nearest-neighbour, for magnified pixels, and for the previous picture while the window is resized.
@group(0) @binding(2) var nearest: sampler;

struct DrawnPart {
    // From (0, 0) at the picture's top left to (1, 1) at its bottom right: the part's corner (xy) and its size (zw).
    part: vec4f,
    // Factors to coordinates in the texture, whose top left corner may hold one texel per block of pixels.
    texture_from_picture: vec2f,
};

@group(0) @binding(3) var<uniform> drawn: DrawnPart;

struct Fragment {
    @builtin(position) position: vec4f,
    // Coordinates in the textures of the picture (xy) and of the overlay (zw).
    @location(0) at: vec4f,
};

// One triangle that covers the viewport.
@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> Fragment {
    let corner = 2.0 * vec2f(f32(vertex & 1u), f32(vertex >> 1u));
    let at = drawn.part.xy + corner * drawn.part.zw;
    let position = vec4f(2.0 * corner.x - 1.0, 1.0 - 2.0 * corner.y, 0.0, 1.0);
    return Fragment(position, vec4f(at * drawn.texture_from_picture, at));
}

// Without arithmetic: Mesa's llvmpipe then copies texels, which takes 4 ms of CPU time per frame instead of 11 (1280 × 740,
// Mesa 22.3, AVX2, 2026-11).
@fragment
fn fs_picture(fragment: Fragment) -> @location(0) vec4f {
    return textureSample(picture, nearest, fragment.at.xy);
}

// Both textures and the window are sRGB-encoded.
@fragment
fn fs_with_overlay(fragment: Fragment) -> @location(0) vec4f {
    let under = textureSample(picture, nearest, fragment.at.xy);
    let over = textureSample(overlay, nearest, fragment.at.zw);
    return vec4f(over.rgb + (1.0 - over.a) * under.rgb, 1.0);
}
