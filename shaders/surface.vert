// A surface of the scene. Inputs: corner and normal in the world, or of a unit ball scaled by `ball` (w: its radius).
// Outputs: world position, normal, material number.
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
