// A surface of the scene. In: corner and normal in the world, or of a unit ball that `ball` places (w: its radius).
// Out: world position, normal, and which material.
#version 330
uniform mat4 world_to_clip;
in vec3 corner;
in vec3 normal;
in vec4 ball;
in float material;
out vec3 place;
out vec3 n;
flat out int which;

void main() {
    place = ball.xyz + ball.w * corner;
    n = normal;
    which = int(material + 0.5);
    gl_Position = world_to_clip * vec4(place, 1.0);
}
