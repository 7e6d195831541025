// Draws the depth of the triangles only, so that lines behind them can be hidden.

@vertex
fn vs_main(@location(0) position: vec3f) -> @builtin(position) vec4f {
    return clip_from_position(position);
}
