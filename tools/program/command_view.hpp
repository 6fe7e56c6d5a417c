// What a subcommand offers and what it was given, for those who describe command lines instead of running them: the
// envelope of JSON documents, the completion of shells.
#pragma once

#include <string>
#include <vector>

namespace raycache::tools {

class Command;
class Program;

struct OptionView {
    std::vector<std::string> names;  ///< "--output", "-o"; empty for a positional argument
    std::string title;               ///< "output"; of a positional argument "SCENE"
    std::string help, value;         ///< value: what the help text calls it, "TEXT"
    bool is_flag = false;
    bool is_list = false;     ///< may have several words
    bool has_commas = false;  ///< which are separated by commas
    bool is_given = false;
    std::vector<std::string> words;    ///< as typed, else the default, else none
    std::vector<std::string> choices;  ///< the only words allowed; empty: any
};

struct CommandView {
    std::string name, description;
    std::vector<OptionView> options;
};

CommandView view_of(const Command&);
/// All that --help lists.
std::vector<CommandView> views_of_commands(const Program&);

}  // namespace raycache::tools
