// One triangle over the whole picture.
#version 330
out float height;  // 0 at the bottom, 1 at the top

void main() {
    vec2 p = vec2(float(gl_VertexID % 2) * 4.0 - 1.0, float(gl_VertexID / 2) * 4.0 - 1.0);
    height = 0.5 * p.y + 0.5;
    gl_Position = vec4(p, 0.9999, 1.0);
}
