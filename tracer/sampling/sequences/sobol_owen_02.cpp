// sobol-owen-02: every pair of dimensions (0,1), (2,3), … is a (0,2)-sequence in base 2.
// B. Burley, "Practical hash-based Owen scrambling", JCGT 9(4), 2020. See owen_sobol_sets.hpp.
#include "tracer/sampling/sequences/owen_sobol_sets.hpp"

namespace raycache::tracer {

SequenceEntry sobol_owen_02_entry() {
    return {"sobol-owen-02", "Owen-scrambled Sobol in padded pairs, each a (0,2)-sequence (Burley 2020)",
            [](std::uint64_t seed) -> std::unique_ptr<Sequence> { return std::make_unique<OwenSobolSets>(2, seed); }};
}

}  // namespace raycache::tracer
