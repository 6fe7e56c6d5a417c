// What --help says can be read on a narrow screen, and its examples can be pasted.
#include <catch2/catch.hpp>

#include <algorithm>
#include <sstream>

#include "tests/tools/command_line.hpp"

namespace raycache {
namespace {

using Catch::Contains;

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

std::string one_line(const std::string& text) {
    std::istringstream in(text);
    std::string out;
    for (std::string word; in >> word;) out += (out.empty() ? "" : " ") + word;
    return out;
}

/// Where the line of an option begins.
std::size_t place_of(const std::string& help, const std::string& option) {
    for (const char* after : {" ", ",", "\n", "..."})
        if (const std::size_t at = help.find("\n  " + option + after); at != std::string::npos) return at;
    return std::string::npos;
}

/// The commands below "Examples:", a line that goes on with a backslash joined with the next.
std::vector<std::string> examples_of(const std::string& help) {
    std::string joined = help.substr(help.find("\nExamples:\n") + 11);
    for (std::size_t at; (at = joined.find(" \\\n")) != std::string::npos;) joined.erase(at, 3);
    return lines_of(joined);
}

TEST_CASE("no line of any help text is wider than 100 columns") {
    const tools::Program program;
    std::vector<std::string> texts{program.help()};
    for (const auto& command : program.commands()) texts.push_back(program.help(*command));
    CHECK(texts.size() > 12);
    for (const std::string& text : texts)
        for (const std::string& line : lines_of(text)) {
            INFO(line);
            CHECK(line.size() <= 100);
            CHECK((line.empty() || line.back() != ' '));
        }
}

TEST_CASE("the command's own options come first, then those of each group under its heading") {
    const tools::Program program;
    for (const auto& command : program.commands()) {
        const std::string text = program.help(*command);
        const std::size_t own = text.find("\nOptions:\n");
        REQUIRE(own != std::string::npos);
        for (const auto& option : command->options()) {
            INFO(command->name() << ' ' << option->name());
            const std::size_t at = place_of(text, option->names().front());
            REQUIRE(at != std::string::npos);
            if (option->is_positional() || option->group().empty()) continue;
            const std::size_t heading = text.find("\n" + option->group() + ":\n");
            REQUIRE(heading != std::string::npos);
            CHECK(own < heading);
            CHECK(heading < at);
        }
    }
}

TEST_CASE("help shows defaults, what is required, and what excludes what") {
    const tools::Program program;
    const auto help = [&](const std::string& name) {
        for (const auto& command : program.commands())
            if (command->name() == name) return one_line(program.help(*command));
        return std::string();
    };
    CHECK_THAT(help("capture"),
               Contains("[default: micro-jitter]") && Contains("[required]") && Contains("[default: 64]"));
    CHECK_THAT(help("compare"), Contains("not with --json"));
    CHECK_THAT(help("samples"), Contains("not with --csv, --picture, --figure2"));
}

TEST_CASE("every example of every help text is a command line that reads well") {
    const test::InFolder folder({"sponza.glb", "cornell_box.glb"});
    const tools::Program program;
    std::vector<std::string> examples = examples_of(program.help());
    for (const auto& command : program.commands()) {
        const auto own = examples_of(program.help(*command));
        CHECK_FALSE(own.empty());
        for (const std::string& line : own) CHECK_THAT(line, Contains("raycache " + command->name()));
        examples.insert(examples.end(), own.begin(), own.end());
    }
    CHECK(examples.size() > 30);
    for (const std::string& line : examples) {
        INFO(line);
        if (line.find_first_not_of(' ') != line.find("raycache ")) continue;  // source <(raycache …)
        CHECK(test::refusal(test::words_of(line)) == "");
    }
}

}  // namespace
}  // namespace raycache
