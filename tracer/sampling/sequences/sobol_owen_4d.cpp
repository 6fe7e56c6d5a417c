// sobol-owen-4d: every four dimensions (0…3), (4…7), … are the first four of Sobol: well spread jointly,
// and dimensions 0 and 1 of each set are a (0,2)-sequence.
// B. Burley, "Practical hash-based Owen scrambling", JCGT 9(4), 2020. See owen_sobol_sets.hpp.
#include "tracer/sampling/sequences/owen_sobol_sets.hpp"

namespace raycache::tracer {

SequenceEntry sobol_owen_4d_entry() {
    return {"sobol-owen-4d", "Owen-scrambled Sobol in padded native sets of 4 dimensions (Burley 2020)",
            [](std::uint64_t seed) -> std::unique_ptr<Sequence> { return std::make_unique<OwenSobolSets>(4, seed); }};
}

}  // namespace raycache::tracer
