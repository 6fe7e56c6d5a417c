#include "traces/block_index.hpp"

#include <string>

#include "traces/compression.hpp"
#include "traces/format.hpp"

namespace raycache::traces {
namespace {

constexpr std::size_t frame = format::index_head_bytes + format::index_tail_bytes;

}  // namespace

Bytes encode_index(std::span<const BlockInfo> blocks) {
    Bytes out;
    append(out, format::index_magic);
    append(out, static_cast<std::uint64_t>(blocks.size()));
    for (const BlockInfo& block : blocks) {
        append(out, block.offset);
        append(out, block.bytes);
        append(out, block.launch);
        append(out, block.first_warp);
        append(out, block.warps);
        append(out, block.records);
        append(out, block.lane_accesses);
        append(out, block.rays);
    }
    append(out, static_cast<std::uint64_t>(out.size() + format::index_tail_bytes));
    seal(out);
    append(out, format::end_magic);
    return out;
}

std::uint64_t index_bytes(std::span<const std::uint8_t> tail, std::uint64_t file_bytes, const Origin& origin) {
    if (tail.size() < format::index_tail_bytes || !starts_with(tail.subspan(16), format::end_magic))
        refuse(origin + (tail.size() < 16 ? 0 : 16), "end of the file", "the end mark RCEND", "other bytes",
               "the file is cut short or has bytes added: keep its whole launches with `raycache verify --recover`");
    const auto size = load<std::uint64_t>(tail.data());
    if (size < frame || size > file_bytes)
        refuse(origin, "size of the index", fmt::format("{} to {}", frame, file_bytes), fmt::format("{}", size));
    return size;
}

std::vector<BlockInfo> decode_index(const Header& header, std::uint64_t head_bytes, std::span<const std::uint8_t> index,
                                    const Origin& origin) {
    if (!starts_with(index, format::index_magic)) refuse(origin, "magic of the index", "RCINDEX", "other bytes");
    check_sealed(index.first(index.size() - format::end_magic.size()), origin, "index", salvage);
    const auto count = load<std::uint64_t>(index.data() + 8);
    const std::uint64_t room = index.size() - frame;
    if (room % format::index_entry_bytes != 0 || count != room / format::index_entry_bytes)
        refuse(origin + 8, "blocks in the index", fmt::format("{}", room / format::index_entry_bytes),
               fmt::format("{}", count));

    std::vector<BlockInfo> blocks(count);
    WarpCursor cursor(header);
    std::uint64_t offset = head_bytes;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint64_t at = format::index_head_bytes + format::index_entry_bytes * i;
        const std::uint8_t* p = index.data() + at;
        BlockInfo& block = blocks[i];
        block = {load<std::uint64_t>(p),      load<std::uint32_t>(p + 8),  load<std::uint32_t>(p + 12),
                 load<std::uint32_t>(p + 16), load<std::uint32_t>(p + 20), load<std::uint64_t>(p + 24),
                 load<std::uint64_t>(p + 32), load<std::uint64_t>(p + 40)};
        if (block.offset != offset || block.bytes > origin.offset - offset)
            refuse(origin + at, fmt::format("place of block {}", i), fmt::format("offset {} and no overlap", offset),
                   fmt::format("offset {} and {} bytes", block.offset, block.bytes));
        if (!cursor.accepts(block.launch, block.first_warp, block.warps))
            refuse(origin + at + 12, fmt::format("warps of block {}", i),
                   fmt::format("launch {} from warp {}", cursor.launch(), cursor.warp()),
                   fmt::format("launch {} from warp {}, {} warps", block.launch, block.first_warp, block.warps));
        cursor.advance(block.warps);
        offset += block.bytes;
    }
    if (offset != origin.offset)
        refuse(origin, "start of the index", fmt::format("offset {}", offset), fmt::format("offset {}", origin.offset));
    if (!cursor.done())
        refuse(origin + 8, "blocks in the index", "every warp of every launch",
               fmt::format("none for launch {} warp {}", cursor.launch(), cursor.warp()));
    return blocks;
}

}  // namespace raycache::traces
