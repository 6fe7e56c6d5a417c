#!/usr/bin/python3
"""What compare and replay print: groups, baseline, formats, saved files, and where warnings go."""
import csv
import io
import json
import os
import pty
import re
import subprocess

from support import GPU, LAUNCHES, PICTURE, RAYCACHE, ROOT, SCENE, ProgramTest, main

COMPARE = ["compare", "--scene", *SCENE, *LAUNCHES, *GPU]


class Reports(ProgramTest):
    def test_the_scene_is_an_argument_and_a_gpu_goes_by_other_spellings(self):
        tail = [*SCENE[1:], *LAUNCHES, "--strategy", "coherent,micro-jitter", "--csv"]
        text = self.succeeds("compare", SCENE[0], *tail, "--gpu", "gtx-980-ti").text
        self.assertEqual(self.succeeds("compare", "--scene", SCENE[0], *tail, "--gpu", "GTX_980_Ti").text, text)

    def test_lists_of_values_make_a_row_for_every_gpu(self):
        trace = self.capture()
        rows = self.succeeds("replay", trace, "--gpu", "rtx-3070", "--l1-kib", "32,128", "--set", "sms=4,8",
                             "--json").json["rows"]
        self.assertEqual([row["gpu"] for row in rows],
                         [f"rtx-3070 (sms={sms}, l1={kib} KiB)" for sms in (4, 8) for kib in (32, 128)])
        sectors = [row["totals"]["l2_sectors"] for row in rows]
        self.assertGreater(sectors[0], sectors[1])
        by_ways = self.succeeds("replay", trace, "--gpu", "rtx-3070", "--set", "sms=4", "--set", "l1.ways=64",
                                "--json").json["rows"][0]
        self.assertEqual(by_ways["totals"], rows[0]["totals"])

    def test_the_groups_of_each_cut_add_up_to_the_whole(self):
        whole = {row["strategy"]: row["totals"] for row in self.succeeds(*COMPARE, "--json").json["rows"]}
        for by, expected in (("bounce", 3), ("ray", 3), ("object", 2)):
            with self.subTest(by):
                report = self.succeeds(*COMPARE, "--by", by, "--json").json
                self.assertEqual(report["by"], by)
                for strategy, totals in whole.items():
                    rows = [row for row in report["rows"] if row["strategy"] == strategy]
                    self.assertGreaterEqual(len({row["group"] for row in rows}), expected)
                    for key in ("steps", "lane_accesses", "sectors", "l1_hits", "l1_visit_hits", "l2_sectors", "dram_sectors"):
                        self.assertEqual(sum(row["totals"][key] for row in rows), totals[key], key)
                    if by != "object":
                        self.assertEqual(sum(row["totals"]["rays"] for row in rows), totals["rays"])

    def test_cranley_patterson_is_the_baseline_where_it_is_compared(self):
        report = self.succeeds(*COMPARE, "--json").json
        self.assertEqual(report["baseline"], "cranley-patterson")
        for row in report["rows"]:
            self.assertEqual(row["dram_bytes_ratio"] is None, row["strategy"] == "cranley-patterson")

    def test_another_baseline_can_be_chosen_and_the_factors_multiply_to_the_ratio(self):
        report = self.succeeds(*COMPARE, "--baseline", "coherent", "--json").json
        self.assertEqual(report["baseline"], "coherent")
        compared = [row for row in report["rows"] if row["strategy"] != "coherent"]
        self.assertEqual(len(compared), 2)
        for row in compared:
            product = 1
            for factor in row["factors"].values():
                product *= factor["mean"]
                self.assertGreaterEqual(factor["half_width_95"], 0)
            self.assertAlmostEqual(product / row["dram_bytes_ratio"]["mean"], 1, delta=1e-9)
            self.assertGreater(row["dram_bytes_ratio"]["half_width_95"], 0)

    def test_across_gpus_all_variants_are_held_against_the_first(self):
        variants = [*COMPARE[:-1], "rtx-3070", "--l1-kib", "16,128", "--across-gpus", "--json"]
        report = self.succeeds(*variants, "--strategy", "cranley-patterson,micro-jitter").json
        self.assertEqual((report["baseline"], report["baseline_gpu"]), ("cranley-patterson", "rtx-3070 (l1=16 KiB)"))
        base, ratios = report["rows"][0]["l2_bytes_per_ray"]["mean"], []
        for row in report["rows"]:
            ratio = row["l2_bytes_ratio"]
            ratios.append(ratio and ratio["mean"])
            if ratio:
                self.assertAlmostEqual(ratio["mean"], row["l2_bytes_per_ray"]["mean"] / base, places=9)
        self.assertEqual(ratios.count(None), 1)
        one = self.succeeds(*variants, "--strategy", "micro-jitter").json
        self.assertEqual(one["baseline"], "micro-jitter")
        self.assertLess(one["rows"][1]["l2_bytes_ratio"]["mean"], 1)

        several = "expected several variants of one GPU, such as --l1-kib 128,256"
        self.assertIn(several, self.refuses(2, *COMPARE, "--across-gpus"))
        self.assertIn(several, self.refuses(2, *COMPARE[:-1], "rtx-3070,h100", "--across-gpus"))
        self.assertIn("expected one clock", self.refuses(2, *COMPARE[:-1], "rtx-3070", "--set", "timing.clock_mhz=1000,2000",
                                                         "--across-gpus", "--timed"))

    def test_without_cranley_patterson_there_is_a_table_without_ratios(self):
        report = self.succeeds(*COMPARE, "--strategy", "coherent,micro-jitter", "--json").json
        self.assertEqual([row["dram_bytes_ratio"] for row in report["rows"]], [None, None])
        self.assertNotIn("DRAM ratio", self.succeeds(*COMPARE, "--strategy", "coherent,micro-jitter").text)

    def test_several_k_make_a_row_each_and_a_strategy_without_k_has_one(self):
        report = self.succeeds(*COMPARE, "--k", "1,2.5", "--json").json
        rows = [(row["strategy"], row["parameters"].split(" ")[0]) for row in report["rows"]]
        self.assertEqual(rows, [("coherent", ""), ("cranley-patterson", ""), ("micro-jitter", "K=1"), ("micro-jitter", "K=2.5")])
        alone = self.succeeds(*COMPARE, "--k", "1", "--json").json["rows"]
        self.assertEqual([row for row in report["rows"] if "K=2.5" not in row["parameters"]], alone)
        text = self.succeeds(*COMPARE, "--k", "1,2.5").text
        self.assertIn("micro-jitter, K=1 s=2", text)
        self.assertIn("micro-jitter, K=2.5 s=2", text)

    def test_csv_and_json_hold_the_same_numbers(self):
        rows = self.succeeds(*COMPARE, "--spp", "16,64", "--json").json["rows"]
        lines = list(csv.DictReader(io.StringIO(self.succeeds(*COMPARE, "--spp", "16,64", "--csv").text)))
        self.assertEqual(len(lines), 6)
        for row, line in zip(rows, lines, strict=True):
            self.assertEqual((row["strategy"], str(row["spp"])), (line["strategy"], line["spp"]))
            self.assertEqual(row["totals"]["dram_sectors"], int(line["dram_sectors"]))
            self.assertEqual(row["l1_hit_rate"]["mean"], float(line["l1_hit_rate"]))

    def test_the_counters_of_a_profiler_are_those_of_the_json(self):
        trace = self.capture()
        totals = self.succeeds("replay", trace, *GPU, "--json").json["rows"][0]["totals"]
        text = self.succeeds("replay", trace, *GPU, "--counters", "ncu").text
        values = dict(line.split() for line in text.splitlines() if "__" in line and len(line.split()) == 2)
        self.assertEqual(int(values["l1tex__t_sectors_pipe_lsu_mem_global_op_ld.sum"]), totals["l1_requests"])
        self.assertEqual(int(values["dram__bytes_read.sum"]), 32 * totals["dram_sectors"])
        self.assertEqual(int(values["l1tex__t_requests_pipe_lsu_mem_global_op_ld.sum"]), totals["loads"])
        self.assertEqual(int(values["lts__t_sectors_srcunit_tex_op_read.sum"]), totals["l2_sectors"])
        requests = int(values["lts__t_requests_srcunit_tex_op_read.sum"])
        self.assertLess(totals["l2_sectors"] / 4, requests)  # at most the sectors of a line, at least one
        self.assertLess(requests, totals["l2_sectors"])
        self.assertIn(f"L2 sectors per read request  {totals['l2_sectors'] / requests:.2f}", " ".join(
            re.sub(" {2,}", "  ", line) for line in text.splitlines()))
        self.assertNotIn("per_second", text)
        self.assertGreater(totals["l1_requests"], totals["sectors"])
        self.assertEqual(self.succeeds(*COMPARE, "--counters", "ncu").text.count("dram__bytes_read.sum"), 3)
        self.refuses(2, "replay", trace, *GPU, "--counters", "nvprof", mentions=["--counters", "nvprof"])
        self.refuses(2, "replay", trace, "--gpu", "xeon-8380", "--counters", "ncu", mentions=["xeon-8380", "two levels"])

    def test_the_counters_of_a_profiler_come_in_every_format(self):
        trace = self.capture()
        counters = ["replay", trace, *GPU, "--counters", "ncu", "--by", "ray"]
        printed = self.succeeds(*counters, "--save", "ncu").text
        rows = self.succeeds(*counters, "--json").json["rows"]
        table = self.succeeds(*counters, "--csv").text
        self.assertEqual(self.path("ncu.txt").read_text("utf-8"), printed)
        self.assertEqual(json.loads(self.path("ncu.json").read_text("utf-8"))["rows"], rows)
        self.assertEqual(self.path("ncu.csv").read_text("utf-8"), table)
        lines = list(csv.DictReader(io.StringIO(table)))
        self.assertEqual([line["group"] for line in lines], ["camera", "bounce", "shadow"])
        for row, line in zip(rows, lines, strict=True):
            for name, value, unit in map(dict.values, row["metrics"]):
                self.assertEqual(value, float(line[name]), name)
                self.assertEqual(unit == "%", name.endswith(".pct"))
                self.assertIn(name, printed)
            self.assertEqual(row["group"], line["group"])

    def test_with_time_the_counters_of_a_profiler_have_rates_and_shares_of_peaks(self):
        trace = self.capture()
        timed = self.succeeds("replay", trace, *GPU, "--timed", "--json").json["rows"][0]
        counters = self.succeeds("replay", trace, *GPU, "--timed", "--counters", "ncu", "--json").json["rows"][0]
        metrics = {metric["name"]: metric["value"] for metric in counters["metrics"]}
        self.assertEqual(metrics["gpc__cycles_elapsed.max"], timed["cycles"])
        self.assertAlmostEqual(metrics["dram__bytes.sum.per_second"], 1e9 * timed["dram_gb_s"], delta=1)
        for name, use in (("gpu__dram", "dram"), ("lts__", "l2_slices"), ("l1tex__", "l1_port")):
            name = name.removesuffix("__") + ("_throughput" if name == "gpu__dram" else "__throughput")
            self.assertAlmostEqual(metrics[name + ".avg.pct_of_peak_sustained_elapsed"],
                                   100 * timed["utilisation"][use], places=6)
        self.assertAlmostEqual(metrics["l1tex__t_bytes_pipe_lsu_mem_global_op_ld.sum.per_second"],
                               32 * timed["traffic"]["totals"]["l1_requests"] / timed["seconds"], delta=10)
        self.refuses(2, "replay", trace, *GPU, "--timed", "--counters", "ncu", "--by", "ray")

    def test_stores_and_sorts_of_a_wavefront_have_names_of_their_own(self):
        wave = ["--strategy", "cranley-patterson+morton"]
        totals = self.succeeds(*COMPARE, *wave, "--json").json["rows"][0]["totals"]
        counters = self.succeeds(*COMPARE, *wave, "--counters", "ncu", "--json").json["rows"][0]["metrics"]
        metrics = {metric["name"]: metric["value"] for metric in counters}
        self.assertEqual(metrics["dram__bytes.sum"], 32 * totals["dram_sectors"])
        self.assertEqual(metrics["dram__bytes_write.sum"], 32 * totals["written_sectors"])
        self.assertEqual(metrics["dram__bytes_read.sum"],
                         32 * (totals["dram_sectors"] - totals["written_sectors"] - totals["sort_sectors"]))
        self.assertGreater(totals["sort_sectors"], 0)
        stores = {row["group"]: row["totals"] for row in
                  self.succeeds(*COMPARE, *wave, "--by", "object", "--json").json["rows"]}
        written = sum(stores[kind + " write"]["l2_sectors"] for kind in ("ray state", "hit", "queue"))
        self.assertEqual(metrics["lts__t_sectors_op_write.sum"], written)
        self.assertEqual(metrics["l1tex__m_l1tex2xbar_write_sectors_mem_lg_op_st.sum"], written)
        self.assertEqual(metrics["l1tex__m_xbar2l1tex_read_sectors_mem_lg_op_ld.sum"],
                         totals["l2_sectors"] - written - stores["sort"]["l2_sectors"])

    def test_a_changed_gpu_is_named_so_in_every_format(self):
        name = "gtx-980-ti (l1.ways=2, warps_per_sm=24)"
        changed = ["--strategy", "coherent", "--set", "l1.ways=2", "--warps-per-sm", "24"]
        for more in ([], ["--timed"], ["--counters", "ncu"]):
            with self.subTest(more):
                self.assertIn(name, self.succeeds(*COMPARE, *changed, *more).text)
                self.assertEqual(self.succeeds(*COMPARE, *changed, *more, "--json").json["rows"][0]["gpu"], name)
                line, = csv.DictReader(io.StringIO(self.succeeds(*COMPARE, *changed, *more, "--csv").text))
                self.assertEqual(line["gpu"], name)
        self.assertNotIn("(", self.succeeds(*COMPARE, "--strategy", "coherent", "--json").json["rows"][0]["gpu"])

    def test_a_gpu_without_timing_is_refused_before_the_scene_is_touched(self):
        preset = (ROOT / "cachesim/gpus/v100.toml").read_text()
        self.path("untimed.toml").write_text(preset[:preset.index("[timing]")])
        self.path("broken.glb").write_bytes(b"glTF and then no scene")
        for command in (["compare", "--scene", "broken.glb", "--timed"], ["sweep", "broken.glb"],
                        ["quality", "broken.glb"]):
            with self.subTest(command[0]):
                self.refuses(1, *command, "--gpu", "untimed.toml", mentions=["untimed.toml: ", "[timing]"])

    def test_a_processor_of_three_levels_adds_columns_and_a_factor(self):
        command = ["compare", "--scene", *SCENE, *LAUNCHES, "--gpu", "xeon-8380"]
        text = self.succeeds(*command, "--wide").text
        for title in ("L3 %", "L3->L2", "L3 loc."):
            self.assertIn(title, text)
        self.assertNotIn("L3", self.succeeds(*COMPARE).text)
        for row in self.succeeds(*command, *GPU, "--json").json["rows"]:
            totals = row["totals"]
            if row["gpu"] == "xeon-8380":
                self.assertEqual(totals["l2_sectors"], totals["l2_hits"] + totals["l3_sectors"])
                self.assertEqual(totals["l3_sectors"], totals["l3_hits"] + totals["dram_sectors"])
                self.assertLessEqual(row["active_lanes"]["mean"], 8)
            else:
                self.assertIsNone(row["l3_hit_rate"])

    def test_the_lines_of_the_table_are_as_wide_as_each_other_and_name_each_strategy(self):
        text = self.succeeds(*COMPARE).text
        for name in ("coherent", "cranley-patterson", "micro-jitter"):
            self.assertRegex(text, rf"(?m)^{name} ")
        self.assertNotIn("nan", text)

    def test_save_writes_three_files_and_still_prints_the_table(self):
        printed = self.succeeds(*COMPARE, "--save", "study").text
        self.assertEqual(self.listing(), ["study.csv", "study.json", "study.txt"])
        self.assertEqual(self.path("study.txt").read_text("utf-8"), printed)
        self.assertEqual(self.path("study.json").read_bytes(), self.succeeds(*COMPARE, "--json").stdout)
        self.assertEqual(self.path("study.csv").read_bytes(), self.succeeds(*COMPARE, "--csv").stdout)

    def test_the_ratios_are_no_different_with_a_gpu_beside(self):
        alone = self.succeeds(*COMPARE, "--json").json["rows"]
        both = self.succeeds(*COMPARE, "--gpu", "h100", "--json").json["rows"]
        self.assertEqual([row for row in both if row["gpu"] == "gtx-980-ti"], alone)

    def test_fewer_resident_warps_change_the_traffic_and_nothing_else(self):
        # Large enough for more warps than fit at once.
        command = ["compare", "--scene", *SCENE, *GPU, "--resolution", "256x192", "--trace-samples", "1",
                   "--bounces", "1", "--strategy", "random", "--json"]
        row, = self.succeeds(*command).json["rows"]
        few, = self.succeeds(*command, "--warps-per-sm", "1").json["rows"]
        self.assertEqual(few["totals"]["sectors"], row["totals"]["sectors"])
        self.assertNotEqual(few["totals"]["l1_hits"], row["totals"]["l1_hits"])

    def test_one_sample_index_has_no_interval_and_says_so(self):
        report = self.succeeds("compare", "--scene", *SCENE, *GPU, *PICTURE, "--trace-samples", "1", "--json").json
        self.assertIsNone(report["rows"][0]["dram_bytes_per_ray"]["half_width_95"])
        self.assertTrue(any("one sample index" in note for note in report["notes"]))

    def test_mu_above_one_is_clamped_with_a_warning_on_stderr_only(self):
        plain = self.succeeds(*COMPARE, "--strategy", "micro-jitter", "--mu", "1")
        clamped = self.warns(*COMPARE, "--strategy", "micro-jitter", "--mu", "1.5")
        self.assertEqual(len(clamped.stderr.splitlines()), 1)
        self.assertIn("1.5", clamped.stderr)
        self.assertEqual(clamped.stdout, plain.stdout)

    def test_mu_of_zero_is_the_coherent_strategy(self):
        zero, = self.succeeds(*COMPARE, "--strategy", "micro-jitter", "--mu", "0", "--json").json["rows"]
        coherent, = self.succeeds(*COMPARE, "--strategy", "coherent", "--json").json["rows"]
        self.assertEqual(zero["totals"], coherent["totals"])

    def test_progress_is_shown_on_a_terminal_only_and_wiped_at_the_end(self):
        ours, theirs = pty.openpty()
        command = [RAYCACHE, "compare", "--scene", *SCENE, *GPU, "--resolution", "256x256", "--trace-samples", "4"]
        process = subprocess.Popen(command, cwd=self.folder, stdout=subprocess.PIPE, stderr=theirs)
        os.close(theirs)
        shown = b""
        while True:
            try:
                chunk = os.read(ours, 65536)
            except OSError:  # Linux: the other end is closed
                break
            if not chunk:
                break
            shown += chunk
        table = process.communicate()[0]
        os.close(ours)
        self.assertEqual(process.returncode, 0)
        self.assertIn(b"rays/s", shown)
        self.assertTrue(shown.endswith(b"\r\x1b[K"), shown[-200:])
        self.assertNotIn(b"rays/s", table)
        self.assertEqual(self.succeeds(*command[1:]).stdout, table)


if __name__ == "__main__":
    main()
