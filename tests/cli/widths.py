#!/usr/bin/python3
"""Every text of every command keeps to 100 columns, with long names, several GPUs and wavefronts; --wide is not held to it."""
from support import LAUNCHES, SCENE, ProgramTest, main

WIDTH = 100
FUSED = ["compare", "--scene", *SCENE, *LAUNCHES, "--spp", "64"]
THREE = ["--gpu", "gtx-980-ti", "--gpu", "rtx-2080-ti", "--gpu", "titan-x-pascal"]
LONG = ["--set", "l1.ways=64", "--set", "l1.policy='tree_plru'", "--set", "l2.policy='fifo'", "--warps-per-sm", "24"]
WAVES = "cranley-patterson,cranley-patterson+meister-two-point,net-micro-jitter-fast+garanzha-loop,micro-jitter"
QUALITY = [*SCENE, "--resolution", "16x16", "--spp", "16", "--reference-spp", "32", "--trace-samples", "2", "--bounces", "1"]


class Widths(ProgramTest):
    def fits(self, *command):
        """Returns the text."""
        text = self.warns(*command).text
        for line in text.splitlines():
            self.assertLessEqual(len(line), WIDTH, f"{' '.join(map(str, command))}:\n{line}")
            self.assertEqual(line, line.rstrip())
        return text

    def test_compare_keeps_to_100_columns(self):
        for more in (["--gpu", "h100"], THREE, [*THREE, *LONG], ["--gpu", "gtx-980-ti", "--gpu", "xeon-8380"],
                     ["--gpu", "h100", "--sequence", "sobol,halton-scrambled"], ["--gpu", "h100", "--spp", "64,1024"],
                     ["--gpu", "h100", "--by", "bounce"], [*THREE, "--by", "object"]):
            for timed in ([], ["--timed"]):
                if not ("--by" in more and timed):
                    self.fits(*FUSED, *more, *timed)

    def test_compare_of_wavefronts_keeps_to_100_columns(self):
        waves = ["--strategy", WAVES, "--sequence", "sobol-owen-02"]
        for more in (["--gpu", "h100"], [*THREE, *LONG], ["--gpu", "h100", "--by", "object"],
                     ["--gpu", "h100", "--counters", "ncu"], ["--gpu", "h100", "--timed"]):
            self.fits(*FUSED, *waves, *more)

    def test_replay_and_its_counters_keep_to_100_columns(self):
        trace = self.capture()
        for more in ([*THREE, *LONG], [*THREE, *LONG, "--timed"], ["--gpu", "xeon-8380", "--by", "ray"],
                     ["--gpu", "v100", *LONG, "--counters", "ncu", "--by", "bounce"]):
            self.fits("replay", trace, *more)

    def test_explain_keeps_to_100_columns(self):
        base = self.capture("a trace of cranley-patterson with a long name.rct", "--strategy", "cranley-patterson")
        other = self.capture("other.rct", "--strategy", "micro-jitter")
        for more in (["--gpu", "gtx-980-ti", "--by", "bounce"], ["--gpu", "xeon-8380", "--by", "ray"],
                     ["--gpu", "rtx-2080-ti", *LONG]):
            self.fits("explain", base, other, *more)

    def test_curve_keeps_to_100_columns(self):
        self.fits("curve", "--scene", *SCENE, *LAUNCHES, "--spp", "64", "--gpu", "h100", *LONG, "--policy", "belady",
                  "--strategy", "net-micro-jitter-fast,cranley-patterson,micro-jitter")

    def test_quality_and_sweep_keep_to_100_columns(self):
        self.fits("quality", *QUALITY, "--gpu", "gtx-980-ti", *LONG, "--pairs", "--repeats", "2")
        self.fits("quality", *QUALITY, "--gpu", "gtx-980-ti", "--sequence", "sobol-owen-02,sobol-owen-4d", "--spp", "16,64",
                  "--strategy", "cranley-patterson,net-micro-jitter-fast", "--output", "pictures")
        self.fits("sweep", *QUALITY, "--gpu", "gtx-980-ti", *LONG, "--mu", "0,0.0625,0.5,1")

    def test_what_needs_no_replay_keeps_to_100_columns(self):
        trace = self.capture("t.rct", "--strategy", "cranley-patterson+meister-two-point")
        for command in (["list"], ["list", "gpus"], ["list", "gpus", "--details"], ["info", trace], ["verify", trace],
                        ["samples"], ["samples", "--strategy", "net-micro-jitter-fast", "--sequence", "sobol-owen-02"],
                        ["samples", "--table", "discrepancy"], ["samples", "--table", "jitter"]):
            self.fits(*command)

    def test_wide_leaves_nothing_out_and_has_every_name_in_full(self):
        name = "gtx-980-ti (l1.policy=tree_plru, l1.ways=64, l2.policy=fifo, warps_per_sm=24)"
        narrow = self.fits(*FUSED, *THREE, *LONG)
        wide = self.warns(*FUSED, *THREE, *LONG, "--wide").text
        self.assertGreater(max(map(len, wide.splitlines())), WIDTH)
        self.assertNotIn("left out", wide)
        self.assertGreaterEqual(wide.count(name), 3)
        self.assertIn(name, " ".join(narrow.split()))

    def test_the_help_keeps_to_100_columns(self):
        self.fits("--help")
        for name in ("render", "capture", "info", "verify", "replay", "compare", "explain", "quality", "sweep", "export",
                     "import", "samples", "list"):
            self.fits(name, "--help")


if __name__ == "__main__":
    main()
