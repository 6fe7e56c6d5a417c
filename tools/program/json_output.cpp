#include "tools/program/json_output.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "cachesim/report/json_key.hpp"
#include "tools/program/command.hpp"
#include "tools/program/command_view.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

using Json = nlohmann::ordered_json;
using cachesim::snake_case;

template <std::size_t n>
bool contains(const std::array<std::string_view, n>& list, std::string_view word) {
    return std::find(list.begin(), list.end(), word) != list.end();
}

/// Options that say how fast and where to, not what is asked: results do not depend on them.
bool is_about_output(const std::string& key) {
    constexpr std::array<std::string_view, 8> list{"help", "json",    "csv",          "save",
                                                   "wide", "threads", "memory_limit", "bvh_cache"};
    return contains(list, key);
}

/// Options whose values are names, even where one reads as a number.
bool is_a_name(const std::string& key) {
    constexpr std::array<std::string_view, 8> list{"scene",  "camera", "trace", "traces",
                                                   "inputs", "gpu",    "set",   "topic"};
    return contains(list, key);
}

/// A name stays one where it reads as a number.
Json value_of(const std::string& text, bool name) { return name ? Json(text) : value_json(text); }

/// Given, else the default; a list for options that take one.
Json value_of(const OptionView& option, const std::string& key) {
    if (option.is_flag) return option.is_given;
    const bool name = is_a_name(key);
    if (!option.is_list) return option.words.empty() ? Json(nullptr) : value_of(option.words.back(), name);
    Json list = Json::array();
    for (const std::string& word : option.words) list.push_back(value_of(word, name));
    return list;
}

/// As a shell reads it back.
std::string quoted_word(const std::string& word) {
    constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./,:@%";
    if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
    std::string out = "'";
    for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

template <class Visit>
void each_option(const CommandView& command, const Visit& visit) {
    for (const OptionView& option : command.options)
        if (const std::string key = snake_case(option.title); !is_about_output(key)) visit(option, key);
}

std::string command_line(const CommandView& command) {
    std::string names, options;
    each_option(command, [&](const OptionView& option, const std::string&) {
        if (!option.is_given) return;
        if (option.is_flag) {
            options += ' ' + option.names.front();
        } else if (option.names.empty()) {
            for (const std::string& word : option.words) names += ' ' + quoted_word(word);
        } else if (option.has_commas) {
            options += ' ' + option.names.front() + ' ' + quoted_word(fmt::format("{}", fmt::join(option.words, ",")));
        } else {
            for (const std::string& word : option.words)
                options += ' ' + option.names.front() + ' ' + quoted_word(word);
        }
    });
    return "raycache " + command.name + names + options;
}

}  // namespace

void JsonOption::add(Command& command) {
    command_ = &command;
    command.add_flag("--json", asked_, "print JSON (docs/json.md)");
}

std::string JsonOption::document(const std::string& report, const Subject& subject) const {
    const CommandView command = view_of(*command_);
    Json out{{"schema_version", json_schema_version}, {"program", "raycache"},
             {"version", RAYCACHE_VERSION},           {"command", command.name},
             {"command_line", command_line(command)}, {"settings", Json::object()}};
    each_option(command, [&](const OptionView& option, const std::string& key) {
        Json value = value_of(option, key);
        // A positional argument and an option of one name are two ways to say the same.
        if (!out["settings"].contains(key) || option.is_given) out["settings"][key] = std::move(value);
    });
    if (!subject.gpus.empty()) out["gpus"] = subject.gpus;
    if (!subject.traces.empty()) out["traces"] = subject.traces;
    const Json body = Json::parse(report);
    for (const auto& [key, value] : body.items()) {
        if (out.contains(key)) throw Error(fmt::format("JSON of {}: key \"{}\" stands twice", command.name, key));
        out[key] = value;
    }
    return json_text(out);
}

}  // namespace raycache::tools
