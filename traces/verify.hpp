// Checks every byte and every record of a trace; salvages the whole blocks of a damaged one.
#pragma once

#include <cstdint>
#include <string>

namespace raycache::traces {

struct VerifyResult {
    std::uint64_t blocks = 0, warps = 0, records = 0, lane_accesses = 0, rays = 0;
};

/// Reads the whole file and checks each checksum, count and element index. Throws Error with the offset of the first
/// fault.
VerifyResult verify(const std::string& path);

struct RecoverResult {
    std::uint64_t launches_kept = 0, launches_lost = 0;  ///< a launch is kept when all its blocks are whole
    std::uint64_t blocks_kept = 0, blocks_lost = 0;
};

/// Scans `damaged` for whole blocks (it needs a whole header, but no footer) and writes the launches that are complete
/// to `recovered`, a valid trace. Throws Error if no launch is complete.
RecoverResult recover(const std::string& damaged, const std::string& recovered);

}  // namespace raycache::traces
