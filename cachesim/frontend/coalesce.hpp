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
#include "cachesim/frontend/line_ids.hpp"
#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

/// What a warp access became.
struct Coalesced {
    std::size_t requests = 0;
    unsigned sectors = 0;  ///< of all requests together
};

class Coalescer {
public:
    /// Sizes in bytes, powers of two, at most 32 sectors per line.
    Coalescer(const std::vector<traces::Region>& regions, const LineIds& ids, std::uint32_t line_bytes,
              std::uint32_t sector_bytes)
        : line_shift_(std::countr_zero(line_bytes)),
          sector_shift_(std::countr_zero(sector_bytes)),
          sectors_per_line_(line_bytes / sector_bytes) {
        std::size_t most_lines = 1;
        for (std::size_t i = 0; i < regions.size(); ++i) {
            const traces::Region& r = regions[i];
            const bool one_line =
                r.base % line_bytes == 0 && r.stride <= line_bytes && r.stride && line_bytes % r.stride == 0;
            layouts_.push_back(
                {r.base, r.stride, r.element_size - 1, one_line && r.element_size <= r.stride, ids.offset(i)});
            most_lines = std::max<std::size_t>(most_lines, (r.element_size - 1) / line_bytes + 2);
        }
        max_requests_ = most_lines * traces::warp_lanes;
        // At most a quarter full, so that a probe rarely meets another line.
        table_.resize(std::bit_ceil(std::max<std::size_t>(256, 4 * max_requests_)));
        table_shift_ = 64 - std::countr_zero(table_.size());
    }

    /// No warp access becomes more requests than this.
    std::size_t max_requests() const { return max_requests_; }

    /// `elements`: one index per active lane, lowest lane first. Requests go to `out`, which has room for
    /// max_requests(), with cache and group as in `like`.
    Coalesced operator()(std::size_t region, const std::uint32_t* elements, unsigned lanes, const Request& like,
                         Request* out) {
        const Layout layout = layouts_[region];
        if (++generation_ == 0) {  // after 2^32 accesses: forget what looks like new
            std::fill(table_.begin(), table_.end(), Entry{});
            generation_ = 1;
        }
        Coalesced result;
        const auto touch = [&](std::uint64_t line, std::uint32_t sectors) {
            std::size_t at = (line * 0x9e3779b97f4a7c15ull) >> table_shift_;
            while (table_[at].generation == generation_ && table_[at].line != line)
                [[unlikely]] at = (at + 1) & (table_.size() - 1);
            Entry& entry = table_[at];
            const bool seen = entry.generation == generation_;
            const std::size_t place = seen ? entry.place : result.requests;
            const std::uint32_t before = seen ? out[place].sectors : 0;
            entry = {line, generation_, static_cast<std::uint32_t>(place)};
            // Field by field: a copy of a half-written whole would wait for the stores before it.
            Request& request = out[place];
            request.line = line;
            request.id = static_cast<std::uint32_t>(line - layout.id_offset);
            request.sectors = before | sectors;
            request.cache = like.cache;
            request.group = like.group;
            result.requests += !seen;
            result.sectors += static_cast<unsigned>(std::popcount(sectors & ~before));
        };
        const std::uint64_t in_line = sectors_per_line_ - 1;
        for (unsigned lane = 0; lane < lanes; ++lane) {
            const std::uint64_t first_byte = layout.base + std::uint64_t{elements[lane]} * layout.stride;
            const std::uint64_t first = first_byte >> sector_shift_,
                                last = (first_byte + layout.extra) >> sector_shift_;
            const int line_of_sector = line_shift_ - sector_shift_;
            std::uint64_t line = first >> line_of_sector;
            if (layout.one_line) {
                touch(line, sector_range(first & in_line, last & in_line));
                continue;
            }
            const std::uint64_t last_line = last >> line_of_sector;
            for (std::uint64_t from = first & in_line; line < last_line; ++line, from = 0)
                touch(line, sector_range(from, in_line));
            touch(line, sector_range(last_line == first >> line_of_sector ? first & in_line : 0, last & in_line));
        }
        return result;
    }

private:
    struct Layout {
        std::uint64_t base = 0, stride = 0, extra = 0;  ///< extra: element size - 1
        bool one_line = false;                          ///< no element straddles a line
        std::uint64_t id_offset = 0;
    };
    /// Hash table of the lines seen in this access; entries of earlier generations count as empty.
    struct Entry {
        std::uint64_t line = 0;
        std::uint32_t generation = 0, place = 0;
    };

    /// Bits first … last, both included.
    static std::uint32_t sector_range(std::uint64_t first, std::uint64_t last) {
        return static_cast<std::uint32_t>(((std::uint64_t{2} << (last - first)) - 1) << first);
    }

    int line_shift_, sector_shift_, table_shift_ = 0;
    std::uint64_t sectors_per_line_;
    std::size_t max_requests_ = 0;
    std::uint32_t generation_ = 0;
    std::vector<Layout> layouts_;
    std::vector<Entry> table_;
};

}  // namespace raycache::cachesim
