#!/usr/bin/python3
"""Real scenes through the whole program. They are not part of the project: skipped where they are not at hand."""
import unittest

from support import ProgramTest, main, real_scene

SCENES = real_scene("")
NAMES = ["sponza.glb", "cornell_box.glb"]
SMALL = ["--resolution", "64x48", "--trace-samples", "2"]
STRATEGIES = ["coherent", "cranley-patterson", "micro-jitter"]
ABSENT = f"{' or '.join(NAMES)} is absent; put the .glb files into {SCENES}, or set RAYCACHE_SCENES to their folder"


@unittest.skipUnless(all(real_scene(name).is_file() for name in NAMES), ABSENT)
class RealScenes(ProgramTest):
    def test_a_picture_is_rendered(self):
        for name in NAMES:
            with self.subTest(name):
                self.warns("render", SCENES / name, "--resolution", "64x48", "--spp", "2", "-o", "picture.png")
                self.assertEqual(self.path("picture.png").read_bytes()[:4], b"\x89PNG")

    def test_capture_info_verify_and_replay_agree(self):
        for name in NAMES:
            with self.subTest(name):
                self.warns("capture", SCENES / name, *SMALL, "-o", "trace.rct")
                info = self.succeeds("info", "trace.rct", "--json").json
                self.assertEqual(info["traces"][0]["scene"], name)
                self.assertEqual(self.succeeds("verify", "trace.rct", "--json").json["rays"], info["rays"])
                row, = self.succeeds("replay", "trace.rct", "--gpu", "h100", "--json").json["rows"]
                self.assertEqual(row["totals"]["lane_accesses"], info["lane_accesses"])

    def test_files_and_the_fused_comparison_give_the_same_report(self):
        gpus = ["--gpu", "gtx-980-ti", "--gpu", "h100", "--by", "object", "--json"]
        for name in NAMES:
            with self.subTest(name):
                for strategy in STRATEGIES:
                    self.warns("capture", SCENES / name, *SMALL, "--strategy", strategy, "-o", strategy + ".rct")
                files = self.succeeds("compare", *(s + ".rct" for s in STRATEGIES), *gpus).report
                fused = self.warns("compare", "--scene", SCENES / name, *SMALL, *gpus).report
                self.assertEqual(fused, files)

    def test_threads_do_not_change_a_trace(self):
        for name in NAMES:
            with self.subTest(name):
                for threads in (1, 2):
                    self.warns("capture", SCENES / name, *SMALL, "--threads", threads, "-o", f"{threads}.rct")
                self.assertEqual(self.path("1.rct").read_bytes(), self.path("2.rct").read_bytes())

    def test_each_camera_of_a_scene_can_be_chosen_by_name_and_by_number(self):
        pictures = set()
        for camera in ("atrium", "gallery"):
            self.warns("render", SCENES / "sponza.glb", "--camera", camera, "--resolution", "32x24", "--spp", "1", "-o",
                       "picture.png")
            pictures.add(self.path("picture.png").read_bytes())
        self.warns("render", SCENES / "sponza.glb", "--camera", "1", "--resolution", "32x24", "--spp", "1", "-o",
                   "picture.png")
        self.assertEqual(len(pictures), 2)
        self.assertIn(self.path("picture.png").read_bytes(), pictures)
        self.path("picture.png").unlink()
        self.refuses(2, "render", SCENES / "sponza.glb", "--camera", "cellar", "-o", "picture.png", warnings=True,
                     mentions=["cellar", "atrium", "gallery"])

    def test_a_scene_cut_off_anywhere_is_refused(self):
        data = (SCENES / "cornell_box.glb").read_bytes()
        for share in (0.001, 0.1, 0.5, 0.9, 0.99):
            self.path("cut.glb").write_bytes(data[:int(len(data) * share)])
            self.refuses(1, "capture", "cut.glb", *SMALL, "-o", "trace.rct", mentions=["cut.glb"])

    def test_detail_belongs_to_built_in_scenes_only(self):
        self.refuses(2, "capture", SCENES / "cornell_box.glb", "--detail", "50000", "-o", "trace.rct")


if __name__ == "__main__":
    main()
