// --wide: tables as wide as they need to be.
#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>

#include "cachesim/report/table.hpp"

namespace raycache::tools {

struct WidthOption {
    bool wide = false;

    void add(CLI::App& command) {
        command.add_flag("--wide", wide, "every column of a table in one line, however wide; default: 100 columns");
    }
    std::size_t columns() const { return wide ? cachesim::any_width : cachesim::text_width; }
};

}  // namespace raycache::tools
