// One instruction of an Accel-Sim trace:
//     PC mask ndst [Rd …] OPCODE nsrc [Rs …] memwidth [mode addresses] immediate
// Numbers may stand before it: block x y z and warp in tracer versions below 3, the source line where the header says
// so. Version 6 has more behind it: a second immediate, and the values of registers or "NoVal".
#pragma once

#include <string_view>

#include "traces/accelsim/text_place.hpp"
#include "traces/accelsim/traceg_parser.hpp"

namespace raycache::traces {

struct InstructionGrammar {
    unsigned numbers_before = 0;  ///< the program counter
    unsigned version = 5;         ///< of the tracer
    /// Where a generic address leads to shared and to local memory; 0: not known.
    std::uint64_t shared_window = 0, local_window = 0;
    bool stores = false;  ///< are told, too
};

struct InstructionLine {
    std::string_view opcode;     ///< "LDG.E.128.SYS"; part of the line
    bool has_addresses = false;  ///< memwidth is not 0 and lanes are active
    bool is_access = false;      ///< a load, or store, of global memory, with active lanes; only then is `load` told
    /// Of an instruction without addresses: what stands behind its registers, where it is a number; else 0.
    std::uint64_t immediate = 0;
};

/// `place`: where the line stands, for a refusal.
InstructionLine parse_instruction(std::string_view line, const InstructionGrammar&, const TextPlace& place,
                                  GlobalLoad& load);

/// Numbers that stand before the program counter of this line; none if it is no instruction.
unsigned count_numbers_before(std::string_view line);

}  // namespace raycache::traces
