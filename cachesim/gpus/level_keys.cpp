#include <algorithm>

#include "cachesim/cache/registry.hpp"
#include "cachesim/gpus/key_tables.hpp"

namespace raycache::cachesim {

namespace {

constexpr std::uint64_t most_bytes = std::uint64_t{1} << 40;

}  // namespace

std::span<const Key<CacheGeometry>> level_keys() {
    using Cache = CacheGeometry;
    static constexpr Key<Cache> keys[] = {
        {"sets", whole(&Cache::sets, 1, most_bytes), needed, "", "of one slice"},
        {"ways", whole(&Cache::ways, 1, most_bytes), needed, "", "lines of a set"},
        {"line_bytes", power_of_two(&Cache::line_bytes, 16, 4096), needed, "bytes", "the same in all levels"},
        {"sector_bytes", power_of_two(&Cache::sector_bytes, 4, 4096), needed, "bytes",
         "the same in all levels; no larger than a line, at most 32 to a line"},
        {"index", choice<&Cache::index, set_indices>(), needed, "",
         "set of a line (`cachesim/cache/line_map.hpp`); `ipoly` asks for 16, 32 or 64 sets"},
        {"policy", name_out_of(&Cache::policy, cache_policies), needed, "",
         "which line to evict (`cachesim/cache/policies/`)"},
        {"seed", whole(&Cache::seed, 0), initial, "", "of the policy `random`"},
        {"index_masks", list(&Cache::index_masks, "address masks"), initial, "",
         "`parity`, which needs them: one mask of address bits for each bit of the set"},
        {"slices", whole(&Cache::slices, 1, 4096), initial, "", "parts of the cache with sets of their own"},
        {"slice_hash", choice<&Cache::slice_hash, slice_hashes>(), initial, "",
         "slice of a line; `ipoly` asks for 16, 32 or 64 slices"},
        {"interleave_bytes",
         power_of_two(&Cache::interleave_bytes, 1, 1u << 30),
         {false, "256, or a line where that is longer",
          [](Cache& cache) { cache.interleave_bytes = std::max(256u, cache.line_bytes); }},
         "bytes",
         "`modulo`, `xor_fold`: neighbouring bytes in one slice, at least a line"},
        {"slice_bits", list(&Cache::slice_bits, "address bits"), initial, "",
         "`ipoly`, which needs them: address bits above those of a byte in its line, up to 62, that number the slices, "
         "lowest first"},
        {"slice_hash_from", whole(&Cache::slice_hash_from, 0, 63), initial, "",
         "`ipoly`, which needs it: the lowest of the address bits, above all `slice_bits`, that are mixed in"},
        {"fill_bytes",
         power_of_two(&Cache::fill_bytes),
         {false, "a sector", [](Cache& cache) { cache.fill_bytes = cache.sector_bytes; }},
         "bytes",
         "what a miss fetches: the absent sectors of its aligned piece of this size, from a sector to a line"},
        {"allocate", choice<&Cache::allocate, allocations>(), initial, "",
         "when a miss takes its line; makes a difference in time only"},
        {"carve_out_bytes", whole(&Cache::carve_out_bytes, 0), initial, "bytes",
         "what shared memory takes, rounded up to whole ways; at least one way is left"},
    };
    return keys;
}

}  // namespace raycache::cachesim
