// Arrow heads by their distance to the outline: 1 filled, 2 a chevron, 3 two chevrons.
#version 330
#include "veil.glsl"
uniform vec4 seam;     // colour and opacity of the border
uniform float extra;   // its width in logical pixels
in vec4 ink;
in vec2 spot;
flat in int shape;
flat in float reach;
out vec4 color;

const float SPREAD = 0.42;  // half the width over the length

// Distance to the two strokes of a chevron whose tip is at x.
float chevron(vec2 p, float x, float size) {
    vec2 q = vec2(p.x - x, abs(p.y));
    vec2 stroke = vec2(size, size * SPREAD * 1.25);
    float t = clamp(dot(q, stroke) / dot(stroke, stroke), 0.0, 1.0);
    return length(q - t * stroke) - 1.1;
}

// Distance to the filled head with its tip at 0.
float head(vec2 p) {
    vec2 q = vec2(p.x, abs(p.y));
    vec2 side = normalize(vec2(1.0, SPREAD));
    return max(dot(q, vec2(-side.y, side.x)), q.x - reach);
}

void main() {
    float d = shape == 1 ? head(spot)
            : shape == 2 ? chevron(spot, 0.0, 0.8 * reach)
            : min(chevron(spot, -0.1 * reach, 0.7 * reach), chevron(spot, 0.4 * reach, 0.7 * reach));
    float cover = clamp(0.5 - d, 0.0, 1.0);
    float around = clamp(extra + 0.5 - d, 0.0, 1.0);
    color = seen(bordered(ink, cover, seam, around));
    if (color.a < 0.004) discard;
}
