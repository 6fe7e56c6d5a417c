#!/usr/bin/python3
"""raycache measure: which rows it prints and what it refuses. Speed is the machine's, and not tested."""
import csv
import io

from support import SCENE, ProgramTest, main

SMALL = ["measure", *SCENE, "--resolution", "32x24", "--trace-samples", "2", "--repeats", "1", "--strategy",
         "cranley-patterson,micro-jitter"]


class Measure(ProgramTest):
    def test_text_json_and_csv_have_the_same_rows_and_counts_of_rays_that_do_not_change(self):
        asked = [*SMALL, "--modes", "single,packet4-coherent", "--by", "ray"]
        document = self.warns(*asked, "--threads", "1", "--json").json
        rows = document["rows"]
        self.assertEqual(len(rows), 3 * 2 * 2 * 4)  # strategies and control, modes, orders, groups
        self.assertEqual({row["group"] for row in rows}, {"all", "camera", "bounce", "shadow"})
        for row in rows:
            self.assertEqual(len(row["rays"]), 2)
            self.assertEqual(row["other_ends"], 0)
            self.assertGreater(row["mrays_per_second"]["mean"], 0)
            is_base = row["strategy"] == "cranley-patterson" and not row["control"]
            self.assertEqual(row["speed_up"] is None, is_base)
        camera = next(row for row in rows if row["group"] == "camera")
        self.assertEqual(camera["rays"], [32 * 24] * 2)
        machine = document["machine"]
        for key in ("cpu", "threads", "governor", "embree", "isa", "packet_widths", "counters"):
            self.assertIn(key, machine)
        table = list(csv.DictReader(io.StringIO(self.warns(*asked, "--threads", "2", "--csv").text)))
        self.assertEqual([(r["strategy"], r["mode"], r["order"], r["group"], int(float(r["rays"]))) for r in table],
                         [(r["strategy"], r["mode"], r["order"], r["group"], sum(r["rays"])) for r in rows])
        text = self.warns(*asked).text
        self.assertLessEqual(max(map(len, text.splitlines())), 100)
        for word in (machine["isa"], machine["embree"], "control (seed 2)", "packet4-coherent"):
            self.assertIn(word, text)

    def test_the_rays_are_those_that_a_capture_of_the_same_settings_counts(self):
        shown = ["--resolution", "32x24", "--trace-samples", "2"]
        trace = self.path("mj.rct")
        self.warns("capture", *SCENE, *shown, "--strategy", "micro-jitter", "-o", trace)
        counted = self.succeeds("info", trace, "--json").json["rays"]
        rows = self.warns(*SMALL, "--modes", "single", "--no-shuffled", "--json").json["rows"]
        self.assertEqual([sum(r["rays"]) for r in rows if r["strategy"] == "micro-jitter"],
                         [counted if isinstance(counted, int) else sum(counted.values())])

    def test_one_sample_index_has_no_interval_and_says_so(self):
        result = self.warns(*SMALL[:-2], "--spp", "1", "--no-shuffled", "--strategy", "cranley-patterson", "--modes", "single",
                            "--json")
        self.assertIsNone(result.json["rows"][0]["ns_per_ray"]["half_width_95"])
        self.assertIn("one sample index", " ".join(result.json["notes"]))

    def test_what_makes_no_sense_is_refused_in_one_line(self):
        self.refuses(2, *SMALL, "--modes", "packet5", mentions=["packet5", "single"])
        self.refuses(2, *SMALL, "--spp", "0", mentions=["--spp"])
        self.refuses(2, *SMALL, "--repeats", "0", mentions=["--repeats"])
        self.refuses(2, *SMALL, "--baseline", "owen", mentions=["owen", "--strategy"])
        self.refuses(2, *SMALL, "--json", "--csv", mentions=["--json"])
        self.refuses(2, "measure", mentions=["SCENE"])
        self.refuses(2, "measure", "none.glb", mentions=["none.glb"])
        self.refuses(2, "measure", *SCENE, "--strategy", "cranley-patterson+morton", mentions=["cranley-patterson+morton"])
        self.refuses(2, "measure", "--preset", *SCENE, mentions=["--preset alone"])
        self.refuses(2, "measure", "--preset", "--json", mentions=["--json"])
        self.refuses(2, *SMALL, "-o", "cpu.toml", mentions=["--preset"])
        self.refuses(1, "measure", "--preset", "-o", "no folder/cpu.toml", mentions=["no folder"])


if __name__ == "__main__":
    main()
