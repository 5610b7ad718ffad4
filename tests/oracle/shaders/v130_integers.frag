#version 130
in vec4 v;
uniform ivec3 k;
out vec4 colour;
void main() {
    ivec4 i = ivec4(v * 100.0) - 40;
    uvec4 u = uvec4(abs(i)) * 2654435761u;
    int shifted = (i.x << (k.x + 1)) ^ (i.y >> 1) | (i.z & 0x5a) ;
    uint mixed = (u.x >> 13u) % 97u + u.y / 1000003u;
    colour = vec4(float(shifted), float(mixed), float(abs(i.w) % (k.y + 3)), float(~i.x / (k.z + 2)));
}
