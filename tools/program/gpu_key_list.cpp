#include "tools/program/gpu_key_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cachesim/gpus/gpu_keys.hpp"
#include "cachesim/report/table.hpp"

namespace raycache::tools {
namespace {

/// Terminals show no Markdown.
std::string plain(std::string text) {
    std::erase(text, '`');
    return text;
}

std::string title_of(const std::string& section) {
    if (section.empty()) return "the chip";
    return section == "l1" ? "[l1], [l2], [l3]" : fmt::format("[{}]", section);
}

nlohmann::ordered_json text_or_null(const std::string& text) {
    return text.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(plain(text));
}

}  // namespace

std::string gpu_keys_text(std::size_t width) {
    const auto keys = cachesim::gpu_keys();
    std::size_t names = 0;
    for (const auto& key : keys) names = std::max(names, key.name.size());
    std::string text;
    const std::string* section = nullptr;
    for (const auto& key : keys) {
        if (!section || *section != key.section)
            text += fmt::format("{}{}\n", section ? "\n" : "", title_of(key.section));
        section = &key.section;
        std::string line = plain(key.values);
        if (!key.unit.empty()) line += fmt::format(" ({})", key.unit);
        line += key.needed ? "; needed" : fmt::format("; default: {}", plain(key.default_value));
        text += cachesim::break_lines(fmt::format("  {:<{}}  {}. {}\n", key.name, names, line, plain(key.meaning)),
                                      width, names + 4);
    }
    return text;
}

std::string gpu_keys_json() {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const auto& key : cachesim::gpu_keys()) {
        nlohmann::ordered_json sections = nlohmann::ordered_json::array();
        if (key.section == "l1")
            sections = {"l1", "l2", "l3"};
        else if (!key.section.empty())
            sections.push_back(key.section);
        list.push_back({{"name", key.name},
                        {"sections", sections},
                        {"needed", key.needed},
                        {"default", text_or_null(key.default_value)},
                        {"values", plain(key.values)},
                        {"unit", text_or_null(key.unit)},
                        {"meaning", plain(key.meaning)}});
    }
    return nlohmann::ordered_json{{"gpu_keys", list}}.dump(2) + "\n";
}

}  // namespace raycache::tools
