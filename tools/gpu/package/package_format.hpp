// The bytes of a package's files (docs/gpu_package.md), for its reader and writer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace raycache::gpu::format {

inline constexpr std::string_view magic{"rcgpu\r\n\0", 8};
inline constexpr std::uint32_t version = 1;
inline constexpr std::uint32_t bvh_kind = 1, launch_kind = 2;
inline constexpr unsigned bvh_sections = 2, launch_sections = 5;

// Of the head, from its start.
inline constexpr std::size_t version_at = 8, kind_at = 12, id_at = 16, bytes_at = 24, sections_at = 32, text_at = 36,
                             numbers_at = 40, table_at = 56;
// Of an entry of the table.
inline constexpr std::size_t section_offset_at = 0, section_bytes_at = 8, section_sum_at = 16, entry_bytes = 24;
inline constexpr std::size_t sum_bytes = 8;      ///< of the head, table and text; behind them
inline constexpr std::uint64_t alignment = 256;  ///< of sections: that of device memory

constexpr std::uint64_t aligned(std::uint64_t at) { return (at + alignment - 1) / alignment * alignment; }

// numbers: of bvh.rcgp launches, tree, wavefront, 0; of a launch ordinal, first sample index, warps, 0.

}  // namespace raycache::gpu::format
