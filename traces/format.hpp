// The numbers of FORMAT.md: magic values, sizes, limits. Internal to traces/.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "traces/symbols.hpp"

namespace raycache::traces::format {

using namespace std::string_view_literals;

inline constexpr std::uint32_t version = 5;  ///< the newest

inline constexpr std::string_view file_magic = "RCTRACE\x1a"sv;
inline constexpr std::string_view block_magic = "RCBLOCK\x1a"sv;
inline constexpr std::string_view index_magic = "RCINDEX\x1a"sv;
inline constexpr std::string_view end_magic = "RCEND..\x1a"sv;

inline constexpr std::size_t fixed_header_bytes = 48;
inline constexpr std::size_t region_bytes = 40;
inline constexpr std::size_t checksum_bytes = 8;
inline constexpr std::size_t index_entry_bytes = 48;
inline constexpr std::size_t index_head_bytes = 16;
inline constexpr std::size_t index_tail_bytes = 24;

/// The streams of a block, in file order.
enum Stream : unsigned {
    control,          ///< counts of each warp; records that the schedule does not predict
    linked_symbols,   ///< successor of each access to an element with links
    other_symbols,    ///< successor of each other access and of each ray start
    literal_regions,  ///< of each literal: its region, then the four bytes of its zigzag difference
    literal_byte0,
    literal_byte1,
    literal_byte2,
    literal_byte3,
};
inline constexpr unsigned streams = 8;
inline constexpr std::size_t block_head_bytes = 48 + streams * 8;

using symbol::end_of_ray;
using symbol::literal;
using symbol::sequential;
inline constexpr unsigned stack_entries = symbol_stack_entries;

// Bits of a control tag.
inline constexpr std::uint8_t tag_region = 1, tag_mask = 2, tag_ray = 4, tag_known = 7;

// Limits. A reader refuses larger values before it allocates anything.
inline constexpr std::uint32_t max_regions = 254;
inline constexpr std::uint32_t max_launches = 1u << 20;
inline constexpr std::uint32_t max_warps_per_launch = 1u << 26;
inline constexpr std::uint32_t max_kernels_per_launch = 1024;
inline constexpr std::uint32_t max_elements = (1u << 30) - 1;
inline constexpr std::uint32_t max_element_size = 4096;
inline constexpr std::uint64_t region_alignment = 2u << 20;
inline constexpr std::uint64_t max_address = std::uint64_t{1} << 48;  ///< of a base
inline constexpr unsigned max_degree = 16;
inline constexpr std::uint64_t max_links = std::uint64_t{1} << 28;  ///< in one region
inline constexpr std::uint32_t max_provenance_bytes = 1u << 16;
inline constexpr std::uint32_t max_block_warps = 1u << 20;
inline constexpr std::uint64_t max_block_records = std::uint64_t{1} << 25;
/// Raw bytes of the control stream for each record and warp; with issue steps, of which an access has at most two.
inline constexpr std::uint64_t max_control_bytes = 16, max_control_bytes_issue = 48;
inline constexpr std::uint64_t max_block_lanes = std::uint64_t{1} << 25;  ///< lane accesses plus rays

}  // namespace raycache::traces::format
