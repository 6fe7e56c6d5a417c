// The layouts of list.hpp by their names.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tracer/bvh/layouts/list.hpp"
#include "traces/did_you_mean.hpp"
#include "traces/error.hpp"

namespace raycache::tracer {
namespace {

template <class Layout>
std::unique_ptr<const BvhLayout> make(const Bvh& bvh, const Scene& scene) {
    return Layout::make(bvh, scene);
}

template <class... Layouts>
std::vector<BvhLayoutEntry> entries_of(LayoutList<Layouts...>) {
    return {{Layouts::name, Layouts::description, Layouts::max_leaf_size, &make<Layouts>}...};
}

}  // namespace

const std::vector<BvhLayoutEntry>& bvh_layouts() {
    static const std::vector<BvhLayoutEntry> all = entries_of(BvhLayouts{});
    return all;
}

const BvhLayoutEntry& bvh_layout_entry(const std::string& name) {
    std::vector<std::string> valid;
    for (const BvhLayoutEntry& entry : bvh_layouts()) {
        if (entry.name == name) return entry;
        valid.push_back(entry.name);
    }
    throw UsageError(fmt::format("unknown layout '{}'; expected one of: {}{}", name, fmt::join(valid, ", "),
                                 did_you_mean(name, valid)));
}

}  // namespace raycache::tracer
