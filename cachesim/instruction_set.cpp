#include "cachesim/instruction_set.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>

#include "cachesim/dispatch.hpp"
#include "traces/did_you_mean.hpp"
#include "traces/error.hpp"
#include "traces/printable.hpp"

namespace raycache::cachesim {

namespace {

struct Compiled {
    InstructionSet instructions;
    const char* name;
    std::int64_t target;  ///< Highway's
};

/// Highway's target AVX3 is AVX-512 F, BW, DQ and VL. Every processor with these has CD, which is made sure of.
constexpr Compiled entries[] = {
    {InstructionSet::scalar, "scalar", 0},        {InstructionSet::neon, "neon", HWY_NEON},
    {InstructionSet::sse4, "sse4", HWY_SSE4},     {InstructionSet::avx2, "avx2", HWY_AVX2},
    {InstructionSet::avx512, "avx512", HWY_AVX3},
};

const Compiled& entry_of(InstructionSet instructions) { return entries[static_cast<std::size_t>(instructions)]; }

bool is_available(const Compiled& entry) {
    if (entry.target == 0) return true;
#if HWY_ARCH_X86
    if (entry.instructions == InstructionSet::avx512 && !__builtin_cpu_supports("avx512cd")) return false;
#endif
    // Asks the processor, which takes long in a virtual machine.
    static const std::int64_t supported = hwy::SupportedTargets();
    return (supported & HWY_TARGETS & entry.target) != 0;
}

InstructionSet choose() {
    const auto sets = instruction_sets();
    const char* const wanted = std::getenv("RAYCACHE_INSTRUCTIONS");
    if (!wanted || !*wanted) return sets.back();
    std::vector<std::string> names;
    for (const InstructionSet set : sets) names.push_back(name_of(set));
    const auto at = std::find(names.begin(), names.end(), wanted);
    if (at == names.end())
        throw UsageError(
            fmt::format("environment variable RAYCACHE_INSTRUCTIONS: expected one of {}, which this "
                        "processor has, found \"{}\"{}",
                        fmt::join(names, ", "), printable_line(wanted), did_you_mean(wanted, names)));
    return sets[static_cast<std::size_t>(at - names.begin())];
}

}  // namespace

std::int64_t highway_target(InstructionSet instructions) { return entry_of(instructions).target; }

std::vector<InstructionSet> instruction_sets() {
    std::vector<InstructionSet> sets;
    for (const Compiled& entry : entries)
        if (is_available(entry)) sets.push_back(entry.instructions);
    return sets;
}

InstructionSet best_instruction_set() {
    static const InstructionSet best = choose();
    return best;
}

std::string name_of(InstructionSet instructions) { return entry_of(instructions).name; }

}  // namespace raycache::cachesim
