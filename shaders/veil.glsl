// What is between the camera and a line: an opaque thing makes it faint, glass veils it.
uniform sampler2D solid;  // depth of the frontmost opaque thing
uniform sampler2D front;  // depth of the frontmost glass; 1 where there is none
uniform sampler2D glass;  // colour times opacity of all glass together, and its opacity
uniform float hidden;     // opacity behind opaque things; 1: the line is drawn while the depth buffer is in use

const float VEIL = 0.5;   // share of the glass's opacity over lines: their colours stay legible

// The colour of a line that is blended over the picture with the glass. With VEIL = 1 the result would be the same as if
// the line had been drawn before the glass.
vec4 seen(vec4 line) {
    if (hidden == 1.0) return line;
    ivec2 at = ivec2(gl_FragCoord.xy);
    if (gl_FragCoord.z > texelFetch(solid, at, 0).r) line.a *= hidden;
    if (gl_FragCoord.z > texelFetch(front, at, 0).r) {
        vec4 veil = VEIL * texelFetch(glass, at, 0);
        line.rgb = veil.rgb + (1.0 - veil.a) * line.rgb;
    }
    return line;
}

// A line with its border: `cover` is the share of the pixel under the line, `around` that under line and border.
vec4 bordered(vec4 ink, float cover, vec4 seam, float around) {
    float over = ink.a * cover, under = ink.a * seam.a * around * (1.0 - over);
    float alpha = over + under;
    return vec4((ink.rgb * over + seam.rgb * under) / max(alpha, 1e-4), alpha);
}
