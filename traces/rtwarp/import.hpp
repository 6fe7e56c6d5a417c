// An RTWARP01 trace (plain or zstd: warp accesses of a lock-step BVH traversal, one launch) as a trace of this project.
//
// Little endian, no padding. Header, 64 bytes: 0 magic "RTWARP01"; 8 u32 header size, 64; 12 u32 warps; 16, 20 u32
// picture width, height; 24 u32 sample index; 28 u32 N; 32 f32 mu; 36 u32 strategy, 0 coherent, 1 Cranley-Patterson, 2
// micro-jitter; 40, 44 u32 bytes of a node, of a triangle; 48, 56 u64 address of node 0, of triangle 0. Then for each
// warp u32 records, u32 bytes of them, and the records: u8 tag (bits 0 to 2 ray kind: 0 camera, n bounce n, 4 + n
// shadow ray of bounce n; bit 6 triangle instead of node; bit 7 ray start), u32 mask, and unless a ray start one u32
// index per lane of the mask, lowest first.
#pragma once

#include <string>

namespace raycache::traces {

/// Whether the content, decompressed where it is, starts as an RTWARP01 trace does.
bool looks_like_rtwarp(const std::string& path);

/// Writes `output`. `program` and `command` are for Provenance. Throws Error if the file is no whole RTWARP01 trace.
void import_rtwarp(const std::string& input, const std::string& output, const std::string& program,
                   const std::string& command);

}  // namespace raycache::traces
