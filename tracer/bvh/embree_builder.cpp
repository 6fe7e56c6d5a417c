#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "tracer/bvh/bvh.hpp"
#include "traces/error.hpp"

namespace raycache::tracer {
namespace {

/// To be raised with every change to this file that changes a tree: those kept on disk are then built again.
constexpr int builder_version = 1;

/// Room for references that spatial splits add, as a share of the triangles.
constexpr double split_budget = 0.5;

/// What Embree's callbacks know and count.
struct Build {
    const Scene& scene;
    std::size_t nodes = 0, entries = 0;
};

/// What they make, in Embree's arena, gone once flattened: an inner node, or a leaf, which is its number of triangles
/// and then the triangles. Both begin with that number.
struct InnerNode {
    std::uint32_t no_triangles = 0;
    std::array<void*, 2> child{};
    std::array<Box, 2> box;
};
std::uint32_t count_of(const void* node) { return *static_cast<const std::uint32_t*>(node); }

Box to_box(const RTCBounds& b) { return {{b.lower_x, b.lower_y, b.lower_z}, {b.upper_x, b.upper_y, b.upper_z}}; }

void* create_node(RTCThreadLocalAllocator allocator, unsigned, void* user) {
    ++static_cast<Build*>(user)->nodes;
    return new (rtcThreadLocalAlloc(allocator, sizeof(InnerNode), alignof(InnerNode))) InnerNode;
}

void set_children(void* node, void** children, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i) static_cast<InnerNode*>(node)->child.at(i) = children[i];
}

void set_bounds(void* node, const RTCBounds** bounds, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i) static_cast<InnerNode*>(node)->box.at(i) = to_box(*bounds[i]);
}

void* create_leaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, size_t count, void* user) {
    auto* leaf = static_cast<std::uint32_t*>(
        rtcThreadLocalAlloc(allocator, (1 + count) * sizeof(std::uint32_t), alignof(std::uint32_t)));
    leaf[0] = static_cast<std::uint32_t>(count);
    for (size_t i = 0; i < count; ++i) leaf[1 + i] = primitives[i].primID;
    std::sort(leaf + 1, leaf + 1 + count);  // the builder's partition leaves them in no particular order
    ++static_cast<Build*>(user)->nodes;
    static_cast<Build*>(user)->entries += count;
    return leaf;
}

/// Bounds of the two parts into which the plane `axis` = `position` cuts a triangle reference.
void split_primitive(const RTCBuildPrimitive* primitive, unsigned axis, float position, RTCBounds* left,
                     RTCBounds* right, void* user) {
    const Scene& scene = static_cast<const Build*>(user)->scene;
    const std::uint32_t* index = &scene.indices[3 * std::size_t{primitive->primID}];
    std::array<Box, 2> part;
    for (int edge = 0; edge < 3; ++edge) {
        const Vec3 a = scene.positions[index[edge]];
        const Vec3 b = scene.positions[index[(edge + 1) % 3]];
        const float from = a[static_cast<int>(axis)];
        const float to = b[static_cast<int>(axis)];
        if (from <= position) part[0].add(a);
        if (from >= position) part[1].add(a);
        if ((from < position && to > position) || (from > position && to < position)) {
            const Vec3 cut = a + (b - a) * ((position - from) / (to - from));
            part[0].add(cut);
            part[1].add(cut);
        }
    }
    // The cut point is rounded: keep the plane itself as the common face, and never leave the reference's own box.
    const Box whole{{primitive->lower_x, primitive->lower_y, primitive->lower_z},
                    {primitive->upper_x, primitive->upper_y, primitive->upper_z}};
    std::array<Box, 2> limit{whole, whole};
    (axis == 0 ? limit[0].upper.x : axis == 1 ? limit[0].upper.y : limit[0].upper.z) = position;
    (axis == 0 ? limit[1].lower.x : axis == 1 ? limit[1].lower.y : limit[1].lower.z) = position;
    // Widen by the rounding error of the cut, relative to the coordinates it was computed from.
    for (int side = 0; side < 2; ++side) {
        Box& box = part.at(static_cast<std::size_t>(side));
        const Vec3 reach = max(max(box.lower, -box.lower), max(box.upper, -box.upper)) * 4e-7F;
        box.lower = max(box.lower - reach, limit.at(static_cast<std::size_t>(side)).lower);
        box.upper = min(box.upper + reach, limit.at(static_cast<std::size_t>(side)).upper);
        RTCBounds* out = side == 0 ? left : right;
        *out = {box.lower.x, box.lower.y, box.lower.z, 0, box.upper.x, box.upper.y, box.upper.z, 0};
    }
}

/// Depth-first copy of the builder's tree.
Bvh flatten(const void* root, const Box& root_box, const Build& build) {
    struct Pending {
        const void* node;
        Box box;
        std::uint32_t depth;
        std::uint32_t parent;  ///< whose second child this is, or none
    };
    constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    Bvh bvh;
    bvh.nodes.reserve(build.nodes);
    bvh.triangles.reserve(build.entries);
    std::vector<Pending> stack{{root, root_box, 0, none}};
    while (!stack.empty()) {
        const Pending p = stack.back();
        stack.pop_back();
        const auto index = static_cast<std::uint32_t>(bvh.nodes.size());
        if (p.parent != none) bvh.nodes[p.parent].first = index;
        bvh.depth = std::max(bvh.depth, p.depth);
        if (const std::uint32_t count = count_of(p.node); count != 0) {
            bvh.nodes.push_back({p.box, static_cast<std::uint32_t>(bvh.triangles.size()), count});
            const auto* triangles = static_cast<const std::uint32_t*>(p.node) + 1;
            bvh.triangles.insert(bvh.triangles.end(), triangles, triangles + count);
        } else {
            bvh.nodes.push_back({p.box, 0, 0});
            const auto* inner = static_cast<const InnerNode*>(p.node);
            stack.push_back({inner->child[1], inner->box[1], p.depth + 1, index});
            stack.push_back({inner->child[0], inner->box[0], p.depth + 1, none});
        }
    }
    return bvh;
}

std::vector<RTCBuildPrimitive> make_primitives(const Scene& scene, std::size_t room) {
    std::vector<RTCBuildPrimitive> primitives;
    primitives.reserve(room);
    for (std::size_t t = 0; t < scene.triangle_count(); ++t) {
        Box box;
        for (int corner = 0; corner < 3; ++corner)
            box.add(scene.positions[scene.indices[3 * t + static_cast<std::size_t>(corner)]]);
        primitives.push_back({box.lower.x, box.lower.y, box.lower.z, 0, box.upper.x, box.upper.y, box.upper.z,
                              static_cast<unsigned>(t)});
    }
    return primitives;
}

}  // namespace

std::string bvh_builder() {
    const RTCDevice device = rtcNewDevice("threads=1,set_affinity=0");
    if (device == nullptr) throw Error("Embree cannot start on this processor");
    const auto version = rtcGetDeviceProperty(device, RTC_DEVICE_PROPERTY_VERSION);
    rtcReleaseDevice(device);
    return fmt::format("Embree {}, builder {}", version, builder_version);
}

std::size_t most_leaf_entries(std::size_t triangles, const BvhSettings& settings) {
    if (!settings.spatial_splits) return triangles;
    return static_cast<std::size_t>(static_cast<double>(triangles) * (1 + split_budget)) + 16;
}

Bvh build_bvh(const Scene& scene, const BvhSettings& settings) {
    if (scene.triangle_count() == 0) throw Error(fmt::format("{}: no triangle to build a BVH from", scene.name));
    const Box bounds = scene.bounds();
    const float reach = std::max(max_component(bounds.upper), max_component(-bounds.lower));
    if (!(reach <= max_coordinate))
        throw Error(fmt::format("{}: a coordinate of {:g}; expected at most {:g}: scale the scene down", scene.name,
                                reach, max_coordinate));

    auto primitives = make_primitives(scene, most_leaf_entries(scene.triangle_count(), settings));
    Build build{scene};
    const RTCDevice device = rtcNewDevice("threads=1,set_affinity=0");
    if (device == nullptr) throw Error("Embree cannot start on this processor");
    const RTCBVH handle = rtcNewBVH(device);

    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.buildQuality = settings.spatial_splits ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM;
    arguments.maxBranchingFactor = 2;
    arguments.maxDepth = 64;
    arguments.sahBlockSize = 1;
    arguments.minLeafSize = 1;
    arguments.maxLeafSize = settings.max_leaf_size;
    arguments.traversalCost = 1;
    arguments.intersectionCost = 1;
    arguments.bvh = handle;
    arguments.primitives = primitives.data();
    arguments.primitiveCount = primitives.size();
    arguments.primitiveArrayCapacity = primitives.capacity();
    arguments.createNode = create_node;
    arguments.setNodeChildren = set_children;
    arguments.setNodeBounds = set_bounds;
    arguments.createLeaf = create_leaf;
    arguments.splitPrimitive = settings.spatial_splits ? split_primitive : nullptr;
    arguments.userPtr = &build;

    // One thread: the parallel builder's partition order depends on timing.
    const void* root = nullptr;
    tbb::task_arena(1).execute([&] { root = rtcBuildBVH(&arguments); });
    const RTCError status = rtcGetDeviceError(device);
    primitives = {};  // before the tree is there twice
    Bvh bvh;
    if (root != nullptr) bvh = flatten(root, bounds, build);
    rtcReleaseBVH(handle);
    rtcReleaseDevice(device);
    if (root == nullptr)
        throw Error(fmt::format("{}: Embree could not build a BVH of {} triangles (error {}): is there enough memory?",
                                scene.name, scene.triangle_count(), static_cast<int>(status)));
    return bvh;
}

}  // namespace raycache::tracer
