// A ray's strip with its border: round ends, smooth edges, dashes in pixels.
#version 330
#include "veil.glsl"
uniform vec4 seam;     // colour and opacity of the border
uniform float extra;   // its width in logical pixels
in vec4 ink;
noperspective in vec2 beside;
flat in float half_width;
flat in float span;
flat in vec2 pattern;
flat in float fades;
out vec4 color;

void main() {
    float along = clamp(beside.x, 0.0, span);
    float away = length(vec2(beside.x - along, beside.y));
    float cover = clamp(half_width + 0.5 - away, 0.0, 1.0);
    float around = clamp(half_width + extra + 0.5 - away, 0.0, 1.0);
    float shown = mix(1.0, 1.0 - clamp(along / max(span, 1.0), 0.0, 1.0), fades);
    float period = pattern.x + pattern.y;
    if (period > 0.0) {
        float place = mod(beside.x, period);
        shown *= clamp(min(place, pattern.x - place) + 0.5, 0.0, 1.0);
    }
    color = seen(bordered(vec4(ink.rgb, ink.a * shown), cover, seam, around));
    if (color.a < 0.004) discard;
}
