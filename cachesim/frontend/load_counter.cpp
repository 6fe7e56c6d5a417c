#include "cachesim/frontend/load_counter.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "cachesim/frontend/distinct.hpp"
#include "cachesim/instruction_set.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

namespace {

/// Lanes [first, first + count) of the mask, moved to bit 0.
std::uint32_t group_of(std::uint32_t mask, unsigned first, unsigned count) {
    return static_cast<std::uint32_t>(mask >> first & ((std::uint64_t{1} << count) - 1));
}

}  // namespace

LoadCounter::LoadCounter(const std::vector<traces::Region>& regions, const FrontEnd& front_end, const LineShape& shape)
    : sector_shift_(shape.sector_shift) {
    for (const traces::Region& region : regions) regions_.push_back(make(region, front_end, shape));
}

LoadCounter::Loads LoadCounter::make(const traces::Region& region, const FrontEnd& front_end, const LineShape& shape) {
    Loads loads;
    if (traces::is_stream(region.kind)) {
        loads.form = Form::from_sectors;
        loads.requests_per_element = 1;
        return loads;
    }
    loads.region = {region.kind, region.base, region.element_size, region.stride, region.count, 0, {}, region.pages};
    loads.bytes = std::min(front_end.load_bytes, std::bit_ceil(region.element_size));
    loads.count = (region.element_size + loads.bytes - 1) / loads.bytes;
    loads.last_bytes = region.element_size - (loads.count - 1) * loads.bytes;
    loads.lanes_per_request = loads.bytes >= 16  ? front_end.lanes_per_request_16
                              : loads.bytes >= 8 ? front_end.lanes_per_request_8
                                                 : front_end.lanes_per_request_4;

    const std::uint64_t sector = shape.line_bytes / shape.sectors, place = region.base | region.stride;
    const bool whole_loads = place % loads.bytes == 0 && loads.bytes <= sector;  // none straddles sectors
    const bool apart = region.stride >= sector;
    loads.requests_per_element = loads.count;
    if (loads.lanes_per_request == traces::warp_lanes) {
        const std::uint64_t sectors = (region.element_size + sector - 1) / sector;
        if (loads.count == 1) {
            loads.form = Form::from_sectors;
            return loads;
        }
        if (whole_loads && place % sector == 0 && region.element_size <= region.stride &&
            std::has_single_bit(sectors)) {
            loads.form = Form::from_sectors;
            loads.sectors_shift = std::countr_zero(sectors);
            return loads;
        }
    }
    if (whole_loads && apart) loads.form = Form::from_elements;
    return loads;
}

unsigned LoadCounter::distinct(std::uint32_t mask, const std::uint32_t* elements, unsigned lanes_per_request) {
    if (lanes_per_request == traces::warp_lanes) {
        static CountDistinct* const count = count_distinct(best_instruction_set());
        return count(elements, static_cast<unsigned>(std::popcount(mask)));
    }
    if (lanes_per_request == 2) {
        unsigned equal = 0;
        for (std::uint32_t pairs = mask & mask >> 1 & 0x55555555; pairs; pairs &= pairs - 1) {
            const int first = std::popcount(mask & ((pairs & (~pairs + 1)) - 1));
            equal += elements[first] == elements[first + 1];
        }
        return static_cast<unsigned>(std::popcount(mask)) - equal;
    }
    unsigned sum = 0;
    for (unsigned lane = 0; lane < traces::warp_lanes; lane += lanes_per_request) {
        const auto lanes = static_cast<unsigned>(std::popcount(group_of(mask, lane, lanes_per_request)));
        sum += distinct_by_bits(elements, lanes);
        elements += lanes;
    }
    return sum;
}

unsigned LoadCounter::general(const Loads& loads, std::uint32_t mask, const std::uint32_t* elements) const {
    std::array<std::uint64_t, 5 * traces::warp_lanes> sectors;  // 16 bytes touch at most 5 sectors of 4
    unsigned requests = 0;
    for (unsigned lane = 0; lane < traces::warp_lanes; lane += loads.lanes_per_request) {
        const auto lanes = static_cast<unsigned>(std::popcount(group_of(mask, lane, loads.lanes_per_request)));
        for (std::uint32_t k = 0; k < loads.count; ++k) {
            auto* end = sectors.data();
            const std::uint64_t extra = (k + 1 == loads.count ? loads.last_bytes : loads.bytes) - 1;
            for (unsigned i = 0; i < lanes; ++i) {
                const std::uint64_t first = loads.region.address(elements[i]) + std::uint64_t{k} * loads.bytes;
                for (std::uint64_t s = first >> sector_shift_; s <= (first + extra) >> sector_shift_; ++s) *end++ = s;
            }
            std::sort(sectors.data(), end);
            requests += static_cast<unsigned>(std::unique(sectors.data(), end) - sectors.data());
        }
        elements += lanes;
    }
    return requests;
}

std::uint32_t LoadCounter::line_requests(std::size_t region, std::uint32_t mask, const std::uint32_t* elements,
                                         std::uint64_t line, std::uint32_t sectors) const {
    const Loads& loads = regions_[region];
    const std::uint64_t sector_bytes = std::uint64_t{1} << sector_shift_;
    constexpr std::uint64_t nobody = ~std::uint64_t{0};
    std::array<std::uint64_t, 32> fetcher;  // of each sector: load, then group of lanes
    fetcher.fill(nobody);
    for (std::uint32_t lanes = mask; lanes; lanes &= lanes - 1, ++elements) {
        const auto group = static_cast<std::uint64_t>(std::countr_zero(lanes)) / loads.lanes_per_request;
        const std::uint64_t begin = loads.region.address(*elements), end = begin + loads.region.element_size;
        for (std::uint32_t left = sectors; left; left &= left - 1) {
            const auto sector = static_cast<unsigned>(std::countr_zero(left));
            const std::uint64_t at = line + sector * sector_bytes;
            if (end <= at || begin >= at + sector_bytes) continue;
            const std::uint64_t load = begin >= at ? 0 : (at - begin) / loads.bytes;
            fetcher[sector] = std::min(fetcher[sector], load * traces::warp_lanes + group);
        }
    }
    std::sort(fetcher.begin(), fetcher.end());
    const auto end = std::unique(fetcher.begin(), std::find(fetcher.begin(), fetcher.end(), nobody));
    return static_cast<std::uint32_t>(end - fetcher.begin());
}

}  // namespace raycache::cachesim
