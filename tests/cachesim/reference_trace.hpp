// Reads the RTWARP01 reference traces (lock-step traversal of Sponza, 256 warps each; tests/real_data.hpp).
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim::test {

using Warps = std::vector<std::shared_ptr<const traces::WarpTrace>>;

struct Launch {
    std::vector<traces::Region> regions;
    Warps warps;

    std::uint64_t lane_accesses() const {
        std::uint64_t sum = 0;
        for (const auto& warp : warps) sum += warp->elements.size();
        return sum;
    }
};

/// A file compressed by zstd.
Launch read_rtwarp(const std::string& path);

}  // namespace raycache::cachesim::test
