#include "traces/successors.hpp"

#include <bit>

#include "traces/lane_stack.hpp"
#include "traces/record_rules.hpp"

namespace raycache::traces {
void SuccessorFinder::find(const Header& header, const WarpTrace& warp) {
    std::size_t lanes = 0, accesses = 0;
    for (std::size_t i = 0; i < warp.records.size(); ++i) {
        check_record(header, warp, i);
        lanes += warp.records[i].lanes();
        if (warp.records[i].is_access()) accesses += warp.records[i].lanes();
    }
    check_elements(warp, accesses);
    if (after.size() < lanes) after.resize(lanes);
    if (next_in.size() < warp.records.size()) next_in.resize(warp.records.size());

    std::array<Successor, warp_lanes> next{};
    std::array<std::uint32_t, 3> in{};
    Successor* out = after.data() + lanes;
    const std::uint32_t* elements = warp.elements.data() + accesses;
    for (std::size_t i = warp.records.size(); i-- > 0;) {
        const Record record = warp.records[i];
        const unsigned count = record.lanes();
        out -= count;
        Successor* to = out;
        next_in[i] = in;
        for (unsigned r = 0; r < in.size(); ++r)
            in[r] = (in[r] & ~record.mask) | (r == record.region ? record.mask : 0);
        if (!record.is_access()) {
            for (std::uint32_t left = record.mask; left != 0; left &= left - 1) {
                Successor& lane = next[static_cast<unsigned>(std::countr_zero(left))];
                *to++ = lane;
                lane = {};
            }
            continue;
        }
        elements -= count;
        const std::uint32_t* from = elements;
        const std::uint32_t limit = header.regions[record.region].count;
        const std::uint32_t high = std::min<std::uint32_t>(record.region, unlinkable) << element_bits;
        std::uint32_t outside = 0;
        for (std::uint32_t left = record.mask; left != 0; left &= left - 1) {
            Successor& lane = next[static_cast<unsigned>(std::countr_zero(left))];
            const std::uint32_t element = *from++;
            *to++ = lane;
            lane = {high | element, record.region};
            outside |= element >= limit;
        }
        if (outside)
            reject_record(
                warp, i,
                fmt::format("expected elements of region {} below {}, found one beyond", record.region, limit));
    }
    at_start = next;
    lanes_at_start = 0;
    for (unsigned lane = 0; lane < warp_lanes; ++lane) lanes_at_start |= std::uint32_t{!next[lane].none()} << lane;
}

}  // namespace raycache::traces
