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
    std::unique_ptr<Level> (*make)(const CacheGeometry&, unsigned caches, std::uint64_t lines, InstructionSet);
};

/// Sorted by name.
constexpr Entry policies[] = {
    {"fifo", make_fifo},
    {"lru", make_lru},
    {"random", make_random},
    {"tree_plru", make_tree_plru},
};

}  // namespace

std::unique_ptr<Level> make_level(const CacheGeometry& geometry, unsigned caches, std::uint64_t lines,
                                  InstructionSet instructions) {
    for (const Entry& policy : policies)
        if (policy.name == geometry.policy) return policy.make(geometry, caches, lines, instructions);
    throw Error(fmt::format("cache: expected a replacement policy out of {}, found \"{}\"",
                            fmt::join(cache_policies(), ", "), geometry.policy));
}

std::vector<std::string> cache_policies() {
    std::vector<std::string> names;
    for (const Entry& policy : policies) names.emplace_back(policy.name);
    return names;
}

}  // namespace raycache::cachesim
