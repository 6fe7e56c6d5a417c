#include "traces/block_format.hpp"

#include <cstring>
#include <string>

namespace raycache::traces {

void store_block_head(const BlockHead& head, std::uint8_t* to) {
    std::memcpy(to, format::block_magic.data(), format::block_magic.size());
    store(to + 8, head.bytes);
    store(to + 12, head.launch);
    store(to + 16, head.first_warp);
    store(to + 20, head.warps);
    store(to + 24, head.records);
    store(to + 32, head.lane_accesses);
    store(to + 40, head.rays);
    for (unsigned s = 0; s < format::streams; ++s) {
        store(to + 48 + 8 * s, head.sizes[s].raw);
        store(to + 52 + 8 * s, head.sizes[s].stored);
    }
}

BlockHead parse_block_head(std::span<const std::uint8_t> block, bool issue, const Origin& origin) {
    constexpr std::size_t frame = format::block_head_bytes + format::checksum_bytes;
    if (block.size() < frame)
        refuse(origin, "block", fmt::format("at least {} bytes", frame), fmt::format("{}", block.size()));
    if (!starts_with(block, format::block_magic)) refuse(origin, "block magic", "RCBLOCK", "other bytes");
    const std::uint8_t* p = block.data();
    BlockHead head{load<std::uint32_t>(p + 8),  load<std::uint32_t>(p + 12),
                   load<std::uint32_t>(p + 16), load<std::uint32_t>(p + 20),
                   load<std::uint64_t>(p + 24), load<std::uint64_t>(p + 32),
                   load<std::uint64_t>(p + 40), {}};
    const auto bound = [&](std::uint64_t at, const char* what, std::uint64_t value, std::uint64_t most) {
        if (value > most)
            refuse(origin + at, fmt::format("{} of the block", what), fmt::format("at most {}", most),
                   fmt::format("{}", value));
    };
    bound(20, "warps", head.warps, format::max_block_warps);
    if (head.warps == 0) refuse(origin + 20, "warps of the block", "at least 1", "0");
    bound(24, "records", head.records, format::max_block_records);
    bound(32, "lane accesses", head.lane_accesses, format::max_block_lanes);
    bound(40, "rays", head.rays, format::max_block_lanes - head.lane_accesses);

    const std::uint64_t symbols = head.lane_accesses + head.rays + std::uint64_t{warp_lanes} * head.warps;
    const std::uint64_t control =
        (issue ? format::max_control_bytes_issue : format::max_control_bytes) * (head.records + head.warps);
    std::uint64_t end = format::block_head_bytes;
    for (unsigned s = 0; s < format::streams; ++s) {
        BlockHead::Size& size = head.sizes[s];
        size = {load<std::uint32_t>(p + 48 + 8 * s), load<std::uint32_t>(p + 52 + 8 * s)};
        bound(48 + 8 * s, "raw stream size", size.raw, s == format::control ? control : symbols);
        bound(52 + 8 * s, "stored stream size", size.stored, block.size() - format::checksum_bytes - end);
        if ((size.raw == 0) != (size.stored == 0))
            refuse(origin + 48 + 8 * s, "stream sizes of the block", "both zero or none",
                   fmt::format("{} and {}", size.raw, size.stored));
        end += size.stored;
    }
    const std::uint64_t literals = head.sizes[format::literal_regions].raw;
    for (unsigned s = format::literal_byte0; s <= format::literal_byte3; ++s)
        if (head.sizes[s].raw != literals)
            refuse(origin + 48 + 8 * s, "raw size of a literal stream", fmt::format("{}", literals),
                   fmt::format("{}", head.sizes[s].raw));
    const std::uint64_t coded =
        std::uint64_t{head.sizes[format::linked_symbols].raw} + head.sizes[format::other_symbols].raw;
    if (head.lane_accesses + head.rays > coded || head.records > coded)
        refuse(origin + 24, "symbols of the block", "one per lane access and ray", fmt::format("{} in all", coded));
    if (head.bytes != end + format::checksum_bytes)
        refuse(origin + 8, "size of the block", fmt::format("{}", end + format::checksum_bytes),
               fmt::format("{}", head.bytes));
    return head;
}

}  // namespace raycache::traces
