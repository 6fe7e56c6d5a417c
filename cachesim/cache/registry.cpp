#include "cachesim/cache/registry.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string_view>

#include "cachesim/cache/policies/fifo.hpp"
#include "cachesim/cache/policies/lru.hpp"
#include "cachesim/cache/policies/random.hpp"
#include "cachesim/cache/policies/tree_plru.hpp"
#include "traces/error.hpp"

namespace raycache::cachesim {

namespace {

struct Entry {
    std::string_view name;
    std::unique_ptr<Level> (*make)(const CacheGeometry&, CacheRange caches, std::uint64_t lines, InstructionSet);
    std::unique_ptr<VictimOrder> (*order)(const CacheGeometry&, unsigned cache);
};

/// Sorted by name. A timed replay keeps the order of lru itself.
constexpr Entry policies[] = {
    {"fifo", make_fifo, order_fifo},
    {"lru", make_lru, nullptr},
    {"random", make_random, order_random},
    {"tree_plru", make_tree_plru, order_tree_plru},
};

const Entry& entry_of(const CacheGeometry& geometry) {
    for (const Entry& policy : policies)
        if (policy.name == geometry.policy) return policy;
    throw Error(fmt::format("cache: expected a replacement policy out of {}, found \"{}\"",
                            fmt::join(cache_policies(), ", "), geometry.policy));
}

}  // namespace

std::unique_ptr<Level> make_level(const CacheGeometry& geometry, CacheRange caches, std::uint64_t lines,
                                  InstructionSet instructions) {
    return entry_of(geometry).make(geometry, caches, lines, instructions);
}

std::unique_ptr<VictimOrder> make_victim_order(const CacheGeometry& geometry, unsigned cache) {
    const Entry& policy = entry_of(geometry);
    return policy.order ? policy.order(geometry, cache) : nullptr;
}

std::vector<std::string> cache_policies() {
    std::vector<std::string> names;
    for (const Entry& policy : policies) names.emplace_back(policy.name);
    return names;
}

}  // namespace raycache::cachesim
