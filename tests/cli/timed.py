#!/usr/bin/python3
"""Timed replays, --set, and the import of RTWARP01 traces, from outside."""
import csv
import os
import struct
import subprocess
import sys

from support import GPU_FILE, LAUNCHES, RAYCACHE, ROOT, SCENE, ProgramTest, main


def rtwarp(records, magic=b"RTWARP01", nodes=0x7F5000000000):
    """One warp of these (tag, mask, indices), as the bytes of a file."""
    body = b"".join(struct.pack("<BI%dI" % len(indices), tag, mask, *indices) for tag, mask, indices in records)
    head = struct.pack("<8sIIIIIIfIIIQQ", magic, 64, 1, 8, 4, 38, 64, 0.0, 1, 64, 48, nodes, 0x7F5000815000)
    return head + struct.pack("<II", len(records), len(body)) + body


class Timed(ProgramTest):
    def test_cycles_speed_up_and_bottleneck_are_printed(self):
        cp = self.capture("cp.rct", "--strategy", "cranley-patterson")
        coherent = self.capture("coherent.rct", "--strategy", "coherent")
        done = self.succeeds("compare", cp, coherent, "--gpu", "rtx-3070", "--timed")
        self.assertIn("speed-up", done.text)
        self.assertIn("bottleneck", done.text)
        rows = {row["strategy"]: row for row in
                self.succeeds("compare", cp, coherent, "--gpu", "rtx-3070", "--timed", "--json").json["rows"]}
        quotient = rows["cranley-patterson"]["cycles"] / rows["coherent"]["cycles"]
        self.assertAlmostEqual(rows["coherent"]["speed_up"]["mean"], quotient, places=9)
        self.assertEqual(rows["coherent"]["l2"]["requests"],
                         rows["coherent"]["l1"]["line_misses"] + rows["coherent"]["l1"]["sector_misses"])

    def test_threads_and_files_do_not_change_a_timed_report(self):
        trace = self.capture("trace.rct")
        one = self.succeeds("replay", trace, "--gpu", "v100", "--timed", "--json", "--threads", "1").text
        two = self.succeeds("replay", trace, "--gpu", "v100", "--timed", "--json", "--threads", "2").text
        self.assertEqual(one, two)

    def test_peak_memory_stays_below_300_mib_however_long_the_trace(self):
        peaks = {}
        for samples in (1, 6):
            trace = self.path(f"{samples}.rct")
            self.succeeds("capture", *SCENE, "--resolution", "128x128", "--trace-samples", samples, "--spp", "64", "-o", trace)
            for mode in ([], ["--timed"]):
                command = [RAYCACHE, "replay", str(trace), "--gpu", "rtx-3070", "--threads", "1", *mode]
                with subprocess.Popen(command, stdout=subprocess.DEVNULL) as process:
                    status, usage = os.wait4(process.pid, 0)[1:]
                    process.returncode = status
                self.assertEqual(status, 0)
                peaks[samples, *mode] = usage.ru_maxrss / 1024
        self.assertLess(max(peaks.values()), 300, peaks)
        self.assertLess(peaks[6, "--timed"], peaks[1, "--timed"] + 40, peaks)
        self.assertLess(peaks[6,], peaks[1,] + 40, peaks)

    def test_every_preset_can_be_timed_and_one_without_times_says_what_it_lacks(self):
        trace = self.capture("trace.rct", "--bounces", "0")
        names = [gpu["name"] for gpu in self.succeeds("list", "gpus", "--details", "--json").json["gpu_presets"]]
        self.assertGreaterEqual(len(names), 11)
        for name in names:
            row = self.succeeds("replay", trace, "--gpu", name, "--timed", "--json").json["rows"][0]
            if name.startswith("xeon"):
                self.assertIsNone(row["cycles"])
            else:
                self.assertGreater(row["cycles"], 0)
            for level in ("l1", "l2", "l3"):
                self.assertEqual(level in row, level != "l3" or name.startswith("xeon"), name)
        self.path("untimed.toml").write_text(GPU_FILE)
        self.refuses(1, "replay", trace, "--gpu", "./untimed.toml", "--timed", mentions=["[timing]"])

    def test_a_set_value_takes_the_place_of_the_presets(self):
        trace = self.capture("trace.rct")
        few = self.succeeds("replay", trace, "--gpu", "v100", "--set", "l1.ways=2", "--json").json["rows"][0]
        many = self.succeeds("replay", trace, "--gpu", "v100", "--json").json["rows"][0]
        self.assertGreater(few["totals"]["l2_sectors"], many["totals"]["l2_sectors"])
        for code, change, word in ((2, "l1.wys=2", "l1.wys"), (2, "l1.ways", "KEY=VALUE"), (2, "l1.ways=-1", "l1.ways"),
                                   (2, "l9.ways=4", "l9"),
                                   (2, "l1.policy=newest", "with --set: l1.policy: expected one of: fifo, lru"),
                                   (2, "l1.policy='lru", "KEY=VALUE"), (2, "l1.allocate=never", "on_fill")):
            self.refuses(code, "replay", trace, "--gpu", "v100", "--set", change, mentions=[word])

    def test_what_a_users_file_lacks_in_time_is_said_in_its_name(self):
        trace = self.capture("trace.rct", "--bounces", "0")
        preset = (ROOT / "cachesim/gpus/v100.toml").read_text()
        self.path("mine.toml").write_text(preset)
        self.succeeds("replay", trace, "--gpu", "mine.toml", "--timed")
        self.refuses(1, "replay", trace, "--gpu", "mine.toml", "--timed", "--set", "timing.accesses_in_flight=64",
                     mentions=["mine.toml: ", "(timing.accesses_in_flight=64)", "expected at most 64 for each"])
        self.refuses(1, "explain", "courtyard", "--gpu", "mine.toml", "--set",
                     "timing.accesses_in_flight=64", mentions=["mine.toml: ", "expected at most 64 for each"])
        self.path("mine.toml").write_text(preset[:preset.index("[timing]")])
        self.refuses(1, "replay", trace, "--gpu", "mine.toml", "--timed", mentions=["mine.toml: ", "[timing]"])

    def test_options_that_exclude_each_other_are_refused(self):
        trace = self.capture("trace.rct", "--bounces", "0")
        self.refuses(2, "replay", trace, "--gpu", "v100", "--timed", "--by", "bounce")


class NoTime(ProgramTest):
    """A GPU file with `not_predicted`: traffic, and no time in any report."""

    NOTE = "CPU time: not predicted for xeon-8380 ("
    OF_TIME = ("cycles", "seconds", "cycles_per_ray", "speed_up", "bottleneck", "busiest", "occupancy", "l2_gb_s", "dram_gb_s",
               "visit_latency")

    def traces(self):
        return (self.capture("cp.rct", "--strategy", "cranley-patterson"), self.capture("coherent.rct", "--strategy", "coherent"))

    def test_a_table_has_the_traffic_and_says_that_time_is_not_predicted_and_where_to_read_why(self):
        for command in (["compare", *self.traces()], ["replay", "cp.rct"], ["compare", "--scene", *SCENE, *LAUNCHES, "--spp", "64"]):
            with self.subTest(command[0]):
                options = [*command, "--gpu", "xeon-8380", "--timed"]
                text = self.succeeds(*options).text
                words = " ".join(text.split())
                self.assertEqual(words.count("note: " + self.NOTE), 1)
                self.assertIn("cachesim/MODEL.md", words)
                rows = self.succeeds(*options, "--json").json["rows"]
                self.assertGreaterEqual(len(rows), 1)
                for row in rows:  # cycles, ms, cycles/ray, speed-up, occupancy, bottleneck
                    self.assertRegex(text, rf"(?m)^{row['strategy']}( +64)?( +-){{6}}$")
                    self.assertIn(f" {row['dram_sectors']}\n", text)
                self.assertNotRegex(text, r"\bnan\b")
                self.assertNotIn("slots on average", words)

    def test_json_has_null_and_csv_nothing_where_a_time_would_stand_and_other_gpus_keep_theirs(self):
        command = ["compare", *self.traces(), "--gpu", "rtx-3070,xeon-8380", "--timed"]
        report = self.succeeds(*command, "--json").json
        self.assertEqual(sum(self.NOTE in note for note in report["notes"]), 1)
        for row in report["rows"]:
            cpu = row["gpu"] == "xeon-8380"
            for key in self.OF_TIME:
                if key != "speed_up" or row["strategy"] == "coherent":
                    self.assertEqual(row[key] is None, cpu, key)
            for value in row["utilisation"].values():
                self.assertEqual(value is None, cpu)
            for key in ("rays", "warp_accesses", "dram_sectors"):
                self.assertGreater(row[key], 0)
            self.assertGreater(row["l1"]["requests"], row["l1"]["hits"])
        rows = list(csv.DictReader(self.succeeds(*command, "--csv").text.splitlines()))
        self.assertEqual(len(rows), 4)
        for row in rows:
            for key in self.OF_TIME + ("issue", "l1_port", "dram", "l2_mshrs"):
                if key != "speed_up" or row["strategy"] == "coherent":
                    self.assertEqual(row[key] == "", row["gpu"] == "xeon-8380", key)
            self.assertGreater(int(row["dram_sectors"]), 0)

    def test_explain_has_the_traffic_and_no_replays_in_time(self):
        command = ["explain", *self.traces(), "--gpu", "xeon-8380"]
        text = self.succeeds(*command).text
        self.assertIn(self.NOTE, " ".join(text.split()))
        self.assertNotIn("perfect L1", text)
        report = self.succeeds(*command, "--json").json
        self.assertIsNone(report["timed"])
        self.assertIn(self.NOTE, report["time_sentence"])
        self.assertNotIn("not predicted", self.succeeds(*command, "--counts-only").text)

    def test_quality_and_sweep_have_the_pictures_errors_and_no_speed_up(self):
        common = [*SCENE, "--resolution", "32x32", "--spp", "8", "--reference-spp", "16", "--reference", "reference.exr",
                  "--gpu", "xeon-8380"]
        cases = {"quality": ["--strategy", "cranley-patterson,micro-jitter"], "sweep": ["--mu", "0,1", "--strategy", "random"]}
        for command, options in cases.items():
            with self.subTest(command):
                text = self.succeeds(command, *common, *options).text
                self.assertIn("note: " + self.NOTE, " ".join(text.split()))
                self.assertNotRegex(text, r"\bnan\b|speed [0-9]|predicted [0-9]|predicted for xeon-8380,")
                report = self.succeeds(command, *common, *options, "--json").json
                self.assertTrue(any(self.NOTE in note for note in report["notes"]))
                for row in report["rows"]:
                    self.assertIsNone(row["predicted_seconds"])
                    self.assertIsNone(row["speed_up"])
                    self.assertGreater(row["rmse"]["value"], 0)
                for row in csv.DictReader(self.succeeds(command, *common, *options, "--csv").text.splitlines()):
                    self.assertEqual((row["predicted_seconds"], row["speed_up"]), ("", ""))
        self.succeeds("quality", *common, *cases["quality"], "-o", "pictures")
        self.path("sweep.json").write_bytes(self.succeeds("sweep", *common, *cases["sweep"], "--json").stdout)
        plot = subprocess.run([sys.executable, ROOT / "tools/plot_sweep", "sweep.json", "-o", "sweep.png"], cwd=self.folder,
                              capture_output=True, timeout=300, check=False)
        self.assertEqual(plot.returncode, 1)
        self.assertIn(b"not predicted", plot.stderr)

    def test_the_file_decides_not_the_name_and_an_empty_reason_gives_times(self):
        trace = self.capture("trace.rct")
        gpu = (ROOT / "cachesim/gpus/v100.toml").read_text()
        self.path("mine.toml").write_text(gpu.replace("[timing]\n", "[timing]\nnot_predicted = \"clock unknown\"\n"))
        text = " ".join(self.succeeds("replay", trace, "--gpu", "mine.toml", "--timed").text.split())
        self.assertIn("note: time: not predicted for v100 (clock unknown; see cachesim/MODEL.md)", text)
        for gpu, change in (("mine.toml", "timing.not_predicted=''"), ("xeon-8380", 'timing.not_predicted=""')):
            row = self.succeeds("replay", trace, "--gpu", gpu, "--timed", "--json", "--set", change).json["rows"][0]
            self.assertGreater(row["cycles"], 0)
        self.refuses(2, "replay", trace, "--gpu", "mine.toml", "--timed", "--set", "timing.not_predicted=1",
                     mentions=["timing.not_predicted", "text"])


class Rtwarp(ProgramTest):
    def test_an_imported_trace_counts_what_the_file_says(self):
        self.path("t.rtw").write_bytes(rtwarp([(0x80, 0xF, []), (0, 0xF, [0, 0, 1, 2]), (0x40, 0x3, [5, 6]),
                                              (0x84, 0x1, []), (4, 0x1, [7])]))
        self.succeeds("import", "t.rtw", "-o", "t.rct")
        totals = self.succeeds("replay", "t.rct", "--gpu", "v100", "--json").json["rows"][0]["totals"]
        self.assertEqual((totals["rays"], totals["lane_accesses"], totals["warp_accesses"]), (5, 7, 3))

    def test_bad_files_end_in_one_line_and_leave_nothing(self):
        whole = rtwarp([(0, 0xF, [0, 0, 1, 2])])
        bad = {"truncated": whole[:-3], "no magic": rtwarp([], b"RTWARP01")[:70], "empty mask": rtwarp([(0, 0, [])]),
               "large index": rtwarp([(0, 1, [0xFFFFFFFF])]), "broken zstd": bytes.fromhex("28b52ffd") + b"\xff" * 40}
        for content in bad.values():
            self.path("bad.rtw").write_bytes(content)
            self.refuses(1, "import", "bad.rtw", "-o", "bad.rct", mentions=["bad.rtw"])

    def test_objects_beyond_the_addresses_of_a_trace_are_refused_in_the_files_own_name(self):
        for nodes in (1 << 48, (1 << 64) - (1 << 21), (1 << 64) - 64):
            self.path("far.rtw").write_bytes(rtwarp([(0, 0x3, [0, 1])], nodes=nodes))
            self.refuses(1, "import", "far.rtw", "-o", "far.rct",
                         mentions=["far.rtw: offset", "below address 2^48", f"{nodes:#x}"])
        for index in ((1 << 30) - 1, (1 << 30) - 2):  # the second is none too many, but the file's base moves it
            self.path("many.rtw").write_bytes(rtwarp([(0x40, 0x1, [index])]))
            self.refuses(1, "import", "many.rtw", "-o", "many.rct", mentions=["many.rtw: offset", str(index)])


if __name__ == "__main__":
    main()
