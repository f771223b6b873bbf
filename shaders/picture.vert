// A picture on a quadrangle in the world: the rendered image on the camera's image plane.
#version 330
uniform mat4 world_to_clip;
uniform vec3 corners[4];  // top left, bottom left, top right, bottom right
out vec2 uv;

void main() {
    uv = vec2(float(gl_VertexID / 2), float(gl_VertexID % 2));
    gl_Position = world_to_clip * vec4(corners[gl_VertexID], 1.0);
}
