#!/usr/bin/python3
"""Inputs made to do harm: cameras and sizes beyond all bounds, files that ask for gigabytes, names that steer a terminal,
and things that are no files at all. One line each, in little time and memory."""
import csv
import io
import json
import os
import struct
import unicodedata
import zlib

from support import GPU, LAUNCHES, SCENE, ProgramTest, main

TINY = ["--resolution", "4x4", "--spp", "1"]
EVIL = "e\x1b[31m\u202ev\x07i\x7fl\u009b\r\nname\t"


def triangle(**changes):
    """A glTF document, its buffer inside."""
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 3]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.1}}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": "triangle.bin"}]}
    return {**document, **changes}


class HostileTest(ProgramTest):
    def setUp(self):
        super().setUp()
        self.path("triangle.bin").write_bytes(struct.pack("<9f", -1, -1, 0, 1, -1, 0, 0, 1, 0))

    def scene(self, name="scene.gltf", **changes):
        self.path(name).write_text(json.dumps(triangle(**changes)))
        return name

    def render(self, *arguments):
        return ["render", *arguments, *TINY, "-o", "o.exr"]


class Cameras(HostileTest):
    def test_an_eye_that_no_ray_can_start_from_is_refused_before_any_does(self):
        name = self.scene()
        quality = ["quality", name, *TINY, "--reference-spp", "2", "--strategy", "coherent", "--reference", "r.exr"]
        for command in (self.render(name), ["capture", name, *LAUNCHES, "-o", "t.rct"], quality):
            for eye in ("1e19,0,0", "0,-1.1e18,0", "0,0,3e38"):
                with self.subTest(f"{command[0]} {eye}"):
                    self.refuses(2, *command, "--eye", eye, "--look-at", "0,0,0", mentions=["--eye", "1e+18"],
                                 warnings=True)
                    self.refuses(2, *command, "--eye", "0,0,0", "--look-at", eye, mentions=["--look-at"], warnings=True)
        self.warns(*self.render(name), "--eye", "1e18,1e18,-1e18", "--look-at", "0,0,0")

    def test_a_camera_of_the_file_beyond_the_limit_is_refused(self):
        for place in ([1e19, 0, 0], [0, 0, -1e30], [0, 1e300, 0]):
            nodes = [{"mesh": 0}, {"camera": 0, "name": "far", "translation": place}]
            with self.subTest(place):
                line = self.refuses(1, *self.render(self.scene(nodes=nodes)), warnings=True)
                self.assertIn("camera far: expected an eye within 1e+18 m", line)
        self.warns(*self.render("scene.gltf"), "--eye", "0,0,3", "--look-at", "0,0,0")

    def test_transforms_of_every_kind_make_a_picture_or_a_refusal(self):
        for node in ({"scale": [1e-30] * 3}, {"scale": [1e30] * 3}, {"scale": [1e300, 1, 1]}, {"scale": [0, 0, 0]},
                     {"scale": [1, 0, 1]}, {"rotation": [0, 0, 0, 0]}, {"rotation": [1e-200, 0, 0, 0]},
                     {"matrix": [1, 0, 0, 0, 1, 1e-8, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1]},
                     {"matrix": [1e38, 1e38, 1e38, 0] * 3 + [0, 0, 0, 1]}, {"translation": [1e18, 1e18, 1e18]},
                     {"translation": [1e19, 0, 0]}):
            for nodes in ([{"mesh": 0, **node}, {"camera": 0, "translation": [0, 0, 3]}],
                          [{"mesh": 0}, {"camera": 0, **node}], [{"mesh": 0, **node}]):
                changes = {"nodes": nodes, "scenes": [{"nodes": list(range(len(nodes)))}]}
                if len(nodes) == 1:
                    changes["cameras"] = []
                with self.subTest(nodes):
                    result = self.run_program(*self.render(self.scene(**changes)), "--bounces", "4")
                    self.assertIn(result.code, (0, 1), result)
                    for line in result.stderr.splitlines():
                        self.assertRegex(line, "^raycache: (warning: |error: |wrote )")


class Memory(HostileTest):
    def test_sizes_are_read_strictly(self):
        name = self.scene()
        for size in ("", "0", "-1", "4 GiB", " 4GiB", "4GiB ", "4gb", "4G", "1e9", "0x10", "GiB", "1.5GiB", "0KiB",
                     "99999999999GiB", "16777216TiB", "+1GiB"):
            with self.subTest(size):
                self.refuses(2, *self.render(name), f"--memory-limit={size}",
                             mentions=["--memory-limit", "4GiB" if size else "SIZE"])
        for size in ("1000000000", "1GiB", "1024MiB", "1048576KiB", "1TiB"):
            self.warns(*self.render(name), "--memory-limit", size)

    def test_whatever_an_input_asks_for_is_weighed_before_it_is_allocated(self):
        self.refuses(1, *self.render(*SCENE), "--memory-limit", "1MiB", mentions=["courtyard", "--memory-limit"])
        self.refuses(1, "render", self.scene(), "--resolution", "16384x16384", "--spp", "1", "-o", "o.exr",
                     "--memory-limit", "1GiB", mentions=["16384 x 16384 pixels", "--memory-limit"], warnings=True)
        accessor = {"componentType": 5126, "count": 1 << 24, "type": "VEC3"}  # without a view: zeros, not one in the file
        bombs = {
            "accessor": {"accessors": [accessor]},
            "instances": {"accessors": [{**accessor, "count": 1 << 20}], "nodes": [{"mesh": 0}] * 64,
                          "scenes": [{"nodes": list(range(64))}], "cameras": []},
            "objects": {"materials": [{}] * 100000},
        }
        for name, changes in bombs.items():
            with self.subTest(name):
                self.assertLess(len(json.dumps(triangle(**changes))), 500000)
                self.refuses(1, *self.render(self.scene(**changes)), "--memory-limit", "64MiB",
                             mentions=["scene.gltf", "at most 64 MiB", "--memory-limit"], warnings=True)

    def test_a_texture_is_weighed_by_its_header(self):
        header = struct.pack(">IIBBBBB", 16000, 16000, 8, 6, 0, 0, 0)
        chunks = [(b"IHDR", header), (b"IDAT", zlib.compress(b"")), (b"IEND", b"")]
        png = b"\x89PNG\r\n\x1a\n" + b"".join(struct.pack(">I", len(content)) + kind + content +
                                              struct.pack(">I", zlib.crc32(kind + content)) for kind, content in chunks)
        self.path("huge.png").write_bytes(png)
        name = self.scene(images=[{"uri": "huge.png"}], textures=[{"source": 0}],
                          materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
                          meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}])
        self.refuses(1, *self.render(name), "--memory-limit", "256MiB", mentions=["huge.png", "found 976.6 MiB"],
                     warnings=True)


class Names(HostileTest):
    def assert_harmless(self, data, what):
        text = data.decode("utf-8")  # throws for anything else
        steering = [c for c in text if c != "\n" and unicodedata.category(c) in ("Cc", "Cf", "Zl", "Zp")]
        self.assertEqual(steering, [], what)

    def test_control_characters_of_names_reach_neither_stdout_nor_stderr(self):
        nodes = [{"mesh": 0, "name": EVIL}, {"camera": 0, "name": EVIL, "translation": [0, 0, 3]}]
        self.scene(EVIL + ".gltf", nodes=nodes, materials=[{"name": EVIL}])
        self.warns("capture", EVIL + ".gltf", *LAUNCHES, "-o", "a.rct")
        self.warns("capture", EVIL + ".gltf", *LAUNCHES, "--strategy", "coherent", "-o", "b.rct")
        for command in (["info", "a.rct"], ["info", "a.rct", "--json"], ["verify", "a.rct"],
                        ["replay", "a.rct", *GPU], ["replay", "a.rct", *GPU, "--csv"], ["replay", "a.rct", *GPU, "--json"],
                        ["replay", "a.rct", *GPU, "--counters", "ncu"], ["compare", "a.rct", "b.rct", *GPU],
                        ["compare", "a.rct", "b.rct", *GPU, "--csv"], ["explain", "a.rct", "b.rct", *GPU],
                        ["explain", "a.rct", "b.rct", *GPU, "--json"],
                        ["quality", EVIL + ".gltf", *TINY, "--reference-spp", "2", "--reference", "r.exr", "--json"],
                        ["quality", EVIL + ".gltf", *TINY, "--reference-spp", "2", "--reference", "r.exr"],
                        ["render", EVIL + ".gltf", "--camera", EVIL + "no", *TINY, "-o", "o.png"],
                        ["info", EVIL + ".rct"], ["import", EVIL, "-o", "o.rct"],
                        ["replay", "a.rct", "--gpu", EVIL], ["replay", "a.rct", "--gpu", EVIL + ".toml"]):
            with self.subTest(command):
                result = self.run_program(*command)
                self.assert_harmless(result.stdout, result)
                self.assert_harmless(result.stderr.encode(), result)
        scene = self.succeeds("info", "a.rct", "--json").json["traces"][0]["scene"]
        self.assertEqual(scene, EVIL + ".gltf")

    def test_a_name_with_line_breaks_does_not_break_a_table(self):
        self.scene("plain.gltf")
        self.scene("a\nb.gltf")
        self.warns("capture", "plain.gltf", *LAUNCHES, "-o", "plain.rct")
        self.warns("capture", "a\nb.gltf", *LAUNCHES, "-o", "broken.rct")
        for arguments in (["info"], ["replay", *GPU], ["replay", *GPU, "--csv"]):
            counts = [len(self.succeeds(arguments[0], trace, *arguments[1:]).text.splitlines())
                      for trace in ("plain.rct", "broken.rct")]
            self.assertEqual(counts[0], counts[1], arguments)
        rows = list(csv.DictReader(io.StringIO(self.succeeds("replay", "broken.rct", *GPU, "--csv").text)))
        self.assertEqual({row["scene"] for row in rows}, {"a b.gltf"})

    def test_names_that_are_no_utf8_are_told_all_the_same(self):
        name = os.fsdecode(b"n\xff\xc3ame.rct")
        for command in (["info", name], ["replay", name, *GPU], ["render", name, "-o", "o.png"], ["import", name, "-o", "o"]):
            result = self.run_program(*command)
            self.assertIn(result.code, (1, 2))
            self.assert_harmless(result.stderr.encode(), result)
            self.assertIn("n??ame.rct", result.stderr)


class NoFiles(HostileTest):
    def test_folders_devices_pipes_and_loops_are_refused_at_once(self):
        self.path("folder").mkdir()
        self.path("empty").write_bytes(b"")
        os.mkfifo(self.path("pipe"))
        self.path("loop").symlink_to("loop")
        self.path("nowhere").symlink_to("missing")
        things = ["folder", "empty", "pipe", "loop", "nowhere", "/dev/zero", "/dev/null", "/proc/self/maps", "/"]
        for thing in things:
            for command in (["info", thing], ["verify", thing], ["verify", thing, "--recover", "o.rct"],
                            ["replay", thing, *GPU], ["compare", thing, *GPU], ["import", thing, "-o", "o.rct"],
                            self.render(thing), ["export", thing, "--gpu", "h100", "-o", "o"],
                            ["quality", *SCENE, *TINY, "--reference-spp", "2", "--reference", thing]):
                if command[0] == "quality" and thing in ("loop", "nowhere", "/dev/null", "/"):
                    continue  # names for a reference still to be written
                with self.subTest(command):
                    result = self.run_program(*command, timeout=60)
                    self.assertIn(result.code, (1, 2), result)
                    self.assertEqual(len(result.stderr.splitlines()), 1, result)
        for thing in ("folder", "pipe", "loop", "/dev/zero", "/"):
            for name in {"folder": ["folder/"], "pipe": ["./pipe"], "loop": ["./loop"]}.get(thing, [thing]):
                with self.subTest(f"--gpu {name}"):
                    self.path("t.rct").write_bytes(b"")
                    self.refuses(1, "replay", "t.rct", "--gpu", name, timeout=60)

    def test_a_link_to_a_trace_is_as_good_as_the_trace(self):
        self.capture()
        self.path("link.rct").symlink_to("trace.rct")
        self.assertEqual(self.succeeds("info", "link.rct").text, self.succeeds("info", "trace.rct").text)


if __name__ == "__main__":
    main()
