#!/usr/bin/python3
"""capture, info, verify, replay and compare on trace files, and the same without files."""
import signal
import subprocess
import time

from support import GPU, LAUNCHES, PICTURE, RAYCACHE, SCENE, ProgramTest, main

FORMATS = ([], ["--json"], ["--csv"])


class Traces(ProgramTest):
    def test_a_capture_writes_one_file_and_prints_nothing(self):
        result = self.succeeds("capture", *SCENE, *LAUNCHES, "-o", "trace.rct")
        self.assertEqual(result.stdout, b"")
        self.assertEqual(self.listing(), ["trace.rct"])

    def test_info_tells_the_settings_that_the_capture_was_given(self):
        trace = self.capture("trace.rct", "--strategy", "micro-jitter", "--sequence", "halton", "--bounces", "2",
                             "--seed", "7")
        info = self.succeeds("info", trace, "--json").json
        made, = info["traces"]
        for key, value in (("file", str(trace)), ("strategy", "micro-jitter"), ("sequence", "halton"), ("spp", 64),
                           ("seed", 7), ("k", 2.5), ("s", 2), ("mu", 0.3125), ("resolution", "64x48"), ("bounces", 2),
                           ("thread_map", "tile"), ("layout", "bvh2"), ("execution", "megakernel"), ("order", "none")):
            self.assertEqual(made[key], value, key)
        self.assertIn("courtyard", made["scene"])
        self.assertEqual(len(made["samples"]), 2)
        self.assertEqual(info["file_bytes"], trace.stat().st_size)
        self.assertEqual(info["traces"][0]["warps_per_launch"], 64 * 48 // 32)
        # Every pixel of both samples starts a camera ray; a hit starts a shadow ray or a bounce ray.
        self.assertGreater(info["rays"], 2 * 64 * 48)
        self.assertGreater(info["lane_accesses"], info["rays"])
        self.assertAlmostEqual(info["bytes_per_ray"], info["file_bytes"] / info["rays"])
        self.assertIn("micro-jitter", self.succeeds("info", trace).text)

    def test_the_command_that_info_shows_makes_the_same_trace_again(self):
        trace = self.capture("trace.rct", "--strategy", "micro-jitter", "--bounces", "1", "--k", "1.5")
        command = self.succeeds("info", trace, "--json").json["traces"][0]["command_line"].split()
        self.assertEqual(command[:2], ["raycache", "capture"])
        self.succeeds(*command[1:], "-o", "again.rct")
        self.assertEqual(self.path("again.rct").read_bytes(), trace.read_bytes())

    def test_verify_counts_the_same_rays_as_info(self):
        trace = self.capture()
        whole = self.succeeds("verify", trace, "--json").json
        info = self.succeeds("info", trace, "--json").json
        for key in ("rays", "records", "lane_accesses", "blocks"):
            self.assertEqual(whole[key], info[key], key)
        self.assertEqual(whole["warps"], 2 * info["traces"][0]["warps_per_launch"])
        self.assertIn("whole", self.succeeds("verify", trace).text)

    def test_replay_counts_the_rays_and_lane_accesses_of_the_trace(self):
        trace = self.capture()
        info = self.succeeds("info", trace, "--json").json
        for gpu in ("gtx-980-ti", "h100"):
            row, = self.succeeds("replay", trace, "--gpu", gpu, "--json").json["rows"]
            self.assertEqual(row["totals"]["rays"], info["rays"])
            self.assertEqual(row["totals"]["lane_accesses"], info["lane_accesses"])
            self.assertEqual(row["samples"], info["traces"][0]["samples"])
            self.assertEqual(row["gpu"], gpu)

    def test_compare_of_files_puts_the_replays_side_by_side(self):
        names = ["coherent", "cranley-patterson", "micro-jitter"]
        traces = [self.capture(name + ".rct", "--strategy", name) for name in names]
        rows = self.succeeds("compare", *traces, *GPU, "--json").json["rows"]
        self.assertEqual([row["strategy"] for row in rows], names)
        for trace, row in zip(traces, rows):
            alone, = self.succeeds("replay", trace, *GPU, "--json").json["rows"]
            self.assertEqual(row["totals"], alone["totals"])

    def test_without_files_the_reports_are_the_same_as_with_files(self):
        names = ["cranley-patterson", "micro-jitter"]
        traces = [self.capture(name + ".rct", "--strategy", name) for name in names]
        gpus = ["--gpu", "gtx-980-ti", "--gpu", "h100", "--by", "bounce"]
        for form in FORMATS:
            with self.subTest(form):
                files = self.succeeds("compare", *traces, *gpus, *form)
                fused = self.succeeds("compare", "--scene", *SCENE, *LAUNCHES, "--spp", "64", "--strategy",
                                      ",".join(names), *gpus, *form)
                if form == ["--json"]:
                    self.assertEqual(fused.report, files.report)
                else:
                    self.assertEqual(fused.stdout, files.stdout)

    def test_one_thread_and_two_give_the_same_trace_and_the_same_reports(self):
        one = self.capture("one.rct", "--threads", "1")
        two = self.capture("two.rct", "--threads", "2")
        self.assertEqual(one.read_bytes(), two.read_bytes())
        for form in FORMATS:
            reports = {self.succeeds("replay", one, *GPU, *form, "--threads", threads).stdout for threads in (1, 2)}
            self.assertEqual(len(reports), 1, form)
            fused = {self.succeeds("compare", "--scene", *SCENE, *LAUNCHES, *GPU, *form, "--threads", threads).stdout
                     for threads in (1, 2)}
            self.assertEqual(len(fused), 1, form)

    def test_the_same_command_twice_gives_the_same_bytes(self):
        first, second = self.capture("first.rct"), self.capture("second.rct")
        self.assertEqual(first.read_bytes(), second.read_bytes())
        for form in FORMATS:
            reports = {self.succeeds("replay", first, *GPU, *form).stdout for _ in range(2)}
            self.assertEqual(len(reports), 1, form)

    def test_the_seed_changes_the_trace(self):
        self.assertNotEqual(self.capture("1.rct", "--seed", "1").read_bytes(),
                            self.capture("2.rct", "--seed", "2").read_bytes())

    def test_every_strategy_traces_the_same_sample_indices(self):
        rows = self.warns("compare", "--scene", *SCENE, *LAUNCHES, "--spp", "1000", "--strategy",
                          "coherent,cranley-patterson,micro-jitter", *GPU, "--json").json["rows"]
        self.assertEqual(len({tuple(row["samples"]) for row in rows}), 1)
        self.assertTrue(all(0 <= i < 1000 for i in rows[0]["samples"]))

    def test_no_more_samples_are_traced_than_there_are(self):
        for spp, wanted in ((1, 8), (4, 5)):
            row, = self.warns("compare", "--scene", *SCENE, *PICTURE, *GPU, "--strategy", "cranley-patterson", "--spp", spp,
                              "--trace-samples", wanted, "--json").json["rows"]
            self.assertEqual(row["samples"], list(range(spp)))

    def test_micro_jitter_of_one_sample_is_cranley_patterson_in_its_spread(self):
        # N = 1 gives mu = 1: the jitter covers the whole interval, so both are uniform rotations.
        rows = self.warns("compare", "--scene", *SCENE, "--resolution", "256x192", "--spp", "1", "--trace-samples", "1",
                          "--strategy", "cranley-patterson,micro-jitter", *GPU, "--json").json["rows"]
        rotation, jitter = (row["steps_per_ray"]["mean"] for row in rows)
        self.assertAlmostEqual(jitter / rotation, 1, delta=0.03)

    def test_a_killed_capture_leaves_no_file_under_the_final_name(self):
        process = subprocess.Popen([RAYCACHE, "capture", *SCENE, "--resolution", "2048x2048", "-o", "trace.rct"],
                                   cwd=self.folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        deadline = time.monotonic() + 120
        while not self.listing() and time.monotonic() < deadline and process.poll() is None:
            time.sleep(0.01)
        time.sleep(0.1)
        process.send_signal(signal.SIGKILL)
        process.communicate()
        self.assertEqual(process.returncode, -signal.SIGKILL, "it ended before it was killed")
        left, = self.listing()
        self.assertRegex(left, r"\Atrace\.rct\.\d+-[0-9a-f]{8}\.partial\Z")
        warned = self.warns("capture", *SCENE, *LAUNCHES, "-o", "trace.rct")
        self.assertRegex(warned.stderr, f"(?m)^raycache: warning: {left}: .*--recover")
        self.assertEqual(self.listing(), ["trace.rct", left])


if __name__ == "__main__":
    main()
