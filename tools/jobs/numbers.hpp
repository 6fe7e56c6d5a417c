// Numbers that a person types: decimal, finite, nothing before or after them.
#pragma once

#include <cstdint>
#include <limits>
#include <string>

namespace raycache::tools {

struct WholeRange {
    std::uint64_t least = 0, most = std::numeric_limits<std::uint64_t>::max();
};
struct RealRange {
    double least = std::numeric_limits<double>::lowest(), most = std::numeric_limits<double>::max();
};

/// "a whole number from 1 to 64"
std::string describe(const WholeRange&);
/// "a number from 0 to 1", "a number of 0 or more", "a number such as 2.5"
std::string describe(const RealRange&);

/// Digits alone: "064" is 64. Throws UsageError "WHAT 'WORD': expected …" for a sign, a blank, "0x40", an empty word,
/// or a number out of range. `expected`: what the message says instead of the range.
std::uint64_t read_whole(const std::string& word, const std::string& what, const WholeRange&,
                         const std::string& expected = {});
/// Decimal with an optional '-', fraction and exponent: "-1.5e3". Throws as read_whole() does; "inf" and "nan" are no numbers.
double read_real(const std::string& word, const std::string& what, const RealRange&, const std::string& expected = {});

/// Bytes: a whole number, alone or with a unit right behind it: B, KiB, MiB, GiB (powers of 1024), in letters of either
/// case. At least 1. Throws as read_whole() does.
std::uint64_t read_size(const std::string& word, const std::string& what);

}  // namespace raycache::tools
