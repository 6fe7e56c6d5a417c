#!/usr/bin/python3
"""Where results go: never over what is read, through links and named pipes, onto devices, to stdout."""
import os
import stat
import struct
import threading
import unittest

from support import GPU, LAUNCHES, PICTURE, SCENE, ProgramTest, main

HEAD = "-kernel name = k\n-grid dim = (1,1,1)\n-block dim = (32,1,1)\n-accelsim tracer version = 5\n\n#traces format = x\n\n"
KERNEL = HEAD + ("#BEGIN_TB\nthread block = 0,0,0\nwarp = 0\ninsts = 1\n"
                 "0000 00000003 1 R4 LDG.E.SYS 1 R4 4 1 0x1000 4 0\n#END_TB\n")
SECTORS = ["--gpu", "h100", "--sm", "0", "--launch", "0", "--format"]
GLTF = ('{"asset":{"version":"2.0"},"buffers":[{"uri":"positions.rct","byteLength":36}],'
        '"bufferViews":[{"buffer":0,"byteLength":36}],'
        '"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],'
        '"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],'
        '"scenes":[{"nodes":[0]}],"scene":0}')


class SameOutput(ProgramTest):
    def test_two_outputs_of_a_command_in_one_file_are_refused_under_whatever_names(self):
        self.path("real.png").write_bytes(b"before")
        os.link(self.path("real.png"), self.path("hard.png"))
        os.symlink(self.path("real.png"), self.path("soft.png"))
        for other in ("real.png", "./real.png", "hard.png", "soft.png"):
            self.refuses(2, "samples", "--spp", "4", "--copies", "4", "--picture", "real.png", "--csv", other,
                         mentions=["two outputs"])
        self.assertEqual(self.path("real.png").read_bytes(), b"before")
        self.succeeds("samples", "--spp", "64", "--copies", "4", "--csv", "/dev/null")

    def test_a_reference_is_not_the_picture_of_a_strategy(self):
        self.path("pictures").mkdir()
        self.refuses(2, "quality", *SCENE, "--resolution", "8x8", "--spp", "2", "--bounces", "1", "--strategy", "coherent,random",
                     "--reference-spp", "4", "--reference", "pictures/coherent.exr", "-o", "pictures",
                     mentions=["coherent.exr"], warnings=True)


class Overwriting(ProgramTest):
    def keeps(self, name, *command, warnings=False):
        """The command is refused as wrong use, naming the file, and the file is as before."""
        before = self.path(name).read_bytes()
        self.refuses(2, *command, mentions=[name, "another file than the input"], warnings=warnings)
        self.assertEqual(self.path(name).read_bytes(), before)

    def test_no_command_writes_over_the_file_that_it_reads(self):
        self.capture("t.rct")
        self.path("kernel-1.traceg").write_text(KERNEL)
        self.keeps("t.rct", "export", "t.rct", *SECTORS, "csv", "-o", "t.rct")
        self.path("t.rct").rename(self.path("kernelslist.g"))
        self.keeps("kernelslist.g", "export", "kernelslist.g", "--format", "accel-sim", "-o", ".")
        self.path("kernelslist.g").rename(self.path("t.png"))
        self.keeps("t.png", "explain", "t.png", "t.png", *GPU, "--heatmap", "t.exr")
        self.path("t.png").rename(self.path("t.csv"))
        for command in (["replay"], ["compare", "t.csv"], ["replay", "--timed"], ["replay", "--counters", "ncu"]):
            self.keeps("t.csv", command[0], "t.csv", *command[1:], *GPU, "--save", "t")
        self.keeps("t.csv", "verify", "t.csv", "--recover", "t.csv")
        self.keeps("kernel-1.traceg", "import", "kernel-1.traceg", "-o", "kernel-1.traceg")

    def test_not_under_another_name_either(self):
        self.capture("t.rct")
        self.path("folder").mkdir()
        self.path("link.rct").symlink_to("t.rct")
        os.link(self.path("t.rct"), self.path("twin.rct"))
        for name in ("./t.rct", "folder/../t.rct", self.path("t.rct"), "link.rct", "twin.rct"):
            self.keeps("t.rct", "export", "t.rct", *SECTORS, "u64", "-o", name)
            self.keeps("t.rct", "verify", name, "--recover", "t.rct")

    def test_a_scene_is_kept_with_all_its_files(self):
        self.path("scene.gltf").write_text(GLTF)
        self.path("positions.rct").write_bytes(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0))
        self.keeps("scene.gltf", "capture", "scene.gltf", *LAUNCHES, "-o", "scene.gltf")
        self.keeps("positions.rct", "capture", "scene.gltf", *LAUNCHES, "-o", "positions.rct", warnings=True)
        self.path("scene.gltf").rename(self.path("scene.png"))
        self.keeps("scene.png", "render", "scene.png", *PICTURE, "--spp", "1", "-o", "scene.png")
        self.keeps("scene.png", "explain", "--scene", "scene.png", *LAUNCHES, *GPU, "--heatmap", "scene.exr")
        self.path("pictures").mkdir()
        self.path("scene.png").rename(self.path("pictures/random.png"))
        self.keeps("pictures/random.png", "quality", "pictures/random.png", "--strategy", "random", *PICTURE,
                   "--spp", "2", "--reference-spp", "4", "--output", "pictures")

    def test_a_file_named_like_a_built_in_scene_is_no_input(self):
        for _ in range(2):
            self.capture("courtyard")

    def test_a_gpu_file_is_kept(self):
        self.capture("t.rct")
        self.path("gpu.toml").write_text("name = 'x'\n")
        self.keeps("gpu.toml", "export", "t.rct", "--gpu", "gpu.toml", "--sm", "0", "--format", "csv", "-o", "gpu.toml")


class Devices(ProgramTest):
    def stdout_of(self, *command):
        return self.succeeds(*command).stdout

    def test_a_link_stays_a_link(self):
        self.path("far").mkdir()
        self.path("near.rct").symlink_to("far/there.rct")
        for _ in range(2):  # dangling, then not
            self.capture("near.rct")
            self.assertTrue(self.path("near.rct").is_symlink())
        self.succeeds("verify", "far/there.rct")
        self.assertEqual(self.listing(), ["far", "far/there.rct", "near.rct"])

    def test_what_goes_through_a_named_pipe_is_what_a_file_holds(self):
        self.capture("t.rct")
        self.succeeds("export", "t.rct", *SECTORS, "dinero", "-o", "file")
        os.mkfifo(self.path("pipe"))
        received = []
        reader = threading.Thread(target=lambda: received.append(self.path("pipe").read_bytes()))
        reader.start()
        self.succeeds("export", "t.rct", *SECTORS, "dinero", "-o", "pipe")
        reader.join()
        self.assertEqual(received, [self.path("file").read_bytes()])
        self.assertTrue(stat.S_ISFIFO(os.stat(self.path("pipe")).st_mode))
        self.assertEqual(self.listing(), ["file", "pipe", "t.rct"])

    @unittest.skipUnless(os.geteuid() == 0, "only root can make a device; run the tests as root")
    def test_a_device_is_written_to_and_stays_one(self):
        self.capture("t.rct")
        for name, minor in (("null", 3), ("full", 7)):
            os.mknod(self.path(name), 0o600 | stat.S_IFCHR, os.makedev(1, minor))
        try:
            self.path("null").write_bytes(b"x")
        except PermissionError:
            self.skipTest("devices do not work in this folder; set TMPDIR to one not mounted nodev")
        commands = (["export", "t.rct", *SECTORS, "csv"], ["capture", *SCENE, *LAUNCHES],
                    ["export", "t.rct", "--launch", "0", "--format", "accel-sim"], ["verify", "t.rct", "--recover"])
        for command in commands:
            command += [] if command[0] == "verify" else ["-o"]
            with self.subTest(command[0]):
                self.succeeds(*command, "null")
                self.refuses(1, *command, "full", mentions=["full: offset", "No space left on device"])
                for name in ("null", "full"):
                    self.assertTrue(stat.S_ISCHR(os.stat(self.path(name)).st_mode), name)

    def test_a_minus_is_stdout_where_nothing_else_goes_there(self):
        self.capture("t.rct")
        self.assertEqual(self.stdout_of("capture", *SCENE, *LAUNCHES, "--spp", "64", "-o", "-"),
                         self.path("t.rct").read_bytes())
        for form in ("csv", "dinero", "u64"):
            self.succeeds("export", "t.rct", *SECTORS, form, "-o", "file")
            self.assertEqual(self.stdout_of("export", "t.rct", *SECTORS, form, "-o", "-"),
                             self.path("file").read_bytes())
        kernel = ["export", "t.rct", "--launch", "1", "--format", "accel-sim", "-o"]
        self.succeeds(*kernel, "k.traceg")
        self.assertEqual(self.stdout_of(*kernel, "-"), self.path("k.traceg").read_bytes())
        imported = self.stdout_of("import", "k.traceg", "-o", "-")
        self.succeeds("import", "k.traceg", "-o", "k.rct")
        self.assertEqual(imported, self.path("k.rct").read_bytes())
        self.assertNotIn("-", self.listing())
        with open("/dev/full", "wb") as full:
            result = self.run_program("export", "t.rct", *SECTORS, "csv", "-o", "-", stdout=full)
        self.assertEqual(result.code, 1)
        self.assertRegex(result.stderr, r"\Araycache: error: stdout: offset \d+: [^\n]*No space left on device[^\n]*\n\Z")

    def test_a_minus_is_refused_where_stdout_is_for_a_report(self):
        self.capture("t.rct")
        self.refuses(2, "verify", "t.rct", "--recover", "-", mentions=["--recover -", "stdout"])
        self.refuses(2, "replay", "t.rct", *GPU, "--save", "-", mentions=["--save -", "stdout"])
        self.refuses(2, "samples", "--csv", "-", mentions=["--csv -", "stdout"])
        self.refuses(2, "quality", *SCENE, *PICTURE, "--output", "-", mentions=["--output -", "stdout"])
        self.refuses(2, "render", *SCENE, *PICTURE, "-o", "-", mentions=[".png"])
        self.refuses(2, "explain", "t.rct", "t.rct", *GPU, "--heatmap", "-", mentions=[".exr"])


if __name__ == "__main__":
    main()
