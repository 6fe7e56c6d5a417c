#include "tools/gpu/package/tree_check.hpp"

#include <algorithm>
#include <bit>

#include "tools/gpu/walk.hpp"

namespace raycache::gpu {
namespace {

constexpr std::size_t bytes_of_triangle = 48;

std::uint32_t word(std::span<const std::uint8_t> bytes, std::size_t at) {
    std::uint32_t value;
    std::memcpy(&value, &bytes[at], sizeof value);
    return value;
}

/// Calls node(element) and triangles(first, count) for each child of a node.
template <class Node, class Triangles>
void for_each_child(TreeKind kind, std::span<const std::uint8_t> node, const Node& to_node,
                    const Triangles& to_triangles) {
    if (kind == TreeKind::cwbvh8) {
        std::uint32_t next = word(node, 16);
        const std::uint32_t first = word(node, 20);
        const std::uint32_t inner = node[15];
        for (unsigned slot = 0; slot < 8; ++slot) {
            const std::uint32_t meta = node[24 + slot];
            const bool is_node = (meta & 31) >= WalkCwbvh8::first_inner;
            // Anything but a node's own bits would lead astray; a triangle's are counted from the lowest.
            if ((inner >> slot & 1) != (is_node ? 1U : 0U) || (is_node && meta != (32U | (24 + slot))))
                return to_node(~0U);
            if (is_node) {
                to_node(next++);
            } else if (meta != 0) {
                const std::uint32_t count = static_cast<std::uint32_t>(std::popcount(meta >> 5));
                if (meta >> 5 != (1U << count) - 1 || count == 0 || (meta & 31) + count > 24) return to_node(~0U);
                to_triangles(first + (meta & 31), count);
            }
        }
        return;
    }
    const unsigned children = kind == TreeKind::bvh2 ? 2 : 4;
    const std::size_t at = kind == TreeKind::bvh2 ? 48 : 96;
    for (unsigned c = 0; c < children; ++c) {
        const std::uint32_t ref = word(node, at + 4 * c);
        if (ref == RefLane::nothing) continue;
        if ((ref & RefLane::leaf_bit) == 0)
            to_node(ref);
        else
            to_triangles((ref & ~RefLane::leaf_bit) >> 3, ref & 7);
    }
}

}  // namespace

TreeFacts check_tree(TreeKind kind, const BvhPart& bvh) {
    const std::size_t node_bytes = kind == TreeKind::bvh2   ? WalkBvh2::node_bytes
                                   : kind == TreeKind::bvh4 ? WalkBvh4::node_bytes
                                                            : WalkCwbvh8::node_bytes;
    const std::uint32_t most = kind == TreeKind::bvh2   ? WalkBvh2::most_stack
                               : kind == TreeKind::bvh4 ? WalkBvh4::most_stack
                                                        : WalkCwbvh8::most_stack;
    const std::uint32_t siblings = kind == TreeKind::bvh4 ? 3 : 1;
    if (bvh.nodes.empty() || bvh.nodes.size() % node_bytes != 0 || bvh.triangles.size() % bytes_of_triangle != 0)
        return {"whole nodes and triangles"};
    const std::size_t nodes = bvh.nodes.size() / node_bytes, triangles = bvh.triangles.size() / bytes_of_triangle;
    if (nodes >= RefLane::leaf_bit || triangles >= RefLane::leaf_bit) return {"fewer than 2^31 nodes and triangles"};
    struct Open {
        std::uint32_t node, depth;
    };
    std::vector<Open> open{{0, 0}};
    std::vector<bool> seen(nodes);
    seen[0] = true;
    std::uint32_t deepest = 0;
    bool sound = true;
    while (sound && !open.empty()) {
        const Open at = open.back();
        open.pop_back();
        deepest = std::max(deepest, at.depth);
        for_each_child(
            kind, bvh.nodes.subspan(at.node * node_bytes, node_bytes),
            [&](std::uint32_t child) {
                sound = sound && child < nodes && !seen[child];
                if (!sound) return;
                seen[child] = true;
                open.push_back({child, at.depth + 1});
            },
            [&](std::uint32_t first, std::uint32_t count) {
                sound = sound && count != 0 && first < triangles && count <= triangles - first;
            });
    }
    if (!sound) return {"nodes that form a tree over the triangles"};
    const std::uint32_t entries = siblings * (deepest + 1) + 1;
    if (entries > most) return {"a tree that the walk's stack has room for (97 levels)"};
    return {nullptr, entries};
}

}  // namespace raycache::gpu
