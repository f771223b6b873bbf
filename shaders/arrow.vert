// Arrow heads of constant size in pixels, on the rays. Inputs of a head: the ray's two ends, position along it, colour, kind.
#version 330
uniform mat4 world_to_clip;
uniform vec2 size;
uniform float scale;
uniform float length_px;
uniform float extra;
in vec3 from;
in vec3 to;
in float at;
in vec4 tint;
in float kind;
out vec4 ink;
out vec2 spot;        // logical pixels from the tip: x backwards, y across
flat out int shape;
flat out float reach;

const float NEAR = 1e-4;

void main() {
    vec4 a = world_to_clip * vec4(from, 1.0);
    vec4 b = world_to_clip * vec4(to, 1.0);
    vec4 c = world_to_clip * vec4(mix(from, to, at), 1.0);
    if (c.w < NEAR || kind < 0.5) { gl_Position = vec4(0.0, 0.0, 2.0, 1.0); return; }
    vec4 start = a.w < NEAR ? mix(a, c, (NEAR - a.w) / (c.w - a.w)) : a;
    vec4 end = b.w < NEAR ? c : b;
    vec2 along = 0.5 * size * (end.xy / end.w - start.xy / start.w) / scale;
    float far = length(along);
    along = far > 1e-6 ? along / far : vec2(1.0, 0.0);
    // No arrow on a ray that is hardly longer than it, or seen along its length.
    if (far < 1.6 * length_px) { gl_Position = vec4(0.0, 0.0, 2.0, 1.0); return; }
    vec2 across = vec2(-along.y, along.x);
    reach = length_px;
    float margin = extra + 1.5;
    vec2 corner = vec2(float(gl_VertexID / 2) * 2.0 - 1.0, float(gl_VertexID % 2) * 2.0 - 1.0);
    vec2 half_box = vec2(1.0 * length_px + margin, 0.62 * length_px + margin);
    vec2 shift = along * corner.x * half_box.x + across * corner.y * half_box.y;
    gl_Position = c + vec4(shift * scale * 2.0 / size * c.w, 0.0, 0.0);
    spot = vec2(0.5 * length_px - corner.x * half_box.x, corner.y * half_box.y);
    ink = tint;
    shape = int(kind + 0.5);
}
