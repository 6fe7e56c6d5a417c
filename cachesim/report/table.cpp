#include "cachesim/report/table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

namespace raycache::cachesim {

namespace {

constexpr std::size_t gap = 2;
/// Names of subjects longer than this become letters where a table is too wide.
constexpr std::size_t long_name = 20;

/// "L2->L1 B/ray" -> {"L2->L1", "B/ray"}: broken at a space, or behind a slash, where the longer line is shortest; one
/// line where there is neither.
std::vector<std::string> two_lines(const std::string& title) {
    std::vector<std::string> best{title};
    std::size_t least = columns_of(title);
    for (std::size_t at = 0; at + 1 < title.size(); ++at) {
        if (title[at] != ' ' && title[at] != '/') continue;
        const std::string first = title.substr(0, title[at] == '/' ? at + 1 : at), second = title.substr(at + 1);
        const std::size_t longer = std::max(columns_of(first), columns_of(second));
        if (longer >= least) continue;
        least = longer;
        best = {first, second};
    }
    return best;
}

/// A, B, ..., Z, AA, AB, ...
std::string letters(std::size_t index) {
    std::string text(1, static_cast<char>('A' + index % 26));
    return index < 26 ? text : letters(index / 26 - 1) + text;
}

/// A row that goes on with the one above: intervals below means.
bool is_continuation(const std::vector<std::string>& row) { return row.front().empty(); }

std::size_t sum_of(const std::vector<std::size_t>& widths) {
    return std::accumulate(widths.begin(), widths.end(), std::size_t{0}) +
           gap * (widths.empty() ? 0 : widths.size() - 1);
}

/// `titles`: the lines of each column's title.
template <class Rows>
std::vector<std::size_t> widths_of(const std::vector<std::vector<std::string>>& titles, const Rows& rows) {
    std::vector<std::size_t> widths;
    for (std::size_t c = 0; c < titles.size(); ++c) {
        std::size_t& width = widths.emplace_back(0);
        for (const std::string& line : titles[c]) width = std::max(width, columns_of(line));
        for (const auto& row : rows) width = std::max(width, columns_of(row[c]));
    }
    return widths;
}

template <class Columns>
std::vector<std::vector<std::string>> titles_of(const Columns& columns, bool broken) {
    std::vector<std::vector<std::string>> titles;
    for (const auto& column : columns) {
        if (broken)
            titles.push_back(two_lines(column.title));
        else
            titles.push_back({column.title});
    }
    return titles;
}

template <class Columns, class Rows>
std::size_t width_of(const Columns& columns, const Rows& rows, bool broken) {
    return sum_of(widths_of(titles_of(columns, broken), rows));
}

template <class Columns, class Rows>
void erase_column(Columns& columns, Rows& rows, std::size_t c) {
    columns.erase(columns.begin() + static_cast<std::ptrdiff_t>(c));
    for (auto& row : rows) row.erase(row.begin() + static_cast<std::ptrdiff_t>(c));
}

}  // namespace

std::size_t columns_of(std::string_view text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

std::string break_lines(std::string_view text, std::size_t width, std::size_t indent) {
    if (width == any_width) return std::string(text);
    std::string out;
    std::size_t used = 0;  // of the line so far
    for (std::size_t at = 0; at < text.size();) {
        if (text[at] == '\n') {
            out += '\n';
            used = 0;
            ++at;
            continue;
        }
        const std::size_t word_at = std::min(text.find_first_not_of(' ', at), text.size());
        const std::size_t end = std::min(text.find_first_of(" \n", word_at), text.size());
        const std::string_view blanks = text.substr(at, word_at - at), word = text.substr(word_at, end - word_at);
        if (used > indent && !word.empty() && used + blanks.size() + columns_of(word) > width) {
            out += '\n' + std::string(indent, ' ');
            used = indent;
        } else {
            out += blanks;
            used += blanks.size();
        }
        out += word;
        used += columns_of(word);
        at = end;
    }
    return out;
}

/// "N 64, GPU h100", and without these columns.
std::string TextTable::lift_shared(std::vector<Column>& columns, Rows& rows) {
    std::string shared;
    if (rows.empty()) return shared;
    for (std::size_t c = 1; c < columns.size();) {
        const bool same = columns[c].is_subject && std::all_of(rows.begin(), rows.end(), [&](const auto& row) {
                              return row[c] == rows.front()[c] || is_continuation(row);
                          });
        if (!same) {
            ++c;
            continue;
        }
        if (!rows.front()[c].empty())
            shared += fmt::format("{}{} {}", shared.empty() ? "" : ", ", columns[c].title, rows.front()[c]);
        erase_column(columns, rows, c);
    }
    return shared;
}

/// Letters for the names of a subject of which some is long; "GPU A: gtx-980-ti (l1.ways=64), B: …".
std::string TextTable::shorten_names(std::vector<Column>& columns, Rows& rows) {
    std::string key;
    for (std::size_t c = 0; c < columns.size(); ++c) {
        if (!columns[c].is_subject) continue;
        std::vector<std::string> names;
        bool has_long = false;
        for (const auto& row : rows) {
            if (is_continuation(row)) continue;
            has_long = has_long || columns_of(row[c]) > long_name;
            if (std::find(names.begin(), names.end(), row[c]) == names.end()) names.push_back(row[c]);
        }
        if (!has_long) continue;
        const auto letter = [&](const std::string& name) {
            return letters(static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin()));
        };
        for (auto& row : rows)
            if (!is_continuation(row)) row[c] = letter(row[c]);
        for (std::size_t i = 0; i < names.size(); ++i)
            key += break_lines(
                       fmt::format("{} {}: {}", columns[c].title, letters(i), names[i].empty() ? "none" : names[i]),
                       text_width, 4) +
                   '\n';
    }
    return key;
}

std::string TextTable::leave_out(std::vector<Column>& columns, Rows& rows, std::size_t width) {
    std::vector<std::string> names;
    while (width_of(columns, rows, true) > width) {
        std::size_t last = 0;
        for (std::size_t c = 1; c < columns.size(); ++c)
            if (columns[c].rank > columns[last].rank) last = c;
        if (columns[last].rank == 0) break;
        names.push_back(columns[last].title);
        erase_column(columns, rows, last);
    }
    if (names.empty()) return {};
    std::reverse(names.begin(), names.end());
    return break_lines(fmt::format("left out for want of room: {} (--wide)\n", fmt::join(names, ", ")));
}

std::string TextTable::text(std::size_t width) const {
    std::vector<Column> columns = columns_;
    Rows rows = rows_;
    const std::string shared = lift_shared(columns, rows);
    bool broken = false;
    std::string below;
    if (width != any_width && width_of(columns, rows, false) > width) {
        broken = true;
        if (width_of(columns, rows, true) > width) below = shorten_names(columns, rows);
        below += leave_out(columns, rows, width);
    }
    const auto titles = titles_of(columns, broken);
    const std::vector<std::size_t> widths = widths_of(titles, rows);
    std::string text =
        shared.empty() ? "" : break_lines("all rows: " + shared, width == any_width ? any_width : text_width) + "\n\n";
    const auto add_line = [&](const auto& cell) {
        std::string line;
        for (std::size_t c = 0; c < columns.size(); ++c) {
            const std::string content = cell(c);
            const std::string padding(widths[c] - columns_of(content), ' ');
            if (c) line += std::string(gap, ' ');
            line += columns[c].align == Align::left ? content + padding : padding + content;
        }
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + '\n';
    };
    if (std::any_of(titles.begin(), titles.end(), [](const auto& lines) { return lines.size() > 1; }))
        add_line([&](std::size_t c) { return titles[c].size() > 1 ? titles[c].front() : std::string(); });
    add_line([&](std::size_t c) { return titles[c].back(); });
    add_line([&](std::size_t c) { return std::string(widths[c], '-'); });
    for (const auto& row : rows) add_line([&](std::size_t c) { return row[c]; });
    if (!below.empty()) text += '\n' + below;
    return text;
}

}  // namespace raycache::cachesim
