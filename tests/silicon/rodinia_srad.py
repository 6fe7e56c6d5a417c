"""Rodinia's srad (version 1), the kernel that finds derivatives and diffusion coefficients of an image.

One thread a pixel, column after column. It reads its pixel, four tables of neighbours (by row: north, south; by column:
west, east) and the four neighbours they name, and writes four derivatives and a coefficient.
"""
import numpy as np

from kernel_trace import Memory, load, only, store

THREADS = 512


def ctas(rows=502, columns=458):
    pixels = rows * columns
    memory = Memory()
    image = memory.array(pixels)
    tables = [memory.array(rows), memory.array(rows), memory.array(columns), memory.array(columns)]
    results = [memory.array(pixels) for _ in range(5)]
    for first in range(0, pixels, THREADS):
        pixel = first + np.arange(THREADS)
        inside = pixel < pixels
        column, row = np.divmod(pixel, rows)
        north, south = np.maximum(row - 1, 0), np.minimum(row + 1, rows - 1)
        west, east = np.maximum(column - 1, 0), np.minimum(column + 1, columns - 1)
        steps = [load(only(inside, image + 4 * pixel))]
        for table, entry, neighbour in ((tables[0], row, column * rows + north), (tables[1], row, column * rows + south),
                                        (tables[2], column, west * rows + row), (tables[3], column, east * rows + row)):
            steps += [load(only(inside, table + 4 * entry)), load(only(inside, image + 4 * neighbour))]
        yield steps + [store(only(inside, result + 4 * pixel)) for result in results]
