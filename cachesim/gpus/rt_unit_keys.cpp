#include "cachesim/gpus/key_tables.hpp"

namespace raycache::cachesim {

std::span<const Key<RtUnitTiming>> rt_unit_keys() {
    using R = RtUnitTiming;
    constexpr std::uint64_t longest_test = 100'000;
    constexpr double slowest = 0.001, fastest = 1e6;
    static constexpr Key<R> keys[] = {
        {"warps", whole(&R::warps, 1, 1024), initial, "warps",
         "whose rays the unit of an SM holds at once; others wait for a place, in order"},
        {"box_tests_per_cycle", real(&R::box_tests_per_cycle, slowest, fastest), initial, "tests/cycle",
         "of a ray against a box each; a node takes as many for each lane as it has boxes"},
        {"triangle_tests_per_cycle", real(&R::triangle_tests_per_cycle, slowest, fastest), initial, "tests/cycle",
         "of a ray against a triangle each"},
        {"box_latency", whole(&R::box_latency, 0, longest_test), initial, "cycles",
         "from the last cycle in which tests of a visit enter to their results"},
        {"triangle_latency", whole(&R::triangle_latency, 0, longest_test), initial, "cycles", "the same of triangles"},
        {"load_bytes", power_of_two(&R::load_bytes, 16, 128), initial, "bytes",
         "nodes and triangles are fetched in pieces of this size, each a load of all lanes of a warp at once"},
        {"loads_per_cycle", whole(&R::loads_per_cycle, 1, 64), initial, "loads",
         "that the unit puts into its queue to L1 in a cycle; the port of an L1 takes one at most"},
        {"load_queue", whole(&R::load_queue, 1, 65535), initial, "loads",
         "of the unit that may wait for the L1 port, beside those of the schedulers"},
    };
    return keys;
}

}  // namespace raycache::cachesim
