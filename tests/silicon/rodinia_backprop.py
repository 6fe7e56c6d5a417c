"""Rodinia's backprop: one layer of a neural network of `inputs` neurons and 16 hidden ones.

Weights form a matrix of 17 columns, a row for each input; row and column 0 belong to the bias. A CTA of 16 x 16 threads
has 16 rows. The forward kernel also reads the 16 inputs (threads of column 0), and writes a partial sum for each hidden
neuron (the same threads). The other kernel changes weights by the error of the hidden neuron, the input, and the change
of the iteration before; since each store may change what it reads, it reads errors, inputs and old changes twice.
"""
import numpy as np

from kernel_trace import Memory, load, only, store

SIDE = 16
ROW = SIDE + 1


def places(inputs):
    memory = Memory()
    arrays = {name: memory.array(count) for name, count in
              (("inputs", inputs + 1), ("weights", (inputs + 1) * ROW), ("sums", inputs), ("old", (inputs + 1) * ROW),
               ("errors", ROW))}
    y, x = np.divmod(np.arange(SIDE * SIDE), SIDE)
    return arrays, x, y


def forward(inputs=65536):
    at, x, y = places(inputs)
    for block in range(inputs // SIDE):
        neuron = 4 * (SIDE * block + y + 1)
        weight = at["weights"] + 4 * (ROW * (SIDE * block + y + 1) + x + 1)
        yield [load(only(x == 0, at["inputs"] + neuron)), load(weight), store(weight),
               store(only(x == 0, at["sums"] + 4 * (SIDE * block + y)))]


def adjust(inputs=65536):
    at, x, y = places(inputs)
    for block in range(inputs // SIDE):
        neuron = at["inputs"] + 4 * (SIDE * block + y + 1)
        error = at["errors"] + 4 * (x + 1)
        element = 4 * (ROW * (SIDE * block + y + 1) + x + 1)
        weight, old = at["weights"] + element, at["old"] + element
        steps = [load(error), load(neuron), load(old), load(weight), store(weight),
                 load(error), load(neuron), load(old), store(old)]
        if block == 0:  # the weights of the bias
            bias = 4 * (x + 1)
            of_bias = [only(y == 0, at[name] + bias) for name in ("errors", "old", "weights")]
            steps += [load(a) for a in of_bias] + [store(of_bias[2]), store(of_bias[1])]
        yield steps
