// Caches of any replacement policy and size beside those of a replay: they hear the same look-ups, and so count what a
// replay with them in the level would.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cachesim/cache/geometry.hpp"
#include "cachesim/cache/level.hpp"
#include "cachesim/cache/line_map.hpp"
#include "cachesim/gpus/gpu.hpp"
#include "cachesim/replay/request_sink.hpp"
#include "traces/header.hpp"

namespace raycache::cachesim {

/// Of all caches of a level together, in sectors.
struct PolicyCounts {
    std::uint64_t asked = 0, hits = 0;
    std::uint64_t fetched = 0;  ///< from below, those beside the missing ones included
    bool operator==(const PolicyCounts&) const = default;
};

class PolicyCaches final : public RequestSink {
public:
    /// Of Gpu::levels[level], as `geometries` instead: policies are those of cache_policies(); lines, sectors and
    /// fill_bytes must be those of the level.
    PolicyCaches(const Gpu&, const std::vector<traces::Region>&, std::size_t level,
                 std::span<const CacheGeometry> geometries);

    bool wants(std::size_t level, std::uint32_t /*sm*/) const override { return level == level_; }
    void served(std::size_t level, std::span<const ServedRequest>) override;

    /// Of each geometry, of all look-ups so far.
    std::vector<PolicyCounts> counts() const;

private:
    struct Kind {
        CacheGeometry geometry;
        LineMap map;
        std::vector<std::unique_ptr<Level>> of_sm;
        PolicyCounts counts;
    };

    std::size_t level_;
    unsigned caches_;  ///< of an SM
    std::uint64_t lines_;
    std::vector<Kind> kinds_;
    std::vector<std::uint32_t> sets_, numbers_, sectors_;  ///< of a call
};

}  // namespace raycache::cachesim
