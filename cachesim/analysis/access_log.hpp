// The warp accesses of the present window of rounds: who stands behind a look-up, lane by lane.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "cachesim/frontend/region_layout.hpp"
#include "cachesim/replay/request_sink.hpp"
#include "traces/header.hpp"

namespace raycache::cachesim {

class AccessLog {
public:
    AccessLog(const std::vector<traces::Region>& regions, std::uint32_t line_bytes, std::uint32_t sector_bytes)
        : line_bytes_(line_bytes), sector_bytes_(sector_bytes) {
        for (const traces::Region& r : regions) places_.push_back({r.base, r.stride, r.element_size});
    }

    struct Access {
        std::uint32_t mask = 0;   ///< active lanes
        std::uint32_t warp = 0;   ///< number of the warp in its launch
        std::uint32_t first = 0;  ///< where its elements begin
        std::uint8_t region = 0;
    };

    void add(const IssuedAccess& a) {
        if (a.number >= accesses_.size()) accesses_.resize(2 * std::size_t{a.number} + 1);
        accesses_[a.number] = {a.record.mask, a.warp, static_cast<std::uint32_t>(elements_.size()), a.record.region};
        elements_.insert(elements_.end(), a.elements, a.elements + a.record.lanes());
    }
    void clear() { elements_.clear(); }

    /// By IssuedAccess::number.
    const Access& operator[](std::uint32_t access) const { return accesses_[access]; }
    /// Of its active lanes, lowest first.
    const std::uint32_t* elements(const Access& access) const { return &elements_[access.first]; }

    /// Calls use(lane, element, sectors) for each active lane, lowest first, whose object lies in some of the sectors
    /// that the look-up asked for, until one call returns false.
    template <class Use>
    void for_each_lane(const ServedRequest& request, Use&& use) const {
        const Access& access = accesses_[request.access];
        const Place& place = places_[access.region];
        const std::uint64_t line_end = request.address + line_bytes_ - 1;
        const std::uint32_t* element = elements(access);
        for (std::uint32_t left = access.mask; left != 0; left &= left - 1, ++element) {
            const std::uint64_t begin = place.base + std::uint64_t{*element} * place.stride;
            const std::uint64_t end = begin + place.size - 1;
            if (begin > line_end || end < request.address) continue;
            const std::uint64_t first = (std::max(begin, request.address) - request.address) / sector_bytes_;
            const std::uint64_t last = (std::min(end, line_end) - request.address) / sector_bytes_;
            const std::uint32_t sectors = sector_range(first, last) & request.asked;
            if (sectors && !use(static_cast<unsigned>(std::countr_zero(left)), *element, sectors)) return;
        }
    }

private:
    struct Place {
        std::uint64_t base;
        std::uint32_t stride, size;
    };
    std::uint32_t line_bytes_, sector_bytes_;
    std::vector<Place> places_;     ///< by region
    std::vector<Access> accesses_;  ///< by number; those of other windows are garbage
    std::vector<std::uint32_t> elements_;
};

}  // namespace raycache::cachesim
