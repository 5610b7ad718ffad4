#version 430
in vec4 v;
uniform float table[6];
out vec4 colour;
struct Node { float weight; vec2 place[2]; };
void main() {
    const float fixed_table[5] = float[](0.1, 0.9, 0.3, 0.7, 0.5);
    float grid[3][2];
    Node nodes[3];
    for (int i = 0; i < 3; ++i) {
        nodes[i].weight = table[i * 2] + fixed_table[i];
        for (int k = 0; k < 2; ++k) { grid[i][k] = table[i + k] * v[i]; nodes[i].place[k] = v.xy * grid[i][k]; }
    }
    int at = int(abs(v.x) * 10.0) % 3;
    vec4 c = vec4(grid[at][1], nodes[2 - at].weight, nodes[at].place[at / 2]);
    c[at] += fixed_table[at + 2];
    colour = c + v[at + 1];
}
