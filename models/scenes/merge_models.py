"""merge_models.py FOLDER OUT.glb: puts the converted models of FOLDER into one glTF scene.

Each model becomes one mesh with one material. Corners with equal position and normal become one vertex, numbered by
first use; triangles keep the order of their file, so that vertex reuse is that of the model and not of an optimiser.
"""
import array
import json
import math
import pathlib
import struct
import sys

# model, base colour with opacity, scale, degrees about y, x, z.
# Every model stands on the plane y = 0; they overlap as seen from +z, so that a pixel sees up to a dozen surfaces.
PLACED = [
    ("asteroid-high", (0.50, 0.47, 0.44, 0.8), 0.85, 0, 1.15, -1.5),
    ("horse", (0.55, 0.33, 0.18, 0.6), 1.6, 30, -0.9, -1.2),
    ("bunny", (0.85, 0.80, 0.72, 0.5), 1.0, 0, 0.1, 0.0),
    ("cat", (0.25, 0.45, 0.70, 0.4), 0.42, -20, 0.55, 1.0),
]
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963
UNSIGNED_SHORT, UNSIGNED_INT, FLOAT = 5123, 5125, 5126


def read_glb(path):
    """The first primitive of a .glb: a list of (position, normal) and the list of indices."""
    data = path.read_bytes()
    json_length, = struct.unpack_from("<I", data, 12)
    gltf = json.loads(data[20:20 + json_length])
    binary = data[20 + json_length + 8:]

    def accessor(index, code, width):
        entry = gltf["accessors"][index]
        view = gltf["bufferViews"][entry["bufferView"]]
        begin = view.get("byteOffset", 0) + entry.get("byteOffset", 0)
        size = struct.calcsize(code) * width * entry["count"]
        return list(struct.iter_unpack(f"<{width}{code}", binary[begin:begin + size]))

    primitive, = gltf["meshes"][0]["primitives"]
    codes = {UNSIGNED_SHORT: "H", UNSIGNED_INT: "I"}
    indices = accessor(primitive["indices"], codes[gltf["accessors"][primitive["indices"]]["componentType"]], 1)
    positions = accessor(primitive["attributes"]["POSITION"], "f", 3)
    normals = accessor(primitive["attributes"]["NORMAL"], "f", 3)
    return list(zip(positions, normals)), [index for index, in indices]


def weld(corners, indices):
    """Equal corners become one vertex; triangles that thereby lose an edge are dropped."""
    numbers, triangles = {}, []
    for first in range(0, len(indices), 3):
        triangle = [corners[index] for index in indices[first:first + 3]]
        if len({position for position, _ in triangle}) == 3:
            triangles += [numbers.setdefault(corner, len(numbers)) for corner in triangle]
    return list(numbers), triangles


class Scene:
    def __init__(self):
        self.binary = bytearray()
        self.gltf = {
            "asset": {"version": "2.0", "generator": "ropsim models/scenes/merge_models.py"},
            "scene": 0, "scenes": [{"name": "menagerie", "nodes": []}],
            "nodes": [], "meshes": [], "materials": [], "accessors": [], "bufferViews": [], "buffers": [{}],
        }

    def add(self, kind, entry):
        self.gltf[kind].append(entry)
        return len(self.gltf[kind]) - 1

    def add_accessor(self, values, code, target, entry):
        self.binary += bytes(-len(self.binary) % 4)
        block = array.array(code, values)
        if sys.byteorder == "big":
            block.byteswap()
        view = self.add("bufferViews", {"buffer": 0, "byteOffset": len(self.binary),
                                        "byteLength": len(block) * block.itemsize, "target": target})
        self.binary += block.tobytes()
        return self.add("accessors", {"bufferView": view, **entry})

    def add_vectors(self, vectors, bounds):
        entry = {"componentType": FLOAT, "type": "VEC3", "count": len(vectors)}
        if bounds:
            entry.update(min=[min(axis) for axis in zip(*vectors)], max=[max(axis) for axis in zip(*vectors)])
        return self.add_accessor([x for vector in vectors for x in vector], "f", ARRAY_BUFFER, entry)

    def add_model(self, name, colour, scale, degrees, x, z, vertices, triangles):
        positions, normals = zip(*vertices)
        wide = len(vertices) > 65535
        indices = {"componentType": UNSIGNED_INT if wide else UNSIGNED_SHORT, "type": "SCALAR", "count": len(triangles)}
        primitive = {
            "attributes": {"POSITION": self.add_vectors(positions, True), "NORMAL": self.add_vectors(normals, False)},
            "indices": self.add_accessor(triangles, "I" if wide else "H", ELEMENT_ARRAY_BUFFER, indices),
            "material": self.add("materials", {
                "name": name, "alphaMode": "BLEND", "doubleSided": True,
                "pbrMetallicRoughness": {"baseColorFactor": colour, "metallicFactor": 0.0, "roughnessFactor": 0.6}}),
        }
        half_turn = math.radians(degrees) / 2
        lowest = min(position[1] for position in positions)
        self.gltf["scenes"][0]["nodes"].append(self.add("nodes", {
            "name": name, "mesh": self.add("meshes", {"name": name, "primitives": [primitive]}),
            "translation": [x, -lowest * scale, z], "rotation": [0.0, math.sin(half_turn), 0.0, math.cos(half_turn)],
            "scale": [scale, scale, scale]}))

    def write(self, path):
        self.binary += bytes(-len(self.binary) % 4)
        self.gltf["buffers"][0]["byteLength"] = len(self.binary)
        text = json.dumps(self.gltf, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        total = 12 + 8 + len(text) + 8 + len(self.binary)
        path.write_bytes(b"glTF" + struct.pack("<II", 2, total) + struct.pack("<I", len(text)) + b"JSON" + text +
                         struct.pack("<I", len(self.binary)) + b"BIN\0" + self.binary)


def main():
    folder, out = map(pathlib.Path, sys.argv[1:])
    scene, total = Scene(), 0
    for name, *placing in PLACED:
        vertices, triangles = weld(*read_glb(folder / f"{name}.glb"))
        scene.add_model(name, *placing, vertices, triangles)
        total += len(triangles) // 3
    scene.write(out)
    print(f"{out}: {total} triangles, {out.stat().st_size} bytes")


main()
