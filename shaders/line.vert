// Rays as strips of constant width in pixels. Inputs of a strip: two ends in the world, colour, width, dash, fading.
// Clip lines to a few widths of the picture before the division by depth: a line that starts behind the eye would
// otherwise be millions of pixels long, and its dashes would be rounding errors.
#version 330
uniform mat4 world_to_clip;
uniform vec2 size;     // of the picture, in pixels
uniform float scale;   // pixels per logical pixel
uniform float extra;   // logical pixels of border on either side
in vec3 from;
in vec3 to;
in vec4 tint;
in float width;
in vec2 dash;
in float fading;       // 1: fades towards its end
out vec4 ink;
noperspective out vec2 beside;       // logical pixels: along from the start, across from the middle
flat out float half_width;
flat out float span;
flat out vec2 pattern;
flat out float fades;

const float NEAR = 1e-4;
const float AROUND = 4.0;  // half widths of the picture

// Clip the part [x, y] of the line from a to b to where a linear form is positive.
void keep(float at_a, float at_b, inout vec2 part) {
    if (at_a < 0.0 && at_b < 0.0) part = vec2(1.0, 0.0);
    else if (at_a < 0.0) part.x = max(part.x, at_a / (at_a - at_b));
    else if (at_b < 0.0) part.y = min(part.y, at_a / (at_a - at_b));
}

void main() {
    vec4 whole_a = world_to_clip * vec4(from, 1.0);
    vec4 whole_b = world_to_clip * vec4(to, 1.0);
    vec2 part = vec2(0.0, 1.0);
    keep(whole_a.w - NEAR, whole_b.w - NEAR, part);
    keep(AROUND * whole_a.w - whole_a.x, AROUND * whole_b.w - whole_b.x, part);
    keep(AROUND * whole_a.w + whole_a.x, AROUND * whole_b.w + whole_b.x, part);
    keep(AROUND * whole_a.w - whole_a.y, AROUND * whole_b.w - whole_b.y, part);
    keep(AROUND * whole_a.w + whole_a.y, AROUND * whole_b.w + whole_b.y, part);
    if (part.x >= part.y) { gl_Position = vec4(0.0, 0.0, 2.0, 1.0); return; }
    vec4 a = mix(whole_a, whole_b, part.x), b = mix(whole_a, whole_b, part.y);
    vec2 p = 0.5 * size * a.xy / a.w / scale;
    vec2 q = 0.5 * size * b.xy / b.w / scale;
    vec2 along = q - p;
    float far = length(along);
    along = far > 1e-6 ? along / far : vec2(1.0, 0.0);
    vec2 across = vec2(-along.y, along.x);
    half_width = 0.5 * width;
    float reach = half_width + extra + 1.0;  // room for smoothing the edge
    int k = gl_VertexID;
    float end = float(k / 2), sign = float(k % 2) * 2.0 - 1.0;
    vec4 clip = end < 0.5 ? a : b;
    vec2 shift = across * sign * reach + along * (end * 2.0 - 1.0) * reach;
    gl_Position = clip + vec4(shift * scale * 2.0 / size * clip.w, 0.0, 0.0);
    beside = vec2(end < 0.5 ? -reach : far + reach, sign * reach);
    span = far;
    ink = tint;
    pattern = dash;
    fades = fading;
}
