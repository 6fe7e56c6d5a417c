// Front end: one warp access -> the distinct cache lines it touches, and of each line the distinct sectors.
//
// Every active lane reads one whole object [base + index * stride, … + element_size). Lanes that touch the same line
// share one look-up; lanes that touch the same sector share that sector. Lines come in the order in which the lanes,
// lowest first, first touch them; the lines of one object in ascending order.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cachesim/cache/request.hpp"
#include "cachesim/frontend/coalesce_avx512.hpp"
#include "cachesim/frontend/region_layout.hpp"
#include "cachesim/instruction_set.hpp"
#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

class Coalescer {
public:
    Coalescer(const std::vector<traces::Region>& regions, const LineShape& shape, InstructionSet instructions)
        : shape_(shape), avx512_(instructions >= InstructionSet::avx512) {
        std::size_t most_lines = 1;
        for (const traces::Region& region : regions) {
            layouts_.emplace_back(region, shape);
            most_lines = std::max<std::size_t>(most_lines, (region.element_size - 1) / shape.line_bytes + 2);
        }
        max_requests_ = most_lines * traces::warp_lanes + 1;
        // At most a quarter full, so that a probe rarely meets another line.
        table_.resize(std::bit_ceil(std::max<std::size_t>(256, 4 * max_requests_)));
        table_shift_ = 64 - std::countr_zero(table_.size());
    }

    /// Every warp access becomes fewer requests than this.
    std::size_t max_requests() const { return max_requests_; }

    /// `elements`: one index per active lane, lowest lane first. Requests go to `out`, which has room for
    /// max_requests(), with region and group as in `like`.
    Coalesced operator()(const std::uint32_t* elements, unsigned lanes, const Request& like, Request* out) {
        const RegionLayout& layout = layouts_[like.region];
        if (avx512_ && can_coalesce_avx512(layout, lanes))
            return coalesce_avx512(layout, shape_, elements, lanes, like, out);
        if (base_ > ~std::uint32_t{0} - 2 * static_cast<std::uint32_t>(max_requests_)) {
            std::fill(table_.begin(), table_.end(), 0);
            base_ = 0;
        }
        base_ += static_cast<std::uint32_t>(max_requests_);  // every entry so far is below
        Merger merger{table_.data(), table_.size() - 1, table_shift_, base_, like, out, {}};
        if (layout.aligned)
            merge_aligned(layout, elements, lanes, merger);
        else
            merge_any(layout, elements, lanes, merger);
        return merger.result;
    }

private:
    /// The lines of the access so far: out[0 … requests). A hash table says at which place to look for a line: an entry
    /// is base + place; entries of earlier accesses are below base, so they are at no place. Free of branches that
    /// depend on whether a line is new, which cannot be predicted: a new line is put behind the others before the
    /// search, as a sentinel, and counts if it is what the search finds.
    struct Merger {
        std::uint32_t* const table;
        const std::size_t table_mask;
        const int table_shift;
        const std::uint32_t base;
        const Request like;
        Request* const out;
        Coalesced result;

        void touch(std::uint64_t line, std::uint32_t sectors) {
            Request& sentinel = out[result.requests];
            sentinel = like;
            sentinel.line = line;
            const auto end = static_cast<std::uint32_t>(result.requests);
            // Multiplicative hashing (Knuth, The Art of Computer Programming 3, section 6.4).
            std::size_t at = (line * 0x9e3779b97f4a7c15ull) >> table_shift;
            std::uint32_t place = std::min(table[at] - base, end);
            while (out[place].line != line) [[unlikely]] {
                    at = (at + 1) & table_mask;
                    place = std::min(table[at] - base, end);
                }
            table[at] = base + place;
            const std::uint32_t before = out[place].sectors;
            out[place].sectors = before | sectors;
            result.requests += place == end;
            result.sectors += static_cast<unsigned>(std::popcount(sectors & ~before));
        }
    };

    static void merge_aligned(const RegionLayout& layout, const std::uint32_t* elements, unsigned lanes, Merger& out) {
        Merger merger = out;  // its own copy, which nothing else can change, stays in registers
        const std::uint32_t* const sectors = layout.sectors.data();
        const std::uint64_t in_line = layout.sectors.size() - 1, first_line = layout.first_line;
        const int shift = layout.elements_shift;
        for (unsigned lane = 0; lane < lanes; ++lane) {
            const std::uint64_t element = elements[lane];
            merger.touch(first_line + (element >> shift), sectors[element & in_line]);
        }
        out.result = merger.result;
    }

    void merge_any(const RegionLayout& layout, const std::uint32_t* elements, unsigned lanes, Merger& merger) const {
        const std::uint64_t in_line = shape_.sectors - 1;
        const int line_of_sector = shape_.line_shift - shape_.sector_shift;
        for (unsigned lane = 0; lane < lanes; ++lane) {
            const std::uint64_t first_byte = layout.base + elements[lane] * layout.stride;
            const std::uint64_t first = first_byte >> shape_.sector_shift,
                                last = (first_byte + layout.extra) >> shape_.sector_shift;
            const std::uint64_t last_line = last >> line_of_sector;
            std::uint64_t line = first >> line_of_sector, from = first & in_line;
            for (; line < last_line; ++line, from = 0) merger.touch(line, sector_range(from, in_line));
            merger.touch(line, sector_range(from, last & in_line));
        }
    }

    LineShape shape_;
    bool avx512_;
    int table_shift_ = 0;
    std::size_t max_requests_ = 0;
    std::uint32_t base_ = 0;
    std::vector<RegionLayout> layouts_;
    std::vector<std::uint32_t> table_;
};

}  // namespace raycache::cachesim
