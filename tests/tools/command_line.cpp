#include "tests/tools/command_line.hpp"

#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "traces/error.hpp"

namespace raycache::test {

std::vector<std::string> words_of(const std::string& line) {
    std::vector<std::string> words;
    std::istringstream in(line);
    std::string word;
    in >> word;  // raycache
    while (in >> word && word != "|" && word != ">" && word != "&&") words.push_back(word);
    return words;
}

std::vector<std::string> shortest_line(const tools::Command& command) {
    std::vector<std::string> words{command.name()};
    for (const auto& option : command.options()) {
        const std::string name = option->name();
        if (!option->is_required() && name != "INPUTS" && name != "SCENE") continue;
        if (!option->is_positional()) words.push_back(name);
        words.emplace_back(name == "SCENE" || name == "INPUTS" ? "courtyard"
                           : name == "--gpu"                   ? "h100"
                           : name == "--format"                ? "accel-sim"
                           : command.name() == "render"        ? "picture.png"
                                                               : "trace.rct");
    }
    return words;
}

std::string refusal(const std::vector<std::string>& words) {
    try {
        tools::Program().parse(words);
    } catch (const UsageError& e) {
        return e.what();
    }
    return {};
}

InFolder::InFolder(const std::vector<std::string>& files) : before_(std::filesystem::current_path()) {
    folder_ = (std::filesystem::temp_directory_path() / "raycache_test_XXXXXX").string();
    if (!mkdtemp(folder_.data())) throw std::runtime_error("no temporary folder");
    std::filesystem::current_path(folder_);
    for (const std::string& name : files) std::ofstream{name};
}

InFolder::~InFolder() {
    std::filesystem::current_path(before_);
    std::filesystem::remove_all(folder_);
}

}  // namespace raycache::test
