// One instruction of an Accel-Sim trace:
//     PC mask ndst [Rd …] OPCODE nsrc [Rs …] memwidth [mode addresses] immediate
#pragma once

#include <string_view>

#include "traces/accelsim/text_lines.hpp"
#include "traces/accelsim/traceg_parser.hpp"

namespace raycache::traces {

struct InstructionLine {
    std::string_view opcode;     ///< "LDG.E.128.SYS"; part of the line
    bool has_addresses = false;  ///< memwidth is not 0 and lanes are active
    bool is_load = false;        ///< LDG with active lanes; only then is `load` told
};

/// `lines` is asked for the number of the line in a refusal. `line_numbers`: source line numbers come first.
InstructionLine parse_instruction(std::string_view line, bool line_numbers, const TextLines& lines, GlobalLoad& load);

}  // namespace raycache::traces
