#!/usr/bin/python3
"""Every command that works in several threads gives what one thread gives; under ThreadSanitizer (tools/test --threads)
the same runs show that no two threads touch the same memory unordered."""
import os
import unittest

from support import GPU, SCENE, ProgramTest, main

PICTURE = ["--resolution", "32x32"]
TRACED = [*PICTURE, "--trace-samples", "2", "--spp", "64"]
STRATEGIES = ["--strategy", "coherent,cranley-patterson,micro-jitter"]


class Threads(ProgramTest):
    def setUp(self):
        super().setUp()
        os.environ["XDG_CACHE_HOME"] = str(self.path("cache"))
        self.addCleanup(os.environ.pop, "XDG_CACHE_HOME")

    def same_for_all_threads(self, *command, output=None):
        results = []
        for threads in (1, 4):
            result = self.run_program(*command, *(["-o", output] if output else []), "--threads", threads)
            self.assertEqual(result.code, 0, f"{command}: {result}")
            results.append(self.path(output).read_bytes() if output else result.stdout)
        self.assertEqual(*results)
        self.assertTrue(results[0])

    def test_render(self):
        self.same_for_all_threads("render", *SCENE, *PICTURE, "--spp", "4", output="picture.exr")

    def test_capture(self):
        self.same_for_all_threads("capture", *SCENE, *TRACED, output="trace.rct")

    def test_capture_of_a_wavefront(self):
        self.same_for_all_threads("capture", *SCENE, *TRACED, "--execution", "wavefront", "--order", "morton",
                                  output="trace.rct")

    def test_compare_of_a_scene(self):
        self.same_for_all_threads("compare", "--scene", *SCENE, *TRACED, *STRATEGIES, *GPU, "--by", "bounce")

    def test_compare_in_time(self):
        self.same_for_all_threads("compare", "--scene", *SCENE, *TRACED, *STRATEGIES, "--gpu", "rtx-3070", "--timed")

    def test_replay_and_explain_of_traces(self):
        for strategy in ("coherent", "cranley-patterson"):
            done = self.run_program("capture", *SCENE, *TRACED, "--strategy", strategy, "-o", strategy + ".rct")
            self.assertEqual(done.code, 0, done)
        self.same_for_all_threads("replay", "coherent.rct", *GPU)
        self.same_for_all_threads("explain", "cranley-patterson.rct", "coherent.rct", *GPU)

    def test_quality(self):
        self.same_for_all_threads("quality", *SCENE, *PICTURE, "--spp", "4", "--bounces", "1", "--reference-spp", "16",
                                  "--reference-strategy", "cranley-patterson", "--strategy",
                                  "coherent,cranley-patterson", "--json")


if __name__ == "__main__":
    unittest.TestCase.maxDiff = 2000
    main()
