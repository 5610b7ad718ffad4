#version 130
in vec2 v;
out vec4 colour;
void main() {
    vec4 c = vec4(0.25);
    for (int i = 0; i < 5; ++i) {
        switch (int(v.x * 7.0) + i) {
        case 0: c.r += 0.5; break;
        case 2: c.g += 0.25;
        case 3: c.b += v.y; break;
        case 5: if (v.y > 0.3) continue; c.a *= 0.5; break;
        default: c.rg = c.gr * 0.9; break;
        }
        c *= 1.1;
    }
    colour = c;
}
