// Reads the warp instructions of an Accel-Sim trace (".traceg", plain or xz, tracer version up to 5): its global loads.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace raycache::traces {

/// One LDG instruction of a warp.
struct GlobalLoad {
    std::uint64_t pc = 0;
    std::uint32_t mask = 0;                ///< active lanes; never 0
    std::uint32_t bytes = 0;               ///< that each lane reads: 1, 2, 4, 8 or 16
    std::vector<std::uint64_t> addresses;  ///< of the active lanes, lowest lane first; multiples of `bytes`
};

struct TracegKernel {
    std::string name;
    std::uint32_t warps_per_cta = 0;
    std::uint64_t ctas = 0;
    std::uint64_t loads = 0;      ///< LDG instructions with active lanes
    std::uint64_t bypassing = 0;  ///< of those, with .STRONG.GPU or .STRONG.SYS: a GPU does not look them up in L1
    std::map<std::string, std::uint64_t> left_out;  ///< other instructions with addresses, by the opcode's first part
};

/// Calls load(warp, GlobalLoad&) for every load, warps in order of CTA and number: warp = CTA * warps_per_cta + number.
/// Throws Error "FILE: line N: …" at the first line that breaks the grammar, and if a CTA is cut short or missing.
TracegKernel parse_traceg(const std::string& path, const std::function<void(std::uint64_t, GlobalLoad&)>& load);

}  // namespace raycache::traces
