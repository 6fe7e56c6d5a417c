// Which pixels a launch's cache traffic belongs to.
//
// What a look-up of a sector costs is charged in equal parts to the lanes that asked for the sector, and each lane's
// part to the pixel it works for; so the pixels of a picture add up to the launch exactly.
#pragma once

#include <cstdint>
#include <vector>

#include "cachesim/analysis/access_log.hpp"
#include "cachesim/replay/request_sink.hpp"

namespace raycache::cachesim {

/// The pixel of every lane of a launch, by warp * 32 + lane: y * width + x, or `no_pixel`.
struct LanePixels {
    static constexpr std::uint32_t no_pixel = ~std::uint32_t{0};
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint32_t> of_lane;
};

/// Costs of one pixel. Sectors are counted in parts of 1 / PixelCosts::parts.
struct PixelCost {
    std::uint64_t l1_parts = 0;    ///< of sectors looked up in L1
    std::uint64_t l2_parts = 0;    ///< of those, missing there
    std::uint64_t dram_parts = 0;  ///< of sectors missing in the last level
    std::uint64_t accesses = 0;    ///< warp accesses that the pixel's lanes took part in, counted once for each lane
    std::uint64_t lanes = 0;       ///< active lanes of these

    bool operator==(const PixelCost&) const = default;
};

class PixelCosts {
public:
    static constexpr std::uint64_t parts = 1 << 20;

    PixelCosts() = default;
    /// `pixels` must outlive this object and have an entry for every lane of every warp that comes.
    explicit PixelCosts(const LanePixels& pixels);

    void add_access(const IssuedAccess&);
    /// A look-up in L1, or in the last level, on behalf of an access in the log.
    void add_l1(const AccessLog&, const ServedRequest&);
    void add_last(const AccessLog&, const ServedRequest&);

    /// By pixel, row by row from the top.
    const std::vector<PixelCost>& pixels() const { return costs_; }

    PixelCosts& operator+=(const PixelCosts&);

private:
    /// Calls charge(cost, sector, parts) for each of `sectors` and each lane that asked for it.
    template <class Charge>
    void share(const AccessLog&, const ServedRequest&, std::uint32_t sectors, Charge&& charge);

    const std::uint32_t* of_lane_ = nullptr;
    std::vector<PixelCost> costs_;
};

}  // namespace raycache::cachesim
