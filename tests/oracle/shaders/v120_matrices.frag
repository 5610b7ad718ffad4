#version 120
uniform mat4 m4;
uniform mat2x3 m23;
uniform mat3x2 m32;
varying vec4 v;
void main() {
    mat3 a = m23 * m32;
    mat2 b = m32 * m23;
    vec3 row = v.xyz * a;
    vec2 small = b * v.xy;
    mat4 t = transpose(m4) * m4;
    mat3 outer = outerProduct(v.xyz, row);
    gl_FragColor = t * v + vec4(row + outer[1], small.x * small.y) + matrixCompMult(m4, t)[2];
}
