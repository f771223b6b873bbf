// A layer of transparent surfaces over the picture: colour times opacity, and opacity.
#version 330
uniform sampler2D layer;
out vec4 color;

void main() {
    color = texelFetch(layer, ivec2(gl_FragCoord.xy), 0);
    if (color.a == 0.0) discard;
}
