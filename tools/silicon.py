"""Replays of kernels that hardware ran and counted (tests/silicon), and the tables of both for docs/accuracy.md."""
import importlib
import json
import pathlib
import subprocess
import sys
import tempfile
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDER = ROOT / "tests/silicon"
TITLE = "Published GPU counters"
WARP = 32

sys.path.insert(0, str(FOLDER))
from kernel_trace import write  # noqa: E402  (where it lies is said above)


def known():
    """(sources, kernels) of tests/silicon/kernels.toml"""
    with open(FOLDER / "kernels.toml", "rb") as file:
        text = tomllib.load(file)
    return text["sources"], text["kernels"]


def generator(kernel):
    module, function = kernel["generator"].split(".")
    return getattr(importlib.import_module(module), function)


def launch(kernel):
    """What the launch itself says: the rest of the preset stays as it is."""
    return {"warps_per_cta": -(-kernel["threads"] // WARP), "warps_per_sm": kernel["resident_warps"]}


class Replays:
    """Traces of kernels in a folder, made once each, and their replays."""

    def __init__(self, program, folder):
        self.program, self.folder = str(program), pathlib.Path(folder)

    def run(self, *arguments):
        return subprocess.run([self.program, *map(str, arguments)], stdout=subprocess.PIPE, text=True, check=True).stdout

    def trace(self, kernel):
        path = self.folder / f"{kernel['generator']}.rct"
        if not path.exists():
            text = path.with_suffix(".traceg")
            write(text, kernel["generator"], kernel["threads"], generator(kernel)())
            self.run("import", text, "--no-fuse", "--stores", "-o", path)
            text.unlink()
        return path

    def counts(self, kernel, **changes):
        """Counts of a functional replay, loads and stores apart, by the names of kernels.toml where it has them."""
        sets = [part for key, value in {**launch(kernel), **changes}.items() for part in ("--set", f"{key}={value}")]
        rows = json.loads(self.run("replay", self.trace(kernel), "--gpu", kernel["gpu"], "--by", "object", "--json", *sets))["rows"]
        of = {row["group"]: row["totals"] for row in rows}
        loads, stores = of["node"], of.get("ray state write", {"sectors": 0})
        return {"l1_reads": loads["sectors"], "l1_read_hits": loads["l1_hits"], "l2_reads": loads["l2_sectors"],
                "l2_read_hits": loads["l2_hits"], "dram_reads": loads["dram_sectors"], "l2_writes": stores["sectors"]}


def off(ours, theirs):
    return 100 * (ours / theirs - 1)


def share(part, whole):
    return 100 * part / whole


class Differences:
    """Of each counter, how far replays are from silicon: mean of the absolute differences, and the worst."""

    def __init__(self):
        self.of = {}

    def add(self, counter, unit, kernel, difference):
        self.of.setdefault((counter, unit), []).append((difference, kernel))
        return f"{difference:+.2f}" + (" %" if unit == "%" else "")

    def table(self):
        lines = ["| counter, V100 | kernels | mean difference | worst | which kernel |", "|---|---|---|---|---|"]
        for (counter, unit), found in self.of.items():
            worst, kernel = max(found, key=lambda f: abs(f[0]))
            mean = sum(abs(d) for d, _ in found) / len(found)
            lines.append(f"| {counter} | {len(found)} | {mean:.2f} {unit} | {worst:+.2f} {unit} | {kernel} |")
        return lines


COUNTERS = (("l1_reads", "L1, read sectors"), ("l1_read_hits", "L1, read hits"), ("l1_read_misses", "L1, read misses"),
            ("l2_writes", "L2, written sectors"), ("l2_reads", "L2, read sectors"), ("l2_read_hits", "L2, read hits"),
            ("dram_reads", "DRAM, read sectors"))
TABLES = (("L1", 3), ("stores, L2, DRAM", 7))


def with_sums(counts):
    """Reads, hits and misses of each level, whichever two of them are known."""
    whole = dict(counts)
    for level in ("l1", "l2"):
        reads, hits, misses = (f"{level}_{what}" for what in ("reads", "read_hits", "read_misses"))
        if reads not in whole:
            whole[reads] = whole[hits] + whole[misses]
        whole[misses] = whole[reads] - whole[hits]
    return whole


def count_tables(replayed):
    """`replayed`: (kernel, its counts) of those with published counts. The summary, and a table for L1 and for the rest."""
    differences = Differences()
    tables, begun = [], 0
    for _, end in TABLES:
        columns = COUNTERS[begun:end]
        lines = ["| kernel |" + "".join(f" {title}: silicon | replay | off |" for _, title in columns),
                 "|---|" + "---|---|---|" * len(columns)]
        begun = end
        for kernel, counts in replayed:
            theirs, ours = with_sums(kernel), with_sums(counts)
            line = f"| {kernel['title']} |"
            for key, title in columns:
                difference = "-"
                if min(theirs[key], ours[key]) > 0:
                    difference = differences.add(title, "%", kernel["title"], off(ours[key], theirs[key]))
                line += f" {theirs[key]:.0f} | {ours[key]} | {difference} |"
            lines.append(line)
        tables.append(lines)
    rates = ["| kernel | L1, hit rate of reads: silicon | replay | points | L2, hit rate of reads: silicon | replay | points |",
             "|---|---|---|---|---|---|---|"]
    for kernel, counts in replayed:
        theirs, ours = with_sums(kernel), with_sums(counts)
        line = f"| {kernel['title']} |"
        for level in ("l1", "l2"):
            a, b = (share(of[f"{level}_read_hits"], of[f"{level}_reads"]) for of in (theirs, ours))
            difference = differences.add(f"{level.upper()}, hit rate of reads", "points", kernel["title"], b - a)
            line += f" {a:.2f} % | {b:.2f} % | {difference} |"
        rates.append(line)
    return [differences.table(), rates, *tables]


def rate_table(replays, kernels):
    """Kernels of which only rates are published, loads and stores together."""
    lines = ["| kernel, RTX 3080 Ti | L1, hit rate: silicon | replay, if L1 has no written sector | if it has all | L2, hit rate: silicon | replay | "
             "with fills of 64 B |", "|---|---|---|---|---|---|---|"]
    for kernel in kernels:
        counts, wide = replays.counts(kernel), replays.counts(kernel, **{"l2.fill_bytes": 64})
        reads, writes = counts["l1_reads"], counts["l2_writes"]
        none, every = (share(counts["l1_read_hits"] + found, reads + writes) for found in (0, writes))
        l2 = [share(c["l2_read_hits"] + writes, c["l2_reads"] + writes) for c in (counts, wide)]
        lines.append(f"| {kernel['title']} | {kernel['l1_hit_rate']:.2f} % | {none:.2f} % | {every:.2f} % | "
                     f"{kernel['l2_hit_rate']:.2f} % | {l2[0]:.2f} % | {l2[1]:.2f} % |")
    return lines


def residency_table(replays, kernel, warps):
    lines = [f"| {kernel['title']}, warps resident on an SM | L1, hit rate of reads | L2, read sectors | DRAM, read sectors |",
             "|---|---|---|---|"]
    for w in warps:
        counts = replays.counts(kernel, warps_per_sm=w)
        lines.append(f"| {w} | {share(counts['l1_read_hits'], counts['l1_reads']):.2f} % | {counts['l2_reads']} | {counts['dram_reads']} |")
    return lines


def share_table(replayed):
    """`replayed`: (kernel, its counts, those with the preset's own residency)."""
    lines = ["| kernel, V100 | L1, hit rate of reads, as launched | with 12 warps resident | L2, read sectors: change | DRAM, read sectors: change |",
             "|---|---|---|---|---|"]
    for kernel, full, few in replayed:
        rates = [share(c["l1_read_hits"], c["l1_reads"]) for c in (full, few)]
        changes = [off(few[key], full[key]) for key in ("l2_reads", "dram_reads")]
        lines.append(f"| {kernel['title']} | {rates[0]:.2f} % | {rates[1]:.2f} % | {changes[0]:+.2f} % | {changes[1]:+.2f} % |")
    return lines


def launch_table(kernels):
    lines = ["| kernel | GPU | threads of a CTA | resident warps | input |", "|---|---|---|---|---|"]
    for kernel in kernels:
        lines.append(f"| {kernel['title']} | `{kernel['gpu']}` | {kernel['threads']} | {kernel['resident_warps']} | {kernel['input']} |")
    return lines


def section(program):
    """The section of docs/accuracy.md, below its title."""
    _, kernels = known()
    counted = [k for k in kernels.values() if "l1_read_hits" in k]
    rated = [k for k in kernels.values() if "l1_hit_rate" in k]
    with tempfile.TemporaryDirectory() as folder:
        replays = Replays(program, folder)
        replayed = [(kernel, replays.counts(kernel)) for kernel in counted]
        tables = [*count_tables(replayed), rate_table(replays, rated),
                  share_table([(kernel, counts, replays.counts(kernel, warps_per_sm=12)) for kernel, counts in replayed]),
                  residency_table(replays, kernels["sgemm"], (4, 8, 12, 16, 24, 28))]
    tables.append(launch_table(kernels.values()))
    text = (ROOT / "docs/accuracy/silicon.md").read_text().rstrip()
    return text.splitlines() + [line for table in tables for line in ["", *table]]
