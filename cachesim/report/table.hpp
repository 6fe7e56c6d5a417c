// A plain text table: columns as wide as their widest cell, two spaces between.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace raycache::cachesim {

class TextTable {
public:
    enum class Align { left, right };

    void column(std::string title, Align align) { columns_.push_back({std::move(title), align}); }
    /// As many cells as columns.
    void row(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }

    /// Title line, rule, rows; every line ends in '\n', none in spaces.
    std::string text() const;

private:
    struct Column {
        std::string title;
        Align align;
    };
    std::vector<Column> columns_;
    std::vector<std::vector<std::string>> rows_;
};

}  // namespace raycache::cachesim
