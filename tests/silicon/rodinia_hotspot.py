"""Rodinia's hotspot: temperatures of a chip, a few steps in time a launch (a pyramid).

A CTA of 16 x 16 threads loads its tile of temperatures and of power with the rim that the steps need, works in shared
memory, and writes the cells that are right after the last step. So tiles overlap: of 16 cells a side, 12 are written
after two steps.
"""
import numpy as np

from kernel_trace import Memory, load, only, store

BLOCK = 16


def ctas(side=1024, pyramid=2):
    """Steps of each CTA for a square grid of cells, in order of launch."""
    memory = Memory()
    temperature, power, result = (memory.array(side * side) for _ in range(3))
    rim = pyramid  # one cell a step
    inner = BLOCK - 2 * rim
    y, x = np.divmod(np.arange(BLOCK * BLOCK), BLOCK)
    for block_y in range(0, side, inner):
        for block_x in range(0, side, inner):
            row, column = block_y - rim + y, block_x - rim + x
            inside = (row >= 0) & (row < side) & (column >= 0) & (column < side)
            cell = 4 * (row * side + column)
            written = inside & (x >= rim) & (x < BLOCK - rim) & (y >= rim) & (y < BLOCK - rim)
            yield [load(only(inside, temperature + cell)), load(only(inside, power + cell)),
                   store(only(written, result + cell))]
