#!/usr/bin/python3
"""Writes the first inputs of the fuzz targets that no golden file has: small scenes, Accel-Sim and RTWARP01 traces,
command lines, changes of GPU files.

Usage: tests/fuzz/make_corpus.py [FOLDER]     (default: corpus beside this file)
"""
import json
import lzma
import pathlib
import struct
import sys
import zlib

import zstandard

CTA = "#BEGIN_TB\n\nthread block = 0,0,0\n\nwarp = 0\ninsts = {count}\n{lines}#END_TB\n"
TRACEG = ("-kernel name = k\n-kernel id = 1\n-grid dim = (1,1,1)\n-block dim = (32,1,1)\n-binary version = 86\n"
          "-accelsim tracer version = 5\n\n#traces format = x\n\n")


def png(width, height):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + bytes(range(4 * width)) for _ in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


class Glb:
    """A scene of one quad with much of what a file may say."""

    def __init__(self):
        self.bin = b""
        self.doc = {"asset": {"version": "2.0"}, "accessors": [], "bufferViews": []}

    def view(self, data):
        self.bin += b"\0" * (-len(self.bin) % 4)
        self.doc["bufferViews"].append({"buffer": 0, "byteOffset": len(self.bin), "byteLength": len(data)})
        self.bin += data
        return len(self.doc["bufferViews"]) - 1

    def accessor(self, values, code, component, kind, width):
        view = self.view(struct.pack(f"<{len(values)}{code}", *values))
        self.doc["accessors"].append({"bufferView": view, "componentType": component, "type": kind,
                                      "count": len(values) // width})
        return len(self.doc["accessors"]) - 1

    def bytes(self):
        self.doc["buffers"] = [{"byteLength": len(self.bin)}]
        text = json.dumps(self.doc, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        self.bin += b"\0" * (-len(self.bin) % 4)
        chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(self.bin), 0x004E4942) + self.bin
        return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def scene(rich):
    glb = Glb()
    attributes = {"POSITION": glb.accessor([0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0], "f", 5126, "VEC3", 3)}
    glb.doc["meshes"] = [{"primitives": [{"attributes": attributes}]}]
    glb.doc["nodes"] = [{"mesh": 0}]
    primitive = glb.doc["meshes"][0]["primitives"][0]
    primitive["indices"] = glb.accessor([0, 1, 2, 2, 3, 0], "H", 5123, "SCALAR", 1)
    if rich:
        attributes["NORMAL"] = glb.accessor([0, 0, 1] * 4, "f", 5126, "VEC3", 3)
        attributes["TEXCOORD_0"] = glb.accessor([0, 0, 1, 0, 1, 1, 0, 1], "f", 5126, "VEC2", 2)
        primitive["material"] = 0
        glb.doc["meshes"][0]["primitives"].append({"attributes": attributes, "mode": 5, "material": 1})
        texture = {"index": 0}
        glb.doc["materials"] = [
            {"alphaMode": "MASK", "alphaCutoff": 0.5, "doubleSided": True, "normalTexture": texture,
             "pbrMetallicRoughness": {"baseColorTexture": texture, "baseColorFactor": [1, 0.5, 0.5, 1],
                                      "metallicRoughnessTexture": texture, "roughnessFactor": 0.3}},
            {"emissiveFactor": [1, 1, 1], "emissiveTexture": texture, "alphaMode": "BLEND",
             "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 3.5},
                            "KHR_materials_transmission": {"transmissionFactor": 0.9},
                            "KHR_materials_ior": {"ior": 1.4}}}]
        glb.doc["extensionsUsed"] = list(glb.doc["materials"][1]["extensions"])
        glb.doc["textures"] = [{"source": 0, "sampler": 0}]
        glb.doc["samplers"] = [{"wrapS": 10497, "wrapT": 33071}]
        glb.doc["images"] = [{"bufferView": glb.view(png(4, 3)), "mimeType": "image/png"}]
        glb.doc["cameras"] = [{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}]
        glb.doc["nodes"] += [{"children": [0], "matrix": [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1]},
                             {"camera": 0, "translation": [0, 0, 4], "rotation": [0, 0, 0.6, 0.8], "scale": [1, 2, 1]}]
        glb.doc["scenes"] = [{"nodes": [1, 2]}]
        glb.doc["scene"] = 0
    return glb.bytes()


def traceg():
    lines = ["0000 ffffffff 1 R4 LDG.E.128.SYS 1 R4 16 1 0x1000 16 0", "0010 00000007 1 R4 LDG.E.SYS 1 R4 4 2 0x9000 64 -8 0",
             "0020 00000003 1 R4 LDG.E.64.STRONG.GPU 1 R4 8 0 0x20 0x4000000 0", "0030 00000001 0 ST.E 1 R4 4 0 0x20 0",
             "0040 ffffffff 0 EXIT 0 0 0"]
    return (TRACEG + CTA.format(count=len(lines), lines="".join(line + "\n" for line in lines))).encode()


def rtwarp():
    def record(tag, mask, *elements):
        return struct.pack(f"<BI{len(elements)}I", tag, mask, *elements)
    warp = record(0x80, 0b11) + record(0, 0b11, 0, 0) + record(0x40, 0b10, 5) + record(0x84, 0b1) + record(4, 0b1, 3)
    warps = struct.pack("<II", 5, len(warp)) + warp
    return (b"RTWARP01" + struct.pack("<6IfI2I2Q", 64, 2, 8, 4, 0, 64, 0.5, 2, 64, 48, 1 << 40, 1 << 41) +
            warps * 2)


OPTIONS = {
    "capture": "capture courtyard --strategy micro-jitter --spp 64 --k 2.5 --s 2 --seed 7 --resolution 64x48 -o a.rct",
    "view": "render a.glb --eye 1,2,3 --look-at 0,0,0 --fov 40 --sky on --spp 16 --sequence halton -o a.png",
    "compare": "compare courtyard --strategy coherent,random --spp 64,256 --gpu h100,rtx-3070 --set l1.ways=64 --timed",
    "traces": "compare a.rct b.rct --gpu gtx-980-ti --warps-per-sm 16 --by bounce --baseline random --json",
    "wavefront": "capture courtyard --execution wavefront --order morton --interleave 4 --mu cycles --output a.rct",
    "paths": "capture courtyard --bounces 5 --bounces-diffuse 2 --bounces-transmission 3 --lights mis -o a.rct",
    "quality": "quality courtyard --spp 16 --repeats 2 --reference-spp 64 --strategy coherent,owen --csv",
    "sweep": "sweep courtyard --mu 0,0.25,1 --gpu v100 --max-rmse 1.1 --max-r8 1.5",
    "explain": "explain a.rct b.rct --gpu gtx-980-ti --by depth --heatmap why.exr",
    "export": "export a.rct --gpu v100 --format csv --level l2 --launch 0 -o a.csv",
    "samples": "samples --k 1 --picture holes.png --strategy micro-jitter",
    "list": "list gpus --details --json",
    "help": "capture --help",
}


def main(folder):
    inputs = {"gltf/plain.glb": scene(False), "gltf/rich.glb": scene(True), "traceg/loads.traceg": traceg(),
              "traceg/loads.traceg.xz": lzma.compress(traceg()), "rtwarp/two-warps.rtw": rtwarp(),
              "rtwarp/two-warps.rtw.zst": zstandard.compress(rtwarp())}
    gpus = pathlib.Path(__file__).resolve().parents[2] / "cachesim/gpus"
    inputs["gpu/change.toml"] = b"#set l1.ways=8\n" + (gpus / "rtx-3070.toml").read_bytes()
    for name, words in OPTIONS.items():
        inputs[f"options/{name}"] = "\n".join(words.split()).encode()
    for name, data in inputs.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else pathlib.Path(__file__).resolve().parent / "corpus")
