#!/usr/bin/python3
"""Kernels whose counters on hardware are published (tests/silicon): the replay of what their generators write. Expected
counts are worked out by hand; those of the true sizes, which tools/accuracy replays, by the same formulas."""
import itertools
import sys

from support import RAYCACHE, ROOT, ProgramTest, main

sys.path.insert(0, str(ROOT / "tools"))
import silicon  # noqa: E402

import kernel_trace  # noqa: E402  (tests/silicon, which silicon puts on the path)
import parboil_sgemm  # noqa: E402
import rodinia_hotspot  # noqa: E402

SMS, SECTOR_FLOATS = 80, 8


def sgemm_counts(rows, columns, inner):
    """Where all CTAs are resident at once and walk in step, and a multiple of the CTAs of a column are the SMs: all CTAs
    of an SM have the same rows of A, whose sectors miss once an SM; B and C are a CTA's own."""
    ctas = rows // 128 * (columns // 16)
    a, b, c = 16 * inner, 4 * 4 * inner // 8, 4 * 4 * 16  # sectors that a CTA reads of each
    return {"l1_reads": ctas * (a + b + c), "l2_reads": min(ctas, SMS) * a + ctas * (b + c),
            "dram_reads": (rows * inner + columns * inner + rows * columns) // SECTOR_FLOATS,
            "l2_writes": rows * columns // SECTOR_FLOATS}


def hotspot_counts(side, rim=2, block=16):
    """Each row of a tile is a run of its cells within the chip: so many sectors; nothing is read twice by an SM."""
    def tiles(margin):
        return [(max(0, first - rim + margin), min(side, first - rim + block - margin)) for first in range(0, side, block - 2 * rim)]

    def sectors(runs):
        return sum((end - 1) // SECTOR_FLOATS - begin // SECTOR_FLOATS + 1 for begin, end in runs)

    def rows(runs):
        return sum(end - begin for begin, end in runs)

    return {"l1_reads": 2 * rows(tiles(0)) * sectors(tiles(0)), "dram_reads": 2 * side * side // SECTOR_FLOATS,
            "l2_writes": rows(tiles(rim)) * sectors(tiles(rim))}


class PublishedCounters(ProgramTest):
    def counts(self, name, ctas):
        """Of so many CTAs of a kernel of the table."""
        _, kernels = silicon.known()
        kernel = dict(kernels[name])
        kernel_trace.write(self.path("k.traceg"), name, kernel["threads"], ctas)
        self.succeeds("import", "k.traceg", "--no-fuse", "--stores", "-o", f"{kernel['generator']}.rct")
        return silicon.Replays(RAYCACHE, self.folder).counts(kernel)

    def holds(self, counts, expected):
        self.assertEqual({key: counts[key] for key in expected}, expected)

    def test_sgemm_reads_a_once_an_sm_and_its_true_size_is_within_a_five_thousandth_of_silicon(self):
        size = {"rows": 1024, "columns": 12 * 16, "inner": 16}
        self.holds(self.counts("sgemm", parboil_sgemm.ctas(**size)), sgemm_counts(**size))
        theirs = silicon.with_sums(silicon.known()[1]["sgemm"])
        ours = sgemm_counts(rows=1024, columns=1056, inner=992)
        self.assertEqual([ours[key] for key in ("l1_reads", "l2_reads", "dram_reads")], [9563136, 2452480, 393088])
        for key in ours:
            self.assertLess(abs(ours[key] / theirs[key] - 1), 0.0002, key)

    def test_hotspot_reads_each_run_of_a_tile_once_and_its_true_size_is_within_a_thousandth_of_silicon(self):
        counts = self.counts("hotspot", rodinia_hotspot.ctas(side=100))
        self.holds(counts, {**hotspot_counts(100), "l1_read_hits": 0})
        theirs = silicon.with_sums(silicon.known()[1]["hotspot"])
        ours = hotspot_counts(1024)
        self.assertEqual(ours, {"l1_reads": 695640, "dram_reads": 262144, "l2_writes": 175104})
        for key in ours:
            self.assertLess(abs(ours[key] / theirs[key] - 1), 0.001, key)

    def test_every_kernel_of_the_table_is_written_and_replayed(self):
        _, kernels = silicon.known()
        self.assertGreaterEqual(len(kernels), 8)
        for name, kernel in kernels.items():
            with self.subTest(name):
                counts = self.counts(name, itertools.islice(silicon.generator(kernel)(), 2))
                self.assertGreater(counts["l1_reads"], 0)
                self.assertGreater(counts["l2_writes"], 0)
                self.assertGreaterEqual(counts["l1_reads"], counts["l2_reads"])


if __name__ == "__main__":
    main()
