// One shape for every message about a bad trace: what, where, expected, found, remedy. Internal to traces/.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "traces/error.hpp"

namespace raycache::traces {

/// The place that a message names.
struct Origin {
    std::string_view path;
    std::uint64_t offset = 0;

    Origin operator+(std::uint64_t bytes) const { return {path, offset + bytes}; }
};

inline constexpr std::string_view salvage =
    "the file is damaged: keep its whole launches with `raycache verify --recover`";
inline constexpr std::string_view recapture =
    "the head of the file is damaged: copy the file again or capture it again";

/// Throws the Error "PATH: offset N: WHAT: expected X, found Y; REMEDY".
[[noreturn]] inline void refuse(const Origin& origin, std::string_view what, const std::string& expected,
                                const std::string& found, std::string_view remedy = salvage) {
    throw Error(fmt::format("{}: offset {}: {}: expected {}, found {}; {}", origin.path, origin.offset, what, expected,
                            found, remedy));
}

inline std::string hex64(std::uint64_t value) { return fmt::format("{:#018x}", value); }

}  // namespace raycache::traces
