#include "cachesim/gpus/key_tables.hpp"

namespace raycache::cachesim {

std::span<const Key<Gpu>> chip_keys() {
    static constexpr Key<Gpu> keys[] = {
        {"name", text(&Gpu::name), needed, "", "as reports name it"},
        {"description", text(&Gpu::description), needed, "", "product, chip, generation"},
        {"sms", whole(&Gpu::sms, 1, 4096), needed, "", "streaming multiprocessors, or cores of a CPU"},
        {"max_warps_per_sm",
         whole(&Gpu::max_warps_per_sm),
         {false, "not known"},
         "warps",
         "what an SM can hold whatever the kernel; `warps_per_sm` above it is refused"},
        {"warps_per_cta", whole(&Gpu::warps_per_cta, 1, 64), needed, "warps", "size of a CTA (thread block)"},
        {"warps_per_sm",
         whole(&Gpu::warps_per_sm, 1, 1024),
         {true, "from `[registers]`"},
         "warps",
         "resident at once; `--warps-per-sm` changes it. CTAs are resident whole, at least one"},
        {"l1_per_sm", whole(&Gpu::l1_per_sm, 1, 8), needed, "",
         "L1s of an SM; resident warps are dealt out among them (Maxwell: 2)"},
        {"simd_width", power_of_two(&Gpu::simd_width, 1, 32), initial, "lanes",
         "lanes that execute together; a warp runs as 32 / `simd_width` vectors"},
        {"scheduler", choice<&Gpu::scheduler, schedulers>(), initial, "",
         "which resident warp issues next; makes a difference in time only"},
        {"traversal", choice<&Gpu::traversal, traversals>(), initial, "",
         "who walks the BVH: instructions of the SM, or its RT unit, which needs `[rt_unit]`; makes a difference in "
         "time only"},
    };
    return keys;
}

std::span<const Key<Registers>> register_keys() {
    static constexpr Key<Registers> keys[] = {
        {"per_sm", whole(&Registers::per_sm), needed, "registers", "of an SM"},
        {"per_thread", whole(&Registers::per_thread), needed, "registers", "of a thread of the kernel"},
        {"allocation", whole(&Registers::allocation), initial, "registers", "a warp's are rounded up to a multiple"},
    };
    return keys;
}

std::span<const Key<FrontEnd>> front_end_keys() {
    static constexpr Key<FrontEnd> keys[] = {
        {"load_bytes", power_of_two(&FrontEnd::load_bytes, 4, 16), initial, "bytes",
         "widest load; objects are read in pieces of this size"},
        {"lanes_per_request_16", power_of_two(&FrontEnd::lanes_per_request_16, 1, 32), initial, "lanes",
         "of a load of 16 bytes, lanes that go to the tag stage together (Maxwell and Pascal: 2). Groups without an "
         "active lane: `timing.empty_request_cycles`"},
        {"lanes_per_request_8", power_of_two(&FrontEnd::lanes_per_request_8, 1, 32), initial, "lanes",
         "the same of a load of 8 bytes (Maxwell and Pascal: 4)"},
        {"lanes_per_request_4", power_of_two(&FrontEnd::lanes_per_request_4, 1, 32), initial, "lanes",
         "the same of a load of at most 4 bytes (Maxwell and Pascal: 8)"},
    };
    return keys;
}

}  // namespace raycache::cachesim
