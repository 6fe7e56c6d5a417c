// What --help prints, at most 100 columns wide.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tools/program/command.hpp"

namespace raycache::tools {

/// Of a subcommand: its arguments, its own options, then those that it shares with others by group; each with its
/// default and the options that it excludes; examples.
std::string help_text(const Command&);
/// Of the program: its subcommands and examples.
std::string help_text(const std::vector<std::unique_ptr<Command>>&);

}  // namespace raycache::tools
