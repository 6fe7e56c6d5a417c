// The container ".tracez" of Accel-Sim 2: the text of a kernel's trace, its instructions compressed warp by warp.
//
//     header     the lines that begin with '-' and '#', up to a byte 0
//     u32 u32    size of the dictionary, instructions of a piece
//     bytes      a zstd dictionary
//     warps      of each: u32 instructions, u32 pieces; of each piece: u32 size, one zstd frame of lines
//     index      u32 thread blocks; of each: u32 x 3 coordinates, u32 x 7 of its cluster, u32 warps; of each warp: u32
//                instructions, u32 pieces, u64 offset, u32 instructions of each piece
//     u64        offset of the index
//
// Little-endian (facts of the simulator's tracez_format.h).
#pragma once

#include <string>

#include "traces/accelsim/traceg_parser.hpp"

namespace raycache::traces {

/// A file that is no compressed text, and has a byte 0 behind lines of such a header.
bool looks_like_tracez(const std::string& path);

/// As parse_traceg().
TracegKernel parse_tracez(const std::string& path, const std::function<void(std::uint64_t, GlobalLoad&)>& load,
                          const TracegOptions&);

}  // namespace raycache::traces
