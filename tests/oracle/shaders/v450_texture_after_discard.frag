#version 450 core
layout(location = 0) out vec4 colour;
in vec2 v;
uniform sampler2D base;
void main() {
    vec4 mask = texture(base, v);
    if (mask.x < 0.4) discard;
    vec2 moved = v;
    for (int i = 0; i < 3; ++i) { if (mask.y * float(i) > 1.0) break; moved += mask.zw * 0.1; }
    colour = texture(base, moved) + vec4(mask.xy, 0.0, 1.0);
}
