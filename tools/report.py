#!/usr/bin/python3
"""Turns the JSON of `raycache compare` into one HTML page: what was found, charts, table, what the words mean.

Example:
  raycache compare --scene courtyard --spp 16,256,1024 --gpu gtx-980-ti --timed --save out/comparison
  raycache quality courtyard --spp 1024 --json > out/quality.json
  tools/report.py out/comparison.json --quality out/quality.json --picture out/courtyard.png -o out/report.html
"""
import argparse
import base64
import html
import json
import pathlib
import re
import sys

sys.dont_write_bytecode = True
import report_charts as charts  # noqa: E402
from files import read_text, whole_file  # noqa: E402
from report_numbers import (BadInput, Comparison, change, distinct, fixed, interval, is_certain, percent,  # noqa: E402
                            present)

SCHEMA = 1
COLUMNS = [  # title, cell, what it says; the title's '\n' breaks the line. Those that no row has are left out
    ("rays", lambda r: f"{r['totals']['rays']:,}".replace(",", "\u202f"),
     "camera, shadow and bounce rays traced, over all traced sample indices"),
    ("steps\nper ray", lambda r: fixed(r["steps_per_ray"], 1),
     "visits to BVH nodes and tests of triangles per ray: the work, whatever the memory does"),
    ("active\nlanes", lambda r: fixed(r["active_lanes"], 2),
     "of the 32 lanes of a warp, how many take part in an average access; 32 is best"),
    ("sectors\nper access", lambda r: fixed(r["sectors_per_access"], 2),
     "different 32-byte pieces of memory that one warp access touches; lower is better"),
    ("L1\nhits", lambda r: percent(r["l1_hit_rate"]),
     "share of the requests of all loads that the first-level cache of the multiprocessor answers, as Nsight Compute counts "
     "(l1tex__t_sector_hit_rate)"),
    ("L2\nhits", lambda r: percent(r["l2_hit_rate"]),
     "share of the rest found in the second-level cache, on a GPU that of all multiprocessors"),
    ("L3\nhits", lambda r: percent(r.get("l3_hit_rate")), "share of the rest found in the third-level cache, which all share"),
    ("L2\u2192L1\nB/ray", lambda r: interval(r["l2_bytes_per_ray"]), "bytes per ray that L1 did not have and asked L2 for"),
    ("L3\u2192L2\nB/ray", lambda r: interval(r.get("l3_bytes_per_ray")), "bytes per ray that L2 did not have and asked L3 for"),
    ("DRAM\nB/ray", lambda r: interval(r["dram_bytes_per_ray"]), "bytes per ray that no cache had and that came from memory"),
    ("first\ntouches", lambda r: percent(r["dram_compulsory_share"]),
     "share of the DRAM reads that no cache could have saved: sectors read for the first time. Each sample index begins with "
     "cold caches, so at about 100 % DRAM bytes count what is touched, not how well caches are used"),
    ("L2\u2192L1\nratio", lambda r: interval(r["l2_bytes_ratio"]),
     "L2\u2192L1 bytes per ray over those of the baseline strategy, compared sample index by sample index; below 1 is better"),
    ("DRAM\nratio", lambda r: interval(r["dram_bytes_ratio"]), "the same for DRAM bytes per ray"),
    ("predicted\nspeed", lambda r: interval(r.get("speed_up"), 2),
     "predicted time of the baseline over that of the row; above 1 is faster. A model's, not a measurement"),
]


def quality_command(row, settings):
    """The command that measures this row's picture against the baseline's, as it would be typed."""
    words = ["raycache quality", settings.get("scene") or row["scene"]]
    for option in ("detail", "camera", "eye", "look_at", "fov"):
        if settings.get(option) not in (None, "", 0):
            words.append(f"--{option.replace('_', '-')} {settings[option]}")
    k = re.match(r"K=(\S+)", row["parameters"])
    words += [f"--spp {row['spp']}", *([f"--k {k[1]}"] if k else []), f"--strategy cranley-patterson,{row['strategy']}"]
    return " ".join(words + ["--resolution 128x128"])


def price(row, quality, settings):
    """What the row costs in picture quality: a sentence from `raycache quality`, or where to find it."""
    match = [q for q in (quality or {"rows": []})["rows"]
             if (q["strategy"], q["sequence"], q["parameters"], q["spp"]) ==
             (row["strategy"], row["sequence"], row["parameters"], row["spp"])]
    if not match:
        return (f"What that costs in picture quality is not on this page: <code>{html.escape(quality_command(row, settings))}</code> "
                f"measures it, and <code>raycache sweep</code> weighs both.")
    own, base = match[0], next((q for q in quality["rows"] if q["strategy"] == quality["baseline"] and q["spp"] == row["spp"]), None)
    of_base = f" ({html.escape(quality['baseline'])}: {measured(base['r8'])})" if base else ""
    return (f"The price is picture quality: the error that 8x8 pixels share, which eyes see as patches, is "
            f"<b>{measured(own['r8'])}</b> times that of white noise{of_base}, at {measured(ratio_of(own))} times the RMSE "
            f"(<code>raycache quality</code>, {quality['width']}x{quality['height']} pixels).")


def measured(value):
    """A value of `raycache quality`: its mean with the 95 % half width, or its bound where the reference's noise hides it."""
    if not isinstance(value, dict):
        value = {"value": value}
    if value.get("below") is not None:
        return f"less than {value['below']:.2f}"
    if value["value"] is None:
        return "an unknown number of"
    half = value.get("half_width_95")
    return f"{value['value']:.2f}" + (f" \u00b1{half:.2f}" if half is not None else "")


def ratio_of(row):
    """The RMSE over the baseline's."""
    return {"value": row["rmse_ratio"], "half_width_95": row.get("rmse_ratio_half_width_95"), "below": row.get("rmse_ratio_below")}


def headline(comparison, quality):
    """The two sentences that the page begins with: the largest certain gain, and what it costs."""
    def gain(row):
        up = row.get("speed_up")
        return (is_certain(up) and up["mean"] > 1, up["mean"] if is_certain(up) else 0, -row["l2_bytes_ratio"]["mean"])

    def gains(row):
        up = row.get("speed_up")
        return is_certain(up) and up["mean"] > 1 or is_certain(row["l2_bytes_ratio"]) and row["l2_bytes_ratio"]["mean"] < 1

    rows = [r for r in comparison.compared() if gains(r)]
    # Coherent is a bound, not a choice: all pixels share one sample.
    rows = [r for r in rows if r["strategy"] != "coherent"] or rows
    baseline = html.escape(comparison.baseline)
    if not rows:
        return [f"No strategy gains anything over {baseline} for certain.",
                "More sample indices (<code>--trace-samples</code>) or pixels (<code>--resolution</code>) narrow the intervals; what "
                "each strategy costs in picture quality <code>raycache quality</code> measures."]
    best = max(rows, key=gain)
    name = f"<b>{html.escape(comparison.label(best))}</b> with N = {best['spp']}"
    where = f"On a simulated {html.escape(comparison.titles[comparison.setting(best)])}, {name}"
    ratio = best["l2_bytes_ratio"]
    bytes_text = f"reads {change(ratio)} from L2" if is_certain(ratio) else ""
    if gain(best)[0]:
        first = (f"{where} is predicted to render <b>{interval(best['speed_up'], 2)} times as fast</b> as {baseline}" +
                 (f", and {bytes_text}" if bytes_text else "") + ".")
    else:
        first = f"{where} <b>{bytes_text}</b> than {baseline}" + \
            (", but that makes no certain difference in predicted time." if present(best.get("speed_up")) else ".")
    return [first, price(best, quality, comparison.command)]


def findings(comparison):
    """The verdict on every strategy, as the program prints it."""
    return [f"{html.escape(comparison.titles[comparison.setting(row)])}, {html.escape(comparison.label(row))}, "
            f"N = {row['spp']}: {html.escape(row['verdict']['text'])}."
            for row in comparison.rows if row["verdict"]]


def table(comparison, columns, setting):
    group = [("group", lambda r: html.escape(r["group"]))] if comparison.grouped else []
    lead = [("strategy", lambda r: html.escape(comparison.label(r))), ("N", lambda r: str(r["spp"])), *group]
    lines = ["<tr>" + "".join(f"<th{' class=left' if i == 0 else ''}>{t}</th>" for i, (t, _) in enumerate(lead)) +
             "".join(f'<th title="{html.escape(words)}">{title.replace(chr(10), "<br>")}</th>' for title, _, words in columns) +
             "</tr>"]
    previous = None
    for row in sorted(comparison.of(setting), key=lambda r: r["spp"]):
        rule = ' class="rule"' if previous not in (None, row["spp"]) else ""
        previous = row["spp"]
        cells = [cell(row) for _, cell in lead]
        compared = row["strategy"] != comparison.baseline
        cells += [cell(row) if compared or not title.endswith(("ratio", "speed")) else "baseline" for title, cell, _ in columns]
        lines.append(f"<tr{rule}><td class=left>{cells[0]}</td>" + "".join(f"<td>{c}</td>" for c in cells[1:]) + "</tr>")
    return f"<h3>{html.escape(comparison.titles[setting])}</h3>\n<div class=scroll><table>\n" + "\n".join(lines) + "\n</table></div>"


STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; color: #222; max-width: 1120px; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.6em; margin-bottom: 0; } h2 { font-size: 1.25em; margin: 2em 0 .4em; } h3 { font-size: 1em; margin: 1.2em 0 .4em; }
.lead { font-size: 1.15em; } details { margin: .6em 0; } summary { cursor: pointer; font-weight: 600; }
table { border-collapse: collapse; font-size: 14px; font-variant-numeric: tabular-nums; }
th, td { padding: .25em .6em; text-align: right; white-space: nowrap; } th { border-bottom: 2px solid #222; vertical-align: bottom; }
.left { text-align: left; position: sticky; left: 0; background: #fff; } tr.rule td { border-top: 1px solid #bbb; }
.legend span { margin-right: 1.5em; white-space: nowrap; }
.legend i { display: inline-block; width: 1em; height: 1em; margin-right: .4em; vertical-align: -.15em; }
.panels { display: flex; flex-wrap: wrap; gap: 8px; } .panels img { width: 346px; max-width: 100%; }
img { max-width: 100%; } dt { font-weight: 600; } dd { margin: 0 0 .4em 1.5em; }
.scroll { overflow-x: auto; } .aside { color: #555; } code { background: #f2f2f2; padding: .1em .3em; overflow-wrap: anywhere; }
"""


def image(words, svg):
    return f'<img alt="{html.escape(words)}" src="data:image/svg+xml;base64,{svg}">'


def legend(comparison):
    return "<p class=legend>" + " ".join(f'<span><i style="background:{colour}"></i>{html.escape(label)}</span>'
                                         for label, colour in charts.colours(comparison).items()) + "</p>"


def chart_section(comparison, key, title, words, axis_title, line=None):
    panels = [charts.bars(comparison, s, key, axis_title, line) for s in comparison.settings]
    if not any(panels):
        return ""
    return (f"<h2>{title}</h2>\n<p>{words}</p>\n{legend(comparison)}<div class=panels>" +
            "".join(image(f"{title}, {comparison.titles[s]}", panel) for s, panel in zip(comparison.settings, panels) if panel) + "</div>")


def factor_section(comparison):
    panels = [(s, charts.factor_panels(comparison, s)) for s in comparison.settings]
    if not any(chart for _, chart in panels):
        return ""
    text = (f"<h2>Where the difference in bytes comes from</h2>\n<p>Read each panel from top to bottom: start at 1, the traffic of "
            f"{html.escape(comparison.baseline)}; each factor moves it <b style='color:{charts.LESS}'>left (less)</b> or "
            f"<b style='color:{charts.MORE}'>right (more)</b>; the black bars are the ratios that they multiply to, exactly.</p>\n<dl>" +
            "".join(f"<dt>{name}</dt><dd>{words}</dd>" for _, name, words in comparison.factors) + "</dl>")
    for setting, own in panels:
        if own:
            text += f"<h3>{html.escape(comparison.titles[setting])}</h3>\n<div class=panels>" + "".join(image(*p) for p in own) + "</div>"
    return text


def page(comparison, quality, picture, command):
    first = comparison.rows[0]
    scenes = ", ".join(distinct(r["scene"] for r in comparison.rows))
    columns = [c for c in COLUMNS if any(c[1](row) != "\u2013" for row in comparison.rows)]
    parts = [f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>raycache: {html.escape(scenes)}</title>
<style>{STYLE}</style></head><body>
<h1>What a sampling strategy costs a GPU's caches</h1>"""]
    if comparison.baseline and not comparison.grouped:
        parts.append(f'<p class="lead">{" ".join(headline(comparison, quality))}</p>')
    parts.append(f"""<p class="aside">Scene {html.escape(scenes)}; sequence {html.escape(", ".join(distinct(r["sequence"] for r in comparison.rows)))};
{len(first["samples"])} of the N sample indices traced for each row. GPUs are simulated{", times are a model's prediction" if comparison.timed else ""}: nothing
was measured on hardware. \u00b1 is everywhere the half width of the 95 % confidence interval over sample indices.</p>""")
    if comparison.baseline and not comparison.grouped:
        parts.append(f"<h2>Strategy by strategy</h2>\n<p>Each against {html.escape(comparison.baseline)}.</p>\n<ul>" +
                     "".join(f"<li>{s}</li>\n" for s in findings(comparison)) + "</ul>")
    if not comparison.grouped:
        parts.append(chart_section(comparison, "speed_up", "Predicted speed", f"Time of {html.escape(comparison.baseline)} over that of the "
                                   "strategy: above the dashed line is faster. The thin lines are 95 % confidence intervals.",
                                   "times as fast", 1))
        parts.append(chart_section(comparison, "l2_bytes_per_ray", "L2\u2192L1 traffic", "Bytes that L1 did not have and read from L2. Lower is "
                                   "better; the thin lines are 95 % confidence intervals.", "bytes per ray"))
        parts.append(chart_section(comparison, "dram_bytes_per_ray", "DRAM traffic", "Bytes that no cache had. Lower is better. Each sample index "
                                   "begins with cold caches, so where L2 holds the scene these are first touches alone (see the table).",
                                   "bytes per ray"))
        parts.append(factor_section(comparison))
    parts.append("<h2>All numbers</h2>\n" + "\n".join(table(comparison, columns, s) for s in comparison.settings))
    parts += [f"<p>Note: {html.escape(note)}.</p>" for note in comparison.notes]
    strategies = distinct((r["strategy"], r["spp"], r["parameters"]) for r in comparison.rows if r["parameters"])
    parts.append("<h2>What the words mean</h2>\n<dl><dt>N</dt><dd>samples per pixel of the whole picture. Only some sample indices "
                 "are traced: a random choice, the same for every strategy</dd>" +
                 "".join(f"<dt>{title.replace(chr(10), ' ')}</dt><dd>{words}</dd>" for title, _, words in columns) + "</dl>")
    if strategies:
        parts.append("<h3>Parameters</h3>\n<ul>" + "".join(f"<li>{html.escape(s)}, N = {n}: {html.escape(p)}</li>" for s, n, p in strategies) + "</ul>")
    if picture:
        data = base64.b64encode(picture).decode()
        parts.append(f'<h2>The scene</h2>\n<img alt="picture of the scene" src="data:image/png;base64,{data}">')
    if command:
        parts.append(f"<h2>Made with</h2>\n<p><code>{html.escape(command)}</code></p>")
    parts.append("</body></html>\n")
    return "\n".join(part for part in parts if part)


def read_report(path):
    """The JSON of the program, of the schema that this reads (docs/json.md)."""
    report = json.loads(read_text(path))
    if report.get("schema_version") != SCHEMA:
        raise BadInput(f"schema_version {report.get('schema_version')}, expected {SCHEMA}: made by another version of raycache")
    return report


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("comparison", type=pathlib.Path, help="JSON of raycache compare")
    parser.add_argument("--quality", type=pathlib.Path, help="JSON of raycache quality: what the strategies cost in picture quality")
    parser.add_argument("--picture", type=pathlib.Path, help="PNG of the scene, shown on the page")
    parser.add_argument("--command", default="", help="how the comparison was made, shown on the page")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, help="HTML page to write")
    arguments = parser.parse_args()
    try:
        comparison = Comparison(read_report(arguments.comparison))
        quality = read_report(arguments.quality) if arguments.quality else None
        picture = arguments.picture.read_bytes() if arguments.picture else None
        text = page(comparison, quality, picture, arguments.command)
        with whole_file(arguments.output) as file:
            file.write(text.encode())
    except OSError as error:
        sys.exit(f"{pathlib.Path(sys.argv[0]).name}: error: {error}")
    except (ValueError, KeyError, TypeError, BadInput) as error:
        sys.exit(f"{pathlib.Path(sys.argv[0]).name}: error: {arguments.comparison}: not a report of raycache compare --json: {error!r}")


if __name__ == "__main__":
    main()
