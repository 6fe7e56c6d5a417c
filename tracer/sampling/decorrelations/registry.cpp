// The list of decorrelations. To add one: write a file in this folder that defines `DecorrelationEntry NAME_entry()` in
// namespace raycache::tracer, and add X(NAME) below.
#include "tracer/sampling/decorrelation.hpp"

#define RAYCACHE_DECORRELATIONS(X) \
    X(coherent)                    \
    X(cranley_patterson)           \
    X(micro_jitter)                \
    X(scrambling_distance)         \
    X(uniform_jitter)              \
    X(interleaved)                 \
    X(owen)                        \
    X(blue_noise)                  \
    X(net_micro_jitter)            \
    X(net_micro_jitter_fast)       \
    X(random)

namespace raycache::tracer {

#define X(name) DecorrelationEntry name##_entry();
RAYCACHE_DECORRELATIONS(X)
#undef X

const std::vector<DecorrelationEntry>& decorrelations() {
#define X(name) name##_entry(),
    static const std::vector<DecorrelationEntry> all{RAYCACHE_DECORRELATIONS(X)};
#undef X
    return all;
}

}  // namespace raycache::tracer
