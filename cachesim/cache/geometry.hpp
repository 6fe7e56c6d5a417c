// The shape of a cache: sizes, how lines find their set and slice, what a miss fetches.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace raycache::cachesim {

/// Which set of its slice a line goes to. Formulas: cachesim/cache/line_map.hpp
enum class SetIndex {
    modulo,
    xor_fold,
    ipoly,   ///< remainder of a polynomial division (Rau 1991); 16, 32 or 64 sets
    parity,  ///< each bit is the parity of some bits of the byte address: CacheGeometry::index_masks
};

/// Which slice of a level a line goes to.
enum class SliceHash {
    modulo,
    xor_fold,
    ipoly,  ///< 16, 32 or 64 slices; CacheGeometry::slice_bits
};

/// When a miss takes a line of the cache. Without time there is no difference.
enum class Allocate {
    on_miss,  ///< at once; the line cannot be evicted until its data are there
    on_fill,  ///< when the data arrive; until then they wait in a miss-status holding register
};

/// A sectored set-associative cache in one or more slices. Any positive numbers will do: powers of two are not required
/// unless a hash asks for them.
struct CacheGeometry {
    std::uint64_t sets = 0, ways = 0;  ///< sets of one slice
    std::uint32_t line_bytes = 128, sector_bytes = 32;
    SetIndex index = SetIndex::modulo;
    std::string policy = "lru";  ///< what to evict: a name of cache_policies()
    std::uint64_t seed = 1;      ///< policy "random": other numbers, other victims

    /// SetIndex::parity: set bit i = parity(byte address & index_masks[i]).
    std::vector<std::uint64_t> index_masks{};
    std::uint32_t slices = 1;
    SliceHash slice_hash = SliceHash::modulo;
    std::uint32_t interleave_bytes = 256;  ///< modulo, xor_fold: neighbouring bytes that share a slice
    /// SliceHash::ipoly: address bits that number the slices before hashing, lowest first, and the lowest of the bits
    /// above that are mixed in.
    std::vector<std::uint32_t> slice_bits{};
    std::uint32_t slice_hash_from = 0;
    /// Bytes fetched from below on a miss: the sectors that lie in the same aligned piece of this size and are absent.
    /// 0: the sector alone.
    std::uint32_t fill_bytes = 0;
    Allocate allocate = Allocate::on_miss;
    /// What the file says shared memory takes of the cache, in whole ways; `ways` are those that are left.
    std::uint64_t carve_out_bytes = 0;

    std::uint64_t lines() const { return slices * sets * ways; }
    std::uint64_t bytes() const { return lines() * line_bytes; }
    /// One more way.
    std::uint64_t way_bytes() const { return slices * sets * line_bytes; }
    bool operator==(const CacheGeometry&) const = default;
};

}  // namespace raycache::cachesim
