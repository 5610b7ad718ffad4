#version 140
uniform samplerBuffer texels;
uniform sampler2DRect rectangle;
in vec2 v;
out vec4 colour;
void main() {
    int n = textureSize(texels);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < n; i += 3) sum += texelFetch(texels, i) * v.x;
    colour = sum + texture(rectangle, abs(v) * 4.0 + 0.3) * float(n);
}
