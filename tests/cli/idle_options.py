#!/usr/bin/python3
"""Options without effect: a warning for each, whatever the strategy, and none where something reads them."""
from support import GPU, SCENE, ProgramTest, main

SMALL = [*SCENE, "--resolution", "16x16", "--bounces", "1"]
CHANGES = {"--k": "1.5", "--s": "3", "--mu": "0.3", "--interleave": "5", "--cycles-multiplier": "0.5",
           "--cycles-min-samples": "24", "--cycles-noise-threshold": "0.1", "--share": "light0", "--share-bits": "5"}
READERS = {"--k": {"micro-jitter"}, "--s": {"micro-jitter"}, "--mu": {"micro-jitter", "scrambling-distance"},
           "--interleave": {"interleaved", "net-micro-jitter-fast"}, "--cycles-multiplier": {"scrambling-distance"},
           "--cycles-min-samples": {"scrambling-distance"}, "--cycles-noise-threshold": {"scrambling-distance"},
           "--share": {"net-micro-jitter"}, "--share-bits": {"net-micro-jitter"}}


class IdleOptions(ProgramTest):
    def warned(self, *arguments):
        """The options that the run warns of."""
        lines = [line.removeprefix("raycache: warning: ") for line in self.warns(*arguments).stderr.splitlines()]
        return {line.split(" has no effect: ")[0] for line in lines if " has no effect: " in line}

    def capture(self, *options):
        usual = [word for option, value in (("--trace-samples", "1"), ("--spp", "64")) if option not in options
                 for word in (option, value)]
        return self.warned("capture", *SMALL, *usual, *options, "-o", "t.rct")

    def test_every_parameter_is_warned_of_with_every_strategy_that_does_not_read_it(self):
        given = [word for pair in CHANGES.items() if pair[0] != "--mu" for word in pair]
        for strategy in [entry["name"] for entry in self.succeeds("list", "strategies", "--json").json["topics"]["strategies"]]:
            options = [*given, "--strategy", strategy]
            expected = {option for option in CHANGES if option != "--mu" and strategy not in READERS[option]}
            if strategy == "scrambling-distance":
                expected.add("--cycles-noise-threshold")  # beside --cycles-min-samples
            self.assertEqual(self.capture(*options), expected, strategy)
            with_mu = {"--k", "--s", "--cycles-multiplier", "--cycles-min-samples", "--cycles-noise-threshold"}
            expected |= with_mu if strategy in READERS["--mu"] else {"--mu"}
            self.assertEqual(self.capture(*options, "--mu", "0.3"), expected, strategy)

    def test_the_warning_names_who_reads_the_option_or_what_takes_its_place(self):
        text = self.warns("capture", *SMALL, "--strategy", "cranley-patterson", "--mu", "0.1", "-o", "t.rct").stderr
        self.assertIn("cranley-patterson does not read it (micro-jitter, scrambling-distance do)", text)
        text = self.warns("capture", *SMALL, "--k", "2", "--mu", "0.1", "-o", "t.rct").stderr
        self.assertIn("--k has no effect: --mu is given", text)
        text = self.warns("capture", *SMALL, "--strategy", "owen", "--param", "mu=0.1", "-o", "t.rct").stderr
        self.assertIn("--param mu has no effect: owen does not read it (micro-jitter, scrambling-distance do)", text)

    def test_in_a_list_one_strategy_that_reads_an_option_is_enough(self):
        compare = ["compare", "--scene", *SMALL, "--trace-samples", "1", *GPU, "--mu", "0.3"]
        self.assertEqual(self.warned(*compare, "--strategy", "cranley-patterson,micro-jitter"), set())
        self.assertEqual(self.warned(*compare, "--strategy", "cranley-patterson,coherent"), {"--mu"})

    def test_more_indices_than_samples_limits_above_the_bounces_and_seeds_that_nothing_draws_from(self):
        self.assertEqual(self.capture("--spp", "4", "--trace-samples", "9"), {"--trace-samples"})
        self.assertEqual(self.capture("--spp", "4", "--trace-samples", "4"), set())
        self.assertEqual(self.capture("--bounces-diffuse", "2", "--bounces-transmission", "1"), {"--bounces-diffuse"})
        self.assertEqual(self.capture("--russian-roulette"), {"--russian-roulette"})
        self.assertEqual(self.capture("--strategy", "random", "--sequence", "halton"), {"--sequence"})
        self.assertEqual(self.capture("--strategy", "coherent", "--seed", "5"), set())  # chooses the index
        self.assertEqual(self.capture("--strategy", "coherent", "--seed", "5", "--spp", "1"), {"--seed"})
        self.assertEqual(self.capture("--strategy", "coherent", "--thread-map", "classes", "--interleave", "4"), set())
        self.assertEqual(self.capture("--strategy", "owen@tile", "--thread-map", "samples"), {"--thread-map"})
        self.assertEqual(self.capture("--strategy", "owen@tile", "--thread-map", "tile"), set())

    def test_an_n_between_powers_of_two_is_pointed_out_for_nets(self):
        for sequence, strategy, expected in (("sobol", "owen", True), ("pmj02", "micro-jitter", True),
                                             ("halton", "micro-jitter", False), ("sobol", "random", False)):
            text = self.warns("capture", *SMALL, "--trace-samples", "1", "--spp", "100", "--sequence", sequence,
                              "--strategy", strategy, "-o", "t.rct").stderr
            self.assertEqual("no power of two" in text, expected, (sequence, strategy))

    def test_a_picture_reads_no_bvh_and_quality_without_a_gpu_traces_no_warp(self):
        self.assertEqual(self.warned("render", *SMALL, "--spp", "1", "--spatial-splits", "-o", "a.png"),
                         {"--spatial-splits"})
        quality = ["quality", *SMALL, "--spp", "2", "--reference-spp", "4", "--reference", "r.exr",
                   "--strategy", "random,coherent"]
        options = ["--trace-samples", "2", "--thread-map", "tile", "--spatial-splits", "--set", "l1.ways=8"]
        self.assertEqual(self.warned(*quality, *options),
                         {"--trace-samples", "--thread-map", "--spatial-splits", "--set"})
        self.assertEqual(self.warned(*quality, *options, *GPU), set())

    def test_options_of_scene_and_sampling_have_no_effect_on_trace_files(self):
        for strategy in ("coherent", "random"):
            self.capture("--strategy", strategy)
            self.path("t.rct").rename(self.path(strategy + ".rct"))
        traces = ["coherent.rct", "random.rct", *GPU]
        self.assertEqual(self.warned("compare", *traces, "--spp", "4", "--mu", "0.1", "--fov", "30"),
                         {"--spp", "--mu", "--fov"})
        self.assertEqual(self.warned("explain", *traces, "--strategy", "owen"), {"--strategy"})
        self.assertEqual(self.warned("compare", *traces), set())

    def test_samples_warns_too_and_of_everything_beside_a_table(self):
        self.assertEqual(self.warned("samples", "--strategy", "cranley-patterson", "--k", "1"), {"--k"})
        self.assertEqual(self.warned("samples", "--k", "1"), set())

    def test_an_option_beside_param_of_its_name_is_warned_of_and_param_twice_is_refused(self):
        self.assertEqual(self.capture("--mu", "0.3", "--param", "mu=0.2"), {"--mu"})
        self.assertEqual(self.capture("--param", "mu=0.2"), set())
        self.refuses(2, "capture", *SMALL, "--param", "mu=0.2", "--param", "mu=0.3", "-o", "t.rct", mentions=["twice"])

    def test_wide_without_a_table_and_exposure_of_a_linear_picture_are_warned_of(self):
        self.assertEqual(self.warned("list", "gpus", "--json", "--wide"), {"--wide"})
        self.succeeds("list", "gpus", "--wide")
        picture = ["render", *SMALL, "--spp", "1", "--exposure", "1", "-o"]
        self.assertEqual(self.warned(*picture, "p.exr"), {"--exposure"})
        self.assertEqual(self.warned(*picture, "p.png"), set())

    def test_a_target_beside_exact_replay_is_warned_of(self):
        exact = ["compare", *SMALL, *GPU, "--spp", "8", "--strategy", "coherent,random", "--fidelity", "exact"]
        self.assertEqual(self.warned(*exact, "--baseline", "random", "--target-error", "5%"), {"--target-error"})

    def test_options_of_another_export_are_refused(self):
        self.succeeds("capture", *SMALL, "--spp", "64", "--trace-samples", "1", "-o", "t.rct")
        for option in ("--warps-per-cta", "--binary-version"):
            self.refuses(2, "export", "t.rct", *GPU, "--sm", "0", "--format", "csv", option, "8" if "cta" in option else "75",
                         "-o", "t.csv", mentions=[option, "accel-sim"])

    def test_mu_cycles_is_refused_with_the_options_that_took_its_place(self):
        for command in (["capture", *SMALL, "-o", "t.rct"], ["samples"]):
            self.refuses(2, *command, "--mu", "cycles", mentions=["--cycles-multiplier", "scrambling-distance"])

    def test_sweeping_a_strategy_without_a_mu_is_refused(self):
        self.refuses(2, "sweep", *SMALL, *GPU, "--swept", "owen", mentions=["micro-jitter"])


if __name__ == "__main__":
    main()
