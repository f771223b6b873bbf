// See picture.vert. The picture is 8-bit sRGB, its first row at the top.
#version 330
uniform sampler2D picture;
uniform float opacity;
in vec2 uv;
out vec4 color;

void main() {
    color = vec4(texture(picture, uv).rgb, opacity);
}
