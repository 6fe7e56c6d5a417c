#!/usr/bin/python3
"""The figures of reports: what `raycache list figures` says of each, and that docs/figures.md says the same."""
from support import GPU, LAUNCHES, ROOT, SCENE, ProgramTest, main

TOPICS = {"figures": "traffic", "timed-figures": "timed"}


def table_row(figure):
    """A figure as docs/figures.md has it."""
    is_quotient = figure["denominator"] is not None
    formula = f"`{figure['numerator']}` / `{figure['denominator']}`" if is_quotient else f"`{figure['numerator']}`"
    formula += ", compared" if figure["compared"] else ""
    where = f"`{'.'.join(figure['path'])}`" if figure["path"] else "in text only"
    return (f"| {where} | {figure['title']} | {figure['unit']} | {formula} | {figure['better'] or ''} "
            f"| {figure['definition']} |")


class Figures(ProgramTest):
    def listed(self, topic):
        return self.succeeds("list", topic, "--json").json["topics"][topic.replace("-", "_")]

    def test_every_figure_is_listed_with_its_definition(self):
        for topic in TOPICS:
            text = self.succeeds("list", topic, "--wide").text
            for figure in self.listed(topic):
                self.assertIn(f"  {figure['name']} ", text)
                self.assertIn(figure["definition"], text)

    def test_the_documentation_has_the_same_table(self):
        documented = (ROOT / "docs/figures.md").read_text("utf-8").splitlines()
        rows = [line for line in documented if line.startswith(("| `", "| in text"))]
        expected = [table_row(figure) for topic in TOPICS for figure in self.listed(topic)]
        self.assertEqual(rows, expected, "docs/figures.md: put in the rows that the program has:\n" + "\n".join(expected))

    def test_a_report_carries_the_figures_that_it_shows(self):
        listed = {figure["key"] for topic in TOPICS for figure in self.listed(topic)}
        for options in ([], ["--timed"]):
            report = self.succeeds("compare", "--scene", *SCENE, *LAUNCHES, *GPU, *options, "--json").json
            keys = [figure["key"] for figure in report["figures"]]
            self.assertLessEqual(set(keys), listed)
            self.assertIn("l2_bytes_ratio", keys)
            self.assertEqual("speed_up" in keys, bool(options))


if __name__ == "__main__":
    main()
