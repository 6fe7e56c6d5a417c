// Random replacement, the same in every run: eviction number n (from 0) of set s, numbered through all slices of all
// caches of the level, takes way
//     floor(ways * m(m(m(seed) xor s) xor n) / 2^64)
// where m is SplitMix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", 2014). So the order in
// which sets are simulated does not matter. An empty way is taken before any is evicted.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "cachesim/cache/level.hpp"
#include "cachesim/cache/policies/victim_order.hpp"
#include "cachesim/instruction_set.hpp"

namespace raycache::cachesim {

class RandomOrder {
public:
    /// `first`: number of the first set.
    RandomOrder(std::uint64_t sets, std::uint64_t ways, std::uint64_t seed, std::uint64_t first = 0)
        : ways_(ways), mixed_seed_(mix(seed)), first_(first), evictions_(sets) {}

    void use(std::uint64_t /*set*/, std::uint64_t /*way*/) {}

    std::uint64_t victim(std::uint64_t set) {
        const std::uint64_t number = mix(mix(mixed_seed_ ^ (first_ + set)) ^ evictions_[set]++);
        return static_cast<std::uint64_t>((Wide{number} * ways_) >> 64);
    }

private:
    __extension__ using Wide = unsigned __int128;

    /// SplitMix64's output for this state.
    static std::uint64_t mix(std::uint64_t state) {
        std::uint64_t z = state + 0x9e3779b97f4a7c15;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
        z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
        return z ^ (z >> 31);
    }

    std::uint64_t ways_, mixed_seed_, first_;
    std::vector<std::uint64_t> evictions_;  ///< by set, so far
};

std::unique_ptr<Level> make_random(const CacheGeometry&, CacheRange caches, std::uint64_t lines, InstructionSet);
std::unique_ptr<VictimOrder> order_random(const CacheGeometry&, unsigned cache);

}  // namespace raycache::cachesim
