#version 330
uniform sampler2DShadow shadow;
uniform sampler2D base;
in vec4 v;
out vec4 colour;
void main() {
    float lit = texture(shadow, v.xyz) + textureProj(shadow, v + vec4(0.0, 0.0, 0.0, 2.0));
    colour = lit * textureProj(base, vec3(v.xy, v.w + 2.0)) + textureGrad(base, v.xy, dFdx(v.xy), dFdy(v.xy)) + textureOffset(base, v.yz, ivec2(1, -2));
}
