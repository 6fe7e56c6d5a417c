#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "traces/block_decoder.hpp"
#include "traces/compression.hpp"
#include "traces/format.hpp"
#include "traces/header_codec.hpp"
#include "traces/input_file.hpp"
#include "traces/memory_budget.hpp"
#include "traces/verify.hpp"
#include "traces/writer.hpp"

namespace raycache::traces {
namespace {

struct Found {
    std::uint64_t offset = 0;
    BlockHead head;
};

/// Offset of the next block magic at or after `from`, or the size of the file.
std::uint64_t next_magic(const InputFile& file, std::uint64_t from, Bytes& window) {
    constexpr std::uint64_t step = 1u << 20;
    const std::size_t overlap = format::block_magic.size() - 1;
    // The first look is a short one: most blocks follow each other without a gap.
    for (std::uint64_t look = 1; from + overlap < file.bytes(); from += std::exchange(look, step)) {
        file.read(from, std::min(look + overlap, file.bytes() - from), window);
        const auto hit =
            std::search(window.begin(), window.end(), format::block_magic.begin(), format::block_magic.end(),
                        [](std::uint8_t byte, char letter) { return byte == static_cast<std::uint8_t>(letter); });
        if (hit != window.end()) return from + static_cast<std::uint64_t>(hit - window.begin());
    }
    return file.bytes();
}

/// The block at `offset` if every byte of it is good.
std::optional<Found> whole_block(const InputFile& file, const Header& header, const MemoryBudget& budget,
                                 std::size_t launches, std::uint64_t offset, Bytes& bytes) {
    try {
        const std::uint64_t left = file.bytes() - offset;
        file.read(offset, std::min<std::uint64_t>(left, format::block_head_bytes), bytes);
        if (bytes.size() < format::block_head_bytes) return std::nullopt;
        const auto size = load<std::uint32_t>(bytes.data() + 8);
        if (size > left) return std::nullopt;
        budget.check(size, file.at(offset).path, "bytes of a block");
        file.read(offset, size, bytes);
        std::vector<WarpTrace> warps;
        const Found found{offset, decode_block(header, bytes, file.at(offset), budget, warps)};
        const BlockHead& head = found.head;
        if (head.launch >= launches || head.first_warp >= header.warps_per_launch ||
            head.warps > header.warps_per_launch - head.first_warp)
            return std::nullopt;
        return found;
    } catch (const MemoryError&) {
        throw;
    } catch (const Error&) {
        return std::nullopt;
    }
}

/// Blocks of one launch by first warp; complete if they follow each other through all warps.
bool complete(const std::map<std::uint32_t, Found>& blocks, std::uint32_t warps) {
    std::uint32_t next = 0;
    for (const auto& [first_warp, found] : blocks) {
        if (first_warp != next) return false;
        next += found.head.warps;
    }
    return next == warps;
}

Block renumbered(Bytes bytes, const BlockHead& head, std::uint32_t launch) {
    store(bytes.data() + 12, launch);
    const auto body = std::span(bytes).first(bytes.size() - format::checksum_bytes);
    store(bytes.data() + body.size(), checksum(body));
    return {launch, head.first_warp, head.warps, head.records, head.lane_accesses, head.rays, std::move(bytes)};
}

}  // namespace

RecoverResult recover(const std::string& damaged, const std::string& recovered) {
    const InputFile file(damaged);
    Bytes bytes;
    file.read(0, std::min<std::uint64_t>(file.bytes(), format::fixed_header_bytes), bytes);
    const std::uint64_t head_bytes = header_bytes(bytes, file.bytes(), file.at(0));
    MemoryBudget budget;
    budget.charge(head_bytes, damaged, "head of the trace");
    file.read(0, head_bytes, bytes);
    Header kept = decode_header(bytes, file.at(0), budget);
    const std::vector<std::uint32_t> all = std::exchange(kept.launches, {});

    std::vector<std::map<std::uint32_t, Found>> launches(all.size());
    std::uint64_t seen = 0;
    for (std::uint64_t at = next_magic(file, head_bytes, bytes); at < file.bytes(); at = next_magic(file, at, bytes)) {
        ++seen;
        const auto found = whole_block(file, kept, budget, all.size(), at, bytes);
        if (found) launches[found->head.launch].emplace(found->head.first_warp, *found);
        at += found ? found->head.bytes : format::block_magic.size();
    }

    RecoverResult result;
    for (std::size_t i = 0; i < launches.size(); ++i) {
        if (complete(launches[i], kept.warps_per_launch)) {
            kept.launches.push_back(all[i]);
            result.blocks_kept += launches[i].size();
        } else {
            launches[i].clear();
        }
    }
    result.launches_kept = kept.launches.size();
    result.launches_lost = launches.size() - result.launches_kept;
    result.blocks_lost = seen - result.blocks_kept;
    if (kept.launches.empty())
        refuse(file.at(head_bytes), "blocks", "all blocks of at least one launch",
               fmt::format("no complete launch among {}", launches.size()), "capture the trace again");

    Writer writer(recovered, kept);
    std::uint32_t launch = 0;
    for (const auto& blocks : launches) {
        if (blocks.empty()) continue;
        for (const auto& [first_warp, found] : blocks) {
            file.read(found.offset, found.head.bytes, bytes);
            writer.append(renumbered(bytes, found.head, launch));
        }
        ++launch;
    }
    writer.finish();
    return result;
}

}  // namespace raycache::traces
