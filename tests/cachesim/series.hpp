// Counts and series made by hand, for the tests of reports.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "cachesim/report/report.hpp"

namespace raycache::cachesim::test {

inline Counters counters(std::uint64_t rays, std::uint64_t steps, std::uint64_t accesses, std::uint64_t sectors,
                         std::uint64_t l2, std::uint64_t dram) {
    Counters c;
    c.rays = rays;
    c.steps = c.lane_accesses = steps;
    c.warp_accesses = accesses;
    c.levels[0].sectors = sectors;
    c.requests = 2 * sectors;  // each sector is asked for by two loads
    c.levels[1].sectors = l2;
    c.levels[0].hits = sectors - l2;
    c.dram_sectors = dram;
    c.levels[1].hits = l2 - dram;
    return c;
}

/// Camera nodes, half as much again for shadow triangles.
inline LaunchStatistics launch(std::uint32_t sample, Counters c) {
    RayGroup camera, shadow;
    camera.rays = c.rays;
    c.rays = 0;
    camera.by_kind[0] = c;
    shadow.ray = traces::RayType::shadow;
    shadow.rays = camera.rays / 2;
    shadow.by_kind[1] = counters(0, c.steps / 2, c.warp_accesses / 2, c.levels[0].sectors / 2, c.levels[1].sectors / 2,
                                 c.dram_sectors / 2);
    return {sample, {camera, shadow}};
}

inline Series series(const std::string& strategy, std::vector<LaunchStatistics> launches) {
    Series s;
    s.scene = "room";
    s.strategy = strategy;
    s.sequence = "sobol";
    s.thread_map = "tile";
    s.gpu = "gtx-980-ti";
    s.spp = 64;
    s.launches = std::move(launches);
    return s;
}

}  // namespace raycache::cachesim::test
