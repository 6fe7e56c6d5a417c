#include "traces/verify.hpp"

#include <vector>

#include "traces/reader.hpp"

namespace raycache::traces {

// Reader refuses a damaged head or index and blocks that leave a warp out; read_block refuses damaged records.
VerifyResult verify(const std::string& path) {
    const Reader reader(path);
    VerifyResult result;
    std::vector<WarpTrace> warps;
    for (std::size_t i = 0; i < reader.blocks().size(); ++i) {
        reader.read_block(i, warps);
        const BlockInfo& block = reader.blocks()[i];
        ++result.blocks;
        result.warps += block.warps;
        result.records += block.records;
        result.lane_accesses += block.lane_accesses;
        result.rays += block.rays;
    }
    return result;
}

}  // namespace raycache::traces
