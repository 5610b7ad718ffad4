// A6, as the program nearest-k with entries rgbz: the fragment takes the place of the first entry that it is nearer
// than, and each entry from there that of the next; of equal depths the first arrival stays in front.
#pragma program "nearest-k" "the k nearest fragments with their colours, sorted (A6)"
#pragma k 4 from 1 to 64
#pragma order any
#pragma peeling nearest
#pragma picture layers

struct Entry { float r, g, b, z; };

Entry entry(Fragment f) { return Entry(f.colour.r, f.colour.g, f.colour.b, f.depth); }

Entry empty() { return Entry(0.0, 0.0, 0.0, largest); }

void modify(inout Entry e[k], Entry f) {
    bool entered = false;
    for (int i = 0; i < k; ++i)
        if (f.z < e[i].z || (entered && f.z == e[i].z)) {
            Entry left = e[i];
            e[i] = f;
            f = left;
            entered = true;
        }
}
