#!/usr/bin/python3
"""Estimates of the steady state from windows: how compare is told how certain to be, and what it says of that."""
import time

from support import LAUNCHES, PICTURE, SCENE, ProgramTest, main

# Two SMs: windows are short.
GPU = ["--gpu", "rtx-3070", "--set", "sms=2"]
STRATEGIES = ["--strategy", "cranley-patterson,micro-jitter", "--k", "1"]
COMPARE = ["compare", *SCENE, *PICTURE, "--spp", "1024", *STRATEGIES, *GPU]
SHORT = [*COMPARE, "--bounces", "1"]  # paths


class Estimates(ProgramTest):
    def test_windows_are_the_default_and_whole_launches_are_exact(self):
        self.assertIn("estimates of the steady state", self.succeeds(*COMPARE, "--windows", "4").text)
        exact = self.succeeds("compare", *SCENE, *PICTURE, "--spp", "16", *STRATEGIES, *GPU, "--exact", "--json")
        self.assertEqual(len(exact.json["rows"][0]["samples"]), 8)
        chosen = self.succeeds("compare", *SCENE, *LAUNCHES, "--spp", "16", *STRATEGIES, *GPU, "--json")
        self.assertEqual(len(chosen.json["rows"][0]["samples"]), 2)
        for whole in (exact, chosen):
            self.assertNotIn("steady state", whole.text)
            self.assertIsNotNone(whole.json["rows"][0]["dram_compulsory_share"])

    def test_the_steady_state_has_no_share_of_first_touches(self):
        explained = self.succeeds("explain", *COMPARE[1:], "--counts-only", "--windows", "4", "--json").json
        compared = self.succeeds(*COMPARE, "--windows", "4", "--json").json["rows"][0]
        for counts in (compared, explained["base"], explained["other"]):
            self.assertIsNone(counts["dram_compulsory_share"])

    def test_the_picture_is_a_real_one_unless_a_resolution_is_given(self):
        settings = self.succeeds("compare", *SCENE, "--spp", "1024", "--strategy", "coherent", *GPU, "--windows", "2",
                                 "--json").json["traces"][0]
        self.assertEqual(settings["resolution"], "1920x1080")
        self.assertLess(1, len(settings["samples"]))

    def test_a_target_is_met_where_nothing_is_said(self):
        rows = self.succeeds(*COMPARE, "--target-error", "20%", "--json").json["rows"]
        for key in ("l2_bytes_ratio", "dram_bytes_ratio"):
            ratio = rows[1][key]
            self.assertLessEqual(ratio["half_width_95"], 0.2 * ratio["mean"])

    def test_more_windows_narrow_the_interval(self):
        def width(windows):
            return self.succeeds(*COMPARE, "--windows", windows, "--json").json["rows"][1]["l2_bytes_ratio"]["half_width_95"]
        self.assertLess(width(128), width(16))

    def test_threads_do_not_change_an_estimate(self):
        one, two = (self.succeeds(*COMPARE, "--timed", "--windows", "8", "--json", "--threads", n).report for n in (1, 2))
        self.assertEqual(one, two)

    def test_the_same_strategy_is_exactly_as_fast_as_itself(self):
        rows = self.succeeds("compare", *SCENE, *PICTURE, "--spp", "64", "--strategy", "micro-jitter,micro-jitter@tile",
                             "--baseline", "micro-jitter", *GPU, "--timed", "--windows", "8", "--json").json["rows"]
        self.assertEqual((rows[1]["speed_up"]["mean"], rows[1]["speed_up"]["half_width_95"]), (1, 0))

    def test_a_time_budget_ends_the_estimate_and_says_how_far_it_came(self):
        result = self.warns(*COMPARE, "--target-error", "0.01%", "--time-budget", "0.001")
        self.assertRegex(result.stderr, r"the time budget of 0\.001 s is less than an interval takes, [0-9.]+ s: [0-9.]+ s "
                                        r"until the scene is ready, [0-9.]+ s for 2 blocks; ±[0-9.]+ % \(")
        self.assertIn("2 blocks", result.text)

    def test_a_longer_time_budget_is_spent_on_more_blocks(self):
        start = time.monotonic()
        one_look = self.succeeds(*COMPARE, "--target-error", "100%", "--time-budget", "1000").text
        budget = 6 * (time.monotonic() - start)
        self.assertIn("2 blocks", one_look)  # a budget looks at two blocks first
        result = self.warns(*COMPARE, "--target-error", "0.01%", "--time-budget", f"{budget:.3f}")
        self.assertRegex(result.stderr, r"ends at (?!2 )\d+ blocks, ±[0-9.]+ % \(.*\); the target was ±0\.01 %")

    def test_one_sample_and_one_pixel_are_estimated_too(self):
        result = self.warns("compare", *SCENE, "--resolution", "1x1", "--spp", "1", "--strategy",
                            "cranley-patterson,coherent", *GPU, "--windows", "4")
        self.assertIn("holds 24 at once", result.stderr)

    def test_a_sweep_is_of_the_steady_state_unless_launches_are_asked_for(self):
        sweep = ["sweep", *SCENE, "--resolution", "32x32", "--spp", "16", "--bounces", "1", "--reference-spp", "16", "--mu",
                 "0,1", "--strategy", "coherent", *GPU]
        rows = {(r["strategy"], r["mu"]): r
                for r in self.succeeds(*sweep, "--windows", "4", "--json").json["rows"]}
        coherent, same = (rows[key]["speed_up"] for key in (("coherent", None), ("micro-jitter", 0)))
        self.assertGreater(coherent["half_width_95"], 0)
        self.assertEqual(coherent, same)  # the same windows of the same samples
        self.assertIn("estimates of the steady state", " ".join(self.succeeds(*sweep, "--windows", "2").text.split()))
        self.assertNotIn("steady state", self.succeeds(*sweep, "--trace-samples", "1").text)
        self.assertNotIn("steady state", self.succeeds(*sweep, "--exact").text)
        for option, value in (("--target-error", "0%"), ("--target-error", "-1%"), ("--target-error", "101%"),
                              ("--windows", "1")):
            self.refuses(2, *sweep, option, value, mentions=[option, value, "expected"])

    def test_wavefronts_are_replayed_as_whole_launches_and_say_so(self):
        result = self.warns("compare", *SCENE, *PICTURE, "--spp", "4", "--strategy", "coherent", "--execution",
                            "wavefront", *GPU)
        self.assertIn("whole launches are replayed", result.stderr)

    def test_cold_launches_stand_beside_the_steady_state(self):
        timed = [*SHORT, "--timed", "--windows", "4", "--cold-launches", "2"]
        result = self.succeeds(*timed, "--json")
        whole = self.succeeds(*SHORT, "--timed", "--trace-samples", "2", "--json").json["rows"]
        for row, launches in zip(result.json["rows"], whole):
            cold = row["cold_launches"]
            self.assertEqual((cold["cycles"], cold["samples"]), (launches["cycles"], launches["samples"]))
            product = cold["steady_cycles"]["mean"] * cold["cold"]["mean"] * cold["ramp"] * cold["tail"]
            self.assertAlmostEqual(product / cold["cycles"], 1, places=12)
            self.assertGreater(cold["cold"]["half_width_95"], 0)
        self.assertIsNone(result.json["rows"][0]["cold_launches"]["speed_up"])
        self.assertEqual(result.json["rows"][1]["cold_launches"]["speed_up"], whole[1]["speed_up"])
        text = self.succeeds(*timed).text
        self.assertIn("2 launches, each (sample indices", text)
        self.assertIn("launch/steady", text)
        self.assertIn("cold_over_steady", self.succeeds(*timed, "--csv").text)

    def test_cold_launches_without_time_compare_bytes(self):
        rows = self.succeeds(*SHORT, "--windows", "4", "--cold-launches", "1", "--json").json["rows"]
        for row in rows:
            self.assertNotIn("cycles", row["cold_launches"])
            self.assertGreater(row["cold_launches"]["l2_bytes_over_steady"]["mean"], 0)

    def test_cold_launches_that_make_no_sense_are_refused(self):
        for value in ("0", "-1", "two", "4097"):
            self.refuses(2, *COMPARE, "--cold-launches", value, mentions=["--cold-launches", value, "expected"])
        self.refuses(2, "compare", *SCENE, *PICTURE, "--spp", "4", *STRATEGIES, *GPU, "--cold-launches", "5",
                     mentions=["5 cold launches; expected 1 to 4: N is 4"])
        for other in (["--exact"], ["--trace-samples", "2"], ["--by", "bounce"], ["--time-budget", "3"],
                      ["--counters", "ncu"]):
            self.refuses(2, *COMPARE, "--cold-launches", "1", *other, mentions=["together"])
        self.refuses(2, *COMPARE, "--execution", "wavefront", "--cold-launches", "1", mentions=["wavefront", "megakernel"])
        self.refuses(2, "compare", self.capture(), *GPU, "--cold-launches", "1", mentions=["beside traces", "scene"])

    def test_a_pilot_picks_a_level_and_says_why(self):
        auto = [*SHORT, "--fidelity", "auto", "--target-error", "50%"]
        one, two = (self.succeeds(*auto, "--json", "--threads", n) for n in (1, 2))
        self.assertEqual(one.report, two.report)
        choice, row = one.json["fidelity"], one.json["rows"][1]
        self.assertIn(choice["picked"], ("functional", "two-phase", "timed", "exact"))
        self.assertTrue(choice["reason"])
        self.assertEqual(len(choice["pilot"]), 1)
        self.assertLessEqual(row["speed_up"]["half_width_95"], 0.5 * row["speed_up"]["mean"])
        text = self.succeeds(*auto).text
        self.assertIn(f"Fidelity: {choice['picked']}, to ±50 % of every speed-up", text)
        self.assertIn("the same on every machine", " ".join(text.split()))

    def test_small_pictures_are_replayed_as_a_whole(self):
        small = ["compare", *SCENE, "--resolution", "16x8", "--spp", "4", *STRATEGIES, *GPU]
        auto = self.warns(*small, "--fidelity", "auto", "--json").json
        exact = self.warns(*small, "--fidelity", "exact", "--json").json
        self.assertEqual(auto["fidelity"]["picked"], "exact")
        self.assertNotIn("fidelity", exact)
        for a, b in zip(auto["rows"], exact["rows"]):
            self.assertEqual(a["cycles"], b["cycles"])
            self.assertTrue(b["windows"]["all_indices"])
            self.assertEqual(b["cycles_per_ray"]["half_width_95"], 0)

    def test_the_other_levels_are_the_options_that_they_stand_for(self):
        for level, option in (("functional", []), ("timed", ["--timed"])):
            asked = self.succeeds(*SHORT, "--windows", "4", "--fidelity", level, "--json").json
            self.assertEqual(asked["rows"], self.succeeds(*SHORT, "--windows", "4", *option, "--json").json["rows"])

    def test_levels_that_make_no_sense_are_refused(self):
        self.refuses(2, *COMPARE, "--fidelity", "best", mentions=["--fidelity", "best", "functional"])
        for other in (["--exact"], ["--trace-samples", "2"], ["--by", "bounce"], ["--counters", "ncu"]):
            self.refuses(2, *COMPARE, "--fidelity", "auto", *other, mentions=["together"])
        for other in (["--windows", "8"], ["--time-budget", "3"]):
            self.refuses(2, *COMPARE, "--fidelity", "auto", *other, mentions=["fidelity auto", "target error alone"])
        for target in ("0%", "-1%", "101%"):
            self.refuses(2, *COMPARE, "--fidelity", "auto", "--target-error", target, mentions=["--target-error", target])
        self.refuses(2, *COMPARE, "--fidelity", "functional", "--timed", mentions=["--fidelity functional", "one of them"])
        self.refuses(2, "compare", *SCENE, *PICTURE, "--spp", "64", "--strategy", "coherent", *GPU, "--fidelity", "auto",
                     mentions=["expected a baseline and another"])
        self.refuses(2, *COMPARE, "--execution", "wavefront", "--fidelity", "auto", mentions=["wavefront", "megakernel"])
        self.refuses(2, "compare", self.capture(), *GPU, "--fidelity", "auto", mentions=["beside traces", "scene"])

    def test_targets_and_windows_that_make_no_sense_are_refused(self):
        for option, value in (("--target-error", "0%"), ("--target-error", "-1%"), ("--target-error", "101%"),
                              ("--target-error", "2"), ("--target-error", "two%"), ("--target-error", "nan%"),
                              ("--windows", "0"), ("--windows", "1"), ("--windows", "1000000"), ("--time-budget", "-1"),
                              ("--time-budget", "inf")):
            self.refuses(2, *COMPARE, option, value, mentions=[option, value, "expected"])
        for first, second in ((["--exact"], ["--windows", "8"]), (["--trace-samples", "2"], ["--target-error", "2%"]),
                              (["--exact"], ["--time-budget", "3"])):
            self.refuses(2, *COMPARE, *first, *second, mentions=["together"])

    def test_an_estimate_from_trace_files_is_refused(self):
        trace = self.capture()
        line = self.refuses(2, "compare", trace, *GPU, "--target-error", "2%", mentions=["--target-error"])
        self.assertIn("whole launches", line)


if __name__ == "__main__":
    main()
