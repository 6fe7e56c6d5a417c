// Kinds of objects that a trace accesses, and what each is to the model: one row of a table per kind.
//
// To add a kind: an enumerator, a row, and a version of the format that knows it (FORMAT.md, format::version). Counts,
// times, reports and exports follow from the row.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace raycache::traces {

/// What kind of object a region holds, and whether its accesses read or write it. Stored in the file: append only.
/// A buffer that is read and written is two regions at the same addresses.
enum class ObjectKind : std::uint8_t {
    node = 0,
    triangle = 1,
    texel = 2,
    // What kernels of a wavefront hand to each other; a megakernel keeps it in registers.
    ray_state = 3,  ///< a ray, or what its path has gathered
    hit = 4,        ///< what a ray met
    queue = 5,      ///< places of rays that are still to be worked on
    ray_state_write = 6,
    hit_write = 7,
    queue_write = 8,
    /// Bytes that sorting a queue moves: an access by n lanes stands for n * element_size bytes that stream from and to
    /// DRAM, whatever the elements.
    sort = 9,
    // What a pass over a picture reads of the surfaces that it shows, by pixel.
    depth = 10,   ///< how far away
    normal = 11,  ///< where it faces
};

/// What an access does to memory.
enum class AccessType : std::uint8_t { read, write, stream };

/// Which number of a GPU preset says how many instructions a visit takes beside its loads: node_instructions
/// (node4_, node8_ where they have more children), triangle_instructions, texel_instructions. What a visit costs is the GPU's business, not the trace's.
enum class Charge : std::uint8_t { node, triangle, texel };

/// The role of a kind.
struct ObjectKindRole {
    ObjectKind kind;
    const char* name;    ///< of a group in reports and exports: "ray state write"
    const char* plural;  ///< heading of its row in explanations
    AccessType access;
    Charge charge;
    bool is_step;             ///< a lane's access is a step of its ray through the BVH
    bool is_between_kernels;  ///< one kernel of a wavefront leaves it for the next
    std::uint32_t version;    ///< of the format, the first that knows it
};

inline constexpr std::array object_kind_roles = [] {
    using K = ObjectKind;
    using A = AccessType;
    using C = Charge;
    // clang-format off
    return std::array{
        ObjectKindRole{K::node,            "node",            "nodes",            A::read,   C::node,     true,  false, 1},
        ObjectKindRole{K::triangle,        "triangle",        "triangles",        A::read,   C::triangle, true,  false, 1},
        ObjectKindRole{K::texel,           "texel",           "texels",           A::read,   C::texel,    false, false, 1},
        ObjectKindRole{K::ray_state,       "ray state",       "ray states",       A::read,   C::texel,    false, true,  2},
        ObjectKindRole{K::hit,             "hit",             "hits",             A::read,   C::texel,    false, true,  2},
        ObjectKindRole{K::queue,           "queue",           "queue entries",    A::read,   C::texel,    false, true,  2},
        ObjectKindRole{K::ray_state_write, "ray state write", "ray state writes", A::write,  C::texel,    false, true,  2},
        ObjectKindRole{K::hit_write,       "hit write",       "hit writes",       A::write,  C::texel,    false, true,  2},
        ObjectKindRole{K::queue_write,     "queue write",     "queue writes",     A::write,  C::texel,    false, true,  2},
        ObjectKindRole{K::sort,            "sort",            "sorts",            A::stream, C::texel,    false, true,  2},
        ObjectKindRole{K::depth,           "depth",           "depths",           A::read,   C::texel,    false, false, 5},
        ObjectKindRole{K::normal,          "normal",          "normals",          A::read,   C::texel,    false, false, 5},
    };
    // clang-format on
}();
inline constexpr unsigned object_kinds = object_kind_roles.size();

constexpr bool is_known(ObjectKind kind) { return static_cast<std::size_t>(kind) < object_kinds; }
/// The kind must be known.
constexpr const ObjectKindRole& role_of(ObjectKind kind) { return object_kind_roles[static_cast<std::size_t>(kind)]; }
constexpr bool is_write(ObjectKind kind) { return role_of(kind).access == AccessType::write; }
constexpr bool is_stream(ObjectKind kind) { return role_of(kind).access == AccessType::stream; }

/// "node", "ray state", "ray state write", …; "?" for an unknown kind.
constexpr const char* name_of(ObjectKind kind) { return is_known(kind) ? role_of(kind).name : "?"; }

/// Rows stand at the place of their kind, and versions only grow: a reader of version v knows the first ones.
constexpr bool in_order(const decltype(object_kind_roles)& roles) {
    for (std::size_t i = 0; i < roles.size(); ++i)
        if (roles[i].kind != static_cast<ObjectKind>(i) || (i > 0 && roles[i].version < roles[i - 1].version))
            return false;
    return true;
}
static_assert(in_order(object_kind_roles), "a row of object_kind_roles is out of place");

/// How many kinds a version of the format knows.
constexpr unsigned object_kinds_of(std::uint32_t version) {
    unsigned known = 0;
    for (const ObjectKindRole& role : object_kind_roles) known += role.version <= version;
    return known;
}

}  // namespace raycache::traces
