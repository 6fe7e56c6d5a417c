#!/usr/bin/python3
"""raycache curve: every size from one replay, what equals what, and what it refuses."""
import csv
import io
import subprocess
import sys

from support import GPU_FILE, LAUNCHES, ROOT, SCENE, ProgramTest, main

FUSED = ["curve", "--scene", *SCENE, *LAUNCHES, "--spp", "64"]


class Curve(ProgramTest):
    def gpu(self):
        self.path("tiny.toml").write_text(GPU_FILE)
        return ["--gpu", "tiny.toml"]

    captured = {}

    def trace(self, name):
        """Captured once for all tests."""
        path = self.path(f"{name}.rct")
        if name in Curve.captured:
            path.write_bytes(Curve.captured[name])
        else:
            Curve.captured[name] = self.capture(path.name, "--strategy", name).read_bytes()
        return path

    def traces(self):
        return [self.trace(name) for name in ("cranley-patterson", "coherent")]

    def test_every_size_is_what_a_replay_with_caches_of_that_size_counts(self):
        trace, gpu = self.trace("coherent"), self.gpu()
        for level, below, asked, sets in (("l1", "l2_sectors", "l1_requests", 16), ("l2", "dram_sectors", "l2_sectors", 64)):
            found, = self.succeeds("curve", trace, *gpu, "--level", level, "--sets", "3", "--json").json["series"]
            own, full, three = found["levels"][0]["organisations"]
            self.assertEqual((own["sets"], full["sets"], three["sets"]), (sets, 1, 3))
            for organisation, ways in ((own, 2), (full, 32), (three, 9)):
                point = min(organisation["curve"], key=lambda p: abs(p["ways"] - ways))
                row, = self.succeeds("replay", trace, *gpu, "--set", f"{level}.ways={point['ways']}", "--set",
                                     f"{level}.sets={organisation['sets']}", "--json").json["rows"]
                self.assertEqual(point["fetched_sectors"], row["totals"][below])
                self.assertAlmostEqual(point["hit_rate"]["mean"], 1 - row["totals"][below] / row["totals"][asked], delta=1e-12)
                self.assertEqual(point["bytes_per_ray"], row["l2_bytes_per_ray" if level == "l1" else "dram_bytes_per_ray"])

    def test_an_equivalent_size_does_as_well_and_the_next_smaller_one_does_not(self):
        traces, gpu = self.traces(), self.gpu()
        report = self.succeeds("curve", *traces, *gpu, "--level", "l1", "--json").json
        found, = report["equivalents"]
        self.assertEqual((found["base"], found["other"], found["own_bytes"]), ("cranley-patterson", "coherent", 16 * 4 * 128))
        size = found["by_bytes_per_ray"]
        self.assertGreater(size["times"], 1)
        self.assertLessEqual(size["low_95"], size["bytes"])
        self.assertGreaterEqual(size["high_95"] or size["bytes"], size["bytes"])
        way = 16 * 128
        fetched = {}
        for trace, bytes_ in ((traces[1], 4 * way), (traces[0], size["bytes"]), (traces[0], size["bytes"] - way)):
            row, = self.succeeds("replay", trace, *gpu, "--set", f"l1.ways={bytes_ // way}", "--json").json["rows"]
            fetched[trace.stem, bytes_ // way] = row["l2_bytes_per_ray"]["mean"]
        goal = fetched["coherent", 4]
        self.assertLessEqual(fetched["cranley-patterson", size["bytes"] // way], goal)
        self.assertGreater(fetched["cranley-patterson", size["bytes"] // way - 1], goal)
        base, other = (s["levels"][0]["organisations"][0]["points"] for s in report["series"])
        at = [p["ways"] for p in base].index(4)
        self.assertAlmostEqual(found["bandwidth"]["mean"], base[at]["bytes_per_ray"]["mean"] / other[at]["bytes_per_ray"]["mean"],
                               delta=1e-9)
        text = " ".join(self.succeeds("curve", *traces, *gpu).text.split())
        self.assertIn("L1: coherent with 8 KiB fetches as few bytes per ray as cranley-patterson with ", text)
        self.assertIn("times the L2-to-L1 bandwidth of coherent", text)

    def test_fused_and_from_files_with_any_threads_are_the_same(self):
        traces, gpu = self.traces(), self.gpu()
        files = self.succeeds("curve", *traces, *gpu, "--json").report
        fused = [*FUSED, *gpu, "--strategy", "cranley-patterson,coherent", "--json"]
        one = self.succeeds(*fused, "--threads", "1")
        self.assertEqual(one.report, files)
        self.assertEqual(self.succeeds(*fused, "--threads", "3").stdout, one.stdout)

    def test_the_table_in_text_and_csv_has_the_sizes_asked_for(self):
        fused = [*FUSED, *self.gpu(), "--strategy", "coherent", "--level", "l1", "--sizes", "6KiB,2048,8KiB"]
        rows = list(csv.DictReader(io.StringIO(self.succeeds(*fused, "--csv").text)))
        own = [row for row in rows if row["organisation"] == "own sets"]
        self.assertEqual([(row["bytes"], row["ways"]) for row in own], [("2048", "1"), ("6144", "3"), ("8192", "4")])
        self.assertEqual(own, sorted(own, key=lambda row: float(row["hit_rate"])))
        text = self.succeeds(*fused).text
        self.assertIn("8 KiB *", text)
        self.assertLessEqual(max(map(len, text.splitlines())), 100)

    def test_other_policies_are_what_a_replay_with_them_counts_and_none_has_fewer_line_misses_than_the_optimum(self):
        trace, gpu = self.trace("coherent"), self.gpu()
        asked = ["curve", trace, *gpu, "--level", "l1", "--sizes", "8KiB,12KiB", "--policy", "random,belady,fifo"]
        level = self.succeeds(*asked, "--json").json["series"][0]["levels"][0]
        found = {row["policy"]: row["points"] for row in level["policies"]}
        self.assertEqual([p["ways"] for p in found["fifo"]], [4, 6])
        for policy in ("fifo", "random"):
            row, = self.succeeds("replay", trace, *gpu, "--set", f"l1.policy={policy}", "--json").json["rows"]
            self.assertEqual(found[policy][0]["bytes_per_ray"], row["l2_bytes_per_ray"])
        lru = level["organisations"][0]["points"][0]
        self.assertGreater(found["belady"][0]["hit_rate"]["mean"], lru["hit_rate"]["mean"])
        self.assertIn("belady", self.succeeds(*asked).text)
        self.assertEqual(self.succeeds(*asked, "--csv").text.count(",belady,"), 2)

    def test_compare_and_explain_say_what_curve_says_where_asked(self):
        traces, gpu = self.traces(), self.gpu()
        sentence = self.succeeds("curve", *traces, *gpu, "--level", "l1", "--json").json["equivalents"][0]["sentence"]
        compared = ["compare", *traces, *gpu, "--cache-equivalent"]
        self.assertIn(sentence, self.succeeds(*compared, "--json").json["notes"])
        self.assertIn(sentence, " ".join(self.succeeds(*compared).text.split()))
        explained = ["explain", *traces, *gpu, "--cache-equivalent"]
        self.assertEqual(self.succeeds(*explained, "--json").json["cache_equivalents"], [sentence])
        self.assertIn(sentence, " ".join(self.succeeds(*explained).text.split()))
        self.refuses(2, "compare", "--scene", *SCENE, "--gpu", "h100", "--cache-equivalent", mentions=["--exact"])
        for option in (["--csv"], ["--counters", "ncu"]):  # these have no place for it
            self.refuses(2, *compared, *option, mentions=["--cache-equivalent", option[0]])

    def test_a_sampled_curve_is_of_large_caches_alone(self):
        sampled = [*FUSED, "--gpu", "rtx-3070", "--strategy", "coherent", "--sampled"]
        exact, = self.succeeds(*sampled[:-1], "--level", "l2", "--json").json["series"][0]["levels"]
        report = self.succeeds(*sampled, "0.3", "--level", "l2", "--json").json
        found, = report["series"][0]["levels"]
        organisation, = found["organisations"]
        self.assertEqual(organisation["name"], "fully associative")
        self.assertGreaterEqual(min(p["ways"] for p in organisation["curve"]), 2048)
        truth = {p["bytes"]: p["hit_rate"]["mean"] for p in exact["organisations"][1]["points"]}
        near = [abs(truth[p["bytes"]] - p["hit_rate"]["mean"]) for p in organisation["points"] if p["bytes"] in truth]
        self.assertGreater(len(near), 1)
        self.assertLess(max(near), 0.05)
        self.assertIn("SHARDS", report["notes"][-1])
        self.refuses(2, *sampled, "0.3", "--level", "l1", mentions=["L1", "2048"])
        self.refuses(2, *sampled, "0.0001", "--level", "l2", mentions=["1024 lines", "exact"])
        self.refuses(2, *sampled, "0.3", "--level", "l2", "--sizes", "64KiB", mentions=["2048 lines"])
        self.refuses(2, *sampled, "0.3", "--level", "l2", "--sets", "4", mentions=["--sets"])

    def test_a_picture_shows_both_and_a_file_of_another_kind_is_refused(self):
        self.path("c.json").write_bytes(self.succeeds(*FUSED, *self.gpu(), "--strategy", "cranley-patterson,coherent", "--json").stdout)
        plot = [sys.executable, ROOT / "tools/plot_curve", "c.json", "-o", "c.png"]
        self.assertEqual(subprocess.run(plot, cwd=self.folder, check=False).returncode, 0)
        self.assertEqual(self.path("c.png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.path("c.json").write_text('{"schema_version": 1, "rows": []}')
        refused = subprocess.run(plot, cwd=self.folder, stderr=subprocess.PIPE, text=True, check=False)
        self.assertEqual((refused.returncode, len(refused.stderr.splitlines())), (1, 1))
        self.assertIn("raycache curve --json", refused.stderr)

    def test_several_n_are_told_apart_within_100_columns(self):
        text = self.succeeds(*FUSED[:-1], "64,256", *self.gpu(), "--level", "l1", "--strategy", "cranley-patterson,micro-jitter").text
        self.assertLessEqual(max(map(len, text.splitlines())), 100)
        words = " ".join(text.split())
        for n in (64, 256):
            self.assertIn(f"micro-jitter N={n} with 8 KiB fetches as few bytes per ray as cranley-patterson N={n} with", words)

    def test_what_makes_no_sense_is_refused_in_one_line(self):
        gpu = self.gpu()
        self.refuses(2, *FUSED, *gpu, "--level", "l1", "--sizes", "3000", mentions=["2 KiB", "4 KiB", "tiny"])
        self.refuses(2, *FUSED, *gpu, "--level", "l1", "--sizes", "64", mentions=["the nearest is 2 KiB"])
        self.refuses(2, *FUSED, *gpu, "--sizes", "8KiB", mentions=["--level"])
        self.refuses(2, *FUSED, *gpu, "--level", "l3", mentions=["l1 to l2"])
        self.refuses(2, *FUSED, *gpu, "--set", "l1.ways=2,4", mentions=["curve"])
        self.refuses(2, *FUSED, *gpu, "--csv", "--json", mentions=["--json"])
        self.refuses(2, *FUSED, *gpu, "--baseline", "interleaved", mentions=["interleaved"], warnings=True)
        waves = self.capture("waves.rct", "--execution", "wavefront")
        self.refuses(2, "curve", waves, *gpu, mentions=["wave"])

    def test_one_ray_has_a_curve_too(self):
        one = ["curve", "--scene", *SCENE, "--resolution", "1x1", "--spp", "1", "--bounces", "0", *self.gpu(), "--json"]
        series = self.succeeds(*one, "--strategy", "coherent").json["series"]
        points = series[0]["levels"][0]["organisations"][0]["curve"]
        self.assertGreaterEqual(len(points), 1)
        self.assertIsNone(points[0]["hit_rate"]["half_width_95"])


if __name__ == "__main__":
    main()
