#!/usr/bin/python3
"""Files that are damaged, missing, or of another kind, and disks that are full: exit code 1 and one line."""
import os
import pathlib
import resource
import signal
import struct
import subprocess
import tempfile
import unittest

from support import GPU, GPU_FILE, LAUNCHES, PICTURE, SCENE, ProgramTest, main

RENDER = ["render", *SCENE, "--resolution", "128x96", "--spp", "1"]
CAPTURE = ["capture", *SCENE, *LAUNCHES]



def files_of_at_most(size):
    """For preexec_fn: a longer file cannot be written, as on a full disk."""
    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
    return limit


class BadScenes(ProgramTest):
    def refuse_scene(self, name, code=1, everywhere=False):
        commands = [["capture", name, *LAUNCHES, "-o", "trace.rct"], ["render", name, "-o", "picture.png"],
                    ["compare", "--scene", name, *GPU]]
        for command in commands if everywhere else commands[:1]:
            with self.subTest(f"{command[0]} {name}"):
                self.refuses(code, *command, mentions=[name])

    def test_a_scene_that_does_not_exist(self):
        self.refuse_scene("missing.glb", code=2, everywhere=True)
        self.refuse_scene("missing/folder/scene.gltf", code=2)

    def test_scenes_that_are_empty_or_something_else(self):
        contents = {"empty.glb": b"", "empty.gltf": b"", "text.glb": b"This is no scene.\n", "text.gltf": b"Neither.",
                    "picture.glb": b"\x89PNG\r\n\x1a\n" + bytes(100), "object.gltf": b"{}", "list.gltf": b"[]",
                    "header.glb": b"glTF" + struct.pack("<II", 2, 12),
                    "old.glb": b"glTF" + struct.pack("<II", 1, 12),
                    "long.glb": b"glTF" + struct.pack("<II", 2, 0xFFFFFFFF) + bytes(8),
                    "deep.gltf": b"[" * 100000, "zeros.glb": bytes(4096)}
        for name, content in contents.items():
            self.path(name).write_bytes(content)
            self.refuse_scene(name)

    def test_a_folder_is_no_scene(self):
        self.path("scene.glb").mkdir()
        self.refuse_scene("scene.glb", everywhere=True)

    def test_a_scene_that_asks_for_a_missing_buffer_or_an_unknown_extension(self):
        scene = ('{"asset":{"version":"2.0"},"buffers":[{"uri":"gone.bin","byteLength":36}],'
                 '"bufferViews":[{"buffer":0,"byteLength":36}],'
                 '"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],'
                 '"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],'
                 '"scenes":[{"nodes":[0]}],"scene":0%s}')
        self.path("buffer.gltf").write_text(scene % "")
        self.refuse_scene("buffer.gltf")
        self.path("gone.bin").write_bytes(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0))
        self.warns("render", "buffer.gltf", "--resolution", "16x16", "--spp", "1", "-o", "picture.png")
        self.path("picture.png").unlink()
        self.path("shapes.gltf").write_text(scene % ',"extensionsRequired":["ACME_shapes"]')
        self.refuse_scene("shapes.gltf")


class BadTraces(ProgramTest):
    def refuse_trace(self, name, *mentions, everywhere=False):
        commands = [["verify", name], ["replay", name, *GPU], ["info", name], ["compare", name, *GPU]]
        for command in commands if everywhere else commands[:2]:
            with self.subTest(" ".join(command)):
                self.refuses(1, *command, mentions=[name, *mentions])

    def test_a_trace_that_does_not_exist(self):
        self.refuse_trace("missing.rct", everywhere=True)

    def test_files_that_are_no_trace(self):
        for name, content in (("empty.rct", b""), ("text.rct", b"not a trace\n" * 100), ("zeros.rct", bytes(65536)),
                              ("short.rct", b"RCTRACE\x1a")):
            self.path(name).write_bytes(content)
            self.refuse_trace(name)
        self.path("folder.rct").mkdir()
        self.refuse_trace("folder.rct")

    def test_a_trace_of_a_newer_version_says_so(self):
        data = bytearray(self.capture().read_bytes())
        version, = struct.unpack_from("<I", data, 8)
        struct.pack_into("<I", data, 8, version + 100)
        self.path("newer.rct").write_bytes(data)
        self.refuse_trace("newer.rct", "version", str(version + 100), everywhere=True)

    def test_a_trace_cut_off_anywhere_is_refused(self):
        data = self.capture().read_bytes()
        for share in (0.001, 0.5, 0.999):
            self.path("cut.rct").write_bytes(data[:int(len(data) * share)])
            self.refuse_trace("cut.rct")
        self.path("cut.rct").write_bytes(data[:-1])
        self.refuse_trace("cut.rct")

    def test_verify_finds_any_changed_byte(self):
        data = self.capture().read_bytes()
        for i in range(16):
            at = len(data) * i // 16
            self.path("changed.rct").write_bytes(data[:at] + bytes([data[at] ^ 0x10]) + data[at + 1:])
            with self.subTest(f"byte {at} of {len(data)}"):
                self.refuses(1, "verify", "changed.rct", mentions=["changed.rct"])

    def test_recover_saves_the_launches_that_are_whole(self):
        trace = self.capture()
        info = self.succeeds("info", trace, "--json").json
        data = bytearray(trace.read_bytes())
        at = len(data) * 3 // 4
        data[at] ^= 0xFF
        for name, content in (("changed.rct", data), ("cut.rct", data[:at])):
            self.path(name).write_bytes(content)
            with self.subTest(name):
                self.refuses(1, "verify", name)
                saved = self.succeeds("verify", name, "--recover", "rest.rct", "--json").json
                self.assertEqual((saved["launches_kept"], saved["launches_lost"]), (1, 1))
                self.succeeds("verify", "rest.rct")
                rest = self.succeeds("info", "rest.rct", "--json").json
                self.assertEqual(rest["traces"][0]["samples"], info["traces"][0]["samples"][:1])
                self.succeeds("replay", "rest.rct", *GPU)

    def test_recover_refuses_where_nothing_is_whole(self):
        data = self.capture().read_bytes()
        self.path("cut.rct").write_bytes(data[:len(data) // 10])
        self.refuses(1, "verify", "cut.rct", "--recover", "rest.rct")
        self.path("text.rct").write_bytes(b"not a trace")
        self.refuses(1, "verify", "text.rct", "--recover", "rest.rct")

    def test_recover_does_not_overwrite_the_damaged_trace_with_itself(self):
        trace = self.capture()
        data = trace.read_bytes()
        self.run_program("verify", trace, "--recover", trace)
        self.assertEqual(trace.read_bytes(), data)


class BadGpus(ProgramTest):
    def refuse_gpu(self, text, *mentions, name="gpu.toml"):
        self.path(name).write_text(text)
        self.refuses(1, "compare", "--scene", *SCENE, *LAUNCHES, "--gpu", name, mentions=[name, *mentions])

    def test_a_file_of_ones_own_works(self):
        self.path("gpu.toml").write_text(GPU_FILE)
        row = self.succeeds("compare", "--scene", *SCENE, *LAUNCHES, "--strategy", "coherent", "--gpu", "gpu.toml",
                            "--json").json["rows"][0]
        self.assertEqual(row["gpu"], "tiny")

    def test_bytes_follow_the_sector_size_of_the_file(self):
        for size in (32, 64):
            self.path("gpu.toml").write_text(GPU_FILE.replace(
                "sector_bytes = { value = 32", f"sector_bytes = {{ value = {size}"))
            row = self.warns("compare", "--scene", *SCENE, *PICTURE, "--trace-samples", "1", "--strategy", "coherent",
                             "--gpu", "gpu.toml", "--json").json["rows"][0]
            for bytes_per_ray, sectors in (("l2_bytes_per_ray", "l2_sectors"), ("dram_bytes_per_ray", "dram_sectors")):
                with self.subTest(f"{bytes_per_ray}, {size}"):
                    totals = row["totals"]
                    self.assertAlmostEqual(row[bytes_per_ray]["mean"], size * totals[sectors] / totals["rays"])

    def test_a_missing_file(self):
        self.refuses(1, "compare", "--scene", *SCENE, "--gpu", "missing.toml", mentions=["missing.toml"])
        self.refuses(1, "compare", "--scene", *SCENE, "--gpu", "./missing", mentions=["missing"])

    def test_unknown_keys_are_named_with_their_line(self):
        self.refuse_gpu(GPU_FILE.replace("\nsms =", "\nsmss ="), "smss")
        self.refuse_gpu(GPU_FILE + 'colour = "green"\n', "colour", f"gpu.toml:{len(GPU_FILE.splitlines()) + 1}")
        self.refuse_gpu(GPU_FILE + "\n[l3]\nsets = 4\n", "l3")

    def test_missing_keys_are_named(self):
        for key in ("sms", "l1_per_sm", "ways", "policy"):
            lines = [line for line in GPU_FILE.splitlines() if not line.startswith(key + " ")]
            self.refuse_gpu("\n".join(lines), key)
        self.refuse_gpu(GPU_FILE[:GPU_FILE.index("[l2]")], "l2")

    def test_values_of_the_wrong_type_or_out_of_range(self):
        for old, new in (("sms = { value = 2,", 'sms = { value = "two",'),
                         ("sms = { value = 2,", "sms = { value = 2.5,"),
                         ("sms = { value = 2,", "sms = { value = 0,"), ("sms = { value = 2,", "sms = { value = -2,"),
                         ("sms = { value = 2,", "sms = { value = 9223372036854775807,"),
                         ("value = 128,", "value = 100,"), ("value = 32,", "value = 0,"),
                         ("value = 32,", "value = 256,"),
                         ("value = 16,", "value = 0,"), ('"lru"', '"clairvoyant"'), ('"modulo"', '"random"'),
                         ('name = "tiny"', "name = 5")):
            with self.subTest(new):
                self.refuse_gpu(GPU_FILE.replace(old, new, 1), "gpu.toml:")

    def test_a_file_that_is_no_toml(self):
        self.refuse_gpu("sms = = 3\n", "gpu.toml:1")
        self.refuse_gpu("", "gpu.toml")
        self.path("gpu.toml").write_bytes(b"\x7fELF" + bytes(range(256)))
        self.refuses(1, "compare", "--scene", *SCENE, "--gpu", "gpu.toml", mentions=["gpu.toml"])

    def test_the_line_of_an_unknown_policy_lists_the_valid_ones(self):
        self.refuse_gpu(GPU_FILE.replace('"lru"', '"clairvoyant"'), "clairvoyant", "lru")


class BadOutputs(ProgramTest):
    def outputs(self, folder):
        """Commands that write, each with the last part of its output's path."""
        return ([*RENDER, "-o", f"{folder}/picture.png"], [*RENDER, "-o", f"{folder}/picture.exr"],
                [*RENDER, "-o", f"{folder}/picture.jpg"], [*RENDER, "-o", f"{folder}/picture.hdr"],
                [*CAPTURE, "-o", f"{folder}/trace.rct"])

    def test_a_folder_that_does_not_exist_or_is_no_folder_or_takes_no_files(self):
        self.path("file").write_text("")
        for folder in ("missing", "file", "/proc"):
            for command in self.outputs(folder):
                with self.subTest(command[-1]):
                    self.refuses(1, *command, mentions=[command[-1]])

    def test_an_output_that_is_a_folder(self):
        for command in self.outputs("."):
            self.path(command[-1]).mkdir()
            with self.subTest(command[-1]):
                self.refuses(1, *command, mentions=[command[-1]])

    @unittest.skipIf(os.geteuid() == 0, "root may write anywhere; run the tests as another user")
    def test_a_folder_without_write_permission(self):
        self.path("locked").mkdir(mode=0o555)
        for command in self.outputs("locked"):
            with self.subTest(command[-1]):
                self.refuses(1, *command, mentions=[command[-1]])

    def test_a_full_disk(self):
        for command in self.outputs("."):
            with self.subTest(command[-1]):
                self.refuses(1, *command, mentions=[command[-1]], preexec_fn=files_of_at_most(1000))

    def test_a_full_disk_leaves_the_old_file_alone(self):
        for command in self.outputs("."):
            self.path(command[-1]).write_bytes(b"old")
            with self.subTest(command[-1]):
                self.refuses(1, *command, preexec_fn=files_of_at_most(1000))
                self.assertEqual(self.path(command[-1]).read_bytes(), b"old")

    def test_a_full_disk_under_recover(self):
        data = bytearray(self.capture().read_bytes())
        data[-40] ^= 0xFF
        self.path("trace.rct").write_bytes(data)
        self.refuses(1, "verify", "trace.rct", "--recover", "rest.rct", mentions=["rest.rct"],
                     preexec_fn=files_of_at_most(1000))

    def test_a_report_that_cannot_be_saved(self):
        trace = self.capture()
        for prefix in ("missing/study", "/proc/study"):
            with self.subTest(prefix):
                result = self.run_program("replay", trace, *GPU, "--save", prefix)
                self.assertEqual(result.code, 1, result)
                self.assertRegex(result.stderr, r"\Araycache: error: [^\n]*study[^\n]*\n\Z")
        result = self.run_program("replay", trace, *GPU, "--save", "study", preexec_fn=files_of_at_most(100))
        self.assertEqual(result.code, 1, result)
        self.assertRegex(result.stderr, r"\A(raycache: error: study\.(txt|json|csv): [^\n]*\n){3}\Z")
        self.assertFalse([name for name in self.listing() if name.endswith(".partial")])

    def test_a_result_that_cannot_be_printed(self):
        trace = self.capture()
        for command in (["list"], ["list", "--json"], ["info", trace], ["verify", trace], ["replay", trace, *GPU]):
            with self.subTest(command[0]), open("/dev/full", "wb") as full:
                result = self.run_program(*command, stdout=full)
                self.assertEqual(result.code, 1, result)
                self.assertRegex(result.stderr, r"\Araycache: error: [^\n]+\n\Z")

    @unittest.skipUnless(os.geteuid() == 0, "only root can mount a small disk; run the tests as root")
    def test_a_small_disk_that_fills_up(self):
        with tempfile.TemporaryDirectory() as disk:
            mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=16k", "tmpfs", disk], check=False,
                                     stderr=subprocess.DEVNULL)
            if mounted.returncode != 0:
                self.skipTest("cannot mount a tmpfs here; run the tests where root may mount")
            try:
                for command in self.outputs(disk):
                    if command[0] == "capture" or command[-1].endswith(".exr"):
                        with self.subTest(command[-1]):
                            self.refuses(1, *command, mentions=[command[-1]])
                            self.assertEqual(list(pathlib.Path(disk).iterdir()), [])
            finally:
                subprocess.run(["umount", disk], check=True)


if __name__ == "__main__":
    main()
