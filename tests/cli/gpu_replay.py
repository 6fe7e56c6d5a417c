#!/usr/bin/python3
"""capture --gpu-package and the walk of tools/gpu/, here on the processor: every ray ends where the tracer's own does,
and reads as many nodes and triangles; what is damaged is refused."""
import json
import os
import pathlib
import shutil
import struct
import subprocess
import sys

from lit_room import write_lit_room
from support import RAYCACHE, ROOT, SCENE, ProgramTest, main, real_scene

sys.path.insert(0, str(ROOT / "traces"))
import read_trace

REPLAY = pathlib.Path(RAYCACHE).with_name("gpu_replay_cpu")
SMALL = ["--resolution", "40x24", "--trace-samples", "2", "--spp", "16"]


class GpuReplay(ProgramTest):
    def replay(self, *arguments):
        return subprocess.run([REPLAY, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                              cwd=self.folder, check=False)

    def walked(self, *arguments):
        done = self.replay(*arguments)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return json.loads(done.stdout)

    def package(self, name="p", *arguments, scene=SCENE):
        self.warns("capture", *scene, *SMALL, *arguments, "--gpu-package", name)
        return self.path(name)

    def refused(self, *arguments, mentions, code=1):
        done = self.replay(*arguments)
        self.assertEqual((done.returncode, done.stdout), (code, ""), done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        self.assertTrue(done.stderr.startswith("gpu_replay_cpu: error: "), done.stderr)
        for word in mentions:
            self.assertIn(word, done.stderr)

    def reads_of_trace(self, name):
        """Elements that lanes read of the regions of nodes and of triangles."""
        reads = {}
        for _, _, records in read_trace.Trace(self.path(name)).warps():
            for mask, region, *_ in records:
                reads[region] = reads.get(region, 0) + mask.bit_count()
        return reads[0], reads[1]

    def test_every_ray_of_every_layout_ends_where_the_tracers_own_walk_ends(self):
        for layout in ("bvh2", "bvh2-van-emde-boas", "bvh4", "cwbvh8"):
            with self.subTest(layout=layout):
                found = self.walked(self.package(layout, "--layout", layout))
                self.assertEqual(found["package"]["tree"], layout.split("-")[0])
                self.assertEqual(found["wrong_rays"], 0)
                self.assertEqual(len(found["launches"]), 2)
                for launch in found["launches"]:
                    kernels = [w for w in launch["walks"] if w["kernel"] == "wavefront"]
                    mega = [w for w in launch["walks"] if w["kernel"] == "megakernel"]
                    self.assertEqual(len(mega), 1)
                    self.assertEqual({w["ray"] for w in kernels}, {"camera", "bounce", "shadow"})
                    for key in ("rays", "node_visits", "triangle_tests"):
                        self.assertGreater(mega[0][key], 0)
                        self.assertEqual(mega[0][key], sum(w[key] for w in kernels), key)
                    self.assertEqual(mega[0]["rays"], launch["rays"])
                    self.assertEqual(mega[0]["seconds"], [])  # nobody's time
                    self.assertEqual(kernels[0]["rays"], 40 * 24)
        alone = self.walked("cwbvh8", "--kernel", "megakernel", "--launches", "1")["launches"]
        self.assertEqual([[w["kernel"] for w in launch["walks"]] for launch in alone], [["megakernel"]])

    def test_the_walk_reads_as_many_nodes_and_triangles_as_the_trace_of_the_same_rays(self):
        for layout in ("bvh2", "bvh4", "cwbvh8"):
            with self.subTest(layout=layout):
                self.warns("capture", *SCENE, *SMALL, "--layout", layout, "-o", "t.rct", "--gpu-package", "p")
                found = self.walked("p")
                mega = [w for launch in found["launches"] for w in launch["walks"] if w["kernel"] == "megakernel"]
                self.assertEqual((sum(w["node_visits"] for w in mega), sum(w["triangle_tests"] for w in mega)),
                                 self.reads_of_trace("t.rct"))

    def test_a_sorted_wavefront_has_the_rays_of_the_megakernel_and_no_paths(self):
        mega = self.walked(self.package("m"))
        found = self.walked(self.package("w", "--execution", "wavefront", "--order", "morton"))
        self.assertEqual(found["checked_rays"] * 2, mega["checked_rays"])  # walked once: there is no megakernel
        self.assertTrue(found["package"]["wavefront"])
        kinds = [[(w["ray"], w["bounce"], w["rays"], w["node_visits"]) for w in launch["walks"] if w["ray"]]
                 for launch in mega["launches"]]
        self.assertEqual([[(w["ray"], w["bounce"], w["rays"], w["node_visits"]) for w in launch["walks"]]
                          for launch in found["launches"]], kinds)
        more = [w for w in found["launches"][0]["walks"] if w["ray"] == "bounce" and w["bounce"] == 3]
        less = [w for w in mega["launches"][0]["walks"] if w["ray"] == "bounce" and w["bounce"] == 3]
        self.assertLess(more[0]["warps"], less[0]["warps"])  # full ones

    def test_files_do_not_depend_on_the_number_of_threads_and_replace_those_before(self):
        first = self.package("p", "--threads", "1", "--strategy", "cranley-patterson")
        other = self.package("q", "--threads", "2", "--strategy", "cranley-patterson")
        self.assertEqual(self.listing(), ["p", "p/bvh.rcgp", "p/launch-0.rcgp", "p/launch-1.rcgp", "q", "q/bvh.rcgp",
                                          "q/launch-0.rcgp", "q/launch-1.rcgp"])
        same = [(first / f).read_bytes() == (other / f).read_bytes() for f in os.listdir(first)]
        self.assertEqual(same, [True] * 3)
        self.package("p", "--strategy", "owen")
        self.assertNotEqual((first / "launch-0.rcgp").read_bytes(), (other / "launch-0.rcgp").read_bytes())
        self.assertEqual(self.walked("p")["package"]["trace"]["strategy"], "owen")

    def test_what_is_damaged_is_refused_in_one_line(self):
        whole = self.package("p")
        bvh, launch = (whole / "bvh.rcgp").read_bytes(), (whole / "launch-1.rcgp").read_bytes()

        def with_file(name, data, *mentions):
            shutil.rmtree(self.path("d"), ignore_errors=True)
            shutil.copytree(whole, self.path("d"))
            if data is None:
                os.remove(self.path("d") / name)
            else:
                (self.path("d") / name).write_bytes(data)
            self.refused("d", mentions=[name, *mentions])

        with_file("bvh.rcgp", None, "none")
        with_file("launch-1.rcgp", None, "none")
        with_file("bvh.rcgp", b"", "something else")
        with_file("bvh.rcgp", bvh[:60], "size")
        with_file("bvh.rcgp", bvh[:-1], "size")
        with_file("bvh.rcgp", b"glTF" + bvh[4:], "first bytes")
        with_file("bvh.rcgp", bvh[:8] + struct.pack("<I", 2) + bvh[12:], "version", "expected 1, found 2")
        with_file("bvh.rcgp", launch, "kind")
        with_file("bvh.rcgp", bvh[:40] + b"\x07" + bvh[41:], "checksum of the head")
        with_file("bvh.rcgp", bvh[:-100] + bytes([bvh[-100] ^ 1]) + bvh[-99:], "checksum of the section 1")
        with_file("launch-1.rcgp", launch[:-9], "size")
        with_file("launch-1.rcgp", (whole / "launch-0.rcgp").read_bytes(), "package", "launch 1")
        for byte in range(0, 250, 9):
            changed = bytearray(launch)
            changed[byte] ^= 0x10
            shutil.copytree(whole, self.path("d"), dirs_exist_ok=True)
            (self.path("d") / "launch-1.rcgp").write_bytes(changed)
            self.refused("d", "--launches", "2", mentions=["launch-1.rcgp"])
        self.package("d", "--strategy", "owen", "--seed", "7")
        shutil.copy(whole / "launch-0.rcgp", self.path("d") / "launch-0.rcgp")
        self.refused("d", mentions=["two captures wrote to one folder"])

    def test_what_makes_no_sense_is_refused_in_one_line(self):
        self.refuses(2, "capture", *SCENE, mentions=["-o", "--gpu-package"])
        self.refuses(2, "capture", *SCENE, "--integrator", "ssao", "--gpu-package", "p", mentions=["ssao"])
        self.path("file").write_text("")
        self.refuses(1, "capture", *SCENE, "--gpu-package", "file", mentions=["file", "folder"])
        self.refuses(1, "capture", *SCENE, "--gpu-package", "none/p", mentions=["none/p"])
        self.refuses(2, "capture", "none.glb", "--gpu-package", "p", mentions=["none.glb"])  # and p is gone
        self.refused(mentions=["expected the folder"], code=2)
        self.refused("p", "q", mentions=["two"], code=2)
        self.refused("p", "--repeats", "0", mentions=["--repeats", "0"], code=2)
        self.refused("p", "--kernel", "mega", mentions=["mega", "megakernel"], code=2)
        self.refused("p", "--repaets", mentions=["--repaets"], code=2)
        self.refused("p", mentions=["bvh.rcgp"])

    def test_rays_pass_holes_where_the_tracers_own_do(self):
        room = write_lit_room(self.path("room.gltf"))
        document = json.loads(room.read_text())
        white = document["materials"][2]
        white["alphaMode"] = "MASK"
        white["pbrMetallicRoughness"]["baseColorFactor"][3] = 0.3  # less than the cutoff: all of it is a hole
        room.write_text(json.dumps(document))
        package = self.package("p", scene=[room])
        self.assertEqual(self.walked("p")["wrong_rays"], 0)
        launch = (package / "launch-0.rcgp").read_bytes()
        offset, size = struct.unpack_from("<QQ", launch, 56 + 4 * 24)  # the section of triangles passed
        self.assertGreater(size, 4 * 100)
        passed = set(struct.unpack_from(f"<{size // 4}I", launch, offset))
        offset, size = struct.unpack_from("<QQ", launch, 56 + 2 * 24)  # hits: t, triangle
        hit = set(struct.unpack_from(f"<{size // 4}I", launch, offset)[1::2])
        self.assertFalse(passed & hit)

    def test_holes_of_a_real_scene_are_passed_where_the_tracer_passes_them(self):
        scene = real_scene("sponza.glb")
        if not scene.exists():
            self.skipTest(f"{scene} is absent; see docs/scenes.md")
        found = self.walked(self.package("p", "--layout", "cwbvh8", scene=[scene]))
        self.assertEqual(found["wrong_rays"], 0)


if __name__ == "__main__":
    main()
