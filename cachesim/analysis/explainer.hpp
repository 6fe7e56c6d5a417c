// Listens to the replay of one launch and finds out why each look-up hit or missed.
//
// Every cache of the GPU is shadowed by what it would be if it were fully associative (ShadowCache), which sorts its
// misses into compulsory, capacity and conflict. A look-up of a sector is charged to the kind of object, the ray type
// and bounce, and the BVH depth it was for; where several lanes ask for a sector, its depth is that of the lowest
// lane's object. For each sector in an L1 the warp that fetched it is kept, which tells whom a later hit owes it to.
// Requests that the replay does not count change what the caches hold, and are not counted here either.
//
// Memory: the lines that each cache was ever asked for, and the accesses of one window of rounds.
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "cachesim/analysis/access_log.hpp"
#include "cachesim/analysis/element_depth.hpp"
#include "cachesim/analysis/findings.hpp"
#include "cachesim/analysis/pixel_costs.hpp"
#include "cachesim/analysis/shadow_cache.hpp"
#include "cachesim/cache/line_ids.hpp"
#include "cachesim/gpus/gpu.hpp"
#include "cachesim/replay/request_sink.hpp"

namespace raycache::cachesim {

/// What came before the replay: nothing, so that the first touch of a sector is a compulsory miss; or the same kind of
/// work without end, so that it is one only as long as the cache is not yet full: from then on it is a capacity miss.
enum class History { launch, endless };

class Explainer final : public RequestSink {
public:
    /// For a replay of these regions on this GPU. `depth` must outlive this object, and so must `pixels`, null if no
    /// costs of pixels are wanted.
    Explainer(const Gpu&, const std::vector<traces::Region>& regions, const ElementDepth& depth,
              const LanePixels* pixels = nullptr, History = History::launch);

    /// Complete after Replay::finish().
    const Findings& findings() const { return findings_; }
    const PixelCosts& pixel_costs() const { return pixel_costs_; }

    bool wants(std::size_t, std::uint32_t) const override { return true; }
    void issued(std::span<const IssuedAccess>) override;
    void served(std::size_t level, std::span<const ServedRequest>) override;
    void end_window() override { log_.clear(); }

private:
    void explain(std::size_t level, const ServedRequest&);
    void find_owners(const ServedRequest&, std::size_t cache, std::uint32_t line);

    History history_;
    std::uint32_t l1_per_sm_, warps_per_cta_, sectors_per_line_, line_bytes_;
    LineIds ids_;
    const ElementDepth& depth_;
    AccessLog log_;
    std::vector<std::vector<ShadowCache>> shadows_;    ///< by level, then cache
    std::vector<std::deque<std::uint32_t>> fetchers_;  ///< by L1, then number of a line x sector: a warp
    bool with_pixels_;
    PixelCosts pixel_costs_;
    Findings findings_;
};

}  // namespace raycache::cachesim
