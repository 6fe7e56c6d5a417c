// Reads the RTWARP01 reference traces (lock-step traversal of Sponza, 256 warps each), if this machine has them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
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

/// Folder of the reference traces: $RAYCACHE_REFERENCE, or ../shared/reference beside the source tree; nothing if
/// neither exists.
std::optional<std::string> reference_folder();

/// FOLDER/NAME.rtw.zst.
Launch read_reference(const std::string& folder, const std::string& name);

}  // namespace raycache::cachesim::test
