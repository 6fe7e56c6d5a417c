#!/usr/bin/python3
"""Turns the JSON of `raycache compare` into one HTML page: what was found, charts, table, what the words mean.

Example:
  raycache compare --scene courtyard --spp 16,256,1024 --gpu gtx-980-ti --save out/comparison
  tools/report.py out/comparison.json --picture out/courtyard.png -o out/report.html
"""
import argparse
import base64
import html
import io
import json
import math
import pathlib
import sys

import matplotlib

from files import read_text, whole_file

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend must be chosen first)

COLOURS = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#999999"]  # Okabe & Ito: for all eyes
SCHEMA = 1
LESS, MORE = "#009e73", "#d55e00"

FACTORS = [  # key in the JSON, name, what it says
    ("work", "work", "BVH nodes and triangles visited per ray"),
    ("simt_efficiency", "SIMT efficiency", "warp accesses per visit: fewer if more lanes of a warp work at once"),
    ("coalescing", "coalescing", "32-byte sectors per warp access: fewer if the lanes read the same or neighbouring places"),
    ("l1_locality", "L1 locality", "share of the sectors that L1 does not have"),
    ("l2_locality", "L2 locality", "share of those that L2 does not have either"),
    ("l3_locality", "L3 locality", "share of those that L3 does not have either"),
]

COLUMNS = [  # title, cell, what it says; the title's '\n' breaks the line. Those of an L3 show only where a GPU has one
    ("rays", lambda r: f"{r['totals']['rays']:,}".replace(",", "\u202f"),
     "camera, shadow and bounce rays traced, over all traced sample indices"),
    ("steps\nper ray", lambda r: fixed(r["steps_per_ray"], 1),
     "visits to BVH nodes and tests of triangles per ray: the work, whatever the memory does"),
    ("active\nlanes", lambda r: fixed(r["active_lanes"], 2),
     "of the 32 lanes of a warp, how many take part in an average access; 32 is best"),
    ("sectors\nper access", lambda r: fixed(r["sectors_per_access"], 2),
     "different 32-byte pieces of memory that one warp access touches; lower is better"),
    ("L1\nhits", lambda r: percent(r["l1_hit_rate"]), "share of those sectors found in the first-level cache of the multiprocessor"),
    ("L2\nhits", lambda r: percent(r["l2_hit_rate"]), "share of the rest found in the second-level cache, on a GPU that of all multiprocessors"),
    ("L3\nhits", lambda r: percent(r["l3_hit_rate"]), "share of the rest found in the third-level cache, which all share"),
    ("L2\u2192L1\nB/ray", lambda r: interval(r["l2_bytes_per_ray"]),
     "bytes per ray that L1 did not have and asked L2 for"),
    ("L3\u2192L2\nB/ray", lambda r: interval(r["l3_bytes_per_ray"]),
     "bytes per ray that L2 did not have and asked L3 for"),
    ("DRAM\nB/ray", lambda r: interval(r["dram_bytes_per_ray"]),
     "bytes per ray that no cache had and that came from memory"),
    ("L2\u2192L1\nratio", lambda r: interval(r["l2_bytes_ratio"]),
     "L2\u2192L1 bytes per ray over those of the baseline strategy, compared sample index by sample index; below 1 is better"),
    ("DRAM\nratio", lambda r: interval(r["dram_bytes_ratio"]),
     "the same for DRAM bytes per ray"),
]


class BadInput(Exception):
    pass


def present(estimate):
    return estimate is not None and estimate["mean"] is not None


def fixed(estimate, digits):
    return f"{estimate['mean']:.{digits}f}" if present(estimate) else "\u2013"


def percent(estimate):
    return f"{100 * estimate['mean']:.1f} %" if present(estimate) else "\u2013"


def interval(estimate):
    """About four digits, and the half width to the same place."""
    if not present(estimate):
        return "\u2013"
    mean, half = estimate["mean"], estimate["half_width_95"]
    digits = 0 if abs(mean) >= 1000 else 1 if abs(mean) >= 100 else 2 if abs(mean) >= 10 else 3
    return f"{mean:.{digits}f}" + ("" if half is None else f" \u00b1{half:.{digits}f}")


def half_width(estimate):
    return (estimate["half_width_95"] or 0) if present(estimate) else 0


def distinct(values):
    return list(dict.fromkeys(values))


class Comparison:
    """The rows, sorted into settings (what the strategies share, except N) and labels (what tells strategies apart)."""

    def __init__(self, report):
        self.rows = report["rows"]
        self.baseline = report["baseline"]
        self.notes = report["notes"]
        self.grouped = report["by"] != "none"
        has_l3 = any("l3_hit_rate" in row for row in self.rows)
        self.columns = [column for column in COLUMNS if has_l3 or not column[0].startswith("L3")]
        self.factors = [factor for factor in FACTORS if has_l3 or factor[0] != "l3_locality"]
        if not self.rows:
            raise BadInput("no rows; run 'raycache compare' first")
        fields = [f for f in ("scene", "sequence", "thread_map") if len({r[f] for r in self.rows}) > 1]
        seen = [(self.setting(r), r["strategy"], r["spp"], r["group"]) for r in self.rows]
        self.ambiguous = len(set(seen)) < len(seen)
        self.settings = distinct(self.setting(r) for r in self.rows)
        self.titles = {self.setting(r): ", ".join([r["gpu"], *(r[f] for f in fields)]) for r in self.rows}
        self.labels = distinct(self.label(r) for r in self.rows)
        self.colours = {label: COLOURS[i % len(COLOURS)] for i, label in enumerate(self.labels)}

    @staticmethod
    def setting(row):
        return row["gpu"], row["scene"], row["sequence"], row["thread_map"]

    def label(self, row):
        extra = f" ({row['parameters']})" if self.ambiguous and row["parameters"] else ""
        return row["strategy"] + extra

    def of(self, setting):
        return [r for r in self.rows if self.setting(r) == setting]


def svg(figure):
    buffer = io.StringIO()
    figure.savefig(buffer, format="svg", metadata={"Date": None})
    plt.close(figure)
    return base64.b64encode(buffer.getvalue().encode()).decode()


def traffic_chart(comparison, key, title):
    """Bars of one quantity: a panel per setting, a group of bars per N, a bar per strategy."""
    count = len(comparison.settings)
    columns = min(2, count)
    lines = math.ceil(count / columns)
    figure, axes = plt.subplots(lines, columns, figsize=(5 * columns, 3.1 * lines + 0.5), squeeze=False, layout="constrained")
    for axis in axes.flat[count:]:
        axis.set_visible(False)
    for axis, setting in zip(axes.flat, comparison.settings):
        rows = comparison.of(setting)
        counts = sorted({r["spp"] for r in rows})
        width = 0.8 / len(comparison.labels)
        for i, label in enumerate(comparison.labels):
            own = {r["spp"]: r[key] for r in rows if comparison.label(r) == label and present(r[key])}
            axis.bar([counts.index(n) + (i - (len(comparison.labels) - 1) / 2) * width for n in own],
                     [e["mean"] for e in own.values()], width * 0.92, color=comparison.colours[label], label=label,
                     yerr=[half_width(e) for e in own.values()], capsize=3, error_kw={"elinewidth": 1})
        axis.set_xticks(range(len(counts)), [f"N = {n}" for n in counts])
        axis.set_title(comparison.titles[setting], fontsize=11)
        axis.set_ylabel(f"{title}, bytes per ray")
        axis.set_ylim(bottom=0)
        axis.spines[["top", "right"]].set_visible(False)
    return svg(figure)


def legend(comparison):
    return "<p class=legend>" + "".join(f'<span><i style="background:{colour}"></i>{html.escape(label)}</span>'
                                        for label, colour in comparison.colours.items()) + "</p>"


def factor_chart(comparison, setting):
    """From 1 to the ratio in five steps: a panel per strategy and N. None where nothing is compared."""
    rows = [r for r in comparison.of(setting) if r["factors"]]
    if not rows:
        return None
    labels = [label for label in comparison.labels if any(comparison.label(r) == label for r in rows)]
    counts = sorted({r["spp"] for r in rows})
    figure, axes = plt.subplots(len(labels), len(counts), figsize=(3.3 * len(counts) + 1.2, 2.3 * len(labels) + 0.5),
                                squeeze=False, sharex=True, sharey=True, layout="constrained")
    names = [name for _, name, _ in comparison.factors] + ["DRAM ratio"]
    for axis in axes.flat:
        axis.set_visible(False)
    for row in rows:
        axis = axes[labels.index(comparison.label(row))][counts.index(row["spp"])]
        axis.set_visible(True)
        value = 1
        for place, (key, _, _) in enumerate(comparison.factors):
            factor = row["factors"][key]
            axis.barh(place, value * factor - value, left=value, color=LESS if factor < 1 else MORE, height=0.7)
            axis.plot([value * factor] * 2, [place - 0.35, place + 1.35], color="#666666", linewidth=0.8)
            axis.annotate(f"\u00d7 {factor:.2f}", (max(value, value * factor), place), xytext=(4, 0),
                          textcoords="offset points", va="center", fontsize=8)
            value *= factor
        axis.barh(len(comparison.factors), value - 1, left=1, color="#444444", height=0.7,
                  xerr=half_width(row["dram_bytes_ratio"]), error_kw={"ecolor": "black", "capsize": 3})
        axis.annotate(f"= {value:.2f}", (max(1, value + half_width(row["dram_bytes_ratio"])), len(comparison.factors)), xytext=(4, 0), textcoords="offset points",
                      va="center", fontsize=8, weight="bold")
        axis.axvline(1, color="black", linewidth=0.8)
        axis.set_yticks(range(len(names)), names)
        axis.set_title(f"{comparison.label(row)}, N = {row['spp']}", fontsize=10)
        axis.spines[["top", "right"]].set_visible(False)
    axes[0][0].invert_yaxis()
    low, high = axes[0][0].get_xlim()
    axes[0][0].set_xlim(max(0, low), high + (high - low) * 0.15)  # room for the numbers
    figure.supxlabel(f"DRAM bytes per ray over those of {comparison.baseline}; left of 1 is better", fontsize=10)
    return svg(figure)


def difference(ratio, source, baseline):
    """Such as "12 % less from DRAM than cranley-patterson (x 0.880 ±0.012)"."""
    if abs(ratio["mean"] - 1) <= half_width(ratio):
        return f"about as much from {source} as {baseline} (\u00d7 {interval(ratio)}; the interval includes 1)"
    change = abs(1 - ratio["mean"]) * 100
    return (f"<b>{change:.{0 if change >= 10 else 1}f} % {'less' if ratio['mean'] < 1 else 'more'} from {source}</b> than "
            f"{baseline} (\u00d7 {interval(ratio)})")


def findings(comparison):
    """One sentence per setting and strategy, at the largest N."""
    sentences = []
    baseline = html.escape(comparison.baseline)
    for setting in comparison.settings:
        rows = comparison.of(setting)
        most = max(r["spp"] for r in rows)
        for row in rows:
            if row["spp"] == most and present(row["dram_bytes_ratio"]) and present(row["l2_bytes_ratio"]):
                sentences.append(f"{html.escape(comparison.titles[setting])}, N = {most}: per ray, "
                                 f"<b>{html.escape(comparison.label(row))}</b> reads "
                                 f"{difference(row['l2_bytes_ratio'], 'L2', baseline)} and "
                                 f"{difference(row['dram_bytes_ratio'], 'DRAM', 'it')}.")
    return sentences


def table(comparison, setting):
    group = [("group", lambda r: html.escape(r["group"]))] if comparison.grouped else []
    lead = [("strategy", lambda r: html.escape(comparison.label(r))), ("N", lambda r: str(r["spp"])), *group]
    lines = ["<tr>" + "".join(f"<th{' class=left' if i == 0 else ''}>{t}</th>" for i, (t, _) in enumerate(lead)) +
             "".join(f'<th title="{html.escape(words)}">{title.replace(chr(10), "<br>")}</th>' for title, _, words in comparison.columns) +
             "</tr>"]
    previous = None
    for row in sorted(comparison.of(setting), key=lambda r: r["spp"]):
        rule = ' class="rule"' if previous not in (None, row["spp"]) else ""
        previous = row["spp"]
        cells = [cell(row) for _, cell in lead]
        values = [cell(row) for _, cell, _ in comparison.columns]
        if row["strategy"] == comparison.baseline:
            values[-2:] = ["baseline", "baseline"]
        lines.append(f"<tr{rule}><td class=left>{cells[0]}</td>" + "".join(f"<td>{c}</td>" for c in cells[1:] + values) + "</tr>")
    return f"<h3>{html.escape(comparison.titles[setting])}</h3>\n<table>\n" + "\n".join(lines) + "\n</table>"


STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; color: #222; max-width: 1120px; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.6em; margin-bottom: 0; } h2 { font-size: 1.25em; margin: 2em 0 .4em; } h3 { font-size: 1em; margin: 1.2em 0 .4em; }
table { border-collapse: collapse; font-size: 14px; font-variant-numeric: tabular-nums; }
th, td { padding: .25em .6em; text-align: right; white-space: nowrap; } th { border-bottom: 2px solid #222; vertical-align: bottom; }
.left { text-align: left; } tr.rule td { border-top: 1px solid #bbb; }
.legend span { margin-right: 1.5em; } .legend i { display: inline-block; width: 1em; height: 1em; margin-right: .4em; vertical-align: -.15em; }
img { max-width: 100%; } dt { font-weight: 600; } dd { margin: 0 0 .4em 1.5em; }
.scroll { overflow-x: auto; } .aside { color: #666; } code { background: #f2f2f2; padding: .1em .3em; overflow-wrap: anywhere; }
"""


def page(comparison, picture, command):
    first = comparison.rows[0]
    scenes = ", ".join(distinct(r["scene"] for r in comparison.rows))
    parts = [f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>raycache: {html.escape(scenes)}</title>
<style>{STYLE}</style></head><body>
<h1>How much memory traffic does a sampling strategy cause?</h1>
<p class="aside">Scene {html.escape(scenes)}; sequence {html.escape(", ".join(distinct(r["sequence"] for r in comparison.rows)))};
{len(first["samples"])} of the N sample indices traced for each row; GPU caches simulated, no GPU used.</p>"""]
    if comparison.baseline:
        parts.append("<h2>What was found</h2>\n<ul>" +
                     "".join(f"<li>{s}</li>\n" for s in findings(comparison) if not comparison.grouped) + "</ul>")
        parts.append("<p class=aside>Less traffic is not the same as less time: this page counts bytes, it does not predict speed. "
                     "\u00b1 is a 95 % confidence interval over sample indices.</p>")
    if not comparison.grouped:
        for key, title in (("dram_bytes_per_ray", "DRAM"), ("l2_bytes_per_ray", "L2\u2192L1")):
            parts.append(f'<h2>{title} traffic</h2>\n<p>{"Read from memory, past both caches." if title == "DRAM" else "Read from L2 because L1 did not have it."} '
                         f"Lower is better; the thin lines are 95 % confidence intervals.</p>\n{legend(comparison)}"
                         f'<img alt="{title} bytes per ray by strategy and N" src="data:image/svg+xml;base64,{traffic_chart(comparison, key, title)}">')
        charts = [(s, factor_chart(comparison, s)) for s in comparison.settings]
        if any(chart for _, chart in charts):
            parts.append(f"<h2>Where the difference comes from</h2>\n<p>Read each panel from top to bottom: start at 1, the traffic of "
                         f"{html.escape(comparison.baseline)}; each factor moves it <b style='color:{LESS}'>left (less)</b> or "
                         f"<b style='color:{MORE}'>right (more)</b>; the last bar is where it ends. The factors multiply to the ratio exactly.</p>\n<dl>" +
                         "".join(f"<dt>{name}</dt><dd>{words}</dd>" for _, name, words in comparison.factors) + "</dl>")
            parts += [f'<h3>{html.escape(comparison.titles[s])}</h3>\n<img alt="factors of the DRAM ratio" '
                      f'src="data:image/svg+xml;base64,{chart}">' for s, chart in charts if chart]
    parts.append("<h2>All numbers</h2>\n<div class=scroll>" + "\n".join(table(comparison, s) for s in comparison.settings) + "</div>")
    parts += [f"<p>Note: {html.escape(note)}.</p>" for note in comparison.notes]
    strategies = distinct((r["strategy"], r["spp"], r["parameters"]) for r in comparison.rows if r["parameters"])
    parts.append("<h2>What the words mean</h2>\n<dl><dt>N</dt><dd>samples per pixel of the whole picture. Only some sample indices "
                 "are traced: a random choice, the same for every strategy</dd>" +
                 "".join(f"<dt>{title.replace(chr(10), ' ')}</dt><dd>{words}</dd>" for title, _, words in comparison.columns) + "</dl>")
    if strategies:
        parts.append("<h3>Parameters</h3>\n<ul>" + "".join(f"<li>{html.escape(s)}, N = {n}: {html.escape(p)}</li>" for s, n, p in strategies) + "</ul>")
    if picture:
        data = base64.b64encode(picture).decode()
        parts.append(f'<h2>The scene</h2>\n<img alt="picture of the scene" src="data:image/png;base64,{data}">')
    if command:
        parts.append(f"<h2>Made with</h2>\n<p><code>{html.escape(command)}</code></p>")
    parts.append("</body></html>\n")
    return "\n".join(parts)


def read_report(path):
    """The JSON of the program, of the schema that this reads (docs/json.md)."""
    report = json.loads(read_text(path))
    if report.get("schema_version") != SCHEMA:
        raise BadInput(f"schema_version {report.get('schema_version')}, expected {SCHEMA}: made by another version of raycache")
    return report


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("comparison", type=pathlib.Path, help="JSON of raycache compare")
    parser.add_argument("--picture", type=pathlib.Path, help="PNG of the scene, shown on the page")
    parser.add_argument("--command", default="", help="how the comparison was made, shown on the page")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, help="HTML page to write")
    arguments = parser.parse_args()
    plt.rcParams.update({"svg.hashsalt": "raycache", "font.size": 9})  # the same input gives the same bytes
    try:
        comparison = Comparison(read_report(arguments.comparison))
        picture = arguments.picture.read_bytes() if arguments.picture else None
        text = page(comparison, picture, arguments.command)
        with whole_file(arguments.output) as file:
            file.write(text.encode())
    except OSError as error:
        sys.exit(f"{pathlib.Path(sys.argv[0]).name}: error: {error}")
    except (ValueError, KeyError, TypeError, BadInput) as error:
        sys.exit(f"{pathlib.Path(sys.argv[0]).name}: error: {arguments.comparison}: not a report of raycache compare --json: {error!r}")


if __name__ == "__main__":
    main()
