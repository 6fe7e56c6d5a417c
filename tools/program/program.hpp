// The whole program as a function: from words to a job, or to a text that was asked for. Nothing is run here.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "tools/program/command.hpp"

namespace raycache::tools {

class Program {
public:
    Program();  ///< with all subcommands

    /// `words`: what follows the program's name on a command line. Returns what it asks for, without doing it:
    /// --help and --version are jobs, too. Throws UsageError. A Program reads one command line: options keep their
    /// values.
    Action parse(const std::vector<std::string>& words);

    Command* add_subcommand(const std::string& name, const std::string& description);
    const std::vector<std::unique_ptr<Command>>& commands() const { return commands_; }

    /// What --help prints: of the program, of a subcommand.
    std::string help() const;
    std::string help(const Command&) const;

private:
    std::vector<std::unique_ptr<Command>> commands_;
};

}  // namespace raycache::tools
