#!/usr/bin/python3
"""One L1 hit rate in every report of a trace, Nsight Compute's; that of visits has a name of its own."""
import csv
import io
import re

from support import GPU, ProgramTest, main

METRIC = "l1tex__t_sector_pipe_lsu_mem_global_op_ld_hit_rate.pct"


class HitRates(ProgramTest):
    def first_csv(self, *arguments):
        return next(csv.DictReader(io.StringIO(self.succeeds(*arguments, "--csv").text)))

    def column(self, text, title):
        """The cell of the first row under a title; columns are two spaces apart."""
        lines = text.splitlines()
        head = next(i for i, line in enumerate(lines) if re.search(rf"(^|  ){re.escape(title)}(  |$)", line))
        end = lines[head].index(f"  {title}") + 2 + len(title)
        return float(lines[head + 2][:end].split()[-1])

    def test_the_l1_percentage_of_every_report_is_the_profilers(self):
        trace = self.capture()
        replay = ["replay", trace, *GPU]
        metrics = self.succeeds(*replay, "--counters", "ncu", "--json").json["rows"][0]["metrics"]
        expected = next(metric["value"] for metric in metrics if metric["name"] == METRIC)
        row = self.succeeds(*replay, "--json").json["rows"][0]
        self.assertAlmostEqual(100 * row["l1_hit_rate"]["mean"], expected, places=9)
        self.assertAlmostEqual(100 * float(self.first_csv(*replay)["l1_hit_rate"]), expected, places=9)
        self.assertAlmostEqual(self.column(self.succeeds(*replay, "--wide").text, "L1 %"), expected, delta=0.051)
        totals = row["totals"]
        self.assertAlmostEqual(100 * totals["l1_hits"] / totals["l1_requests"], expected, places=9)
        explained = ["explain", trace, trace, *GPU, "--counts-only"]
        for side in ("base", "other"):
            self.assertAlmostEqual(100 * self.succeeds(*explained, "--json").json[side]["l1_hit_rate"], expected, places=9)
        text = " ".join(self.succeeds(*explained).text.split())
        self.assertIn(f"(l1tex__t_sector_hit_rate): {expected:.1f} and {expected:.1f}", text)
        timed = self.succeeds(*replay, "--timed", "--json").json["rows"][0]
        self.assertAlmostEqual(100 * timed["traffic"]["l1_hit_rate"]["mean"], expected, places=9)
        # The timed replay looks up in order of time, so a few look-ups end otherwise.
        self.assertAlmostEqual(100 * timed["l1"]["hit_rate"], expected, delta=1)
        self.assertAlmostEqual(100 * float(self.first_csv(*replay, "--timed")["l1_hit_rate"]), 100 * timed["l1"]["hit_rate"], places=9)
        self.assertAlmostEqual(self.column(self.succeeds(*replay, "--timed", "--wide").text, "L1 %"), 100 * timed["l1"]["hit_rate"], delta=0.051)

    def test_where_one_warp_runs_alone_the_timed_rate_is_all_but_the_same(self):
        trace = self.path("warp.rct")
        self.succeeds("capture", "courtyard", "--resolution", "8x4", "--trace-samples", "1", "--spp", "16", "-o", trace)
        row = self.succeeds("replay", trace, *GPU, "--timed", "--json").json["rows"][0]
        self.assertAlmostEqual(row["l1"]["hit_rate"], row["traffic"]["l1_hit_rate"]["mean"], delta=0.0005)

    def test_visits_have_a_rate_of_their_own_with_as_many_misses(self):
        row = self.succeeds("replay", self.capture(), *GPU, "--json").json["rows"][0]
        totals = row["totals"]
        self.assertLess(row["l1_visit_hit_rate"]["mean"], row["l1_hit_rate"]["mean"])
        self.assertEqual(totals["sectors"] - totals["l1_visit_hits"], totals["l2_sectors"])
        self.assertEqual(totals["l1_requests"] - totals["l1_hits"], totals["l2_sectors"])


if __name__ == "__main__":
    main()
