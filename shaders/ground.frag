// The ground behind the scene, from `bottom` to `top`: calm, so that rays read on it.
#version 330
uniform vec3 top;
uniform vec3 bottom;
in float height;
out vec4 color;

void main() {
    // A step of one 256th here and there hides the bands that so slow a change would show.
    float noise = fract(sin(dot(gl_FragCoord.xy, vec2(12.9898, 78.233))) * 43758.5453) - 0.5;
    color = vec4(mix(bottom, top, height) + noise / 255.0, 1.0);
}
