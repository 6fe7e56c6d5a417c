// A plain text table: columns as wide as their widest cell, two spaces between. It fits a width where it can.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "traces/printable.hpp"

namespace raycache::cachesim {

/// Columns that every text for people keeps to unless it is asked for more: a terminal's usual width, a pager's, a
/// mail's.
inline constexpr std::size_t text_width = 100;
/// As a width: no limit.
inline constexpr std::size_t any_width = 0;

class TextTable {
public:
    enum class Align { left, right };

    /// `rank`: how soon the column goes where there is no room for all; 0 stays, the highest goes first.
    void column(const std::string& title, Align align, unsigned rank = 0) {
        columns_.push_back({printable_line(title), align, rank, false});
    }
    /// A column that says what a row is of: GPU, N, sequence. Where all rows are of the same, a line above the table
    /// says it once, unless it is the first column.
    void subject(const std::string& title, Align align) { columns_.push_back({printable_line(title), align, 0, true}); }
    /// As many cells as columns; what a name in one must not do to a terminal or to the table is taken out of it. A row
    /// whose first cell is empty goes on with the row above: its subjects are empty, too.
    void row(std::vector<std::string> cells) {
        for (std::string& cell : cells) cell = printable_line(cell);
        rows_.push_back(std::move(cells));
    }

    /// What all rows share, title line, rule, rows; every line ends in '\n', none in spaces. Wider than `width`, it is
    /// made narrower step by step: titles in two lines; long names of subjects as letters, explained below; then
    /// columns of high rank left out, named below. `width`: any_width leaves all as it is.
    std::string text(std::size_t width = text_width) const;

private:
    struct Column {
        std::string title;
        Align align;
        unsigned rank;
        bool is_subject;
    };
    using Rows = std::vector<std::vector<std::string>>;

    static std::string lift_shared(std::vector<Column>&, Rows&);
    static std::string shorten_names(std::vector<Column>&, Rows&);
    static std::string leave_out(std::vector<Column>&, Rows&, std::size_t width);

    std::vector<Column> columns_;
    Rows rows_;
};

/// A paragraph of words with line breaks at spaces, so that no line is wider; a break that is there stays, and lines
/// after a break of ours begin with `indent` spaces. A word wider than `width` has a line of its own.
std::string break_lines(std::string_view text, std::size_t width = text_width, std::size_t indent = 0);

/// Columns that UTF-8 text takes on a terminal, each code point as one ("±").
std::size_t columns_of(std::string_view text);

}  // namespace raycache::cachesim
