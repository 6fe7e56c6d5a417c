#!/usr/bin/python3
"""raycache samples: the points of all pixels in two dimensions, and the tables about them."""
import csv

from support import ProgramTest, main


class Samples(ProgramTest):
    def test_figure_2_of_the_paper_has_its_k_and_its_holes(self):
        halton = ["samples", "--sequence", "halton", "--strategy", "micro-jitter", "--spp", "128", "--copies", "150"]
        narrow = self.succeeds(*halton, "--k", "1", "--json").json
        wide = self.succeeds(*halton, "--k", "discrepancy", "--json").json
        self.assertAlmostEqual(wide["k_from_discrepancy"], 2.17, delta=0.005)
        self.assertAlmostEqual(wide["hole_free_k"], 1.955, delta=0.002)
        self.assertAlmostEqual(narrow["mu"], 128 ** -0.5, places=6)
        self.assertGreater(narrow["density"]["holes"], 0.1)
        self.assertEqual(wide["density"]["holes"], 0)
        for result in (narrow, wide):
            self.assertAlmostEqual(sum(level["area"] for level in result["density"]["levels"]), 1, places=9)

    def test_cranley_patterson_is_even_and_coherent_has_no_density(self):
        even = self.succeeds("samples", "--strategy", "cranley-patterson", "--json").json
        self.assertEqual((even["mu"], even["density"]["min"], even["density"]["max"]), (1, 1, 1))
        coherent = self.succeeds("samples", "--strategy", "coherent", "--json").json
        self.assertIsNone(coherent["density"])
        self.assertEqual(coherent["largest_hole"], coherent["largest_hole_of_copies"])

    def test_the_csv_holds_every_point_of_every_copy(self):
        self.succeeds("samples", "--spp", "16", "--copies", "3", "--mu", "0.01", "--csv", "p.csv")
        with open(self.path("p.csv"), encoding="ascii") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([(int(r["copy"]), int(r["sample"])) for r in rows], [(c, i) for c in range(3) for i in range(16)])
        for row in rows:
            away = (float(row["x"]) - int(f"{int(row['sample']):04b}"[::-1], 2) / 16) % 1
            self.assertLessEqual(min(away, 1 - away), 0.005 + 1e-9)

    def test_pictures_are_png_files_and_the_same_every_time(self):
        for name in ("a.png", "b.png"):
            self.succeeds("samples", "--spp", "32", "--copies", "20", "--picture", name, "--figure2", "f" + name)
        self.assertEqual(self.path("a.png").read_bytes(), self.path("b.png").read_bytes())
        self.assertEqual(self.path("fa.png").read_bytes(), self.path("fb.png").read_bytes())
        self.assertTrue(self.path("fa.png").read_bytes().startswith(b"\x89PNG"))

    def test_a_table_has_the_same_rows_as_text_and_as_json(self):
        table = self.succeeds("samples", "--table", "discrepancy", "--json").json
        text = self.succeeds("samples", "--table", "discrepancy").text
        self.assertTrue(text.startswith(table["title"]))
        self.assertEqual(len(text.splitlines()), len(table["rows"]) + 4)
        self.assertAlmostEqual(table["rows"][0]["hole_free_k"], 1.955, delta=0.002)

    def test_help_has_an_example_of_the_figure(self):
        self.assertIn("raycache samples --figure2 figure2.png", self.succeeds("samples", "--help").text)

    def test_bad_input_is_refused(self):
        for arguments, words in (
            (["--sequence", "hammersley"], ["hammersley", "halton"]),
            (["--strategy", "macro-jitter"], ["macro-jitter", "micro-jitter"]),
            (["--table", "nothing"], ["nothing", "holes"]),
            (["--table", "holes", "--csv", "x.csv"], ["--table"]),
            (["--copies", "0"], ["--copies '0'"]),
            (["--spp", "0"], ["0"]),
            (["--spp", "1000000", "--copies", "1000"], ["--copies 1000"]),
            (["--dimensions", "0,1024"], ["0,1024", "1023"]),
            (["--dimensions", "3,3"], ["3,3", "different"]),
            (["--dimensions", "0"], ["--dimensions"]),
            (["--k", "-1"], ["-1"]),
            (["--k", "nan"], ["nan"]),
            (["--picture", "x.jpg"], ["x.jpg", ".png"]),
            (["--figure2", "x"], [".png"]),
        ):
            self.refuses(2, "samples", *arguments, mentions=words)
        self.refuses(1, "samples", "--csv", "no/such/folder/x.csv", mentions=["no/such/folder/x.csv"])
        self.refuses(1, "samples", "--picture", "no/such/folder/x.png", mentions=["no/such/folder/x.png"])


if __name__ == "__main__":
    main()
