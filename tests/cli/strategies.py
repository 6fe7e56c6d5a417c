#!/usr/bin/python3
"""Every sequence with every strategy from outside: what a trace says about it, and which pairs are refused."""
from support import GPU, LAUNCHES, SCENE, ProgramTest, main

CAPTURE = ["capture", *SCENE, *LAUNCHES, "--bounces", "1", "--spp", "64", "-o", "trace.rct"]
RENDER = ["render", *SCENE, "--resolution", "32x16", "--bounces", "1", "--spp", "4"]


class Strategies(ProgramTest):
    def recorded(self, *options):
        self.succeeds(*CAPTURE, *options)
        return self.succeeds("info", "trace.rct", "--json").json

    def names(self, topic):
        return [entry["name"] for entry in self.succeeds("list", topic, "--json").json["topics"][topic.replace("-", "_")]]

    def test_every_pair_is_compared_or_refused_with_a_reason(self):
        strategies = self.names("strategies")
        refused = 0
        for sequence in self.names("sequences"):
            defined = []
            for strategy in strategies:
                needs_net = strategy in ("uniform-jitter", "owen") or strategy.startswith("net-micro-jitter")
                if needs_net and sequence in ("halton", "halton-scrambled", "r2", "random"):
                    line = self.refuses(2, *CAPTURE, "--sequence", sequence, "--strategy", strategy)
                    self.assertIn(f"{strategy} moves points inside the cells of a net in base 2", line)
                    self.assertIn(f"'{sequence}'", line)
                    refused += 1
                else:
                    defined.append(strategy)
            report = self.succeeds("compare", "--scene", *SCENE, "--resolution", "32x16", "--trace-samples", "1",
                                   "--bounces", "1", "--sequence", sequence, "--strategy", ",".join(defined), *GPU,
                                   "--json").json
            self.assertEqual({row["strategy"] for row in report["rows"]}, set(defined))
        self.assertEqual(refused, 4 * 4)

    def test_every_strategy_renders(self):
        for strategy in self.names("strategies"):
            self.warns(*RENDER, "--strategy", strategy, "-o", "a.png")

    def test_a_trace_says_the_effective_parameters(self):
        for options, words in [(["--strategy", "scrambling-distance"], "multiplier=1 distance_samples=64 mu=0.5"),
                               (["--strategy", "scrambling-distance", "--mu", "0.2"], "mu=0.2"),
                               (["--strategy", "interleaved", "--interleave", "5"], "m=5"),
                               (["--strategy", "net-micro-jitter", "--sequence", "sobol-owen-4d", "--share", "sets"],
                                "share=sets k=1 mu=0.5"),
                               (["--strategy", "net-micro-jitter"], "share=first-bounce bits=6 free=6"),
                               (["--strategy", "net-micro-jitter", "--share", "light0", "--share-bits", "4"],
                                "share=light0 bits=4 free=6"),
                               (["--strategy", "net-micro-jitter-fast", "--sequence", "pmj02"], "k=3 mu=0.125 m=8"),
                               (["--k", "discrepancy", "--sequence", "r2"], "K=discrepancy("),
                               (["--s", "full", "--k", "0.9"], "K=0.9 s=full(")]:
            self.assertIn(words, str(self.recorded(*options)), options)

    def test_strategies_with_pixel_classes_choose_the_thread_map_classes_unless_told_otherwise(self):
        for options, thread_map in [([], "tile"), (["--strategy", "interleaved"], "classes"),
                                    (["--strategy", "net-micro-jitter-fast"], "classes"),
                                    (["--strategy", "interleaved", "--thread-map", "tile"], "tile"),
                                    (["--strategy", "coherent", "--thread-map", "classes"], "classes")]:
            text = str(self.recorded(*options))
            self.assertIn(f"--thread-map {thread_map} ", text)

    def test_strategies_with_pixel_classes_are_compared_and_explained_against_tiles(self):
        for timed in ([], ["--timed"]):
            row = self.succeeds("compare", "--scene", *SCENE, "--resolution", "64x64", "--trace-samples", "2", "--spp",
                                "16", "--strategy", "cranley-patterson,interleaved", *GPU, *timed, "--json").json["rows"][1]
            self.assertEqual((row["strategy"], row["thread_map"]), ("interleaved", "classes:8"))
            ratio = row["speed_up"] if timed else row["dram_bytes_ratio"]
            self.assertGreater(ratio["mean"], 0)
        for strategy in ("cranley-patterson", "interleaved"):
            self.recorded("--strategy", strategy)
            self.path("trace.rct").rename(self.path(strategy + ".rct"))
        text = self.succeeds("explain", "cranley-patterson.rct", "interleaved.rct", *GPU, "--heatmap", "a.exr").text
        self.assertIn("interleaved", text)
        self.assertTrue(self.path("a.exr").exists())

    def test_a_thread_map_in_the_name_holds_for_that_row_and_tells_it_apart(self):
        compare = ["compare", "--scene", *SCENE, "--resolution", "32x32", "--trace-samples", "1", "--spp", "32", *GPU]
        names = ["cranley-patterson", "cranley-patterson@classes", "interleaved@tile", "owen+wavefront@tile"]
        maps = ["samples", "classes:8", "tile", "tile"]
        mixed = [*compare, "--strategy", ",".join(names), "--thread-map", "samples"]
        for format in ([], ["--timed"]):
            rows = self.succeeds(*mixed, *format, "--json").json["rows"]
            self.assertEqual([(row["strategy"], row["thread_map"]) for row in rows], list(zip(names, maps, strict=True)))
        alone = self.succeeds(*compare, "--strategy", "cranley-patterson", "--thread-map", "classes", "--json").json["rows"]
        row = self.succeeds(*compare, "--strategy", ",".join(names[1:]), "--json").json["rows"][0]
        self.assertEqual(row["totals"], alone[0]["totals"])
        against = self.succeeds(*compare, "--strategy", ",".join(names[:2]), "--json").json["rows"]
        self.assertGreater(against[1]["dram_bytes_ratio"]["mean"], 0)  # held against the tiles
        text = self.succeeds("explain", *SCENE, "--resolution", "32x32", "--trace-samples", "1", *GPU, "--counts-only",
                             "--strategy", "cranley-patterson,cranley-patterson@classes").text
        self.assertIn("cranley-patterson@classes", text)

    def test_thread_maps_are_paired_over_the_same_paths_whatever_a_launch_of_theirs_holds(self):
        strategies = "owen@samples,owen@rows,owen@tile"
        compare = ["compare", "--scene", *SCENE, "--bounces", "1", "--spp", "40", "--strategy", strategies, *GPU,
                   "--baseline", "owen@samples", "--json", "--resolution"]
        exact = self.warns(*compare, "33x17", "--trace-samples", "40").json["rows"]  # of N
        self.assertEqual(len({row["rays"] for row in (r["totals"] for r in exact)}), 1)
        for row in exact:
            self.assertEqual(row["samples"], [0, 32])
            self.assertEqual(row["dram_bytes_ratio"] is not None, row["strategy"] != "owen@samples")
        timed = self.warns(*compare, "64x64", "--timed", "--windows", "16", "--set", "sms=1").json["rows"]
        for row in timed[1:]:
            self.assertGreater(row["speed_up"]["half_width_95"], 0)

    def test_a_group_stands_for_its_strategies_and_brings_its_baseline(self):
        listed = self.succeeds("list", "groups", "--json").json["topics"]["groups"]
        cycles = next(group for group in listed if group["name"] == "cycles")["strategies"]
        compare = ["compare", "--scene", *SCENE, "--resolution", "32x32", "--trace-samples", "1", "--bounces", "1",
                   "--spp", "64", *GPU, "--json", "--strategy"]
        report = self.succeeds(*compare, "cycles").json
        self.assertEqual([row["strategy"] for row in report["rows"]], cycles)
        self.assertEqual([row["thread_map"] for row in report["rows"]], ["samples"] + ["rows"] * 4)
        self.assertEqual([trace.get("mu") for trace in report["traces"]], [None, 0.5, 0.25, 0.125, 0.05])
        self.assertEqual(report["rows"], self.succeeds(*compare, ",".join(cycles), "--baseline", cycles[0]).json["rows"])
        self.assertIn("'cycles'", self.refuses(2, *CAPTURE, "--strategy", "cycles"))

    def test_a_parameter_in_the_name_is_that_strategys_own(self):
        self.assertEqual(self.recorded("--strategy", "micro-jitter:k=1:s=3")["traces"],
                         self.recorded("--strategy", "micro-jitter", "--k", "1", "--s", "3")["traces"])
        rows = self.succeeds("compare", "--scene", *SCENE, *LAUNCHES, "--spp", "64", *GPU, "--k", "4", "--strategy",
                             "micro-jitter,micro-jitter:k=1", "--json").json["rows"]
        self.assertEqual([row["strategy"] for row in rows], ["micro-jitter", "micro-jitter:k=1"])
        self.assertEqual([row["parameters"] for row in rows], ["K=4 s=2 mu=0.5", "K=1 s=2 mu=0.125"])
        line = self.refuses(2, *CAPTURE, "--strategy", "scrambling-distance:cycles-multiplier=0.5", "--mu", "0.1")
        self.assertIn("cycles-multiplier has no effect", line)

    def test_a_thread_map_in_the_name_gives_the_trace_of_the_option(self):
        by_name = self.recorded("--strategy", "owen@samples")
        trace = self.path("trace.rct").read_bytes()
        self.assertEqual(self.recorded("--strategy", "owen", "--thread-map", "samples"), by_name)
        self.assertEqual(self.path("trace.rct").read_bytes(), trace)
        self.assertIn("did you mean 'samples'?", self.refuses(2, *CAPTURE, "--strategy", "owen@sample"))
        self.assertIn("'owen@tile'", self.refuses(2, "render", *SCENE, "--strategy", "owen@tile", "-o", "a.png"))
        self.assertIn("owen+morton", self.refuses(2, "quality", *SCENE, "--reference", "r.exr", "--strategy", "owen+morton"))

    def test_a_parameter_by_its_name_gives_the_trace_of_its_option(self):
        for strategy, options, named in [("micro-jitter", ["--mu", "0.1"], ["mu=0.1"]),
                                         ("micro-jitter", ["--k", "1.5", "--s", "3"], ["k=1.5", "s=3"]),
                                         ("interleaved", ["--interleave", "5"], ["interleave=5"]),
                                         ("scrambling-distance", ["--cycles-noise-threshold", "off"],
                                          ["cycles-noise-threshold=off"])]:
            by_option = self.recorded("--strategy", strategy, *options)
            trace = self.path("trace.rct").read_bytes()
            by_name = [word for name in named for word in ("--param", name)]
            self.assertEqual(self.recorded("--strategy", strategy, *by_name), by_option)
            self.assertEqual(self.path("trace.rct").read_bytes(), trace)
        self.assertIn("did you mean 'interleave'?", self.refuses(2, *CAPTURE, "--param", "interleaf=5"))
        self.assertIn("NAME=VALUE", self.refuses(2, *CAPTURE, "--param", "mu"))
        self.assertIn("1 to 256", self.refuses(2, *CAPTURE, "--param", "interleave=257"))
        self.assertIn("found nothing", self.refuses(2, *CAPTURE, "--strategy", "micro-jitter:k="))
        self.assertIn("mu must be a number of 0 or more, found wide", self.refuses(2, *CAPTURE, "--param", "mu=wide"))

    def test_a_case_rules_over_a_parameter_by_its_name(self):
        compare = ["compare", "--scene", *SCENE, "--resolution", "16x16", "--trace-samples", "1", "--spp", "64", *GPU,
                   "--strategy", "micro-jitter", "--param", "k=3", "--json"]
        self.assertEqual([row["parameters"][:4] for row in self.succeeds(*compare).json["rows"]], ["K=3 "])
        both = self.warns(*compare, "--k", "1,2")
        self.assertEqual([row["parameters"][:4] for row in both.json["rows"]], ["K=1 ", "K=2 "])
        self.assertIn("--param k=3 has no effect: --k takes its place", both.stderr)

    def test_the_command_of_a_trace_makes_the_same_trace_again(self):
        recorded = self.recorded("--strategy", "interleaved", "--interleave", "3", "--seed", "7")
        command = recorded["traces"][0]["command_line"]
        self.succeeds(*command.split()[1:], "-o", "again.rct")
        self.assertEqual(self.path("again.rct").read_bytes(), self.path("trace.rct").read_bytes())

    def test_bad_settings_are_refused_in_one_line(self):
        for options, words in [(["--strategy", "interleaved", "--interleave", "0"], "1 to 256"),
                               (["--strategy", "interleaved", "--interleave", "49"], "64x48"),
                               (["--strategy", "uniform-jitter", "--spp", "100"], "64 or 128"),
                               (["--sequence", "pmj02", "--spp", "65537"], "65536"),
                               (["--k", "discrepancy", "--spp", "100000"], "65536"),
                               (["--k", "-1"], "--k"), (["--k", "nan"], "--k"), (["--k", "big"], "--k"),
                               (["--s", "0"], "s"), (["--s", "-1"], "--s"), (["--s", "some"], "--s"),
                               (["--mu", "-0.1"], "mu"), (["--mu", "nan"], "mu"), (["--mu", "wide"], "--mu"),
                               (["--sequence", "halton", "--strategy", "owen"], "sobol-owen-02")]:
            arguments = list(CAPTURE)
            if "--spp" in options:
                arguments[arguments.index("--spp"):arguments.index("--spp") + 2] = []
            self.refuses(2, *arguments, *options, mentions=[words])

    def test_mu_above_1_is_clamped_with_a_warning(self):
        for strategy in ("micro-jitter", "scrambling-distance"):
            result = self.warns(*CAPTURE, "--strategy", strategy, "--mu", "1.5")
            self.assertIn("mu 1.5 clamped to 1", result.stderr)


if __name__ == "__main__":
    main()
