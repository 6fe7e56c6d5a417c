#!/usr/bin/python3
"""Reads raycache traces (FORMAT.md), independently of the C++ reader. Needs numpy, zstandard and xxhash.

usage: traces/read_trace.py FILE          one line per warp and the digest of the dump
       traces/read_trace.py FILE --dump   every record, as text
As a module, raycache.traces where installed: Trace(path).warps() yields (launch, warp, [(mask, region, ray, bounce, elements), ...]);
where issue is true, Trace.steps is then [(access, needs, instructions), ...] of that warp (record.hpp, IssueStep)."""
import struct
import sys

import numpy as np
import xxhash
import zstandard

NO_LINK, RAY_START, TRIANGLE = 0xFFFFFFFF, 0xFF, 1
SEQUENTIAL, END, LITERAL, STACK_ENTRIES = 0x80, 0x81, 0x82, 64


def require(condition, what):
    if not condition:
        raise ValueError(what)


def lanes(mask):
    return [lane for lane in range(32) if mask >> lane & 1]


def unzip(stored, size):
    return zstandard.ZstdDecompressor().decompress(stored, max_output_size=size) if size else b""


def unzigzag(code):
    return code >> 1 ^ -(code & 1)


def check_sealed(whole, what):
    require(xxhash.xxh3_64_intdigest(whole[:-8]) == struct.unpack("<Q", whole[-8:])[0], f"{what}: wrong checksum")


class Trace:
    def __init__(self, path):
        self.file = open(path, "rb").read()
        magic, version, reserved, size, regions, launches, self.warps_per_launch, text, kernels, issue = (
            struct.unpack_from("<8sIIQIIIIII", self.file))
        require(magic == b"RCTRACE\x1a" and version in (1, 2, 3, 4, 5), "no trace of version 1 to 5")
        require(reserved == 0 and issue <= (version >= 4) and (version >= 2 or kernels == 0), "reserved bits set")
        self.issue, self.steps = issue == 1, []
        self.kernels_per_launch = kernels if version >= 2 else 1
        require(kernels > 0 or version == 1, "no kernel")
        require(self.warps_per_launch % self.kernels_per_launch == 0, "kernels of unequal size")
        check_sealed(self.file[:size], "head")
        self.launches = list(struct.unpack_from(f"<{launches}I", self.file, 48))
        entries = 48 + 4 * launches
        at = entries + 40 * regions
        self.provenance = self.file[at:at + text].decode()
        at += text
        self.regions = []
        for i in range(regions):
            names = "kind degree prediction paged element_size base stride count link_bytes link_checksum".split()
            region = dict(zip(names, struct.unpack_from("<BBBBIQIIQQ", self.file, entries + 40 * i)))
            stored = self.file[at:at + region["link_bytes"]]
            require(xxhash.xxh3_64_intdigest(stored) == region["link_checksum"], f"links of region {i}: wrong checksum")
            require(region["kind"] < (3 if version == 1 else 10 if version < 5 else 12), "unknown kind of object")
            region["links"] = self.links(region, i, stored)
            self.regions.append(region)
            require(region["paged"] <= (version >= 3), "reserved bits set")
            at += region["link_bytes"]
        for region in self.regions:
            region["pages"] = []
            if region["paged"]:
                size_of_table, = struct.unpack_from("<Q", self.file, at)
                count = -(-region["count"] * region["stride"] // 4096)
                differences = np.frombuffer(unzip(self.file[at + 8:at + 8 + size_of_table], 8 * count), "<u8")
                region["pages"] = np.cumsum(differences, dtype=np.uint64)
                at += 8 + size_of_table
        require(at + 8 == size, "head: wrong size")
        index_size, _, end = struct.unpack("<QQ8s", self.file[-24:])
        require(end == b"RCEND..\x1a", "no end mark")
        index = self.file[len(self.file) - index_size:]
        check_sealed(index[:-8], "index")
        self.blocks = list(struct.iter_unpack("<QIIIIQQQ", index[16:-24]))

    @staticmethod
    def links(region, self_index, stored):
        count = region["degree"] * region["count"]
        planes = np.frombuffer(unzip(stored, 4 * count), np.uint8).reshape(4, count).astype(np.uint32)
        last, links, mask = [-1, -1, -1], [], (1 << 30) - 1
        for i, code in enumerate((planes[0] | planes[1] << 8 | planes[2] << 16 | planes[3] << 24).tolist()):
            target_region = code >> 30
            if target_region == 3:
                links.append(NO_LINK)
                continue
            near = region["prediction"] == 0 and target_region == self_index
            guess = i // region["degree"] if near else last[target_region]
            last[target_region] = (guess + 1 + unzigzag(code & mask)) & mask
            links.append(target_region << 30 | last[target_region])
        return links

    def warps(self):
        for offset, size, launch, first, warps, *_ in self.blocks:
            yield from Block(self, self.file[offset:offset + size]).warps()


class Block:
    def __init__(self, trace, data):
        check_sealed(data, "block")
        magic, _, self.launch, self.first, self.count, *rest = struct.unpack_from("<8sIIIIQQQ16I", data)
        require(magic == b"RCBLOCK\x1a", "no block")
        sizes, at, streams = rest[3:], 112, []
        for raw, stored in zip(sizes[::2], sizes[1::2]):
            streams.append(iter(unzip(data[at:at + stored], raw)))
            at += stored
        self.control, self.linked, self.other, *self.literal = streams
        self.trace, self.regions = trace, trace.regions

    def number(self, size):
        return int.from_bytes(bytes(next(self.control) for _ in range(size)), "little")

    def varint(self):
        value = shift = 0
        while True:
            byte = next(self.control)
            value |= (byte & 0x7F) << shift
            shift += 7
            if byte < 0x80:
                return value

    def warps(self):
        for i in range(self.count):
            records = list(self.records())
            self.trace.steps = list(self.steps()) if self.trace.issue else []
            yield self.launch, self.first + i, records

    def steps(self):
        access = 0
        for _ in range(self.varint()):
            access += self.varint()
            back, instructions = self.varint(), self.varint()
            require(back <= access, "an issue step waits for a later access")
            yield access, access - back + 1 if back else 0, instructions

    def successor(self, lane, symbol, links, after):
        """What the lane reads next: (region, element), or None at the end of its ray."""
        stack = self.stacks[lane]
        self.sequential.discard(lane)
        if symbol == END:
            return None
        if symbol == SEQUENTIAL:
            self.sequential.add(lane)
            return after
        if symbol == LITERAL:
            region, *code = (next(stream) for stream in self.literal)
            difference = unzigzag(int.from_bytes(bytes(code), "little"))
            self.recent[region] = (self.recent[region] + difference) & 0xFFFFFFFF
            return region, self.recent[region]
        if symbol < len(links):
            word = links[symbol]
            others = [link for i, link in enumerate(links) if i != symbol and link != NO_LINK]
            stack += others[::-1]
            del stack[STACK_ENTRIES:]
        else:
            depth = symbol - len(links)
            word = stack[-1 - depth]
            del stack[-1 - depth:]
        return word >> 30, word & (1 << 30) - 1

    def running(self, region):
        waiting = self.waiting(region)
        return [l for l in waiting if l in self.sequential] if self.regions[region]["kind"] == TRIANGLE else waiting

    def waiting(self, region):
        return [lane for lane in range(32) if self.next[lane] and self.next[lane][0] == region]

    def predicted_region(self, previous):
        if previous != RAY_START and self.running(previous):
            return previous
        return min((n[0] for n in self.next if n), default=RAY_START)

    def start(self, mask):
        for lane in lanes(mask):
            self.stacks[lane].clear()
            self.next[lane] = self.successor(lane, next(self.other), [], (0, 0))

    def records(self):
        count, _, at_start = self.varint(), self.varint(), self.varint()
        self.stacks, self.next = [[] for _ in range(32)], [None] * 32
        self.recent, self.sequential = [0] * 256, set()
        self.start(at_start)
        previous, ray, bounce, run, spelled_next = RAY_START, 0, 0, 0, False
        for _ in range(count):
            if not run and not spelled_next:
                run, spelled_next = self.varint(), True
            tag = 0
            if run:
                run -= 1
            else:
                tag, spelled_next = next(self.control), False
            region = next(self.control) if tag & 1 else self.predicted_region(previous)
            mask = self.number(4) if tag & 2 else 0
            if tag & 4:
                ray, bounce = next(self.control), next(self.control)
            if region == RAY_START:
                self.start(mask)
                yield mask, region, ray, bounce, []
            else:
                active = [lane for lane in self.waiting(region) if not mask >> lane & 1]
                if not tag & 2 and region == previous:
                    active = self.running(region) or active
                yield sum(1 << l for l in active), region, ray, bounce, [self.next[l][1] for l in active]
                self.access(region, active)
            previous = region

    def access(self, region, active):
        degree, table = self.regions[region]["degree"], self.regions[region]["links"]
        for lane in active:
            element = self.next[lane][1]
            symbol = next(self.linked if degree else self.other)
            links = table[degree * element:degree * (element + 1)]
            self.next[lane] = self.successor(lane, symbol, links, (region, element + 1))


def dump(trace):
    yield "provenance " + trace.provenance
    yield "launches " + " ".join(map(str, trace.launches))
    yield f"warps_per_launch {trace.warps_per_launch} kernels_per_launch {trace.kernels_per_launch}"
    for i, r in enumerate(trace.regions):
        links = xxhash.xxh3_64_hexdigest(np.array(r["links"], "<u4").tobytes())
        yield (f"region {i} kind {r['kind']} base {r['base']:#x} element_size {r['element_size']} stride {r['stride']} "
               f"count {r['count']} degree {r['degree']} links {links}"
               + (f" pages {xxhash.xxh3_64_hexdigest(np.array(r['pages'], '<u8').tobytes())}" if r["paged"] else ""))
    for launch, warp, records in trace.warps():
        yield f"launch {launch} warp {warp}"
        for mask, region, ray, bounce, elements in records:
            yield " ".join([f"{mask:08x} {region} {ray} {bounce}"] + [str(e) for e in elements])
        for access, needs, instructions in trace.steps:
            yield f"step {access} {needs} {instructions}"


def main():
    if len(sys.argv) not in (2, 3) or sys.argv[2:] not in ([], ["--dump"]):
        raise SystemExit(__doc__)
    trace = Trace(sys.argv[1])
    text = "".join(line + "\n" for line in dump(trace))
    if sys.argv[2:]:
        sys.stdout.write(text)
        return
    for launch, warp, records in trace.warps():
        print(f"launch {launch} warp {warp}: {len(records)} records, {sum(len(r[4]) for r in records)} lane accesses")
    print("digest", xxhash.xxh3_64_hexdigest(text))


if __name__ == "__main__":
    main()
