#!/usr/bin/python3
"""Turns the JSON of `raycache compare` into one HTML page: what was found, charts, table, what the words mean.

Example:
  raycache compare --scene courtyard --spp 16,256,1024 --gpu gtx-980-ti --timed --save out/comparison
  raycache quality courtyard --spp 1024 --json > out/quality.json
  tools/report.py out/comparison.json --quality out/quality.json --picture out/courtyard.png -o out/report.html
"""
import argparse
import base64
import json
import pathlib
import re
import sys

import jinja2

sys.dont_write_bytecode = True
import report_charts as charts  # noqa: E402
from files import read_text, whole_file  # noqa: E402
from report_numbers import BadInput, Comparison, cell, change, distinct, interval, is_certain, present  # noqa: E402

SCHEMA = 1


def quality_command(row, settings):
    """The command that measures this row's picture against the baseline's, as it would be typed."""
    inputs = settings.get("inputs") or []
    scene = settings.get("scene") or (inputs[0] if len(inputs) == 1 else None)
    if not scene:  # traces: a built-in scene's name holds what it was made with, "courtyard(detail=50000)"
        name, detail = re.fullmatch(r"(.*?)(?:\(detail=(\d+)\))?", row["scene"]).groups()
        scene, settings = name, {"detail": detail, **{key: value for key, value in settings.items() if value}}
    words = ["raycache quality", scene]
    for option in ("detail", "camera", "eye", "look_at", "fov"):
        if settings.get(option) not in (None, "", 0):
            words.append(f"--{option.replace('_', '-')} {settings[option]}")
    k = re.match(r"K=(\S+)", row["parameters"])
    words += [f"--spp {row['spp']}", *([f"--k {k[1]}"] if k else []), f"--strategy cranley-patterson,{row['strategy']}"]
    return " ".join(words + ["--resolution 128x128"])


def measured(value):
    """A value of `raycache quality`."""
    if not isinstance(value, dict):
        value = {"value": value}
    return {"value": value["value"], "half_width": value.get("half_width_95"), "below": value.get("below")}


def price(row, quality):
    """What the row costs in picture quality, from the JSON of `raycache quality`; None where that has nothing of it."""
    match = [q for q in (quality or {"rows": []})["rows"]
             if (q["strategy"], q["sequence"], q["parameters"], q["spp"]) ==
             (row["strategy"], row["sequence"], row["parameters"], row["spp"])]
    if not match:
        return None
    own, base = match[0], next((q for q in quality["rows"] if q["strategy"] == quality["baseline"] and q["spp"] == row["spp"]), None)
    ratio = {"value": own["rmse_ratio"], "half_width_95": own.get("rmse_ratio_half_width_95"), "below": own.get("rmse_ratio_below")}
    return {"r8": measured(own["r8"]), "rmse_ratio": measured(ratio), "baseline": quality["baseline"],
            "baseline_r8": measured(base["r8"]) if base else None, "width": quality["width"], "height": quality["height"]}


def best_of(comparison, quality):
    """The row with the largest certain gain over the baseline, and its price; None where none gains."""
    def gain(row):
        up = row.get("speed_up")
        return (is_certain(up) and up["mean"] > 1, up["mean"] if is_certain(up) else 0, -row["l2_bytes_ratio"]["mean"])

    def gains(row):
        up = row.get("speed_up")
        return is_certain(up) and up["mean"] > 1 or is_certain(row["l2_bytes_ratio"]) and row["l2_bytes_ratio"]["mean"] < 1

    rows = [r for r in comparison.compared() if gains(r)]
    # Coherent is a bound, not a choice: all pixels share one sample.
    rows = [r for r in rows if r["strategy"] != "coherent"] or rows
    if not rows:
        return None
    best = max(rows, key=gain)
    return {"gpu": comparison.titles[comparison.setting(best)], "strategy": comparison.label(best), "spp": best["spp"],
            "speed": interval(best["speed_up"], 2) if gain(best)[0] else None, "time_known": present(best.get("speed_up")),
            "bytes": change(best["l2_bytes_ratio"]) if is_certain(best["l2_bytes_ratio"]) else None,
            "price": price(best, quality), "quality_command": quality_command(best, comparison.command)}


def verdicts(comparison):
    """The verdict on every strategy, as the program prints it."""
    return [{"title": comparison.titles[comparison.setting(row)], "strategy": comparison.label(row), "spp": row["spp"],
             "text": row["verdict"]["text"]} for row in comparison.rows if row["verdict"]]


def table(comparison, columns, setting):
    lead = [("strategy", comparison.label), ("N", lambda r: str(r["spp"]))]
    if comparison.grouped:
        lead.append(("group", lambda r: r["group"]))
    rows, previous = [], None
    for row in sorted(comparison.of(setting), key=lambda r: r["spp"]):
        compared = not comparison.is_baseline(row)
        rows.append({"rule": previous not in (None, row["spp"]),
                     "cells": [text(row) for _, text in lead] +
                              [cell(figure, row) if compared or not figure["compared"] else "baseline" for figure in columns]})
        previous = row["spp"]
    return {"title": comparison.titles[setting], "lead": [title for title, _ in lead], "rows": rows}


def chart_panels(comparison, key, axis_title, line=None):
    panels = [(comparison.titles[s], charts.bars(comparison, s, key, axis_title, line)) for s in comparison.settings]
    return [(title, svg) for title, svg in panels if svg]


def contents(comparison, quality, picture, command):
    """What the template shows, by the names it uses."""
    columns = [f for f in comparison.figures if f["page"] and any(cell(f, row) != "\u2013" for row in comparison.rows)]
    compares = bool(comparison.baseline) and not comparison.grouped
    found = {
        "scenes": ", ".join(distinct(r["scene"] for r in comparison.rows)),
        "sequences": ", ".join(distinct(r["sequence"] for r in comparison.rows)),
        "samples": len(comparison.rows[0]["samples"]), "windows": comparison.rows[0].get("windows"), "timed": comparison.timed, "grouped": comparison.grouped,
        "compares": compares, "baseline": comparison.baseline_name, "notes": comparison.notes, "command": command,
        "best": best_of(comparison, quality) if compares else None, "verdicts": verdicts(comparison) if compares else [],
        "columns": [{"lines": figure["title"].split(" ", 1), "words": figure["definition"]} for figure in columns],
        "tables": [table(comparison, columns, s) for s in comparison.settings],
        "parameters": distinct((r["strategy"], r["spp"], r["parameters"]) for r in comparison.rows if r["parameters"]),
        "picture": base64.b64encode(picture).decode() if picture else None}
    if not comparison.grouped:
        panels = [(comparison.titles[s], charts.factor_panels(comparison, s)) for s in comparison.settings]
        found.update({
            "legend": list(charts.colours(comparison).items()), "less": charts.LESS, "more": charts.MORE,
            "factors": comparison.factors, "factor_charts": [(title, own) for title, own in panels if own],
            "charts": {"speed_up": chart_panels(comparison, "speed_up", "times as fast", 1),
                       "l2_bytes_per_ray": chart_panels(comparison, "l2_bytes_per_ray", "bytes per ray"),
                       "dram_bytes_per_ray": chart_panels(comparison, "dram_bytes_per_ray", "bytes per ray")}})
    return found


def page(comparison, quality, picture, command):
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(pathlib.Path(__file__).resolve().parent), autoescape=True,
                                     undefined=jinja2.StrictUndefined, keep_trailing_newline=True)
    return environment.get_template("report_page.html").render(page=contents(comparison, quality, picture, command))


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
