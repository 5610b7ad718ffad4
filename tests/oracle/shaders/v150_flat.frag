#version 150
flat in ivec2 id;
flat in vec3 tint;
in vec2 v;
out vec4 colour;
bool inside(vec2 p, out float distance) {
    distance = length(p - 0.5);
    if (distance > 0.6) return false;
    distance *= 2.0;
    return true;
}
void main() {
    float d;
    bool in_it = inside(v, d);
    colour = vec4(tint * d, float(id.x * 10 + id.y));
    if (!in_it) { if (v.x > 0.7) discard; colour.rgb = colour.bgr; }
}
