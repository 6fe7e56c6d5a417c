#include "tracer/bvh/layouts/memory.hpp"

#include "tracer/bvh/layouts/list.hpp"
#include "traces/error.hpp"

namespace raycache::tracer {
namespace {

template <class T>
std::span<const std::uint8_t> bytes_in_memory(const std::vector<T>& elements) {
    return {reinterpret_cast<const std::uint8_t*>(elements.data()), elements.size() * sizeof(T)};
}

template <class... Layouts>
LayoutMemory memory_of(const BvhLayout& layout, LayoutList<Layouts...>) {
    LayoutMemory memory{};
    const auto try_one = [&]<class Tree>(const Tree* tree) {
        if (tree != nullptr)
            memory = {Tree::name, sizeof(tree->nodes[0]), sizeof(tree->triangles[0]), bytes_in_memory(tree->nodes),
                      bytes_in_memory(tree->triangles)};
        return tree != nullptr;
    };
    if (!(try_one(dynamic_cast<const typename Layouts::Tree*>(&layout)) || ...))
        throw Error("a BVH in a layout that tracer/bvh/layouts/list.hpp lacks");
    return memory;
}

}  // namespace

LayoutMemory layout_memory(const BvhLayout& layout) { return memory_of(layout, BvhLayouts{}); }

}  // namespace raycache::tracer
