// See picture.vert. The picture is 8-bit sRGB, its first row at the top.
#version 330
uniform sampler2D picture;
uniform sampler2D front;  // depth of the frontmost glass; 1 where there is none
uniform bool before;      // draw what is before that glass, or what is behind it
uniform float opacity;
in vec2 uv;
out vec4 color;

void main() {
    vec2 inside = min(uv, 1.0 - uv) / fwidth(uv);  // pixels to the border, which is smoothed
    if ((gl_FragCoord.z <= texelFetch(front, ivec2(gl_FragCoord.xy), 0).r) != before) discard;
    color = vec4(texture(picture, uv).rgb, opacity * clamp(min(inside.x, inside.y), 0.0, 1.0));
}
