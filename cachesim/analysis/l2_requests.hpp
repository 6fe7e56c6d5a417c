// Counts what a profiler counts in instructions and the replay does not: requests from the L1s to the level that all
// SMs share, and the lanes of load instructions.
//
// The replay looks a visit up as a whole; a GPU sends each load by itself. Of the sectors of a line that a visit
// misses, those that one of its loads is the first to read are one request: a load fetches at most a line at a time,
// and a later load of the same visit finds what an earlier one fetched (LoadCounter::line_requests). Stores alike.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "cachesim/analysis/access_log.hpp"
#include "cachesim/frontend/load_counter.hpp"
#include "cachesim/gpus/gpu.hpp"
#include "cachesim/replay/request_sink.hpp"
#include "cachesim/replay/statistics.hpp"
#include "traces/header.hpp"

namespace raycache::cachesim {

class L2RequestCounter final : public RequestSink {
public:
    /// For a replay of a launch with these regions on this GPU.
    L2RequestCounter(const Gpu&, const std::vector<traces::Region>&);

    bool wants(std::size_t level, std::uint32_t /*sm*/) const override { return level == shared_; }
    void issued(std::span<const IssuedAccess>) override;
    void served(std::size_t level, std::span<const ServedRequest>) override;
    void end_window() override { log_.clear(); }

    /// The launch that was listened to, in instructions: `requests` are those to the shared level, `warp_accesses` are
    /// load (or store) instructions and `lane_accesses` their active lanes. The rest is as it was counted.
    LaunchStatistics in_instructions(const LaunchStatistics& counted) const;

private:
    struct Instructions {
        std::uint64_t requests = 0, lanes = 0;
    };
    Instructions& of(traces::RayType ray, std::uint8_t bounce, traces::ObjectKind kind) {
        return counts_[static_cast<unsigned>(ray)][bounce][static_cast<unsigned>(kind)];
    }

    std::size_t shared_;
    LoadCounter loads_;
    AccessLog log_;
    std::vector<traces::ObjectKind> kinds_;  ///< by region
    std::array<std::array<std::array<Instructions, traces::object_kinds>, traces::max_bounce + 1>, traces::ray_types>
        counts_{};
};

}  // namespace raycache::cachesim
