// Draws the traced picture and the overlay, pixel for pixel or magnified.

@group(0) @binding(0) var picture: texture_2d<f32>;
// Premultiplied, of the picture's size. Not read without HAS_OVERLAY.
@group(0) @binding(1) var overlay: texture_2d<f32>;

// The part that is drawn, from (0, 0) at the top left to (1, 1) at the bottom right: its corner (xy) and its size (zw).
@group(0) @binding(2) var<uniform> part: vec4f;

override HAS_OVERLAY: bool;

struct Fragment {
    @builtin(position) position: vec4f,
    // From (0, 0) at the top left to (1, 1) at the bottom right.
    @location(0) at: vec2f,
};

// One triangle that covers the viewport.
@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> Fragment {
    let at = 2.0 * vec2f(f32(vertex & 1u), f32(vertex >> 1u));
    return Fragment(vec4f(2.0 * at.x - 1.0, 1.0 - 2.0 * at.y, 0.0, 1.0), at);
}

// Nearest-neighbour sampling, for the previous picture while the window is resized, and for magnified pixels.
fn pixel(texture: texture_2d<f32>, at: vec2f) -> vec4f {
    let size = vec2i(textureDimensions(texture));
    return textureLoad(texture, min(vec2i(at * vec2f(size)), size - 1), 0);
}

// Both textures and the window are sRGB-encoded.
@fragment
fn fs_main(fragment: Fragment) -> @location(0) vec4f {
    let at = part.xy + fragment.at * part.zw;
    let under = pixel(picture, at);
    if !HAS_OVERLAY {
        return under;
    }
    let over = pixel(overlay, at);
    return vec4f(over.rgb + (1.0 - over.a) * under.rgb, 1.0);
}
