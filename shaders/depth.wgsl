// Depth of the triangles alone, so that lines behind them can be hidden.

@vertex
fn vs_main(@location(0) position: vec3f) -> @builtin(position) vec4f {
    return clip_from_position(position);
}
