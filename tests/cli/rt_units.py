#!/usr/bin/python3
"""RT units, from outside: off unless asked for, said in every report of times, no part of counts without time."""
import csv

from support import ROOT, SCENE, ProgramTest, main

BOTH = ("--gpu", "rtx-3070", "--set", "traversal=software,rt_unit")
UNIT = ("--gpu", "rtx-3070", "--set", "traversal=rt_unit")


class RtUnits(ProgramTest):
    def test_every_timed_report_says_who_traversed(self):
        trace = self.capture("trace.rct", "--bounces", "0")
        words = " ".join(self.succeeds("replay", trace, "--gpu", "rtx-3070,v100", "--timed").text.split())
        self.assertEqual(words.count("traversal: software. "), 1)
        self.assertNotIn("RT ", words)
        words = " ".join(self.succeeds("replay", trace, *UNIT, "--timed").text.split())
        self.assertIn("traversal: RT unit (assumed; cachesim/MODEL.md). Counts of caches include what RT units ask for, "
                      "which profilers leave out.", words)
        words = " ".join(self.succeeds("replay", trace, *BOTH, "--timed", "--wide").text.split())
        self.assertIn("RT unit (assumed; cachesim/MODEL.md) in rtx-3070 (traversal=rt_unit); software in the others.", words)
        for column in ("RT boxes %", "RT triangles %", "RT warps %"):
            self.assertIn(column, words)

    def test_what_the_unit_does_is_in_json_and_the_instructions_are_gone(self):
        trace = self.capture("trace.rct", "--bounces", "0")
        software, unit = self.succeeds("replay", trace, *BOTH, "--timed", "--json").json["rows"]
        self.assertEqual((software["traversal"], unit["traversal"]), ("software", "rt_unit"))
        self.assertNotIn("rt_loads", software)
        self.assertNotIn("rt_box_tests", software["utilisation"])
        self.assertGreater(unit["rt_loads"], 0)
        self.assertLess(unit["instructions"], software["instructions"] / 2)
        self.assertLess(unit["loads"], software["loads"] / 10)
        self.assertEqual(unit["warp_accesses"], software["warp_accesses"])
        self.assertEqual(unit["traffic"], software["traffic"])
        for share in ("rt_box_tests", "rt_triangle_tests", "rt_warps"):
            self.assertTrue(0 < unit["utilisation"][share] < 1, share)
        rows = list(csv.DictReader(self.succeeds("replay", trace, *BOTH, "--timed", "--csv").text.splitlines()))
        self.assertEqual([row["traversal"] for row in rows], ["software", "rt_unit"])

    def test_an_idle_unit_changes_no_cycle_and_no_thread_changes_a_busy_one(self):
        trace = self.capture("trace.rct", "--bounces", "0")
        preset = (ROOT / "cachesim/gpus/rtx-3070.toml").read_text()
        self.path("rtx-3070.toml").write_text(preset[:preset.index("[rt_unit]")])
        without = self.succeeds("replay", trace, "--gpu", "./rtx-3070.toml", "--timed", "--json").json["rows"]
        self.assertEqual(self.succeeds("replay", trace, "--gpu", "rtx-3070", "--timed", "--json").json["rows"], without)
        one, two = (self.succeeds("replay", trace, *UNIT, "--timed", "--json", "--threads", n).text for n in ("1", "2"))
        self.assertEqual(one, two)

    def test_counts_without_time_do_not_change(self):
        trace = self.capture("trace.rct", "--bounces", "0")
        counted = [self.succeeds("replay", trace, *options, "--json").json["rows"][0] for options in (UNIT, UNIT[:2])]
        for row in counted:
            row.pop("gpu")
        self.assertEqual(*counted)

    def test_explanations_and_qualities_say_it_too(self):
        base, other = self.capture("cp.rct", "--bounces", "0"), self.capture("other.rct", "--bounces", "0")
        for options, words, key in ((UNIT[:2], "traversal: software.", "software"),
                                    (UNIT, "traversal: RT unit (assumed", "rt_unit")):
            self.assertIn(words, " ".join(self.succeeds("explain", base, other, *options).text.split()))
            self.assertEqual(self.succeeds("explain", base, other, *options, "--json").json["traversal"], key)
        self.assertNotIn("traversal", self.succeeds("explain", base, other, "--gpu", "rtx-3070", "--counts-only").text)
        notes = self.succeeds("quality", *SCENE, "--resolution", "32x32", "--spp", "8", "--reference-spp", "16",
                              "--strategy", "cranley-patterson,micro-jitter", *UNIT, "--json").json["notes"]
        self.assertTrue(any(note.startswith("predicted times: traversal: RT unit (assumed") for note in notes), notes)

    def test_counters_of_a_profiler_with_times_are_refused_since_it_leaves_out_what_units_read(self):
        trace = self.capture("trace.rct", "--bounces", "0")
        self.path("profile.csv").write_text('"ID","dram__bytes_read.sum"\n"","byte"\n"0","1"\n"1","1"\n')
        for command in (["replay", trace, "--counters", "ncu"], ["counters", trace, "--against", "profile.csv"]):
            self.refuses(2, *command, *UNIT, "--timed", mentions=["rt_unit", "leave out what RT units read"])
            self.succeeds(*command, *UNIT)

    def test_a_gpu_without_a_unit_refuses_it_and_so_do_values_out_of_range(self):
        trace = self.capture("trace.rct", "--bounces", "0")
        for gpu, change, words in (("v100", "traversal=rt_unit", "v100.toml with --set: traversal: expected a table [rt_unit]"),
                                   ("rtx-3070", "traversal=hardware", "traversal: expected \"software\" or \"rt_unit\""),
                                   ("rtx-3070", "rt_unit.warps=0", "rt_unit.warps"),
                                   ("rtx-3070", "rt_unit.load_bytes=48", "expected a power of two, found 48"),
                                   ("rtx-3070", "rt_unit.box_tests_per_cycle=0", "rt_unit.box_tests_per_cycle"),
                                   ("v100", "rt_unit.warps=4", "expected a key of one of its tables front_end, l1, l2, ")):
            self.refuses(2, "replay", trace, "--gpu", gpu, "--timed", "--set", change, mentions=[words])


if __name__ == "__main__":
    main()
