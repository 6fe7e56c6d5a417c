"""Rodinia's nn (as of Rodinia 2), euclid: the distance of each record of a text file to a place.

Records have 49 bytes. A thread reads eight digits of its record, a byte each: three and, behind the point, one of the
latitude, which begins at byte 27, and six bytes on the same of the longitude. It writes one distance. CTAs have 16
threads.
"""
import numpy as np

from kernel_trace import Memory, load, store

RECORD, LATITUDE, THREADS = 49, 27, 16
DIGITS = [0, 1, 2, 4, 6, 7, 8, 10]


def ctas(records=15008):
    memory = Memory()
    text, distances = memory.array(records * RECORD, 1), memory.array(records)
    for first in range(0, records, THREADS):
        record = first + np.arange(THREADS)
        yield ([load(text + record * RECORD + LATITUDE + digit, 1) for digit in DIGITS] +
               [store(distances + 4 * record)])
