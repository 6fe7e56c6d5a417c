"""What the page of report.py shows of the JSON of `raycache compare`: rows, labels, and numbers as text."""
import re


class BadInput(Exception):
    pass


def present(estimate):
    return estimate is not None and estimate["mean"] is not None


def half_width(estimate):
    return (estimate["half_width_95"] or 0) if present(estimate) else 0


def is_certain(ratio):
    """Whether the 95 % interval of a ratio does not hold 1."""
    return present(ratio) and ratio["half_width_95"] is not None and abs(ratio["mean"] - 1) > ratio["half_width_95"]


def fixed(estimate, digits):
    return f"{estimate['mean']:.{digits}f}" if present(estimate) else "\u2013"


def percent(estimate, digits):
    return f"{100 * estimate['mean']:.{digits}f} %" if present(estimate) else "\u2013"


def interval(estimate, digits=None):
    """About four digits, or so many decimals, and the half width to the same place."""
    if not present(estimate):
        return "\u2013"
    mean, half = estimate["mean"], estimate["half_width_95"]
    if digits is None:
        digits = 0 if abs(mean) >= 1000 else 1 if abs(mean) >= 100 else 2 if abs(mean) >= 10 else 3
    return f"{mean:.{digits}f}" + ("" if half is None else f" \u00b1{half:.{digits}f}")


def cell(figure, row):
    """What a figure of the report's `figures` says of a row, the way the program wants it shown."""
    value = row
    for key in figure["path"]:
        value = value.get(key) if value else None
    if isinstance(value, int):
        return f"{value:,}".replace(",", "\u202f")
    if figure["unit"] == "share":
        return percent(value, figure["digits"])
    return interval(value, figure["digits"]) if figure["interval"] else fixed(value, figure["digits"])


def change(ratio):
    """Such as "31 \u00b14 % less"."""
    size = 100 * abs(1 - ratio["mean"])
    width = "" if ratio["half_width_95"] is None else f" \u00b1{100 * ratio['half_width_95']:.{0 if size >= 10 else 1}f}"
    return f"{size:.{0 if size >= 10 else 1}f}{width} % {'less' if ratio['mean'] < 1 else 'more'}"


def distinct(values):
    return list(dict.fromkeys(values))


class Comparison:
    """The rows, sorted into settings (what the strategies share, except N) and labels (what tells strategies apart)."""

    def __init__(self, report):
        # A row of `compare --timed` has the figures of one without under "traffic".
        self.rows = [{"group": "all", **row, **(row.get("traffic") or {}), "verdict": row.get("verdict")}
                     for row in report["rows"]]
        if not self.rows:
            raise BadInput("no rows; run 'raycache compare' first")
        if any("dram_bytes_per_ray" not in row for row in self.rows):
            raise BadInput("rows without traffic")
        self.baseline = report["baseline"]
        self.baseline_gpu = report.get("baseline_gpu")  # None: each row's own
        self.baseline_name = f"{self.baseline} on {self.baseline_gpu}" if self.baseline_gpu else self.baseline
        self.notes = report["notes"]
        self.command = report.get("settings") or {}
        self.grouped = report.get("by", "none") != "none"
        self.timed = any("cycles" in row for row in self.rows)
        if "figures" not in report:
            raise BadInput("no figures: made by an older version of raycache; run it again")
        self.figures = report["figures"]
        self.factors = [(f["key"], f["title"], f["definition"]) for f in self.figures if f["path"][-2:-1] == ["factors"]]
        fields = [f for f in ("scene", "sequence", "thread_map") if len({r[f] for r in self.rows}) > 1]
        seen = [(self.setting(r), r["strategy"], r["spp"], r["group"]) for r in self.rows]
        self.ambiguous = {entry[1] for entry in seen if seen.count(entry) > 1}
        self.settings = distinct(self.setting(r) for r in self.rows)
        self.titles = {self.setting(r): ", ".join([r["gpu"], *(r[f] for f in fields)]) for r in self.rows}
        self.labels = distinct(self.label(r) for r in self.rows)

    @staticmethod
    def setting(row):
        return row["gpu"], row["scene"], row["sequence"], row["thread_map"]

    def label(self, row):
        """The strategy, with what tells it from another row of the same name: its K where it has one."""
        if row["strategy"] not in self.ambiguous or not row["parameters"]:
            return row["strategy"]
        k = re.match(r"K=(\S+)", row["parameters"])
        return f"{row['strategy']}, K = {k[1]}" if k else f"{row['strategy']} ({row['parameters']})"

    def is_baseline(self, row):
        return row["strategy"] == self.baseline and self.baseline_gpu in (None, row["gpu"])

    def of(self, setting):
        return [r for r in self.rows if self.setting(r) == setting]

    def compared(self):
        """The rows that have a ratio to the baseline."""
        return [r for r in self.rows if present(r["l2_bytes_ratio"]) and present(r["dram_bytes_ratio"])]
