#include "cachesim/report/table.hpp"

#include <algorithm>

namespace raycache::cachesim {

namespace {

/// Code points of UTF-8 text, which is what a terminal gives a column each ("±").
std::size_t width(const std::string& text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

}  // namespace

std::string TextTable::text() const {
    std::vector<std::size_t> widths;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
        widths.push_back(width(columns_[c].title));
        for (const auto& row : rows_) widths[c] = std::max(widths[c], width(row[c]));
    }
    std::string text;
    const auto add_line = [&](const auto& cell) {
        std::string line;
        for (std::size_t c = 0; c < columns_.size(); ++c) {
            const std::string content = cell(c);
            const std::string padding(widths[c] - width(content), ' ');
            if (c) line += "  ";
            line += columns_[c].align == Align::left ? content + padding : padding + content;
        }
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + '\n';
    };
    add_line([&](std::size_t c) { return columns_[c].title; });
    add_line([&](std::size_t c) { return std::string(widths[c], '-'); });
    for (const auto& row : rows_) add_line([&](std::size_t c) { return row[c]; });
    return text;
}

}  // namespace raycache::cachesim
