// The part of a thing behind the frontmost glass, or the part before it: so rays are seen through glass, and over it.
uniform sampler2D front;  // depth of the frontmost glass; 1 where there is none
uniform int side;         // 0: everything is drawn, 1: what is behind the glass, 2: what is before it

bool is_left_out() {
    if (side == 0) return false;
    return (gl_FragCoord.z <= texelFetch(front, ivec2(gl_FragCoord.xy), 0).r) != (side == 2);
}
