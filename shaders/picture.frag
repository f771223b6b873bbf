// See picture.vert. The picture is 8-bit sRGB, its first row at the top.
#version 330
uniform sampler2D picture;
uniform sampler2D front;  // depth of the frontmost glass; 1 where there is none
uniform bool before;      // draw what is before that glass, or what is behind it
uniform float opacity;
in vec2 uv;
out vec4 color;

// The place from which the linear filter takes the colour: magnified pixels are squares, blended only at their borders.
vec2 squared(vec2 texel) {
    vec2 border = floor(texel + 0.5);
    return border + clamp((texel - border) / min(fwidth(texel), 1.0), -0.5, 0.5);
}

void main() {
    vec2 inside = min(uv, 1.0 - uv) / fwidth(uv);  // pixels to the border, which is smoothed
    if ((gl_FragCoord.z <= texelFetch(front, ivec2(gl_FragCoord.xy), 0).r) != before) discard;
    vec2 size = vec2(textureSize(picture, 0));
    color = vec4(texture(picture, squared(uv * size) / size).rgb, opacity * clamp(min(inside.x, inside.y), 0.0, 1.0));
}
