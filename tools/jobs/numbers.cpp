#include "tools/jobs/numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "traces/error.hpp"

namespace raycache::tools {
namespace {

/// from_chars() reads decimal without blanks and '+'; what is left to check is that it read a number, and all of it.
template <class Number>
bool read_all(const std::string& word, Number& value) {
    const char* end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    return error == std::errc{} && stop == end;
}

[[noreturn]] void refuse(const std::string& word, const std::string& what, const std::string& expected) {
    throw UsageError(fmt::format("{} '{}': expected {}", what, word, expected));
}

}  // namespace

std::string describe(const WholeRange& range) {
    return fmt::format("a whole number from {} to {}", range.least, range.most);
}

std::string describe(const RealRange& range) {
    const RealRange all;
    if (range.least > all.least && range.most < all.most)
        return fmt::format("a number from {:g} to {:g}", range.least, range.most);
    if (range.least > all.least) return fmt::format("a number of {:g} or more", range.least);
    return "a finite number such as 2.5";
}

std::uint64_t read_whole(const std::string& word, const std::string& what, const WholeRange& range,
                         const std::string& expected) {
    std::uint64_t value = 0;
    if (!read_all(word, value) || value < range.least || value > range.most)
        refuse(word, what, expected.empty() ? describe(range) : expected);
    return value;
}

double read_real(const std::string& word, const std::string& what, const RealRange& range,
                 const std::string& expected) {
    double value = 0;
    // "inf", "nan": letters that from_chars() takes, beside the exponent's.
    const bool digits = std::all_of(word.begin(), word.end(), [](char c) {
        return (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+' || c == 'e' || c == 'E';
    });
    if (!digits || !read_all(word, value) || !(value >= range.least && value <= range.most))
        refuse(word, what, expected.empty() ? describe(range) : expected);
    return value;
}

std::uint64_t read_size(const std::string& word, const std::string& what) {
    const std::size_t digits = std::min(word.find_first_not_of("0123456789"), word.size());
    std::string unit = word.substr(digits);
    for (char& c : unit)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    const int shift = unit.empty() || unit == "b" ? 0
                      : unit == "kib"             ? 10
                      : unit == "mib"             ? 20
                      : unit == "gib"             ? 30
                                                  : -1;
    std::uint64_t value = 0;
    if (shift < 0 || !read_all(word.substr(0, digits), value) || value == 0 ||
        value > std::numeric_limits<std::uint64_t>::max() >> shift)
        refuse(word, what, "a number of bytes, or with a unit, such as 64KiB or 2MiB");
    return value << shift;
}

}  // namespace raycache::tools
