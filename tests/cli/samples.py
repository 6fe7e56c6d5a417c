#!/usr/bin/python3
"""raycache samples: holes, density and discrepancy of a strategy's samples, picture, CSV, tables."""
import csv
import struct

from support import ProgramTest, main

FIGURE2 = ["samples", "--sequence", "halton", "--spp", "128"]


class Samples(ProgramTest):
    def test_the_papers_figure_2_has_its_k_and_its_holes(self):
        report = self.succeeds(*FIGURE2, "--json").json
        self.assertAlmostEqual(report["discrepancy_k"], 2.17, delta=0.01)
        self.assertAlmostEqual(report["hole_free_k"], 1.955, delta=0.01)
        self.assertEqual(report["never_sampled"], 0)
        small = self.succeeds(*FIGURE2, "--k", "1", "--json").json
        self.assertGreater(small["never_sampled"], 0.1)
        self.assertGreater(small["copies_hole"], report["copies_hole"])
        self.assertAlmostEqual(sum(bin["share"] for bin in small["density_histogram"]), 1, delta=1e-9)

    def test_mu_of_one_is_even_and_mu_of_zero_is_the_base_points(self):
        self.assertAlmostEqual(self.succeeds(*FIGURE2, "--strategy", "cranley-patterson", "--json").json["density_unevenness"],
                               0, delta=1e-12)
        still = self.succeeds(*FIGURE2, "--strategy", "coherent", "--json").json
        self.assertEqual(still["copies_hole"], still["base_hole"])

    def test_csv_holds_every_sample_once_and_in_the_unit_square(self):
        self.succeeds("samples", "--spp", "16", "--copies", "7", "--csv", "s.csv")
        with open(self.path("s.csv"), encoding="ascii") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len({(row["copy"], row["index"]) for row in rows}), 7 * 16)
        self.assertTrue(all(0 <= float(row[axis]) < 1 for row in rows for axis in "xy"))

    def test_the_picture_has_four_panels_and_the_same_bytes_with_any_threads(self):
        self.succeeds(*FIGURE2, "--picture", "a.png", "--threads", "1")
        self.succeeds(*FIGURE2, "--picture", "b.png", "--threads", "3")
        data = self.path("a.png").read_bytes()
        self.assertEqual(data, self.path("b.png").read_bytes())
        width, height = struct.unpack(">II", data[16:24])
        self.assertGreater(width, 900)
        self.assertGreater(height, 900)

    def test_the_table_of_variants_says_that_wrapping_is_best(self):
        table = self.succeeds("samples", "--table", "boundary", "--json").json["tables"][0]
        errors = [float(row["N=1024"]) for row in table["rows"]]
        self.assertEqual(min(errors), errors[0])
        self.assertGreater(min(errors[1:3]), 100 * errors[0])

    def test_wrong_use_is_refused(self):
        for options, words in ((["--sequence", "nothing"], ["nothing", "sobol"]), (["--strategy", "nothing"], ["nothing"]),
                               (["--copies", "0"], ["--copies"]), (["--spp", "0"], ["N"]), (["--spp", "1000000"], ["--spp"]),
                               (["--spp", "60000", "--copies", "1000"], ["--copies"]),
                               (["--dimensions", "3,3"], ["--dimensions"]), (["--dimensions", "1"], ["--dimensions"]),
                               (["--dimensions", "0,5000"], ["dimension"]), (["--mu", "-1"], ["mu"]),
                               (["--table", "nothing"], ["holes"]), (["--picture", "a.jpg"], [".png"])):
            self.refuses(2, "samples", *options, mentions=words)
        self.refuses(1, "samples", "--csv", "nowhere/s.csv", mentions=["nowhere/s.csv"])
        self.refuses(1, "samples", "--picture", "nowhere/s.png", mentions=["nowhere/s.png"])


if __name__ == "__main__":
    main()
