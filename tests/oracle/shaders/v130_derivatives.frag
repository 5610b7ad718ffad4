#version 130
in vec3 v;
out vec4 colour;
void main() {
    vec3 q = v * v.yzx;
    colour = vec4(dFdx(q.x), dFdy(q.y), fwidth(q.z), length(cross(dFdx(q), dFdy(q))) * 100.0) * 10.0;
}
