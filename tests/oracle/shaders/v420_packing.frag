#version 420
in vec4 v;
out vec4 colour;
void main() {
    vec4 c = clamp(v, 0.02, 0.97);
    colour = unpackUnorm4x8(packUnorm4x8(c)) + unpackSnorm4x8(packSnorm4x8(c)) + vec4(unpackUnorm2x16(packUnorm2x16(c.xy)), unpackHalf2x16(packHalf2x16(c.zw)));
}
