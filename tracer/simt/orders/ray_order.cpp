#include "tracer/simt/orders/ray_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "traces/error.hpp"

namespace raycache::tracer {

const RayOrderEntry& ray_order_entry(const std::string& name) {
    const auto& all = ray_orders();
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& entry) { return entry.name == name; });
    if (found != all.end()) return *found;
    std::string names;
    for (const auto& entry : all) names += (names.empty() ? "" : ", ") + entry.name;
    throw UsageError(fmt::format("unknown ray order '{}'; expected one of: {}", name, names));
}

std::vector<std::uint32_t> sorted_indices(const std::vector<std::uint32_t>& keys) {
    std::vector<std::uint32_t> order(keys.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
    return order;
}

}  // namespace raycache::tracer
