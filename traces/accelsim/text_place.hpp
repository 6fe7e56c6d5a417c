// A place in a text that is read, for the words of a refusal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace raycache::traces {

/// Longer lines are refused.
inline constexpr std::size_t most_line_bytes = 1'000'000;

class TextPlace {
public:
    virtual ~TextPlace() = default;

    /// "FILE: line 12".
    virtual std::string where() const = 0;

    /// Throws Error: "WHERE: WHAT: expected …, found …; REMEDY".
    [[noreturn]] void refuse(std::string_view what, std::string_view expected, std::string_view found,
                             std::string_view remedy = "write the trace again") const;
};

}  // namespace raycache::traces
