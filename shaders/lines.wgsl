// Lines of constant width in pixels, anti-aliased by the distance from their centre line.

// Twin of `StyleUniform` in src/viewer/gpu/lines.rs.
struct Style {
    // sRGB, not premultiplied.
    colour: vec4f,
    half_width_px: f32,
    // The end is moved to this many times its distance from the start.
    stretch: f32,
};

// `Fade` in src/viewer/gpu/lines.rs. 0: lines don't fade. 1: lines fade where they or the gap between them would be
// shorter than a few pixels. 2: only the gap counts, because the lines are pieces of curves. 3: as 2, whatever the
// direction of the gap.
override FADE: u32;
// Whether the clip cuts lines.
override IS_CUT: bool;

@group(1) @binding(0) var<uniform> style: Style;

struct Line {
    @location(0) start: vec3f,
    @location(1) end: vec3f,
    // From the line to the expected position of its neighbour.
    @location(2) gap: vec3f,
};

struct Fragment {
    @builtin(position) position: vec4f,
    // Pixels from the centre line.
    @location(0) @interpolate(linear) across_px: f32,
    @location(1) @interpolate(flat) alpha: f32,
};

// A vertex outside the clip volume.
const NOWHERE = Fragment(vec4f(2.0, 2.0, 0.0, 1.0), 0.0, 0.0);

fn pixel_from_clip(clip: vec4f) -> vec2f {
    return 0.5 * view.viewport * clip.xy / clip.w;
}

// Opacity of a line whose neighbour is this many pixels away. Below MERGED_PX lines merge into a veil, whose
// opacity doesn't increase with density; above ALONE_PX they are separate.
fn visible_part(gap_px: f32) -> f32 {
    const MERGED_PX = 1.5;
    const ALONE_PX = 9.0;
    const VEIL = 0.12;
    let veil = VEIL * min(gap_px / MERGED_PX, 1.0);
    return mix(veil, 1.0, smoothstep(MERGED_PX, ALONE_PX, gap_px));
}

// The length in pixels of a vector at a point, along the axis where it appears longest.
fn longest_px(at: vec3f, size: f32) -> f32 {
    const SEPARATE_PX = 1e6;
    let here = clip_from_position(at);
    var longest = 0.0;
    for (var axis = 0u; axis < 3u; axis += 1u) {
        var beside_at = at;
        beside_at[axis] += size;
        let beside = clip_from_position(beside_at);
        if min(here.w, beside.w) <= view.near_w {
            return SEPARATE_PX;
        }
        longest = max(longest, length(pixel_from_clip(beside) - pixel_from_clip(here)));
    }
    return longest;
}

// The part of a line that the clip keeps, as two factors from 0 to 1; the first is the larger one if nothing is kept.
fn kept_part(start: vec3f, end: vec3f) -> vec2f {
    var part = vec2f(0.0, 1.0);
    for (var k = 0u; k < PLANE_COUNT; k += 1u) {
        let plane = view.planes[k];
        let before = dot(plane.xyz, start) - plane.w;
        let after = dot(plane.xyz, end) - plane.w;
        if before > 0.0 && after > 0.0 {
            return vec2f(1.0, 0.0);
        } else if before > 0.0 {
            part.x = max(part.x, before / (before - after));
        } else if after > 0.0 {
            part.y = min(part.y, before / (before - after));
        }
    }
    return part;
}

// A quad around the line, as two triangles:   1───3
//                                             │ ╲ │
//                                             0───2
@vertex
fn vs_main(@builtin(vertex_index) vertex: u32, line: Line) -> Fragment {
    let far = mix(line.start, line.end, style.stretch);
    var part = vec2f(0.0, 1.0);
    if IS_CUT {
        part = kept_part(line.start, far);
        if part.x > part.y {
            return NOWHERE;
        }
    }
    var start = clip_from_position(mix(line.start, far, part.x));
    var end = clip_from_position(mix(line.start, far, part.y));

    // Clip at the near plane: behind the eye a projection is undefined.
    if start.w < view.near_w && end.w < view.near_w {
        return NOWHERE;
    }
    if start.w < view.near_w {
        start = mix(start, end, (view.near_w - start.w) / (end.w - start.w));
    }
    if end.w < view.near_w {
        end = mix(end, start, (view.near_w - end.w) / (start.w - end.w));
    }

    let along_px = pixel_from_clip(end) - pixel_from_clip(start);
    let length_px = length(along_px);
    if length_px < 1e-4 {
        return NOWHERE;
    }

    var alpha = 1.0;
    if FADE > 2u {
        alpha = visible_part(longest_px(line.start, length(line.gap)));
    } else if FADE > 0u {
        let middle = mix(line.start, line.end, 0.5);
        let here = clip_from_position(middle);
        let beside = clip_from_position(middle + line.gap);
        if min(here.w, beside.w) > view.near_w {
            let gap_px = length(pixel_from_clip(beside) - pixel_from_clip(here));
            alpha = visible_part(select(min(gap_px, length_px), gap_px, FADE > 1u));
        }
    }

    const CORNERS = array(0u, 1u, 2u, 2u, 1u, 3u);
    let corner = CORNERS[vertex];
    let side = select(-1.0, 1.0, (corner & 1u) == 1u);
    let at = select(start, end, corner >= 2u);
    let normal = vec2f(-along_px.y, along_px.x) / length_px;
    // Half a pixel more than the line's half width, for anti-aliasing.
    let across_px = side * (style.half_width_px + 0.5);
    let offset = 2.0 * normal * across_px / view.viewport;
    return Fragment(vec4f(at.xy + offset * at.w, at.zw), across_px, alpha);
}

// Premultiplied colour, sRGB-encoded like the picture below.
@fragment
fn fs_main(fragment: Fragment) -> @location(0) vec4f {
    let coverage = clamp(style.half_width_px + 0.5 - abs(fragment.across_px), 0.0, 1.0);
    let alpha = style.colour.a * fragment.alpha * coverage;
    return vec4f(style.colour.rgb * alpha, alpha);
}
