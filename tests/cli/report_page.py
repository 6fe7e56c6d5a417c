#!/usr/bin/python3
"""tools/report.py: the page made of the JSON of compare, with and without times, quality and certainty."""
import html
import json
import re
import subprocess

from support import GPU, LAUNCHES, ROOT, SCENE, ProgramTest, main

COMPARE = ["compare", "--scene", *SCENE, *LAUNCHES, *GPU]


def estimate(mean, half_width):
    return {"mean": mean, "half_width_95": half_width}


class ReportPage(ProgramTest):
    def page(self, report, *options):
        self.path("c.json").write_text(json.dumps(report), encoding="utf-8")
        subprocess.run(["/usr/bin/python3", str(ROOT / "tools/report.py"), "c.json", *options, "-o", "page.html"],
                       cwd=self.folder, check=True)
        return self.path("page.html").read_text("utf-8")

    def lead(self, page):
        return html.unescape(re.sub("<[^>]*>", "", re.search(r'<p class="lead">(.*?)</p>', page, re.DOTALL)[1]))

    def test_the_first_two_sentences_say_what_was_found_and_where_to_find_its_price(self):
        report = self.succeeds(*COMPARE, "--timed", "--json").json
        row = next(row for row in report["rows"] if row["strategy"] == "micro-jitter")
        row["speed_up"] = estimate(1.234, 0.056)
        row["traffic"]["l2_bytes_ratio"] = estimate(0.69, 0.04)
        found = self.lead(self.page(report))
        self.assertTrue(found.startswith("On a simulated gtx-980-ti, micro-jitter with N = 64 is predicted to render 1.23 ±0.06 times as "
                                         "fast as cranley-patterson, and reads 31 ±4 % less from L2."), found)
        self.assertIn("raycache quality courtyard --detail 50000 ", found)
        row["speed_up"] = estimate(1.01, 0.056)
        found = self.lead(self.page(report))
        self.assertIn("reads 31 ±4 % less from L2 than cranley-patterson, but that makes no certain difference in predicted time.", found)
        row["traffic"]["l2_bytes_ratio"] = estimate(0.98, 0.04)
        others = [r for r in report["rows"] if r["strategy"] == "coherent"]
        for other in others:
            other["speed_up"] = other["traffic"]["l2_bytes_ratio"] = estimate(1, 0.1)
        self.assertTrue(self.lead(self.page(report)).startswith("No strategy gains anything over cranley-patterson for certain."))

    def test_a_baseline_on_one_gpu_is_named_with_it(self):
        report = self.succeeds(*COMPARE, "--set", "l1.ways=24,48", "--across-gpus", "--json").json
        self.assertIn(f"Each against cranley-patterson on {report['baseline_gpu']}.", html.unescape(self.page(report)))

    def test_the_price_is_that_of_the_same_strategy_and_settings(self):
        report = self.succeeds(*COMPARE, "--json").json
        row = next(row for row in report["rows"] if row["strategy"] == "micro-jitter")
        row["l2_bytes_ratio"] = estimate(0.69, 0.04)
        same = {key: row[key] for key in ("strategy", "sequence", "parameters", "spp")}
        base = {**same, "strategy": "cranley-patterson", "parameters": ""}
        quality = {"schema_version": 1, "baseline": "cranley-patterson", "width": 64, "height": 48,
                   "rows": [{**base, "r8": 1.25, "rmse_ratio": 1}, {**same, "r8": 3.5, "rmse_ratio": 0.9}]}
        self.path("q.json").write_text(json.dumps(quality))
        found = self.lead(self.page(report, "--quality", "q.json"))
        self.assertIn("3.50 times that of white noise (cranley-patterson: 1.25), at 0.90 times the RMSE", found)
        quality["rows"][1]["parameters"] = "K=7"
        self.path("q.json").write_text(json.dumps(quality))
        self.assertNotIn("3.50", self.lead(self.page(report, "--quality", "q.json")))

    def test_the_page_holds_the_programs_verdicts_and_numbers_and_is_the_same_every_time(self):
        report = self.succeeds(*COMPARE, "--k", "1", "--json").json
        page = self.page(report)
        for row in report["rows"]:
            if row["verdict"]:
                self.assertIn(row["verdict"]["text"], html.unescape(page))
            self.assertIn(f"{100 * row['l1_hit_rate']['mean']:.1f} %", page)
        self.assertEqual(self.page(report), page)
        self.assertNotIn("nan", page.split("data:image")[0])


if __name__ == "__main__":
    main()
