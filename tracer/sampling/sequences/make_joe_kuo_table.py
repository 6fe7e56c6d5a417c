#!/usr/bin/env python3
"""Writes joe_kuo_6.inc, the table of sobol.cpp, from the copy of new-joe-kuo-6.21201 that SciPy carries.

Use: /usr/bin/python3 make_joe_kuo_table.py > joe_kuo_6.inc
Needs SciPy; the committed table came from SciPy 1.10.1.

SciPy stores per dimension the primitive polynomial with all its bits (leading and trailing 1 included) and the initial
direction numbers m_1 … m_degree. Dimension 0, the van der Corput sequence, needs no row.
"""
import os

import numpy
import scipy.stats

DIMENSIONS = 1024
LICENCE = """\
Primitive polynomials and initial direction numbers new-joe-kuo-6.21201, dimensions 1 ... {last} counted from 0.
S. Joe, F. Y. Kuo, "Constructing Sobol sequences with better two-dimensional projections", SIAM J. Sci. Comput. 30,
2635-2654, 2008. https://web.maths.unsw.edu.au/~fkuo/sobol/
A row is {{polynomial, {{m_1, ..., m_degree}}}}. Written by make_joe_kuo_table.py: do not edit.

Licence pertaining to the sets of direction numbers:
Copyright (c) 2008, Frances Y. Kuo and Stephen Joe. All rights reserved.

Redistribution and use in source and binary forms, with or without modification, are permitted provided that the
following conditions are met:
  * Redistributions of source code must retain the above copyright notice, this list of conditions and the following
    disclaimer.
  * Redistributions in binary form must reproduce the above copyright notice, this list of conditions and the following
    disclaimer in the documentation and/or other materials provided with the distribution.
  * Neither the names of the copyright holders nor the names of the University of New South Wales and the University of
    Waikato and its contributors may be used to endorse or promote products derived from this software without specific
    prior written permission.

THIS SOFTWARE IS PROVIDED BY THE COPYRIGHT HOLDERS "AS IS" AND ANY EXPRESS OR IMPLIED WARRANTIES, INCLUDING, BUT NOT
LIMITED TO, THE IMPLIED WARRANTIES OF MERCHANTABILITY AND FITNESS FOR A PARTICULAR PURPOSE ARE DISCLAIMED. IN NO EVENT
SHALL THE COPYRIGHT HOLDERS BE LIABLE FOR ANY DIRECT, INDIRECT, INCIDENTAL, SPECIAL, EXEMPLARY, OR CONSEQUENTIAL DAMAGES
(INCLUDING, BUT NOT LIMITED TO, PROCUREMENT OF SUBSTITUTE GOODS OR SERVICES; LOSS OF USE, DATA, OR PROFITS; OR BUSINESS
INTERRUPTION) HOWEVER CAUSED AND ON ANY THEORY OF LIABILITY, WHETHER IN CONTRACT, STRICT LIABILITY, OR TORT (INCLUDING
NEGLIGENCE OR OTHERWISE) ARISING IN ANY WAY OUT OF THE USE OF THIS SOFTWARE, EVEN IF ADVISED OF THE POSSIBILITY OF SUCH
DAMAGE.
"""


def main():
    data = numpy.load(os.path.join(os.path.dirname(scipy.stats.__file__), "_sobol_direction_numbers.npz"))
    for line in LICENCE.format(last=DIMENSIONS - 1).splitlines():
        print(("// " + line).rstrip())
    for dimension in range(1, DIMENSIONS):
        polynomial = int(data["poly"][dimension])
        degree = polynomial.bit_length() - 1
        numbers = [int(m) for m in data["vinit"][dimension][:degree]]
        if any(m % 2 == 0 or m >> (k + 1) for k, m in enumerate(numbers)):
            raise SystemExit(f"dimension {dimension}: m_k must be odd and below 2^k, found {numbers}")
        print("{%d, {%s}}," % (polynomial, ", ".join(map(str, numbers))))


main()
