#version 400
in vec3 v;
out vec4 colour;
void main() {
    int i = int(v.x * 1000.0);
    uint u = uint(abs(v.y) * 100000.0);
    uint low, high;
    umulExtended(u, 0x9E3779B9u, high, low);
    uint carry;
    uint sum = uaddCarry(low, 0xF0000000u, carry);
    int e;
    float s = frexp(v.z, e), w;
    float f = modf(v.z * 5.3, w);
    colour = vec4(bitfieldExtract(i, 3, 5) + bitCount(u), float(high % 1000u) + float(carry), float(findMSB(u) * findLSB(u | 16u)) + ldexp(s, e + 2),
                  f + w + float(bitfieldInsert(i, 5, 1, 3)) + float(bitfieldReverse(u) >> 20u) + float(sum >> 28u));
}
