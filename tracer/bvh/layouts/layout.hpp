// How a BVH lies in the memory of the imagined GPU, and how a ray walks it there. A layout says
//   * which regions a trace has of it: their kinds (nodes, triangles), bytes per element, addresses, links;
//   * which of them a visit to a node reads, and a test of a triangle: one warp access each;
//   * how a lane steps: from what it read to where it goes next.
// What a visit costs is the GPU's business: the front end makes load instructions of an access by the element's bytes,
// and a preset's instructions are charged by the role of the region's kind (traces/object_kind.hpp) and, of nodes, by
// Region::degree: how many boxes a visit tests.
//
// Two parts. At run time a layout is a BvhLayout, made by its entry in a list of names. The traversal
// (tracer/simt/warp_traversal.hpp) is a template over the layout's own type, a WalkableBvh, so that its inner loop is
// compiled for that layout alone.
//
// To add one: write NAME.hpp in this folder and add its type to list.hpp.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tracer/bvh/bvh.hpp"
#include "tracer/ray.hpp"
#include "traces/header.hpp"

namespace raycache::tracer {

/// The BVH of a scene in some layout.
class BvhLayout {
public:
    virtual ~BvhLayout() = default;

    /// The memory that a traversal reads, as the first regions of a trace: the root is element 0 of region 0. Links
    /// lead to what the elements of a region point at (traces/header.hpp): they make traces small and tell analyses how
    /// deep an element lies.
    virtual std::vector<traces::Region> regions() const = 0;

    /// Whether the symbols that its lanes return are those of traces/FORMAT.md; if not, the writer of a trace searches
    /// for them.
    virtual bool symbols_known() const = 0;

protected:
    BvhLayout() = default;
    BvhLayout(const BvhLayout&) = default;
    BvhLayout(BvhLayout&&) = default;
    BvhLayout& operator=(const BvhLayout&) = default;
    BvhLayout& operator=(BvhLayout&&) = default;
};

/// Where a step leads a lane.
struct LaneStep {
    std::uint32_t symbol;   ///< of traces/FORMAT.md, of a lane that goes on; anything where symbols are not known
    std::uint32_t at_node;  ///< 1 at a node, 0 at triangles or at the end
    bool ended;             ///< nothing is left to visit
};

/// What the traversal asks of a layout's type.
///
///   node_reads, triangle_reads   regions that a visit to a node reads, and a test of a triangle: the same element of
///                                each, one warp access after the other
///   region_count                 of regions(); those of textures and buffers follow behind
///   View, view()                 pointers to nodes and triangles, taken out of the object before a loop
///   View::triangle(element)      what test_triangle() takes
///   Lane                         one ray's way through the tree
///   stack_entries()              that each lane needs room for
///
/// A lane stands at a node, at triangles, or at its end.
///   start(ray, stack)      at the root, with room for stack_entries() at `stack`
///   shorten(t)             nothing beyond t is wanted any more
///   node()                 the element of the node where it stands
///   visit_node(view)       tests the node's boxes and goes on: to the nearest child that is hit, or back to a sibling
///                          left on its way here
///   take_triangle()        the element of the next triangle where it stands
///   more_triangles()       whether there is another
///   leave_triangles()      all are tested: back to a sibling left on its way here
///   end()                  goes no further
template <class T>
concept WalkableBvh = std::derived_from<T, BvhLayout> &&
    requires(const T& tree, const typename T::View& view, typename T::Lane& lane, const Ray& ray,
             typename T::Lane::StackEntry* stack, float t, std::uint32_t element) {
    requires std::size(T::node_reads)
    > 0 && std::size(T::triangle_reads) > 0;
    { T::region_count } -> std::convertible_to<std::uint8_t>;
    { tree.view() } -> std::same_as<typename T::View>;
    { tree.stack_entries() } -> std::same_as<std::size_t>;
    view.triangle(element);
    lane.start(ray, stack);
    lane.shorten(t);
    { lane.node() } -> std::same_as<std::uint32_t>;
    { lane.visit_node(view) } -> std::same_as<LaneStep>;
    { lane.take_triangle() } -> std::same_as<std::uint32_t>;
    { lane.more_triangles() } -> std::same_as<bool>;
    { lane.leave_triangles() } -> std::same_as<LaneStep>;
    { lane.end() } -> std::same_as<LaneStep>;
};

/// Its name, and how it is made: what a trace's provenance and --layout call it.
struct BvhLayoutEntry {
    std::string name, description;
    std::uint32_t max_leaf_size;  ///< triangles of a leaf of the tree that it is made of, at most
    /// Throws Error where the tree is too large or too deep for the layout.
    std::unique_ptr<const BvhLayout> (*make)(const Bvh&, const Scene&);
};
const std::vector<BvhLayoutEntry>& bvh_layouts();

inline constexpr const char* default_layout = "bvh2";

/// Throws UsageError for an unknown name: lists the valid ones, and the closest.
const BvhLayoutEntry& bvh_layout_entry(const std::string& name);

}  // namespace raycache::tracer
