#!/usr/bin/python3
"""--bvh-cache: BVHs kept on disk. Nothing depends on it but time."""
import json
import os
import resource

from support import GPU, LAUNCHES, SCENE, ProgramTest, main

CAPTURE = ["capture", *SCENE, *LAUNCHES, "--spp", "64"]
COMPARE = ["compare", "--scene", *SCENE, *LAUNCHES, "--spp", "64", "--strategy", "cranley-patterson,micro-jitter", *GPU]


class BvhCache(ProgramTest):
    def setUp(self):
        super().setUp()
        self.environment = dict(os.environ)

    def run_program(self, *arguments, **keywords):
        return super().run_program(*arguments, env=self.environment, **keywords)

    def kept(self, folder="kept"):
        return sorted(self.path(folder).glob("**/*"))

    def test_traces_are_the_same_without_it_when_it_is_filled_and_when_it_is_read(self):
        for name, options in (("plain", []), ("splits", ["--spatial-splits"]), ("layout", ["--layout", "bvh2-breadth-first"])):
            for threads in ("1", "2"):
                folder = f"kept {name} {threads}"
                cache = ["--bvh-cache", folder]
                traces = []
                for words, written in (([], 1), (cache, 2), (cache, 1)):
                    result = self.succeeds(*CAPTURE, *options, *words, "--threads", threads, "-o", "t.rct")
                    self.assertEqual(len(result.wrote), written, result)
                    traces.append(self.path("t.rct").read_bytes())
                self.assertEqual(traces[1], traces[0])
                self.assertEqual(traces[2], traces[0])
                self.assertEqual(len(self.kept(folder)), 1)

    def test_reports_are_the_same_and_do_not_name_it(self):
        for command in (COMPARE, ["explain", *COMPARE[1:], "--counts-only"]):
            without = self.succeeds(*command, "--json").stdout
            for threads in ("1", "2"):
                self.assertEqual(self.succeeds(*command, "--json", "--bvh-cache", "kept", "--threads", threads).stdout, without)

    def test_one_tree_is_kept_for_each_set_of_triangles_and_way_to_build(self):
        cache = ["--bvh-cache", "kept", "-o", "t.rct"]
        for options, trees in (([], 1), (["--layout", "bvh2-breadth-first"], 1), (["--camera", "gallery"], 1),
                               (["--strategy", "owen", "--resolution", "32x32"], 1), (["--spatial-splits"], 2),
                               (["--detail", "60000"], 3), (["--spatial-splits"], 3)):
            self.succeeds("capture", SCENE[0], *(SCENE[1:] if "--detail" not in options else []), "--spp", "64",
                          "--trace-samples", "1", *(["--resolution", "32x24"] if "--resolution" not in options else []),
                          *options, *cache)
            self.assertEqual(len(self.kept()), trees, options)

    def test_a_tree_that_is_damaged_is_built_again_with_a_warning(self):
        trace = self.capture("good.rct", "--bvh-cache", "kept").read_bytes()
        [tree] = self.kept()
        good = tree.read_bytes()
        for bad in (good[:100], b"", good[:-1] + bytes([good[-1] ^ 1]), b"glTF"):
            tree.write_bytes(bad)
            result = self.warns(*CAPTURE, "--bvh-cache", "kept", "-o", "t.rct")
            self.assertRegex(result.stderr, r"\Araycache: warning: cached BVH built again: kept/\w+\.bvh: expected .*, found .*\n\Z")
            self.assertEqual(self.path("t.rct").read_bytes(), trace)
            self.assertEqual(tree.read_bytes(), good)
            self.assertEqual(self.kept(), [tree])

    def test_a_tree_that_does_not_fit_on_the_disk_is_a_warning_and_leaves_nothing(self):
        rows = self.succeeds(*COMPARE).stdout
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
        result = self.warns(*COMPARE, "--bvh-cache", "kept", preexec_fn=limit)
        self.assertRegex(result.stderr, r"\Araycache: warning: the BVH is not kept: kept/.*File too large.*\n\Z")
        self.assertEqual(result.stdout, rows)
        self.assertEqual(self.kept(), [])

    def test_a_folder_that_cannot_be_made_is_a_warning_and_a_file_in_its_place_is_refused(self):
        self.path("file").write_text("no folder")
        self.refuses(2, *CAPTURE, "--bvh-cache", "file", "-o", "t.rct",
                     mentions=["the BVH cache file: expected a folder", "RAYCACHE_BVH_CACHE"])
        result = self.warns(*CAPTURE, "--bvh-cache", "file/below", "-o", "t.rct")
        self.assertRegex(result.stderr, r"\Araycache: warning: the BVH is not kept: file/below/.*\n\Z")

    def test_the_environment_names_it_too_and_the_option_rules(self):
        self.environment["RAYCACHE_BVH_CACHE"] = ""
        self.succeeds(*COMPARE)
        self.assertEqual(self.listing(), [])
        self.environment["RAYCACHE_BVH_CACHE"] = "environment"
        self.succeeds(*COMPARE, "--bvh-cache", "option")
        self.assertEqual((len(self.kept("option")), len(self.kept("environment"))), (1, 0))
        self.succeeds(*COMPARE)
        self.assertEqual(len(self.kept("environment")), 1)
        help_text = self.succeeds("compare", "--help").text
        del self.environment["RAYCACHE_BVH_CACHE"]
        self.assertEqual(self.succeeds("compare", "--help").text, help_text)
        self.assertIn("$RAYCACHE_BVH_CACHE", help_text)

    def test_commands_that_need_no_bvh_of_a_trace_say_that_it_has_no_effect(self):
        small = [*SCENE, "--resolution", "16x16", "--spp", "1"]
        self.assertIn("--bvh-cache has no effect", self.warns("render", *small, "--bvh-cache", "kept", "-o", "a.png").stderr)
        trace = self.capture("t.rct")
        self.assertIn("--bvh-cache has no effect", self.warns("compare", trace, trace, *GPU, "--bvh-cache", "kept").stderr)
        self.assertEqual(self.kept(), [])

    def test_quality_keeps_the_tree_of_its_replays(self):
        quality = ["quality", *SCENE, "--resolution", "16x16", "--spp", "4", "--strategy", "owen", *GPU, "--reference",
                   "r.exr", "--reference-spp", "4", "--json"]
        first, second = (json.loads(self.warns(*quality, "--bvh-cache", "kept").stdout) for _ in range(2))
        self.assertEqual(len(self.kept()), 1)
        self.assertEqual(first["rows"], second["rows"])


if __name__ == "__main__":
    main()
