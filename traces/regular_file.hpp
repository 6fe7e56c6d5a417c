// A file read as a whole.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "traces/memory_budget.hpp"

namespace raycache {

/// Reads an ordinary file, or what a link leads to; never a folder, device or pipe, whose end may never come. Throws
/// Error "PATH: WHAT: expected …, found …" where that cannot be, also for more than `most` bytes, or where `budget`, if
/// any, has no room for the file.
std::vector<std::uint8_t> read_regular_file(const std::string& path, const std::string& what,
                                            MemoryBudget* budget = nullptr, std::uint64_t most = 0xffffffff);

}  // namespace raycache
