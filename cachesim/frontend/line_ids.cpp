#include "cachesim/frontend/line_ids.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <numeric>

#include "traces/error.hpp"

namespace raycache::cachesim {

namespace {

/// First and last byte, both included.
struct Extent {
    std::uint64_t first = 0, last = 0;
};

Extent extent(const std::vector<traces::Region>& regions, std::size_t i) {
    const traces::Region& region = regions[i];
    if (region.element_size == 0 || region.element_size > 4096)
        throw Error(
            fmt::format("region {} of the trace: expected an element size of 1 to 4096 bytes, found {}; "
                        "write the trace again",
                        i, region.element_size));
    // count - 1 and stride are below 2^32, so only the sum can overflow.
    const std::uint64_t span =
        std::uint64_t{std::max(region.count, 1u) - 1} * region.stride + (region.element_size - 1);
    std::uint64_t last = 0;
    if (__builtin_add_overflow(region.base, span, &last))
        throw Error(
            fmt::format("region {} of the trace: expected it to end below 2^64, found base {:#x} and {} "
                        "elements of stride {}; write the trace again",
                        i, region.base, region.count, region.stride));
    return {region.base, last};
}

}  // namespace

LineIds::LineIds(const std::vector<traces::Region>& regions, std::uint32_t line_bytes) : offsets_(regions.size()) {
    const int shift = std::countr_zero(line_bytes);
    std::vector<Extent> lines;
    for (std::size_t i = 0; i < regions.size(); ++i) {
        const Extent bytes = extent(regions, i);
        lines.push_back({bytes.first >> shift, bytes.last >> shift});
    }
    std::vector<std::size_t> order(regions.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return lines[a].first < lines[b].first; });

    std::uint64_t next = 0, offset = 0;  // next: first line number above all intervals so far
    for (const std::size_t i : order) {
        if (count_ == 0 || lines[i].first >= next) offset = lines[i].first - count_;  // a gap: close it
        offsets_[i] = offset;
        next = std::max(next, lines[i].last + 1);
        count_ = next - offset;
    }
}

}  // namespace raycache::cachesim
