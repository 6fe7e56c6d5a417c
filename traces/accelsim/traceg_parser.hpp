// Reads the warp instructions of an Accel-Sim trace: its loads of global memory and, if asked, its stores. A ".traceg"
// of tracer version up to 6, plain or compressed (byte_source.hpp), or a ".tracez" (tracez_file.hpp), told by its
// content.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "traces/accelsim/register_set.hpp"
#include "traces/accelsim/scoreboard.hpp"

namespace raycache::traces {

/// One load instruction of a warp: LDG, LDGSTS, or LD of global memory; or a store: STG, or ST there.
struct GlobalLoad {
    std::uint64_t pc = 0;
    std::uint32_t mask = 0;  ///< active lanes; never 0
    bool is_store = false;
    std::uint32_t bytes = 0;               ///< that each lane reads or writes: 1, 2, 4, 8, 16 or 32
    std::vector<std::uint64_t> addresses;  ///< of the active lanes, lowest lane first; multiples of `bytes`
    RegisterSet written;                   ///< from the destination on, those that `bytes` fill
    RegisterSet read;             ///< the sources, each with the one behind it: an address takes two, and one is named
    RegisterSet between;          ///< that other instructions of the warp since its load before have to do with
    std::vector<LoadStep> steps;  ///< what the warp waits for and issues since the one before
    /// By which steps of the warp are to name it: loads and stores before it, unless the receiver gives another number.
    std::uint32_t number = 0;
};

/// What becomes of lanes that read address 0: tracers write it where they lost the address.
enum class NullLanes {
    drop_loads,  ///< a load whose lanes all do is left out; one of some stays as it is
    drop_lanes,  ///< each of them is left out
    keep,
};

struct TracegOptions {
    NullLanes null_lanes = NullLanes::drop_loads;
    /// Thread blocks are numbered by their place in the file, whatever their coordinates.
    bool number_by_place = false;
    /// Stores are handed on, too; else they are left out.
    bool stores = false;
    /// At the end of each warp: what it waits for and issues since its last load.
    std::function<void(std::uint64_t warp, std::vector<LoadStep>&&)> warp_end = {};
};

struct TracegKernel {
    std::string name;
    std::uint32_t warps_per_cta = 0;
    std::uint64_t ctas = 0;        ///< of the grid
    std::uint64_t empty_ctas = 0;  ///< of them, those that the file leaves out
    std::uint64_t loads = 0;       ///< of global memory with active lanes, as far as they are not left out
    std::uint64_t stores = 0;      ///< the same of stores, if they are asked for
    std::uint64_t bypassing = 0;   ///< of those, with .STRONG.* or .BYPASS: a GPU does not look them up in L1
    std::uint64_t null_lanes = 0, null_loads = 0;   ///< lanes that read address 0, and loads that have such
    std::map<std::string, std::uint64_t> left_out;  ///< other instructions with addresses, by the opcode's first part
    bool in_order = true;  ///< coordinates of thread blocks ascend, so that each is numbered by its own
};

/// Calls load(warp, GlobalLoad&) for every load (and store, if asked). warp = CTA * warps_per_cta + number: CTAs in
/// ascending order, the warps of each as they stand in the file. A CTA's number is that of its coordinates in the grid
/// as long as these ascend through the file, and else its place, which needs a file with all of them. Throws Error
/// "FILE: line N: …" at the first line that breaks the grammar, and if a CTA is cut short.
TracegKernel parse_traceg(const std::string& path, const std::function<void(std::uint64_t, GlobalLoad&)>& load,
                          const TracegOptions& = {});

}  // namespace raycache::traces
