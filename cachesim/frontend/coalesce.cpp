#include "cachesim/frontend/coalesce.hpp"

#include <algorithm>
#include <bit>

#include "traces/record.hpp"

namespace raycache::cachesim {

namespace {

/// The look-ups of one access, from `begin` on. A hash table says at which place to look for a line: an entry is base +
/// place; entries of earlier accesses are below base, so they are at no place. Free of branches that depend on whether
/// a line is new, which cannot be predicted: a new line is put behind the others before the search, as a sentinel, and
/// counts if it is what the search finds.
struct Merger {
    std::uint32_t* const table;
    const std::size_t table_mask;
    const int table_shift;
    const std::uint32_t base;
    std::uint32_t* const lines;
    std::uint32_t* const sectors;
    std::uint32_t count = 0;

    void touch(std::uint32_t line, std::uint32_t wanted) {
        lines[count] = line;
        sectors[count] = 0;
        // Multiplicative hashing (Knuth, The Art of Computer Programming 3, section 6.4).
        std::size_t at = (line * 0x9e3779b97f4a7c15ull) >> table_shift;
        std::uint32_t place = std::min(table[at] - base, count);
        while (lines[place] != line) [[unlikely]] {
                at = (at + 1) & table_mask;
                place = std::min(table[at] - base, count);
            }
        table[at] = base + place;
        sectors[place] |= wanted;
        count += place == count;
    }
};

}  // namespace

Coalescer::Coalescer(const std::vector<traces::Region>& regions, const LineShape& shape, LineIds& ids,
                     InstructionSet instructions)
    : shape_(shape), ids_(ids) {
    std::size_t most_lines = 1;
    bool vectors = true;
    for (std::size_t i = 0; i < regions.size(); ++i) {
        layouts_.emplace_back(regions[i], i, shape, ids);
        most_lines = std::max<std::size_t>(most_lines, (regions[i].element_size - 1) / shape.line_bytes + 2);
        vectors &= layouts_.back().vectors;
    }
    if (vectors) vectors_ = coalesce_vectors(instructions);
    most_lookups_ = most_lines * traces::warp_lanes + 1;
    // At most a quarter full, so that a probe rarely meets another line.
    table_.resize(std::bit_ceil(std::max<std::size_t>(256, 4 * most_lookups_)));
    table_shift_ = 64 - std::countr_zero(table_.size());
}

void Coalescer::operator()(std::span<const WarpAccess> accesses, std::uint32_t first, Lookups& out) {
    if (vectors_) {
        vectors_(accesses, first, layouts_, shape_, packed_, out);
        return;
    }
    for (const WarpAccess& access : accesses) add_one(access, first++, out);
}

void Coalescer::add_one(const WarpAccess& access, std::uint32_t number, Lookups& out) {
    const RegionLayout& layout = layouts_[access.region];
    const unsigned lanes = access.lanes();
    out.reserve(most_lookups_);
    if (base_ > ~std::uint32_t{0} - 2 * static_cast<std::uint32_t>(most_lookups_)) {
        std::fill(table_.begin(), table_.end(), 0);
        base_ = 0;
    }
    base_ += static_cast<std::uint32_t>(most_lookups_);  // every entry so far is below
    Merger merger{table_.data(),
                  table_.size() - 1,
                  table_shift_,
                  base_,
                  out.lines.data() + out.count,
                  out.sectors.data() + out.count};
    if (!layout.sectors.empty()) {
        for (unsigned lane = 0; lane < lanes; ++lane) {
            const std::uint32_t element = access.elements[lane];
            merger.touch(layout.first_id + (element >> layout.elements_shift),
                         layout.sectors[element & layout.in_line]);
        }
    } else {
        const std::uint64_t in_line = shape_.sectors - 1;
        const int line_of_sector = shape_.line_shift - shape_.sector_shift;
        for (unsigned lane = 0; lane < lanes; ++lane) {
            const std::uint64_t first_byte = layout.address(access.elements[lane]);
            const std::uint64_t first = first_byte >> shape_.sector_shift,
                                last = (first_byte + layout.extra) >> shape_.sector_shift;
            const std::uint64_t last_line = last >> line_of_sector;
            std::uint64_t line = first >> line_of_sector, from = first & in_line;
            for (; line < last_line; ++line, from = 0)
                merger.touch(ids_.id(line, access.region), sector_range(from, in_line));
            merger.touch(ids_.id(line, access.region), sector_range(from, last & in_line));
        }
    }
    std::fill_n(out.accesses.begin() + static_cast<std::ptrdiff_t>(out.count), merger.count, number);
    out.count += merger.count;
}

}  // namespace raycache::cachesim
