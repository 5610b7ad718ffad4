#version 330
uniform mat4 a;
uniform mat3 b;
uniform mat2 c;
in vec4 v;
out vec4 colour;
void main() {
    mat4 m = a + mat4(3.0);
    mat3 n = b + mat3(2.0);
    mat2 o = c + mat2(2.0);
    colour = inverse(m) * v + vec4(inverse(n) * v.xyz, determinant(n)) * 0.1 + vec4(inverse(o) * v.xy, determinant(o), determinant(m) * 0.01);
}
