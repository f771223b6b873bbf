// The background, a gradient from `bottom` to `top`: plain, so that rays are easy to see.
#version 330
uniform vec3 top;
uniform vec3 bottom;
in float height;
out vec4 color;

void main() {
    // Dithering by 1/256: so slow a gradient would show bands.
    float noise = fract(sin(dot(gl_FragCoord.xy, vec2(12.9898, 78.233))) * 43758.5453) - 0.5;
    color = vec4(mix(bottom, top, height) + noise / 255.0, 1.0);
}
