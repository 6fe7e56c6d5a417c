#include "traces/symbol_search.hpp"

#include <bit>

#include "traces/stack_search.hpp"

namespace raycache::traces {

/// A symbol that is no depth, and the literal if it is one. `next_…` is what `sequential` would mean.
std::uint8_t SymbolSearch::spell(Schedule& schedule, unsigned lane, std::uint32_t next_region,
                                 std::uint32_t next_element, const Successor& to, BlockStreams& out) {
    if (to.none()) return format::end_of_ray;
    const std::uint32_t bit = 1u << lane;
    schedule.waiting[to.region] |= bit;
    if (to.region == next_region && to.element() == next_element) {
        schedule.sequential |= bit;
        return format::sequential;
    }
    out.literal(to.region, to.element());
    return format::literal;
}

void SymbolSearch::write_starts(Schedule& schedule, std::uint32_t mask, const Successor* to, BlockStreams& out) {
    for (std::uint32_t left = mask; left != 0; left &= left - 1, ++to) {
        const auto lane = static_cast<unsigned>(std::countr_zero(left));
        stacks_[lane].clear();
        *out.other_end++ = spell(schedule, lane, 0, 0, *to, out);
    }
}

/// `fixed_degree` is the degree of the record's region, known to the compiler; or `any_degree`.
constexpr unsigned any_degree = ~0u;

template <unsigned fixed_degree>
void SymbolSearch::write_access(const Header& header, Schedule& schedule, const Record& record,
                                const std::uint32_t* elements, const Successor* to, const NextIn& next_in,
                                BlockStreams& streams) {
    const Region& region = header.regions[record.region];
    const unsigned degree = fixed_degree == any_degree ? region.degree : fixed_degree;
    const std::uint32_t* table = region.links.data();
    std::uint8_t*& end = degree != 0 ? streams.linked_end : streams.other_end;
    std::uint8_t* out = end;
    const std::uint32_t high = std::uint32_t{record.region} << element_bits;
    const bool linkable = record.region < unlinkable;
    std::uint32_t sequential = 0;
    for (std::uint32_t left = record.mask; left != 0; left &= left - 1, ++elements, ++to) {
        const auto lane = static_cast<unsigned>(std::countr_zero(left));
        const std::uint32_t element = *elements, word = to->word;
        const std::uint32_t* links = table + std::size_t{element} * degree;
        LaneStack& stack = stacks_[lane];
        unsigned symbol = not_found;
        if (degree == 0 && linkable && word == (high | element) + 1) {
            symbol = format::sequential;
            sequential |= left & (0u - left);
        } else if (word < no_word) [[likely]] {
            symbol = find_depth(stack, links, degree, word);
            if (symbol != not_found) [[likely]]
                stack.follow(links, degree, symbol);
        }
        if (symbol == not_found) [[unlikely]]
            symbol = spell(schedule, lane, record.region, element + 1, *to, streams);
        *out++ = static_cast<std::uint8_t>(symbol);
    }
    end = out;
    schedule.sequential |= sequential;
    for (unsigned r = 0; r < unlinkable; ++r) schedule.waiting[r] |= next_in[r] & record.mask;
}

void SymbolSearch::write(const Header& header, Schedule& schedule, const WarpTrace& warp, BlockStreams& out) {
    successors_.find(header, warp);
    out.begin_warp(warp, successors_.lanes_at_start);
    for (LaneStack& stack : stacks_) stack.clear();

    std::array<Successor, warp_lanes> first;
    unsigned firsts = 0;
    for (unsigned lane = 0; lane < warp_lanes; ++lane)
        if (!successors_.at_start[lane].none()) first[firsts++] = successors_.at_start[lane];
    write_starts(schedule, successors_.lanes_at_start, first.data(), out);

    const Successor* to = successors_.after.data();
    const std::uint32_t* elements = warp.elements.data();
    const NextIn* next_in = successors_.next_in.data();
    for (const Record& record : warp.records) {
        out.record(schedule, record);
        schedule.begin(record);
        const unsigned count = record.lanes();
        if (!record.is_access()) {
            write_starts(schedule, record.mask, to, out);
        } else {
            switch (header.regions[record.region].degree) {
                case 0:
                    write_access<0>(header, schedule, record, elements, to, *next_in, out);
                    break;
                case 2:
                    write_access<2>(header, schedule, record, elements, to, *next_in, out);
                    break;
                case 4:
                    write_access<4>(header, schedule, record, elements, to, *next_in, out);
                    break;
                case 8:
                    write_access<8>(header, schedule, record, elements, to, *next_in, out);
                    break;
                default:
                    write_access<any_degree>(header, schedule, record, elements, to, *next_in, out);
                    break;
            }
            elements += count;
        }
        to += count;
        ++next_in;
    }
    out.end_warp();
}

}  // namespace raycache::traces
