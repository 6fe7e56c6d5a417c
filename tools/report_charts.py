"""The charts of report.py: one small picture for each panel, so that a narrow screen shows them below each other."""
import base64
import io

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend must be chosen first)

from report_numbers import half_width, present  # noqa: E402

COLOURS = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#999999"]  # Okabe & Ito: for all eyes
LESS, MORE = "#009e73", "#d55e00"
SIZE = 3.6  # inches a panel is wide, so that it fits a telephone

plt.rcParams.update({"svg.hashsalt": "raycache", "font.size": 9})  # the same input gives the same bytes


def colours(comparison):
    return {label: COLOURS[i % len(COLOURS)] for i, label in enumerate(comparison.labels)}


def svg(figure):
    buffer = io.StringIO()
    figure.savefig(buffer, format="svg", metadata={"Date": None})
    plt.close(figure)
    return base64.b64encode(buffer.getvalue().encode()).decode()


def bars(comparison, setting, key, axis_title, line=None):
    """One quantity: a group of bars per N, a bar per strategy. None where no row has it."""
    rows = [r for r in comparison.of(setting) if present(r.get(key))]
    if not rows:
        return None
    figure, axis = plt.subplots(figsize=(SIZE, 2.7), layout="constrained")
    counts = sorted({r["spp"] for r in rows})
    labels = [label for label in comparison.labels if any(comparison.label(r) == label for r in rows)]
    width = 0.8 / len(labels)
    for i, label in enumerate(labels):
        own = {r["spp"]: r[key] for r in rows if comparison.label(r) == label}
        axis.bar([counts.index(n) + (i - (len(labels) - 1) / 2) * width for n in own],
                 [e["mean"] for e in own.values()], width * 0.92, color=colours(comparison)[label], label=label,
                 yerr=[half_width(e) for e in own.values()], capsize=3, error_kw={"elinewidth": 1})
    axis.set_xticks(range(len(counts)), [f"N = {n}" for n in counts])
    axis.set_title(comparison.titles[setting], fontsize=10)
    axis.set_ylabel(axis_title)
    axis.set_ylim(bottom=0)
    if line is not None:
        axis.axhline(line, color="black", linewidth=0.8, linestyle="--")
    axis.spines[["top", "right"]].set_visible(False)
    return svg(figure)


def factor_panel(comparison, row, limits):
    """From 1 to the ratios, factor by factor: one strategy, N and GPU."""
    figure, axis = plt.subplots(figsize=(SIZE, 2.9), layout="constrained")
    names, value, place = [], 1, 0
    for key, name, _ in comparison.factors:
        factor = row["factors"][key]
        axis.barh(place, value * factor["mean"] - value, left=value, color=LESS if factor["mean"] < 1 else MORE, height=0.7)
        after = value * factor["mean"]
        width = f" \u00b1{factor['half_width_95']:.2f}" if factor["half_width_95"] is not None else ""
        axis.annotate(f"\u00d7 {factor['mean']:.2f}{width}", (max(value, after), place), xytext=(4, 0),
                      textcoords="offset points", va="center", fontsize=8)
        names.append(name)
        value = after
        place += 1
        total = {"l1_locality": ("= L2\u2192L1 bytes", "l2_bytes_ratio"), comparison.factors[-1][0]: ("= DRAM bytes", "dram_bytes_ratio")}.get(key)
        if total:
            ratio = row[total[1]]
            axis.barh(place, value - 1, left=1, color="#444444", height=0.7, xerr=half_width(ratio),
                      error_kw={"ecolor": "black", "capsize": 3})
            axis.annotate(f"= {value:.2f} \u00b1{half_width(ratio):.2f}", (max(1, value + half_width(ratio)), place), xytext=(4, 0),
                          textcoords="offset points", va="center", fontsize=8, weight="bold")
            names.append(total[0])
            place += 1
    axis.axvline(1, color="black", linewidth=0.8)
    axis.set_yticks(range(len(names)), names)
    axis.set_xlim(*limits)
    axis.invert_yaxis()
    axis.set_title(f"{comparison.label(row)}, N = {row['spp']}", fontsize=9)
    axis.spines[["top", "right"]].set_visible(False)
    return svg(figure)


def factor_panels(comparison, setting):
    """A panel per strategy and N, all on one scale; [(alternative text, SVG)]."""
    rows = [r for r in comparison.of(setting) if r["factors"]]
    low, high = 1, 1
    for row in rows:
        value = 1
        for key, _, _ in comparison.factors:
            value *= row["factors"][key]["mean"]
            low, high = min(low, value), max(high, value)
        for ratio in (row["l2_bytes_ratio"], row["dram_bytes_ratio"]):
            low, high = min(low, ratio["mean"] - half_width(ratio)), max(high, ratio["mean"] + half_width(ratio))
    limits = max(0, low - 0.02), high + (high - low) * 0.45  # room for the numbers
    order = {label: i for i, label in enumerate(comparison.labels)}
    rows.sort(key=lambda r: (r["spp"], order[comparison.label(r)]))
    return [(f"{comparison.label(r)}, N = {r['spp']}: factors of the traffic ratios", factor_panel(comparison, r, limits))
            for r in rows]
