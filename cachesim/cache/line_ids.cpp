#include "cachesim/cache/line_ids.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <numeric>

#include "traces/error.hpp"

namespace raycache::cachesim {

namespace {

constexpr std::uint64_t most_ids = ~std::uint32_t{0};

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
    if (!region.pages.empty()) return {region.address(0), region.address(region.count - 1) + region.element_size - 1};
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
        last_line_ = std::max(last_line_, lines.back().last);
        dense_ &= regions[i].pages.empty();
    }
    if (!dense_) {
        bound_ = most_ids;
        return;
    }
    std::vector<std::size_t> order(regions.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](auto a, auto b) { return lines[a].first < lines[b].first; });

    constexpr std::uint64_t low_bits = (std::uint64_t{1} << equal_bits) - 1;
    std::uint64_t next = 0, offset = 0;  // next: first line number above all intervals so far
    for (const std::size_t i : order) {
        if (runs_.empty() || lines[i].first >= next) {  // a gap: close it
            offset = (lines[i].first - bound_) & ~low_bits;
            runs_.push_back({static_cast<std::uint32_t>(lines[i].first - offset), offset});
        }
        offsets_[i] = offset;
        next = std::max(next, lines[i].last + 1);
        bound_ = std::max(bound_, lines[i].last - offset + 1);
        if (bound_ >= most_ids || bound_ == 0) {
            dense_ = false;
            bound_ = most_ids;
            return;
        }
    }
}

std::uint64_t LineIds::line(std::uint32_t id) const {
    if (!dense_) return touched_[id];
    const auto after =
        std::upper_bound(runs_.begin(), runs_.end(), id, [](std::uint32_t i, const Run& run) { return i < run.first; });
    return id + std::prev(after)->offset;
}

std::uint32_t LineIds::number(std::uint64_t line) {
    const auto [at, is_new] = numbers_.try_emplace(line, static_cast<std::uint32_t>(touched_.size()));
    if (is_new) {
        if (touched_.size() == most_ids)
            throw Error("trace: expected at most 2^32 - 1 different cache lines in one launch; capture fewer warps");
        touched_.push_back(line);
    }
    return at->second;
}

}  // namespace raycache::cachesim
