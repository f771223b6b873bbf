// A surface of the scene, shaded by the tracer's local term: ambient, diffuse and highlight of every light, no shadows.
// Mirrors and glass reflect an artificial sky. Glass is nearly clear in the middle and opaque at the rim, by Fresnel's
// law, so that rays inside it stay readable. An infinite plane fades out.
// GLASS, MIRROR, CHECKER are defined for scenes that have such surfaces.
#version 330
#include "common.glsl"

const int MOST_LIGHTS = 8;

uniform sampler2D materials;  // color+ambient; checker color+size; diffuse, specular, shininess, reflect; transmit, ior, flat
uniform sampler2D axes;       // of flat checkers, one column a material: u, v
uniform int light_count;
uniform vec4 lights[MOST_LIGHTS];       // w = 1: a position, w = 0: the direction towards it
uniform vec3 light_colors[MOST_LIGHTS];
uniform vec3 ambient;
uniform vec3 eye;
uniform vec3 up;
uniform vec3 sky_top;
uniform vec3 sky_bottom;
uniform float fade_from;  // distance from `fade_center` at which an infinite plane begins to fade, 0: a finite surface
uniform float fade_to;
uniform vec3 fade_center;
uniform vec3 origin;      // added to a position, so that checkers count from the world's origin
uniform vec4 edge;        // of the outline of glass
uniform vec3 tint;        // of clear glass: without it, glass is grey, and many faces are fog
uniform float ghost;      // > 0: opacity of a wall that is seen from behind

in vec3 place;
in vec3 n;
flat in int which;
out vec4 color;

#ifdef CHECKER
// Share of one colour of the checker along one axis, averaged over the pixel's width to avoid aliasing of far squares.
float stripe(float x, float w) {
    w = max(w, 1e-6);
    vec2 ends = vec2(x - 0.5 * w, x + 0.5 * w);
    vec2 area = floor(0.5 * ends) + 2.0 * max(fract(0.5 * ends) - 0.5, 0.0);
    return clamp((area.y - area.x) / w, 0.0, 1.0);
}

float checker(vec4 second, vec4 u, vec4 v) {
    vec3 p = (place + origin) / second.w;
    if (u.w > 0.5) {
        float a = dot(p, u.xyz), b = dot(p, v.xyz);
        float s = stripe(a, fwidth(a)), t = stripe(b, fwidth(b));
        return s + t - 2.0 * s * t;
    }
    vec3 w = fwidth(p);
    // An offset of half a millionth along the axes: a face exactly between two layers of cubes takes one of them as a whole.
    p += 5e-7;
    float s = stripe(p.x, w.x), t = stripe(p.y, w.y), r = stripe(p.z, w.z);
    float st = s + t - 2.0 * s * t;
    return st + r - 2.0 * st * r;
}

#endif

#if defined(GLASS) || defined(MIRROR)
vec3 sky(vec3 direction) {
    return mix(sky_bottom, sky_top, smoothstep(-0.25, 0.6, dot(direction, up)));
}
#endif

void main() {
    vec4 first = texelFetch(materials, ivec2(which, 0), 0);
    vec4 terms = texelFetch(materials, ivec2(which, 2), 0);

    vec3 base = first.rgb;
#ifdef CHECKER
    vec4 second = texelFetch(materials, ivec2(which, 1), 0);
    if (second.w > 0.0)
        base = mix(base, second.rgb, checker(second, texelFetch(axes, ivec2(which, 0), 0), texelFetch(axes, ivec2(which, 1), 0)));
#endif
    vec3 v = normalize(place - eye);
    vec3 normal = normalize(n);
    if (dot(normal, v) > 0.0) normal = -normal;
    vec3 light = first.a * ambient * base;
    vec3 shine = vec3(0.0);
    for (int j = 0; j < light_count; j++) {
        vec3 l = normalize(lights[j].xyz - lights[j].w * place);
        float n_l = dot(normal, l);
        if (n_l <= 0.0) continue;
        light += light_colors[j] * terms.x * n_l * base;
        float r_v = max(dot(reflect(-l, normal), -v), 0.0);
        shine += light_colors[j] * terms.y * pow(r_v, max(terms.z, 1.0));
    }
    float alpha = 1.0;
#if defined(GLASS) || defined(MIRROR)
    vec3 mirrored = sky(reflect(v, normal));
#endif
#ifdef GLASS
    vec4 glass = texelFetch(materials, ivec2(which, 3), 0);
    if (glass.x > 0.0) {
        float c1 = -dot(v, normal);
        float r0 = pow((glass.y - 1.0) / (glass.y + 1.0), 2.0);
        float fresnel = r0 + (1.0 - r0) * pow(1.0 - c1, 5.0);
        float rim = clamp(terms.w + 0.8 * fresnel + 0.22 * pow(1.0 - c1, 3.0), 0.0, 1.0);
        light = 0.3 * light + mix(pow(tint, vec3(2.2)) * base, mirrored, 0.7 * rim);
        alpha = clamp(0.06 + 0.6 * (1.0 - glass.x) + rim, 0.0, fade_from > 0.0 ? 0.34 : 0.8);
        alpha = clamp(alpha + dot(shine, vec3(0.33)), 0.0, 0.92);
        // The outline of curved surfaces: where the normal turns away from the eye within a pixel.
        float turns = fwidth(c1);
        float rim_line = turns > 0.02 ? edge.a * (1.0 - smoothstep(0.6, 1.8, c1 / turns)) : 0.0;
        light = mix(light, pow(edge.rgb, vec3(2.2)), rim_line);
        alpha = max(alpha, rim_line);
    } else
#endif
    {
#ifdef MIRROR
        light += terms.w * mirrored;
#endif
    }
    if (ghost > 0.0) alpha = ghost;
    if (fade_from > 0.0) alpha *= 1.0 - smoothstep(fade_from, fade_to, distance(place, fade_center));
    color = vec4(to_srgb(light + shine), alpha);
}
