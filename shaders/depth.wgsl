// Draws the depth of the triangles only, so that lines behind them can be hidden.

@vertex
fn vs_main(@location(0) position: vec3f) -> @builtin(position) vec4f {
    return clip_from_position(position);
}

// The same with a clip: the part of a triangle that the clip removes hides nothing.

struct Clipped {
    @builtin(position) projected: vec4f,
    @location(0) position: vec3f,
};

@vertex
fn vs_clipped(@location(0) position: vec3f) -> Clipped {
    return Clipped(clip_from_position(position), position);
}

@fragment
fn fs_clipped(point: Clipped) {
    if !is_kept(point.position) {
        discard;
    }
}
