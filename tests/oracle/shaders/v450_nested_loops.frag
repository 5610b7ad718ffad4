#version 450 core
in vec2 v;
layout(location = 0) out vec4 colour;
float series(float x, int n) {
    float sum = 0.0, term = 1.0;
    for (int i = 1; i <= n; ++i) { term *= x / float(i); if (abs(term) < 1e-4) return sum; sum += term; }
    return sum;
}
void main() {
    vec2 z = vec2(0.0), c = v * 2.0 - vec2(1.2, 0.6);
    int n = 0;
    while (n < 12 && dot(z, z) < 4.0) { z = vec2(z.x * z.x - z.y * z.y, 2.0 * z.x * z.y) + c; ++n; }
    float sum = 0.0;
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x <= n; ++x) {
            if (x == y) continue;
            if (x > 6) break;
            sum += series(v.x * float(x), y + 3);
        }
    colour = vec4(float(n), sum * 0.01, series(v.y, 9), 1.0);
}
