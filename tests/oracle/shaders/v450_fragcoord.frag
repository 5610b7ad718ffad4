#version 450 core
layout(location = 0) out vec4 colour;
in noperspective vec2 v;
uniform vec2 scale;
bool odd(ivec2 p) { return ((p.x ^ p.y) & 1) != 0; }
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
    colour = vec4(gl_FragCoord.xy * scale, gl_FragCoord.zw);
    if (gl_FrontFacing && odd(p)) colour = -colour;
    if (all(lessThan(p, ivec2(5))) || any(equal(p, ivec2(9)))) colour.w = 2.0;
    colour.xy += mix(v, v.yx, bvec2(p.x > 8, p.y > 8));
    if (p.x == 17 && p.y > 3) discard;
    colour.z += dFdxFine(v.x * v.y) + dFdyCoarse(v.x);
}
