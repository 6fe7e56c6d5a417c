// Which machine code the replay runs. The program is built for x86-64-v2; its innermost loops exist a second time for
// newer machines and are chosen at run time. All of them work on integers, so the counts are the same.
#pragma once

#include <vector>

namespace raycache::cachesim {

enum class InstructionSet {
    x86_64_v2,  ///< what the whole program needs: up to SSE4.2
    avx512,     ///< AVX-512 F, BW, CD, DQ and VL, BMI1 and BMI2 (x86-64-v4)
};

/// Those that this machine has, in ascending order.
std::vector<InstructionSet> instruction_sets();

/// The highest of them.
InstructionSet best_instruction_set();

}  // namespace raycache::cachesim
