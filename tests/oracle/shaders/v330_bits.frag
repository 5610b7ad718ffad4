#version 330
in vec3 v;
out vec4 colour;
void main() {
    int i = floatBitsToInt(v.x);
    uint u = floatBitsToUint(v.y) & 0xffff0000u;
    float f = intBitsToFloat(i & ~0xff);
    colour = vec4(f, uintBitsToFloat(u), isnan(v.z) ? 1.0 : 0.0, isinf(1.0 / (v.z - v.z)) ? 0.5 : 0.25);
}
