// What a shell can complete: subcommands, options, and the values they take, read off the program's own command line.
#pragma once

#include <string>
#include <vector>

#include "tools/program/command_view.hpp"

namespace raycache::tools {

/// What may stand as the value of an option or as a positional argument.
struct Candidates {
    std::vector<std::string> values;      ///< names; empty if there is no list of them
    std::vector<std::string> extensions;  ///< of files, "toml"; "*": any file; empty if it is no file
};

/// From the option's own check where it has a list of names, else from the lists that the program looks names up in.
Candidates candidates_of(const OptionView&);

/// Scripts that complete command lines of these, to be sourced by bash and to lie in the $fpath of zsh.
std::string bash_completion(const std::vector<CommandView>&);
std::string zsh_completion(const std::vector<CommandView>&);

}  // namespace raycache::tools
