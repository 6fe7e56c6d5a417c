#include "cachesim/analysis/pixel_costs.hpp"

#include <array>
#include <bit>

namespace raycache::cachesim {

PixelCosts::PixelCosts(const LanePixels& pixels)
    : of_lane_(pixels.of_lane.data()), costs_(std::size_t{pixels.width} * pixels.height) {}

void PixelCosts::add_access(const IssuedAccess& access) {
    const std::uint32_t* const pixels = of_lane_ + std::size_t{access.warp} * traces::warp_lanes;
    for (std::uint32_t left = access.record.mask; left != 0; left &= left - 1) {
        const std::uint32_t pixel = pixels[std::countr_zero(left)];
        if (pixel == LanePixels::no_pixel) continue;
        costs_[pixel].accesses += 1;
        costs_[pixel].lanes += access.record.lanes();
    }
}

template <class Charge>
void PixelCosts::share(const AccessLog& log, const ServedRequest& request, std::uint32_t sectors, Charge&& charge) {
    std::array<std::uint32_t, 32> askers{};  // lanes of each sector
    log.for_each_lane(request, [&](unsigned lane, std::uint32_t, std::uint32_t asked) {
        for (std::uint32_t left = asked & sectors; left != 0; left &= left - 1)
            askers[static_cast<unsigned>(std::countr_zero(left))] |= 1u << lane;
        return true;
    });
    const std::uint32_t* const pixels = of_lane_ + std::size_t{log[request.access].warp} * traces::warp_lanes;
    for (std::uint32_t left = sectors; left != 0; left &= left - 1) {
        const auto sector = static_cast<unsigned>(std::countr_zero(left));
        const auto lanes = static_cast<unsigned>(std::popcount(askers[sector]));
        if (lanes == 0) continue;
        std::uint64_t rest = parts % lanes;  // goes to the lowest lanes, so that nothing is lost
        for (std::uint32_t lane = askers[sector]; lane != 0; lane &= lane - 1) {
            const std::uint32_t pixel = pixels[std::countr_zero(lane)];
            const std::uint64_t part = parts / lanes + (rest ? 1 : 0);
            rest -= rest ? 1 : 0;
            if (pixel != LanePixels::no_pixel) charge(costs_[pixel], sector, part);
        }
    }
}

void PixelCosts::add_l1(const AccessLog& log, const ServedRequest& request) {
    share(log, request, request.asked, [&](PixelCost& cost, unsigned sector, std::uint64_t part) {
        cost.l1_parts += part;
        if (request.missing >> sector & 1) cost.l2_parts += part;
    });
}

void PixelCosts::add_last(const AccessLog& log, const ServedRequest& request) {
    share(log, request, request.missing,
          [&](PixelCost& cost, unsigned, std::uint64_t part) { cost.dram_parts += part; });
}

PixelCosts& PixelCosts::operator+=(const PixelCosts& other) {
    if (costs_.empty()) costs_.resize(other.costs_.size());
    for (std::size_t i = 0; i < costs_.size(); ++i) {
        PixelCost& sum = costs_[i];
        const PixelCost& c = other.costs_[i];
        sum.l1_parts += c.l1_parts;
        sum.l2_parts += c.l2_parts;
        sum.dram_parts += c.dram_parts;
        sum.accesses += c.accesses;
        sum.lanes += c.lanes;
    }
    return *this;
}

}  // namespace raycache::cachesim
