"""Parboil's sgemm: C = alpha A B^T + beta C with register tiling (Volkov, Demmel 2008), column-major.

A CTA of 128 threads computes 128 rows and 16 columns of C, a thread 16 elements of one row. Of every 8 columns of A and
B it first loads the 8 x 16 elements of B to shared memory, one a thread, then walks the 8 columns of A: a thread reads
the element of its row. Rows of 32 threads are contiguous, those of B in two runs of 16.
"""
import numpy as np

from kernel_trace import Memory, load, store

TILE_N, TILE_K = 16, 8
THREADS = TILE_N * TILE_K


def ctas(rows=1024, columns=1056, inner=992):
    """Steps of each CTA. Rows are multiples of 128, columns of 16, `inner` of 8."""
    memory = Memory()
    a, b, c = memory.array(rows * inner), memory.array(columns * inner), memory.array(rows * columns)
    thread = np.arange(THREADS)
    in_tile = thread // TILE_N * columns + thread % TILE_N
    for column in range(0, columns, TILE_N):
        for row in range(0, rows, THREADS):
            steps = []
            for k in range(0, inner, TILE_K):
                steps.append(load(b + 4 * (column + k * columns + in_tile)))
                steps += [load(a + 4 * (row + thread + (k + j) * rows)) for j in range(TILE_K)]
            for j in range(TILE_N):
                element = c + 4 * (row + thread + (column + j) * rows)
                steps += [load(element), store(element)]
            yield steps
