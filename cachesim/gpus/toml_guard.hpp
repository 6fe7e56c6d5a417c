// A look at a TOML text before toml++ parses it. Release 3.3 of that library, the one that Debian 12 has, asserts on
// texts such as "[.a]" and leaves defined behaviour on keys of other letters than ASCII, and it descends recursively.
// What passes here has the shape of TOML 1.0 without these: keys of ASCII letters, digits, '_' and '-' or in quotes,
// few levels, strings of valid UTF-8. Whether numbers are numbers and keys are given once stays the library's to say.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace raycache::cachesim {

struct TomlProblem {
    std::size_t line;     ///< from 1
    std::string message;  ///< "expected …, found …"
};

/// The first place that does not have the shape; nothing where the whole text has it.
std::optional<TomlProblem> find_toml_problem(std::string_view text);

}  // namespace raycache::cachesim
