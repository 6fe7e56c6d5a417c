// --wide: tables as wide as they need to be.
#pragma once

#include <cstddef>

#include "cachesim/report/table.hpp"
#include "tools/program/command.hpp"

namespace raycache::tools {

struct WidthOption {
    bool wide = false;

    void add(Command& command) {
        command.add_flag("--wide", wide, "every column of a table in one line, however wide; default: 100 columns");
    }
    std::size_t columns() const { return wide ? cachesim::any_width : cachesim::text_width; }
};

}  // namespace raycache::tools
