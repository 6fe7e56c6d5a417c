#!/usr/bin/python3
"""raycache sensitivity: ranges of GPU files, speed-ups at their values, verdicts, and what it refuses."""
import csv
import io

from support import ROOT, SCENE, ProgramTest, main

SMALL = [*SCENE, "--resolution", "64x48", "--bounces", "1", "--spp", "32", "--windows", "3", "--varied-windows", "2"]
# An SM of four warps, three values with a range that matters, and one that no replay reads.
GPU = ROOT / "cachesim/gpus/rtx-3070.toml"
KEPT = ("dram_channels", "node_instructions")


class Sensitivity(ProgramTest):
    def gpu(self, name="card.toml", edit=lambda text: text):
        """rtx-3070 with two SMs, and ranges of few values."""
        lines = []
        for line in GPU.read_text().splitlines():
            if line.split(" = ")[0] not in KEPT:
                for mark in (", range = ", ", choices = "):
                    if mark in line:
                        line = line[:line.index(mark)] + " }"
            lines.append(line)
        text = "\n".join(lines) + "\n"
        for old, new in (("sms = { value = 46", "sms = { value = 2"),
                         ("max_warps_per_sm = { value = 48", "max_warps_per_sm = { value = 12"),
                         ("warps_per_cta = { value = 12", "warps_per_cta = { value = 4"),
                         ("dram_channels = { value = 16, source = \"", "dram_channels = { value = 16, choices = [4, 16], source = \""),
                         ("[rt_unit]\nwarps = { value = 16, source = \"", "[rt_unit]\nwarps = { value = 16, range = [4, 16], source = \"")):
            self.assertIn(old, text)
            text = text.replace(old, new)
        self.path(name).write_text(edit(text))
        return ["--gpu", name]

    def test_speed_ups_have_ranges_ranks_and_a_verdict_and_do_not_depend_on_threads(self):
        command = ["sensitivity", *SMALL, *self.gpu(), "--samples", "4"]
        report = self.succeeds(*command, "--threads", "2", "--json").json
        row, = report["sensitivities"]
        self.assertEqual((row["strategy"], row["baseline"]), ("micro-jitter", "cranley-patterson"))
        self.assertEqual(sorted(e["key"] for e in row["effects"]), ["timing.dram_channels", "timing.node_instructions"])
        self.assertEqual(row["unread"], ["rt_unit.warps"])
        swings = [e["swing"] for e in row["effects"]]
        self.assertEqual(swings, sorted(swings, reverse=True))
        instructions = next(e for e in row["effects"] if e["key"] == "timing.node_instructions")
        self.assertEqual(instructions["range"], ["59", "74"])
        self.assertEqual([p["values"][0]["value"] for p in instructions["points"]], ["59", "74"])
        self.assertEqual(len(row["hypercube"]), 4)
        spread = [q["speed_up_per_index"] for q in row["quantiles"]]
        self.assertEqual(spread, sorted(spread))
        means = [p["speed_up_per_index"]["mean"] for p in row["hypercube"]]
        self.assertEqual((min(means), max(means)), (spread[0], spread[-1]))
        self.assertIn(row["verdict_per_index"]["outcome"], ("faster", "slower", "not_known"))
        for point in row["hypercube"]:
            change = point["change"]["mean"]
            self.assertAlmostEqual(point["speed_up_per_ray"]["mean"], row["speed_up_per_ray"]["mean"] * change)

        other = self.succeeds(*command, "--threads", "1", "--csv")
        lines = list(csv.DictReader(io.StringIO(other.text)))
        self.assertEqual([line["kind"] for line in lines], ["file"] + 3 * ["one"] + 4 * ["hypercube"])
        self.assertEqual(float(lines[0]["speed_up_per_index"]), row["speed_up_per_index"]["mean"])
        self.assertEqual([float(line["speed_up_per_index"]) for line in lines[4:]], means)
        text = self.succeeds(*command, "--hypercube-seed", "2", "--sms", "1").text
        for words in ("per sample index", "per ray", "4 points of the hypercube", "Verdict", "scale model of 1 SM"):
            self.assertIn(words, " ".join(text.split()))

    def test_whole_launches_say_what_compare_says(self):
        launches = [*SCENE, "--resolution", "32x24", "--bounces", "1", "--spp", "32", "--trace-samples", "2"]
        row, = self.succeeds("sensitivity", *launches, *self.gpu(), "--samples", "0", "--json").json["sensitivities"]
        rows = self.succeeds("compare", *launches, *self.gpu(), "--strategy", "cranley-patterson,micro-jitter", "--timed",
                             "--json").json["rows"]
        self.assertAlmostEqual(row["speed_up_per_index"]["mean"], rows[1]["speed_up"]["mean"], places=12)
        self.assertEqual(row["hypercube"], [])

    def test_a_value_that_is_set_is_not_varied(self):
        launches = [*SCENE, "--resolution", "32x24", "--bounces", "1", "--spp", "32", "--trace-samples", "1"]
        row, = self.succeeds("sensitivity", *launches, *self.gpu(), "--samples", "1", "--set", "timing.node_instructions=70",
                             "--json").json["sensitivities"]
        self.assertEqual([e["key"] for e in row["effects"]], ["timing.dram_channels"])

    def test_presets_list_their_ranges(self):
        presets = {p["name"]: p for p in self.succeeds("list", "gpus", "--details", "--json").json["gpu_presets"]}
        found = presets["gtx-980-ti"]["timing"]["empty_request_cycles"]
        self.assertEqual((found["value"], found["range"]), (0, [0, 1]))
        self.assertEqual(presets["gtx-980-ti"]["l1"]["index"]["choices"], ["modulo", "xor_fold"])
        self.assertIn("may be 0 to 1: a pair", " ".join(self.succeeds("list", "gpus", "--details", "--wide").text.split()))

    def test_bad_ranges_and_settings_are_one_line(self):
        reversed_ends = self.gpu("bad.toml", lambda text: text.replace("range = [59, 74]", "range = [74, 59]"))
        self.refuses(1, "sensitivity", *SMALL, *reversed_ends, mentions=["bad.toml:", "timing.node_instructions.range", "swap"])
        outside = self.gpu("bad.toml", lambda text: text.replace("range = [59, 74]", "range = [63, 74]"))
        self.refuses(1, "sensitivity", *SMALL, *outside, mentions=["bad.toml:", "around the value, 62"])
        gpu = self.gpu()
        self.refuses(2, "sensitivity", *SMALL, *gpu, "--set", "l1.ways=64,128", mentions=["one value"])
        self.refuses(2, "sensitivity", *SMALL, *gpu, "--strategy", "micro-jitter", mentions=["baseline"])
        self.refuses(2, "sensitivity", *SMALL, *gpu, "--baseline", "coherent", mentions=["coherent"])
        self.refuses(2, "sensitivity", *SMALL[:-1], "9", *gpu, mentions=["varied"])
        self.refuses(2, "sensitivity", *SMALL, "--gpu", "xeon-8380", mentions=["not predicted"])


if __name__ == "__main__":
    main()
