// A ray's strip: round ends, smooth edges, dashes in pixels; `opacity` fades it as a whole (behind objects, not selected).
#version 330
#include "front.glsl"
uniform float opacity;
uniform vec4 seam;     // w = 1: this colour for all, for the halo
in vec4 ink;
noperspective in vec2 beside;
flat in float half_width;
flat in float span;
flat in vec2 pattern;
flat in float fades;
out vec4 color;

void main() {
    if (is_left_out()) discard;
    float along = clamp(beside.x, 0.0, span);
    float away = length(vec2(beside.x - along, beside.y));
    float cover = clamp(half_width + 0.5 - away, 0.0, 1.0);
    float period = pattern.x + pattern.y;
    if (period > 0.0) {
        float place = mod(beside.x, period);
        cover *= clamp(min(place, pattern.x - place) + 0.5, 0.0, 1.0);
    }
    float fade = mix(1.0, 1.0 - clamp(along / max(span, 1.0), 0.0, 1.0), fades);
    color = vec4(mix(ink.rgb, seam.rgb, seam.w), ink.a * cover * opacity * fade);
    if (color.a < 0.004) discard;
}
