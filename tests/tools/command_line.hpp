// Reading command lines without running them.
#pragma once

#include <string>
#include <vector>

#include "tools/program/program.hpp"

namespace raycache::test {

/// The words of a line as a shell would make them, up to the first '|', '>' or '&&'; without the program's name.
std::vector<std::string> words_of(const std::string& line);

/// A command line as short as it may be, of every subcommand: what is required, and nothing else.
std::vector<std::string> shortest_line(const tools::Command&);

/// The message of the UsageError that reading these words ends in; empty if it reads well.
std::string refusal(const std::vector<std::string>& words);

/// A folder of its own that is the current one while this lives, with empty files of these names.
class InFolder {
public:
    explicit InFolder(const std::vector<std::string>& files);
    ~InFolder();
    InFolder(const InFolder&) = delete;
    InFolder& operator=(const InFolder&) = delete;

private:
    std::string before_, folder_;
};

}  // namespace raycache::test
