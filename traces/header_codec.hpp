// The head of a trace file as bytes. Internal to traces/.
#pragma once

#include <cstdint>
#include <span>

#include "traces/bytes.hpp"
#include "traces/fault.hpp"
#include "traces/header.hpp"
#include "traces/memory_budget.hpp"

namespace raycache::traces {

/// Throws Error if the header breaks a rule of header.hpp or a limit of the format.
Bytes encode_header(const Header&);

/// The part of the head that tells its size. Refuses other files, newer versions and reserved bits.
/// `file` is the front of the file, at least format::fixed_header_bytes if the file has that many.
std::uint64_t header_bytes(std::span<const std::uint8_t> front, std::uint64_t file_bytes, const Origin&);

/// Decodes a whole head (as long as header_bytes says). The budget is charged for the link tables.
Header decode_header(std::span<const std::uint8_t> head, const Origin&, MemoryBudget&);

}  // namespace raycache::traces
