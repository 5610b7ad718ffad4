#version 400
uniform sampler2D base;
uniform sampler2D many[3];
in vec2 v;
out vec4 colour;
void main() {
    colour = textureGather(base, v) + 0.5 * textureGather(base, v.yx, 2) + texture(many[1], v) + texelFetch(base, ivec2(clamp(v, 0.0, 1.0) * 7.9), 0);
    colour.x += float(textureSize(many[2], 0).y);
}
