#!/usr/bin/python3
"""Timed replays, --set, and the import of RTWARP01 traces, from outside."""
import os
import struct
import subprocess

from support import GPU_FILE, RAYCACHE, ROOT, SCENE, ProgramTest, main


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
        for code, change, word in ((1, "l1.wys=2", "l1.wys"), (2, "l1.ways", "KEY=VALUE"), (1, "l1.ways=-1", "l1.ways"),
                                   (2, "l9.ways=4", "l9"),
                                   (1, "l1.policy=newest", "with --set: l1.policy: expected one of: fifo, lru"),
                                   (2, "l1.policy='lru", "KEY=VALUE"), (1, "l1.allocate=never", "on_fill")):
            self.refuses(code, "replay", trace, "--gpu", "v100", "--set", change, mentions=[word])

    def test_what_a_users_file_lacks_in_time_is_said_in_its_name(self):
        trace = self.capture("trace.rct", "--bounces", "0")
        preset = (ROOT / "cachesim/gpus/v100.toml").read_text()
        self.path("mine.toml").write_text(preset)
        self.succeeds("replay", trace, "--gpu", "mine.toml", "--timed")
        self.refuses(1, "replay", trace, "--gpu", "mine.toml", "--timed", "--set", "timing.accesses_in_flight=64",
                     mentions=["mine.toml: ", "(timing.accesses_in_flight=64)", "expected at most 64 for each"])
        self.refuses(1, "explain", "--scene", "missing.glb", "--gpu", "mine.toml", "--set",
                     "timing.accesses_in_flight=64", mentions=["mine.toml: ", "expected at most 64 for each"])
        self.path("mine.toml").write_text(preset[:preset.index("[timing]")])
        self.refuses(1, "replay", trace, "--gpu", "mine.toml", "--timed", mentions=["mine.toml: ", "[timing]"])

    def test_options_that_exclude_each_other_are_refused(self):
        trace = self.capture("trace.rct", "--bounces", "0")
        self.refuses(2, "replay", trace, "--gpu", "v100", "--timed", "--by", "bounce")
        self.refuses(2, "replay", trace, "--gpu", "v100", "--timed", "--counters", "ncu")


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
