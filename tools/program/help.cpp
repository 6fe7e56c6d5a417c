#include "tools/program/help.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace raycache::tools {
namespace {

constexpr std::size_t columns = 100, indent = 26;

/// A character of UTF-8 is one column wide, whatever its bytes.
std::size_t width_of(const std::string& text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

std::vector<std::string> words_of(const std::string& text) {
    std::vector<std::string> words;
    std::string word;
    for (const char c : text + ' ') {
        if (c != ' ') {
            word += c;
        } else if (!word.empty()) {
            words.push_back(word);
            word.clear();
        }
    }
    return words;
}

/// `first` stands before the first line; the others are indented to `margin`. A line that goes on ends with `more`.
std::string wrap(const std::string& first, const std::string& text, std::size_t margin, const std::string& more = "") {
    std::string out, line = first;
    bool empty = true;  // nothing but `first` or the indent
    for (const std::string& word : words_of(text)) {
        if (!empty && width_of(line) + 1 + width_of(word) + more.size() > columns) {
            out += line + more + "\n";
            line = std::string(margin, ' ');
            empty = true;
        }
        if (!empty) line += ' ';
        line += word;
        empty = false;
    }
    return out + line + "\n";
}

/// A name at the left and what it means beside it, or below where the name is long.
std::string entry(const std::string& name, const std::string& text) {
    if (width_of(name) + 2 > indent) return name + "\n" + wrap(std::string(indent, ' '), text, indent);
    return wrap(fmt::format("{:<{}}", name, indent), text, indent);
}

std::string description_of(const Option& option) {
    std::string text = option.help();
    if (!option.excluded().empty()) text += fmt::format("; not with {}", fmt::join(option.excluded(), ", "));
    if (!option.default_value().empty()) text += fmt::format(" [default: {}]", option.default_value());
    if (option.is_required()) text += " [required]";
    return text;
}

std::string name_of(const Option& option) {
    std::string name = fmt::format("  {}", fmt::join(option.names(), ", "));
    if (option.is_positional()) return name + (option.is_list() ? "..." : "");
    if (option.kind() != Option::Kind::flag) name += ' ' + option.type();
    return name;
}

std::string examples_text(const std::vector<std::string>& lines) {
    std::string out = "\nExamples:\n";
    for (const std::string& line : lines) out += wrap("  ", line, 6, " \\");
    return out;
}

std::string usage(const Command& command) {
    std::string text;
    for (const auto& option : command.options()) {
        if (!option->is_positional()) continue;
        const std::string name = option->name() + (option->is_list() ? "..." : "");
        text += ' ' + (option->is_required() ? name : '[' + name + ']');
    }
    for (const auto& option : command.options())
        if (!option->is_positional() && option->is_required())
            text += fmt::format(" {} {}", option->names().front(), option->type());
    return wrap("", fmt::format("Usage: raycache {}{} [OPTIONS]", command.name(), text), 7);
}

}  // namespace

std::string help_text(const Command& command) {
    std::string out = wrap("", command.description() + ".", 0) + "\n" + usage(command);
    std::vector<std::string> groups{""};
    std::string arguments;
    for (const auto& option : command.options()) {
        if (option->is_positional())
            arguments += entry(name_of(*option), description_of(*option));
        else if (std::find(groups.begin(), groups.end(), option->group()) == groups.end())
            groups.push_back(option->group());
    }
    if (!arguments.empty()) out += "\nArguments:\n" + arguments;
    for (const std::string& group : groups) {
        std::string options;
        for (const auto& option : command.options())
            if (!option->is_positional() && option->group() == group)
                options += entry(name_of(*option), description_of(*option));
        if (group.empty()) options += entry("  -h, --help", "print this text and exit");
        out += fmt::format("\n{}:\n{}", group.empty() ? "Options" : group, options);
    }
    return out + examples_text(command.example_lines());
}

std::string help_text(const std::vector<std::unique_ptr<Command>>& commands) {
    std::string out =
        "Explains why one sampling strategy makes GPU ray tracing faster than another, without a GPU.\n\n"
        "Usage: raycache COMMAND [OPTIONS]\n\n"
        "Commands:\n";
    for (const auto& command : commands)
        if (!command->is_hidden()) out += entry("  " + command->name(), command->description());
    out += "\nOptions:\n" + entry("  -h, --help", "print this text and exit; 'raycache COMMAND --help': of a command") +
           entry("  --version", "print the version and exit");
    return out + examples_text({"raycache compare courtyard --strategy coherent,cranley-patterson,micro-jitter "
                                "--spp 64 --gpu gtx-980-ti",
                                "raycache render courtyard --spp 16 -o courtyard.png", "raycache compare --help"});
}

}  // namespace raycache::tools
