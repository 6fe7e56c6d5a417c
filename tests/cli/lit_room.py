"""A room of one colour a wall with a lamp under its ceiling and a block on its floor: a scene with a light of its own that
the loader has nothing to warn of."""
import base64
import json
import struct

SIZE = 5.5  # metres, each way


def box(low, high, inward):
    """The twelve triangles of a box, as corners."""
    corner = [[(high if i >> axis & 1 else low)[axis] for axis in range(3)] for i in range(8)]
    sides = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    for a, b, c, d in sides:
        a, b, c, d = (corner[i] for i in ((a, d, c, b) if inward else (a, b, c, d)))
        yield [a, b, c, a, c, d]


def write_lit_room(path):
    walls = list(box([0, 0, 0], [SIZE, SIZE, SIZE], inward=True))
    block = [v for side in box([1, 0, 1], [2.8, 1.7, 2.8], inward=False) for v in side]
    low, high, below = 2.1, 3.4, SIZE - 0.8  # no nearer: light that falls on what it hangs under is noise
    lamp = [[low, below, low], [high, below, low], [high, below, high], [low, below, low], [high, below, high],
            [low, below, high]]
    parts = [(walls[4], "red"), (walls[5], "green"), ([v for side in walls[:4] for v in side] + block, "white"),
             (lamp, "lamp")]
    colours = {"red": [0.6, 0.05, 0.05], "green": [0.1, 0.5, 0.1], "white": [0.73, 0.73, 0.73], "lamp": [0, 0, 0]}
    materials = [{"name": name, "doubleSided": True,
                  "pbrMetallicRoughness": {"baseColorFactor": [*colour, 1], "metallicFactor": 0, "roughnessFactor": 1}}
                 for name, colour in colours.items()]
    materials[-1]["emissiveFactor"] = [1, 1, 1]
    materials[-1]["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": 15}}
    data, views, accessors, primitives = b"", [], [], []
    for vertices, material in parts:
        content = b"".join(struct.pack("<3f", *vertex) for vertex in vertices)
        primitives.append({"attributes": {"POSITION": len(accessors)}, "material": list(colours).index(material)})
        accessors.append({"bufferView": len(views), "componentType": 5126, "count": len(vertices), "type": "VEC3",
                          "min": [min(v[i] for v in vertices) for i in range(3)],
                          "max": [max(v[i] for v in vertices) for i in range(3)]})
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(content)})
        data += content
    middle = SIZE / 2
    document = {
        "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_emissive_strength"], "scene": 0,
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0}, {"camera": 0, "translation": [middle, middle, SIZE - 0.1]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.01}}],
        "meshes": [{"primitives": primitives}], "materials": materials, "accessors": accessors, "bufferViews": views,
        "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}]}
    path.write_text(json.dumps(document), encoding="utf-8")
    return path
