// A7, as the program order-and-blend: of the entries and the fragment, the nearest is composited and dropped. Entries
// that hold no fragment yet are nearer than all and contribute nothing.
#pragma program "order-and-blend" "sorts a nearly sorted stream and composites it (A7)"
#pragma k 4 from 1 to 63
#pragma order primitive
#pragma picture state

struct Entry { float r, g, b, z; };
struct State { float r, g, b, t; };

Entry entry(Fragment f) { return Entry(f.colour.r, f.colour.g, f.colour.b, f.depth); }

Entry empty() { return Entry(0.0, 0.0, 0.0, -largest); }

State initial() { return State(0.0, 0.0, 0.0, 1.0); }

void composite(inout State s, Entry f) {
    if (!(f.z > -largest)) return;
    float weight = s.t * opacity;
    s.r += weight * f.r;
    s.g += weight * f.g;
    s.b += weight * f.b;
    s.t *= 1.0 - opacity;
}

void modify(inout Entry e[k], inout State s, Entry f) {
    float z = f.z;
    if (e[0].z <= z) {
        Entry nearest = e[0];
        e[0] = f;
        f = nearest;
        for (int i = 1; i < k; ++i)
            if (e[i].z <= z) {
                Entry farther = e[i - 1];
                e[i - 1] = e[i];
                e[i] = farther;
            }
    }
    composite(s, f);
}

void drain(inout Entry e[k], inout State s) {
    for (int i = 0; i < k; ++i) {
        composite(s, e[i]);
        e[i] = empty();
    }
}
