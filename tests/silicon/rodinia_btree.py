"""Rodinia's b+tree, findK: each CTA looks for one key in a B+ tree, a thread a key of the node.

A node has 256 keys. Every thread compares its key of the node, and where that is not above the wanted one, the next
key, too; the thread between whose two keys the wanted one lies reads the child and stores it as the CTA's next node,
and thread 0 copies it. At the leaf the thread that has the key reads the place of the record, then the record.

The tree is built here as the program builds it from ascending keys: nodes are split in halves, so all but the last have
half of their keys. Keys that are wanted are uniformly random.
"""
import numpy as np

from kernel_trace import Memory, load, only, store

ORDER = 256
NODE_BYTES = 4 + 2 * 4 * (ORDER + 1) + 4 + 4  # its place, children, keys, whether it is a leaf, number of keys
CHILDREN, KEYS = 4, 4 + 4 * (ORDER + 1)
HALF = ORDER // 2 - 1  # keys that a split of ascending keys leaves in a node


def place_of(key, records):
    """Of each level from the root: the node's number in breadth-first order, and the place of the key in it."""
    counts = [records // (HALF)]  # leaves
    while counts[-1] > ORDER:
        counts.append(counts[-1] // (HALF + 1))
    counts.append(1)
    firsts = np.cumsum([0] + counts[:0:-1])
    leaf = min(key // HALF, counts[0] - 1)
    path = [(leaf, key - leaf * HALF)]
    for count in counts[1:]:
        node = min(path[-1][0] // (HALF + 1), count - 1)
        path.append((node, path[-1][0] - node * (HALF + 1)))
    return [(int(firsts[i]) + node, slot) for i, (node, slot) in enumerate(reversed(path))]


def ctas(records=1_000_000, searches=10_000, seed=1):
    memory = Memory()
    record, node = memory.array(records), memory.array(2 * records // ORDER * NODE_BYTES, 1)
    current, offset = memory.array(searches, 8), memory.array(searches, 8)
    keys, answers = memory.array(searches), memory.array(searches)
    thread = np.arange(ORDER)
    wanted = np.random.default_rng(seed).integers(0, records, searches)
    for search in range(searches):
        path = place_of(int(wanted[search]), records)
        all_of = [np.full(ORDER, a + 8 * search) for a in (current, offset)]
        key = np.full(ORDER, keys + 4 * search)
        steps = []
        for number, slot in path[:-1]:
            at = node + NODE_BYTES * number
            found = thread == slot
            steps += [load(all_of[0], 8), load(at + KEYS + 4 * thread), load(key),
                      load(only(thread <= slot, at + KEYS + 4 * (thread + 1))),
                      load(only(found, all_of[1]), 8), load(only(found, at + CHILDREN + 4 * thread)),
                      store(only(found, all_of[1]), 8),
                      load(only(thread == 0, all_of[1]), 8), store(only(thread == 0, all_of[0]), 8)]
        number, slot = path[-1]
        at = node + NODE_BYTES * number
        found = thread == slot + 1  # key 0 of a leaf is less than all
        steps += [load(all_of[0], 8), load(at + KEYS + 4 * thread), load(key),
                  load(only(found, at + CHILDREN + 4 * thread)),
                  load(only(found, np.full(ORDER, record + 4 * int(wanted[search])))),
                  store(only(found, np.full(ORDER, answers + 4 * search)))]
        yield steps
