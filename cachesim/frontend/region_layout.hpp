// How the elements of a region lie in cache lines and sectors: all that coalescing asks of a region.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "cachesim/cache/line_ids.hpp"
#include "traces/header.hpp"

namespace raycache::cachesim {

/// Line and sector of a GPU; sizes in bytes, powers of two, at most 32 sectors per line.
struct LineShape {
    LineShape(std::uint32_t line_size, std::uint32_t sector_size)
        : line_bytes(line_size),
          line_shift(std::countr_zero(line_size)),
          sector_shift(std::countr_zero(sector_size)),
          sectors(line_size / sector_size) {}

    std::uint32_t line_bytes;
    int line_shift, sector_shift;  ///< log2 of the sizes
    std::uint32_t sectors;         ///< per line
};

/// Bits first … last, both included.
inline std::uint32_t sector_range(std::uint64_t first, std::uint64_t last) {
    return static_cast<std::uint32_t>(((std::uint64_t{2} << (last - first)) - 1) << first);
}

struct RegionLayout {
    RegionLayout(const traces::Region& r, std::size_t number, const LineShape& shape, const LineIds& ids)
        : base(r.base),
          stride(r.stride),
          extra(r.element_size - 1),
          pages(r.pages),
          aligned(r.base % shape.line_bytes == 0 && r.stride && shape.line_bytes % r.stride == 0 &&
                  r.element_size <= r.stride),
          start(static_cast<std::uint32_t>(r.base % shape.line_bytes)) {
        const std::uint64_t span = std::uint64_t{r.count} * r.stride;  // cannot overflow: both are below 2^32
        vectors = r.element_size <= shape.line_bytes && shape.sectors <= 8 && span < std::uint64_t{1} << 31 &&
                  ids.dense() && ids.bound() <= std::uint64_t{1} << 28;
        first_id = static_cast<std::uint32_t>((r.base >> shape.line_shift) - ids.offset(number));
        if (!aligned || !ids.dense()) return;
        elements_shift = shape.line_shift - std::countr_zero(r.stride);
        for (std::uint64_t byte = 0; byte < shape.line_bytes; byte += r.stride)
            sectors.push_back(sector_range(byte >> shape.sector_shift, (byte + extra) >> shape.sector_shift));
        in_line = static_cast<std::uint32_t>(sectors.size() - 1);
        few_per_line = sectors.size() <= table.size();
        if (few_per_line) std::copy(sectors.begin(), sectors.end(), table.begin());
    }

    /// First byte of an element.
    std::uint64_t address(std::uint32_t element) const {
        const std::uint64_t byte = element * stride;
        return pages.empty() ? base + byte : pages.address(byte);
    }

    std::uint64_t base, stride, extra;  ///< extra: element size - 1
    traces::PageTable pages;
    std::uint32_t first_id = 0;          ///< of the line of element 0, where ids are dense
    bool aligned;                        ///< a power of two of elements to a line, none straddles
    int elements_shift = 0;              ///< aligned: log2 of elements per line
    std::uint32_t in_line = 0;           ///< aligned: elements per line - 1
    std::vector<std::uint32_t> sectors;  ///< aligned, dense ids: of each element of a line
    /// No element is larger than a line, a line has at most 8 sectors, bytes counted from the start of the first line
    /// fit 32 bits, and ids 28: what coalesce_vectors() needs.
    bool vectors = false;
    std::uint32_t start;        ///< byte of element 0 in its line
    bool few_per_line = false;  ///< aligned, and `table` holds `sectors`
    std::array<std::uint32_t, 16> table{};
};

}  // namespace raycache::cachesim
