// Which vector instructions the replay runs. The program is built for x86-64-v2; its innermost loops are written once,
// in Google Highway, compiled for each instruction set below, and chosen at run time. All of them work on integers, so
// the counts are the same.
#pragma once

#include <string>
#include <vector>

namespace raycache::cachesim {

enum class InstructionSet {
    scalar,  ///< no vectors: what a launch gets that vectors do not fit, and what they are tested against
    neon,    ///< 128 bits
    sse4,    ///< 128 bits
    avx2,    ///< 256 bits, with BMI2
    avx512,  ///< 512 bits: F, BW, CD, DQ and VL
};

/// Those that this machine has, in ascending order.
std::vector<InstructionSet> instruction_sets();

/// The highest of them, or the one that the environment variable RAYCACHE_INSTRUCTIONS names ("avx2"), for
/// measurements. Throws UsageError if it names none of them.
InstructionSet best_instruction_set();

/// "avx2"
std::string name_of(InstructionSet);

}  // namespace raycache::cachesim
