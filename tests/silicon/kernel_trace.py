"""What a kernel reads and writes, as text of Accel-Sim's tracer that `raycache import --stores` takes.

A kernel is a sequence of steps. A step is one load or store that all warps of a CTA execute: the byte address of each of
its threads, or `idle` where a thread takes no part. Threads are numbered as CUDA does, 32 of them a warp; a warp without
a thread that takes part skips the step.
"""
import numpy as np

IDLE = -1
WARP = 32
NO_OFFSET = np.iinfo(np.int64).min
GRID = "-grid dim = ({:010},1,1)\n"


class Memory:
    """Where arrays lie. As cudaMalloc places them: at multiples of 256 B; large ones at multiples of 2 MiB."""

    def __init__(self):
        self.next = 0x7F0000000000

    def array(self, count, element_bytes=4):
        size = count * element_bytes
        step = 1 << 21 if size >= 1 << 20 else 256
        base = -(-self.next // step) * step
        self.next = base + size
        return base


def load(addresses, element_bytes=4):
    return "LDG", element_bytes, np.asarray(addresses, np.int64)


def store(addresses, element_bytes=4):
    return "STG", element_bytes, np.asarray(addresses, np.int64)


def only(condition, addresses):
    """The addresses of the threads for which the condition holds; the others are idle."""
    return np.where(condition, addresses, IDLE)


OPCODES = {("LDG", 1): "1 R4 LDG.E.U8 1 R2 1", ("LDG", 4): "1 R4 LDG.E 1 R2 4", ("LDG", 8): "1 R4 LDG.E.64 1 R2 8",
           ("LDG", 16): "1 R4 LDG.E.128 1 R2 16", ("STG", 4): "0 STG.E 2 R2 R4 4", ("STG", 8): "0 STG.E.64 2 R2 R4 8"}


class Lines:
    """Makes the lines of CTAs. How the addresses of lanes differ repeats, so the text of each pattern is made once."""

    def __init__(self):
        self.known = {}

    @staticmethod
    def text(opcode, offsets):
        """What stands before and behind the first address; `offsets`: of the lanes from it, negative where idle."""
        lanes = np.flatnonzero(offsets != NO_OFFSET)
        mask = sum(1 << int(lane) for lane in lanes)
        differences = np.diff(offsets[lanes]).tolist()
        if lanes[-1] - lanes[0] == len(differences) and len(set(differences)) <= 1:
            mode, rest = 1, str(differences[0] if differences else 0)
        else:
            mode, rest = 2, " ".join(map(str, differences))
        return f"0 {mask:08x} {opcode} {mode} 0x", f" {rest} 0\n"

    def warps(self, steps, threads):
        """Of each warp of a CTA, its lines."""
        warps = -(-threads // WARP)
        addresses = np.full((len(steps), warps * WARP), IDLE, np.int64)
        for step, (_, _, of_threads) in zip(addresses, steps):
            step[:threads] = of_threads
        addresses = addresses.reshape(-1, WARP)
        active = addresses != IDLE
        first = addresses[np.arange(len(addresses)), active.argmax(1)]
        patterns = np.where(active, addresses - first[:, None], NO_OFFSET)
        keys, firsts, pattern_bytes = patterns.tobytes(), first.tolist(), WARP * patterns.itemsize
        lines = [[] for _ in range(warps)]
        for row in np.flatnonzero(active.any(1)).tolist():
            opcode = OPCODES[steps[row // warps][:2]]
            key = opcode, keys[row * pattern_bytes:(row + 1) * pattern_bytes]
            if key not in self.known:
                self.known[key] = self.text(opcode, patterns[row])
            before, behind = self.known[key]
            lines[row % warps].append(f"{before}{firsts[row]:x}{behind}")
        return lines


def write(path, name, threads, ctas):
    """Writes a kernel. `threads`: of a CTA; `ctas`: the steps of each CTA, in order of launch. Returns their number."""
    lines, count = Lines(), 0
    with open(path, "w", encoding="ascii") as file:
        file.write(f"-kernel name = {name}\n-block dim = ({threads},1,1)\n-accelsim tracer version = 5\n")
        grid = file.tell()
        file.write(GRID.format(0) + "\n#traces format = x\n\n")
        for count, steps in enumerate(ctas, 1):
            text = [f"#BEGIN_TB\nthread block = {count - 1},0,0\n"]
            for warp, instructions in enumerate(lines.warps(steps, threads)):
                text.append(f"warp = {warp}\ninsts = {len(instructions)}\n")
                text += instructions
            file.write("".join(text) + "#END_TB\n")
        file.seek(grid)
        file.write(GRID.format(count))
    return count
