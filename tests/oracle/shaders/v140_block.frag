#version 140
layout(std140) uniform Scene { vec3 a; float b; mat3 m; vec2 list[4]; mat2x4 n; };
in vec3 v;
out vec4 colour;
void main() {
    int i = int(v.x * 5.0);
    colour = vec4(m * (v + a), b) + n * list[clamp(i, 0, 3)] + vec4(list[2], m[1].xy);
}
