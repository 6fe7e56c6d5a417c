"""Kernels of the CUDA samples that stream: fast Walsh transform, histogram of 64 bins, Sobol's sequence."""
import numpy as np

from kernel_trace import Memory, load, only, store


def walsh_batch(log2_count=23, log2_part=11):
    """fastWalshTransform, the last passes: a CTA transforms 2^11 numbers in shared memory, in place."""
    memory = Memory()
    numbers = memory.array(1 << log2_count)
    thread = np.arange(1 << log2_part - 2)  # a radix-4 step has a thread for four numbers
    for first in range(0, 1 << log2_count, 1 << log2_part):
        at = [numbers + 4 * (first + quarter * len(thread) + thread) for quarter in range(4)]
        yield [load(a) for a in at] + [store(a) for a in at]


def histogram64(mebibytes=64, ctas=4370):
    """histogram: threads in groups of 64 read 16 B each, striding by the grid; then a CTA writes its 64 counts."""
    memory = Memory()
    pieces = mebibytes << 16
    data, counts = memory.array(pieces, 16), memory.array(ctas * 64)
    thread = np.arange(64)
    for cta in range(ctas):
        steps = []
        for first in range(64 * cta, pieces, 64 * ctas):
            steps.append(load(only(first + thread < pieces, data + 16 * (first + thread)), 16))
        yield steps + [store(counts + 4 * (64 * cta + thread))]


def sobol(vectors=100_000, dimensions=100, ctas_of_dimension=512):
    """SobolQRNG: of each dimension, CTAs of 64 threads; 32 read the direction numbers, all write points, striding by
    the CTAs of the dimension."""
    memory = Memory()
    directions, points = memory.array(32 * dimensions), memory.array(vectors * dimensions)
    thread = np.arange(64)
    for dimension in range(dimensions):
        for cta in range(ctas_of_dimension):
            steps = [load(only(thread < 32, directions + 4 * (32 * dimension + thread)))]
            for first in range(64 * cta, vectors, 64 * ctas_of_dimension):
                steps.append(store(only(first + thread < vectors, points + 4 * (vectors * dimension + first + thread))))
            yield steps
