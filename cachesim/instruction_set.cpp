#include "cachesim/instruction_set.hpp"

namespace raycache::cachesim {

InstructionSet best_instruction_set() {
    static const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                               __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                               __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("bmi") &&
                               __builtin_cpu_supports("bmi2");
    return avx512 ? InstructionSet::avx512 : InstructionSet::x86_64_v2;
}

std::vector<InstructionSet> instruction_sets() {
    std::vector<InstructionSet> sets{InstructionSet::x86_64_v2};
    if (best_instruction_set() >= InstructionSet::avx512) sets.push_back(InstructionSet::avx512);
    return sets;
}

}  // namespace raycache::cachesim
