"""The page and the picture of what tools/tradeoff measured."""
import io
import math

import matplotlib

matplotlib.use("agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend must be chosen first)

# Warp instructions per CPU second of the reference simulator, as docs/benchmarks.md has it.
SIMULATOR = 1700
COLOURS = {"unique sectors": "#e69f00", "reuse distances": "#cc79a7", "functional windows": "#56b4e9",
           "functional exact": "#0072b2", "timed windows": "#d55e00", "timed exact": "#009e73"}  # Okabe & Ito
SIZES = {0.1: 5, 0.05: 7.5, 0.02: 10}
# What an answer says, whether errors of it are differences in points of per cent, and which level is the truth.
FIGURES = [("l1_hit_rate", "L1 hits", True, "functional exact"), ("l2_hit_rate", "L2 hits", True, "functional exact"),
           ("l2_bytes_per_ray", "L2->L1 B/ray", False, "functional exact"),
           ("dram_bytes_per_ray", "DRAM B/ray", False, "functional exact"),
           ("cycles_per_ray", "cycles/ray", False, "timed exact"), ("speed_up", "speed-up", False, "timed exact")]
# Of the question on a picture of 1920x1080 with N = 1024.
REAL_PATHS = 1920 * 1080 * 1024
# Estimates there take 46 SMs for 2 and 8 windows a block for 2; places for work and SMs are only 16 times as many.
MORE_OF_WINDOWS = 46 / 2 * 8 / 2


def value(answers, strategy, key):
    if key == "speed_up":
        return answers[0]["cycles_per_ray"] / answers[strategy]["cycles_per_ray"]
    return answers[strategy][key]


class Rung:
    """One level and target on one scene: CPU seconds and errors, root of the mean square over its drawings."""

    def __init__(self, name, target, results, truth, drawings):
        self.name, self.target = name, target
        self.seconds = sum(r["seconds"] for r in results) / len(results)
        self.blocks = [r["blocks"] for r in results]
        self.reached, self.drawings = len(results), drawings
        self.errors = {key: max(self.error(results, truth[of]["answers"], s, key, points)
                                for s in range(1 if key == "speed_up" else 0, len(truth[of]["answers"])))
                       for key, _, points, of in FIGURES}

    @staticmethod
    def error(results, truth, strategy, key, points):
        exact = value(truth, strategy, key)
        off = [value(r["answers"], strategy, key) - exact for r in results]
        return math.sqrt(sum(o * o for o in off) / len(off)) / (1 if points else abs(exact))

    def label(self):
        return self.name + (f", {100 * self.target:g} %" if self.target else "")


def rungs(scene):
    truth = {level["level"]: level for level in scene["levels"] if not level["target"]}
    by_kind = {}
    for level in scene["levels"]:
        by_kind.setdefault((level["level"], level["target"]), []).append(level)
    drawings = max(level["drawing"] for level in scene["levels"])
    order = list(COLOURS)
    return sorted((Rung(name, target, results, truth, drawings if target else 1) for (name, target), results in by_kind.items()),
                  key=lambda r: (order.index(r.name), -r.target))


def ladder(measured):
    """By label, in order: the rungs of all scenes that have it."""
    found = {}
    for scene in measured:
        for rung in rungs(scene):
            found.setdefault(rung.label(), []).append(rung)
    order = list(COLOURS)
    return dict(sorted(found.items(), key=lambda item: (order.index(item[1][0].name), -item[1][0].target)))


def worst(rung_list, key):
    return max(r.errors[key] for r in rung_list)


def seconds(rung_list):
    return sum(r.seconds for r in rung_list) / len(rung_list)


def complete(rung_list, measured):
    return len(rung_list) == len(measured) and all(r.reached == r.drawings for r in rung_list)


def pareto(points):
    """Labels of (label, seconds, error) that no other beats in both."""
    return [label for label, s, e in points
            if not any((os <= s and oe < e) or (os < s and oe <= e) for _, os, oe in points)]


def percent(x):
    return f"{100 * x:.1f} %" if x < 0.1 else f"{100 * x:.0f} %"


def duration(s):
    for limit, unit, name in ((100, 1, "s"), (6000, 60, "min"), (172800, 3600, "h"), (math.inf, 86400, "days")):
        if s < limit:
            return f"{s / unit:.2g} {name}" if s / unit < 10 else f"{s / unit:,.0f} {name}".replace(",", " ")


OPTIONS = {"unique sectors": "no option", "reuse distances": "no option", "functional windows": "`--target-error {}`",
           "functional exact": "none", "timed windows": "`--timed --target-error {}`", "timed exact": "`--fidelity exact`"}


def option(rung):
    return OPTIONS[rung.name].format(f"{100 * rung.target:g}%")


def real_seconds(rung_list, paths):
    """On the real picture: computed; of windows at most."""
    return seconds(rung_list) * (MORE_OF_WINDOWS if rung_list[0].target else REAL_PATHS / paths)


def real_duration(rung_list, paths):
    return ("at most " if rung_list[0].target else "") + duration(real_seconds(rung_list, paths))


def first_table(measured, levels, paths):
    """The cheapest levels whose error is within each bound, of those that say so in the program's own words."""
    lines = ["| wanted, in the worst case | cheapest on a real picture | option of `compare` | CPU time there | cheapest here | CPU time |",
             "|---|---|---|---|---|---|"]
    for title, keys in (("speed-up", ["speed_up"]), ("cycles per ray", ["cycles_per_ray"]),
                        ("bytes per ray of L2->L1 and DRAM", ["l2_bytes_per_ray", "dram_bytes_per_ray"])):
        for bound in (0.1, 0.05, 0.02):
            fits = {label: r for label, r in levels.items()
                    if complete(r, measured) and max(worst(r, k) for k in keys) <= bound and "no option" != option(r[0])
                    and (r[0].name.startswith("timed") or keys[0] not in ("speed_up", "cycles_per_ray"))}
            real = min(fits, key=lambda label: real_seconds(fits[label], paths))
            here = min(fits, key=lambda label: seconds(fits[label]))
            lines.append(f"| {title} within {100 * bound:g} % | {real} | {option(fits[real][0])} | "
                         f"{real_duration(fits[real], paths)} | {here} | {duration(seconds(fits[here]))} |")
    return lines


def level_table(measured, levels, paths):
    speed = pareto([(label, seconds(r), worst(r, "speed_up")) for label, r in levels.items() if complete(r, measured)])
    lines = ["| level | CPU s | at 1920x1080, N = 1024 | " + " | ".join(title for _, title, _, _ in FIGURES) +
             " | front | blocks |", "|" + "---|" * (len(FIGURES) + 5)]
    for label, r in levels.items():
        blocks = sorted(b for rung in r for b in rung.blocks)
        span = f"{blocks[0]}–{blocks[-1]}" if r[0].target else ""
        reached, all_of = sum(x.reached for x in r), sum(x.drawings for x in r) + r[0].drawings * (len(measured) - len(r))
        if reached < all_of:
            span += f"; reached by {reached} of {all_of}"
        lines.append(f"| {label} | {seconds(r):.1f} | {real_duration(r, paths)} | " +
                     " | ".join(percent(worst(r, key)) + (" pt" if points else "") for key, _, points, _ in FIGURES) +
                     f" | {'yes' if label in speed else ''} | {span} |")
    simulated = sum(s["warp_instructions"] for s in measured) / len(measured) / SIMULATOR
    lines.append(f"| cycle-level simulator (computed) | {duration(simulated)} | {duration(simulated * REAL_PATHS / paths)} |" +
                 " |" * (len(FIGURES) + 2))
    return [line.replace(" % pt", " pt") for line in lines]


def scene_table(measured):
    lines = ["| scene | strategy | exact speed-up | unique sectors | reuse distances | functional exact | issue busy |", "|" + "---|" * 7]
    for scene in measured:
        truth = {level["level"]: level["answers"] for level in scene["levels"] if not level["target"]}
        for s in range(len(scene["strategies"])):
            cells = [f"{value(truth[name], s, 'speed_up'):.3f}" for name in ("timed exact", "unique sectors", "reuse distances",
                                                                             "functional exact")]
            lines.append(f"| {scene['scene']} | {scene['strategies'][s]} | " + " | ".join(cells) +
                         f" | {100 * scene['issue_busy'][s]:.0f} % |")
    return lines


def draw(measured, levels):
    figure, axes = plt.subplots(1, len(measured), figsize=(4.2 * len(measured), 4.4), sharey=True, squeeze=False)
    for axis, scene in zip(axes[0], measured):
        mine = [r for r in rungs(scene) if r.reached == r.drawings]
        points = [(r.seconds, 100 * max(r.errors["speed_up"], 1e-4), r) for r in mine]
        front = sorted((s, e) for s, e, r in points if r.label() in pareto([(q.label(), t, f) for t, f, q in points]))
        axis.step(*zip(*front), where="post", color="#bbbbbb", zorder=1)
        for s, e, r in points:
            axis.plot(s, e, "o", color=COLOURS[r.name], markersize=SIZES.get(r.target, 7.5), zorder=2,
                      label=r.name if r.target in (0, 0.05) else None)
        simulated = scene["warp_instructions"] / SIMULATOR
        axis.axvline(simulated, color="#666666", linestyle=":", label="cycle-level simulator")
        axis.set(xscale="log", yscale="log", title=scene["scene"], xlabel="CPU seconds, all strategies")
        axis.grid(True, which="both", color="#eeeeee")
    axes[0][0].set_ylabel("error of the speed-up, worst strategy, %\n(exact: 0, drawn at 0.01)")
    handles, labels = axes[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="lower center", ncol=4, frameon=False, fontsize=9)
    figure.suptitle("What accuracy costs (windows: larger dots, smaller target)")
    figure.tight_layout(rect=(0, 0.11, 1, 1))
    data = io.BytesIO()
    figure.savefig(data, format="png", dpi=110, metadata={"Software": None})
    return data.getvalue()
