// The list of sequences. To add one: write a file in this folder that defines `SequenceEntry NAME_entry()` in namespace
// raycache::tracer, and add X(NAME) below.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "tracer/sampling/sequence.hpp"
#include "traces/did_you_mean.hpp"
#include "traces/error.hpp"

#define RAYCACHE_SEQUENCES(X) \
    X(sobol)                  \
    X(halton)                 \
    X(halton_scrambled)       \
    X(sobol_owen_02)          \
    X(sobol_owen_4d)          \
    X(r2)                     \
    X(pmj02)                  \
    X(random_numbers)

namespace raycache::tracer {

#define X(name) SequenceEntry name##_entry();
RAYCACHE_SEQUENCES(X)
#undef X

const std::vector<SequenceEntry>& sequences() {
#define X(name) name##_entry(),
    static const std::vector<SequenceEntry> all{RAYCACHE_SEQUENCES(X)};
#undef X
    return all;
}

std::unique_ptr<Sequence> make_sequence(const std::string& name, std::uint64_t seed) {
    const auto& all = sequences();
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& entry) { return entry.name == name; });
    if (found != all.end()) {
        auto sequence = found->make(seed);
        sequence->name_ = name;
        return sequence;
    }
    std::vector<std::string> names;
    for (const auto& entry : all) names.push_back(entry.name);
    throw UsageError(fmt::format("unknown sequence '{}'; expected one of: {}{}", name, fmt::join(names, ", "),
                                 did_you_mean(name, names)));
}

}  // namespace raycache::tracer
