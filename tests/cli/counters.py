#!/usr/bin/python3
"""raycache counters: a profile of Nsight Compute, which the test makes, beside the replay of a trace."""
import csv
import io
import json
import subprocess
import sys

from support import GPU, ROOT, ProgramTest, main

HEAD = ["ID", "Process ID", "Process Name", "Host Name", "Kernel Name", "Context", "Stream", "Device", "CC"]
RATE = "l1tex__t_sector_hit_rate.pct"
READ = "dram__bytes_read.sum"
SECTORS = "l1tex__t_sectors_pipe_lsu_mem_global_op_ld.sum"


def lines(rows):
    text = io.StringIO()
    csv.writer(text, quoting=csv.QUOTE_ALL, lineterminator="\n").writerows(rows)
    return text.getvalue()


def launch(number, kernel):
    return [str(number), "77", "renderer", "127.0.0.1", kernel, "1", "7", "0", "8.6"]


class Counters(ProgramTest):
    MADE = {}  # once for all tests: the trace, and what it is modelled as

    def setUp(self):
        super().setUp()
        self.trace = self.path("trace.rct")
        if not self.MADE:
            self.MADE["trace"] = self.capture().read_bytes()
            ones = [[str(launch), "1", "1", "1"] for launch in (0, 1)]
            probe = self.write(lines([["ID", READ, RATE, SECTORS], ["", "byte", "%", "sector"], *ones]))
            metrics = self.metrics(probe).items()
            self.MADE["launches"] = [{name: metric["values"][i]["modelled"] for name, metric in metrics} for i in (0, 1)]
        self.trace.write_bytes(self.MADE["trace"])
        self.first, self.second = self.MADE["launches"]

    def write(self, text, name="profile.csv"):
        self.path(name).write_text(text, "utf-8")
        return name

    def wide(self, values, kernels=("trace", "trace"), units=("Mbyte", "%", "sector")):
        """`values`: of each launch READ in units[0], RATE, SECTORS."""
        rows = [HEAD + [READ, RATE, SECTORS, "sm__sass_thread_inst_executed_op_fadd_pred_on.sum", "launch__grid_size"],
                [""] * len(HEAD) + [*units, "inst", ""]]
        for i, (kernel, value) in enumerate(zip(kernels, values, strict=True)):
            rows.append(launch(i, kernel) + [*value, "1,024", "64"])
        return self.write('==PROF== Connected to process 77\n==PROF== Profiling "trace": 0%....100% - 4 passes\n' + lines(rows))

    def compare(self, profile, *more):
        return self.succeeds("counters", self.trace, *GPU, "--against", profile, *more)

    def metrics(self, profile, *more):
        return {metric["name"]: metric for metric in self.compare(profile, "--json", *more).json["metrics"]}

    def test_launches_are_laid_side_by_side_with_mean_and_worst_difference(self):
        profile = self.wide([[f"{self.first[READ] / 2e6:.6f}", f"{self.first[RATE] - 3:.6f}", f"{self.first[SECTORS]:,.0f}"],
                             [f"{self.second[READ] / 1e6:.6f}", "10", f"{self.second[SECTORS] * 2:,.0f}"]])
        metrics = self.metrics(profile)
        self.assertEqual(set(metrics), {READ, RATE, SECTORS})
        read, rate, sectors = metrics[READ], metrics[RATE], metrics[SECTORS]
        totals = self.succeeds("replay", self.trace, *GPU, "--json").json["rows"][0]["totals"]
        self.assertEqual(sum(v["modelled"] for v in read["values"]), 32 * totals["dram_sectors"])
        self.assertEqual(sum(v["modelled"] for v in sectors["values"]), totals["l1_requests"])
        self.assertNotEqual(self.first[READ], self.second[READ])
        self.assertAlmostEqual(read["values"][0]["difference"], 1, places=4)
        self.assertAlmostEqual(read["mean_difference"], 0.5, places=4)
        self.assertEqual((read["worst_launch"], sectors["worst_launch"]), (0, 1))
        self.assertAlmostEqual(rate["values"][0]["difference"], 3, places=4)
        self.assertEqual(rate["difference_in"], "points")
        self.assertEqual([v["difference"] for v in sectors["values"]], [0, -0.5])
        report = self.compare(profile, "--json").json
        self.assertEqual(report["not_modelled"], ["sm__sass_thread_inst_executed_op_fadd_pred_on.sum"])
        self.assertIn("lts__t_requests_srcunit_tex_op_read.sum", report["not_measured"])
        self.assertEqual([one["id"] for one in report["launches"]], ["0", "1"])
        text = self.compare(profile).text
        self.assertIn("+100.0 %", text)
        self.assertIn("mean difference 50.0 %, worst +100.0 % in launch 0", text)
        flat = " ".join(text.split())
        self.assertIn("Not modelled: sm__sass_thread_inst_executed_op_fadd_pred_on.sum.", flat)
        self.assertIn("Traversal in RT cores", flat)
        table = list(csv.DictReader(io.StringIO(self.compare(profile, "--csv").text)))
        self.assertEqual(len(table), 6)
        self.assertEqual([float(row["difference"]) for row in table if row["metric"] == SECTORS], [0, -0.5])

    def test_both_forms_say_the_same(self):
        wide = self.metrics(self.wide([["1.5", "50", "1,000"], ["2", "60", "2,000"]]))
        rows = [HEAD + ["Section Name", "Metric Name", "Metric Unit", "Metric Value"]]
        for i, (read, rate, sectors) in enumerate([("1,500", "50", "1,000"), ("2,000", "60", "2,000")]):
            rows += [launch(i, "trace") + ["Command line profiler metrics", *one] for one in (
                [READ, "Kbyte", read], ["L1/TEX Hit Rate", "%", rate], [SECTORS, "sector", sectors], ["", "", ""])]
        self.assertEqual(self.metrics(self.write("IDs of the scene\n" + lines(rows), "long.csv")), wide)

    def test_what_needs_time_is_named_without_it_and_compared_with_it(self):
        name = "gpu__time_duration.sum"
        rows = [["ID", "Kernel Name", name, RATE], ["", "", "us", "%"], ["0", "trace", "10", "50"]]
        profile = self.write(lines(rows))
        report = self.compare(profile, "--json").json
        self.assertEqual([metric["name"] for metric in report["metrics"]], [RATE])
        self.assertTrue(any("--timed only: " + name in note for note in report["notes"]), report["notes"])
        self.assertTrue(any("1 of the 2 launches" in note for note in report["notes"]), report["notes"])
        timed = self.metrics(profile, "--timed")[name]
        self.assertEqual(timed["values"][0]["measured"], 10000)
        self.assertGreater(timed["values"][0]["modelled"], 0)

    def test_sectors_per_request_to_l2_are_divided_here(self):
        part, whole = "lts__t_sectors_srcunit_tex_op_read.sum", "lts__t_requests_srcunit_tex.sum"
        profile = self.write(lines([["ID", part, whole], ["", "sector", "request"], ["0", "300", "200"]]))
        metric = self.metrics(profile)["L2 sectors per read request"]
        self.assertEqual(metric["values"][0]["measured"], 1.5)
        self.assertGreaterEqual(metric["values"][0]["modelled"], 1)
        self.assertLess(metric["values"][0]["modelled"], 4)

    def test_a_kernel_is_chosen_by_a_part_of_its_name(self):
        kernels = ("void trace<float>()", "shade", "trace_b")
        values = [["1", "10", "1"], ["2", "20", "2"], ["3", "30", "3"]]
        profile = self.wide(values, kernels)
        rate = self.metrics(profile, "--kernel", "trace")[RATE]
        self.assertEqual([v["measured"] for v in rate["values"]], [10, 30])
        line = self.refuses(1, "counters", self.trace, *GPU, "--against", profile, mentions=["3 launches", "at most 2", "--kernel"])
        self.assertIn("profile.csv", line)
        self.refuses(2, "counters", self.trace, *GPU, "--against", profile, "--kernel", "none", mentions=["'none'", "void trace"])
        optix = self.wide(values[:1], ("raygen_mega",))
        self.assertIn("ray-tracing pipeline", " ".join(self.compare(optix).text.split()))

    def test_the_threads_do_not_change_a_byte(self):
        profile = self.wide([["1", "10", "1"], ["2", "20", "2"]])
        self.assertEqual(self.compare(profile, "--threads", "1").stdout, self.compare(profile, "--threads", "3").stdout)

    def test_what_cannot_be_compared_is_refused_in_one_line(self):
        def refused(text, *mentions, code=1):
            self.refuses(code, "counters", self.trace, *GPU, "--against", self.write(text), mentions=["profile.csv", *mentions])

        refused("", "empty", "ncu --csv")
        refused("Time (%),Total Time (ns),Name\n1,2,trace\n", "titles", '"ID"')
        refused("NVR\0\1", "binary", "--import")
        refused('"ID","' + RATE + '"\n"","%"\n"0","5', "line 3", "quote")
        refused(lines([["ID", "Kernel Name", "sm__cycles_active.avg"], ["", "", "cycle"], ["0", "k", "5"]]), "none of its metrics")
        refused(lines([["ID", RATE], ["", "%"], ["0", "many"]]), "line 3", RATE, "'many'")
        refused(lines([["ID", READ], ["", "furlong"], ["0", "3"]]), READ, "'furlong'", "--print-units base")
        refused(lines([["ID", READ], ["", "byte"], ["0"]]), "line 3: expected 2 fields")
        self.refuses(1, "counters", self.trace, *GPU, "--against", "nowhere.csv", mentions=["nowhere.csv"])
        self.refuses(2, "counters", self.trace, *GPU)
        profile = self.wide([["1", "10", "1"], ["2", "20", "2"]])
        self.refuses(2, "counters", self.trace, "--gpu", "xeon-8380", "--against", profile, mentions=["xeon-8380", "two levels"])
        self.refuses(2, "counters", self.trace, *GPU, "--against", profile, "--json", "--csv")
        self.refuses(1, "counters", "nowhere.rct", *GPU, "--against", profile, mentions=["nowhere.rct"])
        self.capture("wave.rct", "--execution", "wavefront")
        self.refuses(2, "counters", "wave.rct", *GPU, "--against", profile, mentions=["wave.rct", "wavefront", "--counters ncu"])

    def test_the_plot_is_a_picture_of_the_json_and_of_nothing_else(self):
        profile = self.wide([["1", "10", "1,000"], ["2", "20", "2,000"]])
        self.path("c.json").write_text(self.compare(profile, "--json").text, "utf-8")
        plot = [sys.executable, str(ROOT / "tools/plot_counters"), "c.json", "-o"]
        for name in ("a.png", "b.png"):
            subprocess.run([*plot, name], cwd=self.folder, check=True)
        picture = self.path("a.png").read_bytes()
        self.assertEqual(picture[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(picture, self.path("b.png").read_bytes())
        self.path("c.json").write_text(json.dumps({"schema_version": 1, "command": "sweep"}), "utf-8")
        done = subprocess.run([*plot, "c.png"], cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, len(done.stderr.splitlines()), self.path("c.png").exists()), (1, 1, False))
        self.assertIn("raycache counters --json", done.stderr)


if __name__ == "__main__":
    main()
