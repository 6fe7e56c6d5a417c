// The trace reader: verify(), every block by Reader, recover(). Mutations go behind the checksums and into what the
// blocks' streams hold before they are compressed; blind ones would nearly all end at a checksum.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <random>
#include <span>

#include "tests/fuzz/fuzz.hpp"
#include "traces/block_format.hpp"
#include "traces/compression.hpp"
#include "traces/issue_rules.hpp"
#include "traces/reader.hpp"
#include "traces/verify.hpp"

using namespace raycache;
using namespace raycache::traces;
using fuzz::Bytes;

namespace {

constexpr std::size_t most_raw = 1 << 16;  ///< bytes of a stream that a mutation looks into

/// A trace as header, blocks and index.
struct Parts {
    Bytes head;
    std::vector<Bytes> blocks;
    Bytes index;
};

std::optional<Parts> take_apart(std::span<const std::uint8_t> file) {
    if (file.size() < 160 || load<std::uint64_t>(file.data() + 16) > file.size()) return std::nullopt;
    const auto head = static_cast<std::size_t>(load<std::uint64_t>(file.data() + 16));
    const auto index = load<std::uint64_t>(file.data() + file.size() - format::index_tail_bytes);
    if (head < 56 || index < 40 || index > file.size() - head) return std::nullopt;
    Parts parts;
    parts.head.assign(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(head));
    parts.index.assign(file.end() - static_cast<std::ptrdiff_t>(index), file.end());
    for (std::size_t at = format::index_head_bytes; at + format::index_entry_bytes + format::index_tail_bytes <= index;
         at += format::index_entry_bytes) {
        const auto offset = load<std::uint64_t>(parts.index.data() + at);
        const auto size = load<std::uint32_t>(parts.index.data() + at + 8);
        if (offset > file.size() || size > file.size() - offset || size < format::block_head_bytes + 8)
            return std::nullopt;
        const auto block = file.subspan(static_cast<std::size_t>(offset), size);
        parts.blocks.emplace_back(block.begin(), block.end());
    }
    return parts;
}

void reseal(Bytes& bytes, std::size_t after) {  // bytes after the checksum
    if (bytes.size() < after + 8) return;
    const std::size_t at = bytes.size() - after - 8;
    store(bytes.data() + at, checksum(std::span(bytes).first(at)));
}

Bytes put_together(Parts parts) {
    reseal(parts.head, 0);
    Bytes file = parts.head;
    std::size_t entry = format::index_head_bytes;
    for (Bytes& block : parts.blocks) {
        reseal(block, 0);
        if (entry + 12 <= parts.index.size()) {
            store(parts.index.data() + entry, std::uint64_t{file.size()});
            store(parts.index.data() + entry + 8, static_cast<std::uint32_t>(block.size()));
        }
        entry += format::index_entry_bytes;
        append(file, std::span<const std::uint8_t>(block));
    }
    reseal(parts.index, 8);
    append(file, std::span<const std::uint8_t>(parts.index));
    return file;
}

/// Mutates the bytes that one stream of a block holds, and compresses them again.
void mutate_stream(Bytes& block, std::mt19937& random) {
    std::array<std::size_t, format::streams> raw{}, stored{};
    std::size_t at = format::block_head_bytes;
    const unsigned chosen = random() % format::streams;
    Bytes changed(block.begin(), block.begin() + static_cast<std::ptrdiff_t>(at));
    for (unsigned s = 0; s < format::streams; ++s) {
        raw[s] = load<std::uint32_t>(block.data() + 48 + 8 * s);
        stored[s] = load<std::uint32_t>(block.data() + 52 + 8 * s);
        if (raw[s] > most_raw || stored[s] > block.size() - 8 - at) return;
        const auto from = std::span<const std::uint8_t>(block).subspan(at, stored[s]);
        at += stored[s];
        if (s != chosen) {
            append(changed, from);
            continue;
        }
        Bytes content;
        decompress(from, raw[s], {"fuzz", 0}, content);
        fuzz::mutate(content, content.size() + 16);
        const std::size_t size = compress(content, Effort::fast, changed);
        store(changed.data() + 48 + 8 * s, static_cast<std::uint32_t>(content.size()));
        store(changed.data() + 52 + 8 * s, static_cast<std::uint32_t>(size));
    }
    changed.resize(changed.size() + 8);
    store(changed.data() + 8, static_cast<std::uint32_t>(changed.size()));
    block = std::move(changed);
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
    std::mt19937 random(seed);
    const unsigned kind = random() % 8;
    std::optional<Parts> parts;
    if (kind != 0) parts = take_apart({data, size});
    if (!parts) return LLVMFuzzerMutate(data, size, max_size);
    try {
        const std::size_t block = parts->blocks.empty() ? 0 : random() % parts->blocks.size();
        if (kind == 1) {
            fuzz::mutate(parts->head, parts->head.size());
        } else if (kind == 2) {
            fuzz::mutate(parts->index, parts->index.size());
        } else if (parts->blocks.empty()) {
            return LLVMFuzzerMutate(data, size, max_size);
        } else if (kind == 3) {
            fuzz::mutate(parts->blocks[block], parts->blocks[block].size());
        } else {
            mutate_stream(parts->blocks[block], random);
        }
    } catch (const Error&) {  // a stream that an earlier mutation broke
        return LLVMFuzzerMutate(data, size, max_size);
    }
    return fuzz::hand_back(put_together(std::move(*parts)), data, size, max_size);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string path = fuzz::input_file("trace.rct", data, size);
    VerifyResult verified;
    const bool whole = fuzz::accepts([&] { verified = verify(path); });
    VerifyResult read;
    const bool readable = fuzz::accepts([&] {
        const Reader reader(path);
        std::vector<WarpTrace> warps;
        for (std::size_t b = 0; b < reader.blocks().size(); ++b) {
            reader.read_block(b, warps);
            read.warps += warps.size();
            for (const WarpTrace& warp : warps) {
                std::size_t element = 0;
                const auto accesses = static_cast<std::uint32_t>(std::count_if(
                    warp.records.begin(), warp.records.end(), [](const Record& r) { return r.is_access(); }));
                fuzz::require(warp.issue.empty() || !issue_fault(warp.issue, accesses), "issue steps keep their rules");
                read.records += warp.records.size();
                for (const Record& record : warp.records)
                    for (unsigned n = record.is_access() ? record.lanes() : 0; n > 0; --n)
                        fuzz::require(warp.elements.at(element++) < reader.header().regions.at(record.region).count,
                                      "elements lie within their region");
            }
        }
    });
    fuzz::require(!whole || readable, "what verify() accepts can be read");
    if (whole) fuzz::require(read.warps == verified.warps && read.records == verified.records, "verify() counts right");
    const bool recovered = fuzz::accepts([&] { recover(path, "/dev/null"); });
    fuzz::require(!whole || recovered || verified.warps == 0, "a whole trace can be recovered");
    return 0;
}
