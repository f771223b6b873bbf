// Rays as strips of constant width in pixels. In, a line a strip: two ends in the world, colour, width, dash, fading.
// A line that starts behind the eye is cut at the near plane before anything is divided by its depth.
#version 330
uniform mat4 world_to_clip;
uniform vec2 size;     // of the picture, in pixels
uniform float scale;   // pixels per logical pixel
uniform float extra;   // logical pixels added to the width: the halo
in vec3 from;
in vec3 to;
in vec4 tint;
in float width;
in vec2 dash;
in float fading;       // 1: fades towards its end
out vec4 ink;
out vec2 beside;       // logical pixels: along from the start, across from the middle
flat out float half_width;
flat out float span;
flat out vec2 pattern;
flat out float fades;

const float NEAR = 1e-4;

void main() {
    vec4 a = world_to_clip * vec4(from, 1.0);
    vec4 b = world_to_clip * vec4(to, 1.0);
    // Along the cut line the share of its length stays known, so that dashes do not run when the view moves.
    if (a.w < NEAR && b.w < NEAR) { gl_Position = vec4(0.0, 0.0, 2.0, 1.0); return; }
    if (a.w < NEAR) a = mix(a, b, (NEAR - a.w) / (b.w - a.w));
    if (b.w < NEAR) b = mix(b, a, (NEAR - b.w) / (a.w - b.w));
    vec2 p = 0.5 * size * a.xy / a.w / scale;
    vec2 q = 0.5 * size * b.xy / b.w / scale;
    vec2 along = q - p;
    float far = length(along);
    along = far > 1e-6 ? along / far : vec2(1.0, 0.0);
    vec2 across = vec2(-along.y, along.x);
    half_width = 0.5 * width + extra;
    float reach = half_width + 1.0;  // room for smoothing the edge
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
