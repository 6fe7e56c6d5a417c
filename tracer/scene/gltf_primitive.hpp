// One glTF mesh primitive as triangles, still in its own space; decoded once however often it is placed.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "tracer/scene/gltf_accessor.hpp"
#include "tracer/scene/gltf_document.hpp"
#include "tracer/vec.hpp"

namespace raycache::tracer {

/// What was dropped or replaced on the way, summed over the file; each becomes at most one warning.
struct GltfLosses {
    std::uint64_t bad_triangles = 0;      ///< skipped, with a vertex that is not usable
    std::uint64_t bad_attributes = 0;     ///< normals or texture coordinates that are not finite
    std::uint64_t points_and_lines = 0;   ///< primitives skipped
    std::uint64_t without_positions = 0;  ///< primitives skipped
    std::uint64_t without_texcoords = 0;  ///< textured primitives that lack the set their texture asks for
    void report(const GltfReport&) const;
};

/// The validated accessors of a primitive and the number of triangles they make; nothing is decoded yet.
struct GltfPrimitiveSource {
    explicit GltfPrimitiveSource(GltfAccessor position_accessor) : positions(std::move(position_accessor)) {}

    GltfAccessor positions;
    std::optional<GltfAccessor> indices, normals, texcoords;
    int mode = 0;
    std::uint64_t triangles = 0;
    std::uint16_t material = 0;
};

/// Nothing for points, lines and primitives without positions. `texcoord_set` is -1 where no texture needs one.
std::optional<GltfPrimitiveSource> open_gltf_primitive(const GltfDocument&, int mesh, std::size_t primitive,
                                                       int texcoord_set, std::uint16_t material, GltfLosses&,
                                                       const GltfReport&);

struct GltfPrimitive {
    std::vector<Vec3> positions;  ///< only vertices that a triangle uses, in the order of the file
    std::vector<Vec3> normals;    ///< one per position or none
    std::vector<Vec2> texcoords;  ///< one per position or none
    std::vector<std::uint32_t> indices;
    std::uint16_t material = 0;
};

/// Throws Error for an index out of range.
GltfPrimitive decode_gltf_primitive(const GltfPrimitiveSource&, GltfLosses&, const GltfReport&);

}  // namespace raycache::tracer
