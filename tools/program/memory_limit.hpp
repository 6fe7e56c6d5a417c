// --memory-limit: how much memory an input may make the program take.
#pragma once

#include <cstdint>
#include <string>

namespace raycache::tools {

class Program;

/// Bytes of "512MiB": a whole number above 0, then KiB, MiB, GiB or TiB, or nothing for bytes. Throws UsageError that
/// names the option.
std::uint64_t parse_size(const std::string& text, const std::string& option);

/// Gives every subcommand that reads inputs the option; it holds for all inputs of a run.
void add_memory_limit(Program&);

}  // namespace raycache::tools
