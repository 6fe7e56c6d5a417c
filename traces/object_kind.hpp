// Kinds of objects that a trace accesses.
#pragma once

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
};
inline constexpr unsigned object_kinds = 10;
inline constexpr unsigned object_kinds_of_version_1 = 3;

constexpr bool is_write(ObjectKind kind) {
    return kind >= ObjectKind::ray_state_write && kind <= ObjectKind::queue_write;
}

/// "node", "ray state", "ray state write", …
const char* name_of(ObjectKind);

}  // namespace raycache::traces
