"""mergeSort of the CUDA samples: keys and values are sorted in shared memory, then merged in pairs of runs.

`shared`: a CTA of 512 threads reads 1024 keys and values, two a thread, and writes them sorted.

`elementary`: one merge of runs of `stride` keys. Every 128th key of both runs bounds an interval of the result; a CTA of
128 threads merges one interval: thread 0 reads where it begins and ends in both runs, then each thread reads a key and a
value of either run, as far as the interval has them, and writes the merged ones. Where intervals begin follows from the
keys, so that few lie on a sector's bound.
"""
import numpy as np

from kernel_trace import Memory, load, only, store

SHARED, SAMPLE = 1024, 128


def shared(count=4 << 20):
    memory = Memory()
    keys, values, sorted_keys, sorted_values = (memory.array(count) for _ in range(4))
    thread = np.arange(SHARED // 2)
    for first in range(0, count, SHARED):
        element = 4 * (first + thread)
        half = 4 * SHARED // 2
        yield ([load(a + element + more) for more in (0, half) for a in (keys, values)] +
               [store(a + element + more) for more in (0, half) for a in (sorted_keys, sorted_values)])


def limits(runs):
    """Where the intervals of a pair of sorted runs begin in each, and behind them the ends."""
    a, b = runs
    samples = np.concatenate([a[::SAMPLE], b[::SAMPLE]])
    own = np.tile(np.arange(0, len(a), SAMPLE), 2)
    half = len(samples) // 2
    in_a = np.concatenate([own[:half], np.searchsorted(a, samples[half:], "right")])
    in_b = np.concatenate([np.searchsorted(b, samples[:half], "left"), own[half:]])
    return (np.append(np.sort(in_a), len(a)), np.append(np.sort(in_b), len(b)))


def elementary(count=4 << 20, stride=1 << 16, key_values=65536, seed=1):
    memory = Memory()
    keys, values, merged_keys, merged_values = (memory.array(count) for _ in range(4))
    limits_a, limits_b = (memory.array(count // SAMPLE) for _ in range(2))
    random = np.random.default_rng(seed)
    thread = np.arange(SAMPLE)
    number = 0
    for first in range(0, count, 2 * stride):
        bounds = limits(np.sort(random.integers(0, key_values, (2, stride)), axis=1))
        intervals = len(bounds[0]) - 1
        for i in range(intervals):
            (begin_a, end_a), (begin_b, end_b) = ((int(of[i]), int(of[i + 1])) for of in bounds)
            ends = 1 if i + 1 < intervals else 0
            steps = [load(only(thread == 0, a + 4 * (number + next_one)))
                     for next_one in range(1 + ends) for a in (limits_a, limits_b)]
            parts = ((thread < end_a - begin_a, 4 * (first + begin_a + thread), 4 * (first + begin_a + begin_b + thread)),
                     (thread < end_b - begin_b, 4 * (first + stride + begin_b + thread),
                      4 * (first + begin_b + end_a + thread)))
            steps += [load(only(part, a + read)) for part, read, _ in parts for a in (keys, values)]
            steps += [store(only(part, a + written)) for part, _, written in parts for a in (merged_keys, merged_values)]
            yield steps
            number += 1
