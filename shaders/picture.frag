// See picture.vert. The picture is 8-bit sRGB, its first row at the top.
#version 330
#include "front.glsl"
uniform sampler2D picture;
uniform float opacity;
in vec2 uv;
out vec4 color;

void main() {
    vec2 inside = min(uv, 1.0 - uv) / fwidth(uv);  // pixels to the border, which is smoothed
    if (is_left_out()) discard;
    color = vec4(texture(picture, uv).rgb, opacity * clamp(min(inside.x, inside.y), 0.0, 1.0));
}
