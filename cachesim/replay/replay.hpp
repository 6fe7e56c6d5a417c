// Functional replay of one launch on one GPU: which sectors hit where. Order only, no time.
//
// CTAs of 8 consecutive warps go to SMs in rotating order while there is room (each SM takes one, then the next SM),
// later to whichever SM frees first. Resident warps of an SM take turns (loose round-robin), one warp access per turn;
// SMs take turns.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "cachesim/gpus/gpu.hpp"
#include "cachesim/replay/statistics.hpp"
#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

class Replay {
public:
    /// Caches start empty. `regions` is copied (without links).
    Replay(const Gpu&, const std::vector<traces::Region>& regions, std::uint32_t sample);
    ~Replay();
    Replay(Replay&&) noexcept;

    /// Hands over the next warp of the launch, in warp order. Simulates as far as needed to make room for it, so memory
    /// stays bounded by the warps resident at once.
    void push(std::shared_ptr<const traces::WarpTrace>);

    /// Runs what is left and returns the counts. Call once.
    LaunchStatistics finish();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace raycache::cachesim
