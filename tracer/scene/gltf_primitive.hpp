// One glTF mesh primitive as triangles, still in its own space; decoded once however often it is placed.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tracer/scene/gltf_accessor.hpp"
#include "tracer/scene/gltf_document.hpp"
#include "tracer/scene/gltf_materials.hpp"
#include "tracer/scene/gltf_skins.hpp"
#include "tracer/vec.hpp"

namespace raycache::tracer {

/// What was dropped or replaced on the way, summed over the file; each becomes at most one warning.
struct GltfLosses {
    std::uint64_t bad_triangles = 0;      ///< skipped, with a vertex that is not usable
    std::uint64_t bad_attributes = 0;     ///< normals, texture coordinates or colours that are not finite
    std::uint64_t clamped_colors = 0;     ///< beyond 0 to 1
    std::uint64_t points_and_lines = 0;   ///< primitives skipped
    std::uint64_t without_positions = 0;  ///< primitives skipped
    std::uint64_t without_texcoords = 0;  ///< textured primitives that lack the set their texture asks for
    std::uint64_t spare_corners = 0;      ///< indices or vertices that make no whole triangle
    std::uint64_t other_targets = 0;      ///< morph targets of what else than positions and normals
    std::uint64_t open_back_faces = 0;    ///< triangles of open single-sided meshes that show a camera their back
    void report(const GltfReport&) const;
};

/// A mesh as one node wants it.
struct GltfShape {
    int mesh = 0;
    int skin = -1;
    std::vector<double> weights;  ///< of its morph targets; may be shorter
    bool operator==(const GltfShape&) const = default;
};

/// What one morph target adds to each vertex, times its weight.
struct GltfTarget {
    double weight = 0;
    std::optional<GltfAccessor> positions, normals;
};

/// The validated accessors of a primitive and the number of triangles they make; nothing is decoded yet.
struct GltfPrimitiveSource {
    explicit GltfPrimitiveSource(GltfAccessor position_accessor) : positions(std::move(position_accessor)) {}

    GltfAccessor positions;
    std::optional<GltfAccessor> indices, normals, colors;
    std::vector<std::pair<GltfTexcoords, std::optional<GltfAccessor>>> texcoords;  ///< by layer
    std::vector<GltfTarget> targets;                                               ///< those with a weight
    std::shared_ptr<const GltfSkin> skin;
    std::vector<GltfAccessor> joints, weights;  ///< sets of four
    std::string where;
    int mode = 0;
    std::uint64_t triangles = 0;
    std::uint16_t material = 0;
};

/// Nothing for points, lines and primitives without positions. `layers`: of the material's textures. `skin`: null where
/// the shape has none.
std::optional<GltfPrimitiveSource> open_gltf_primitive(const GltfDocument&, const GltfShape&, std::size_t primitive,
                                                       const std::vector<GltfTexcoords>& layers, std::uint16_t material,
                                                       const std::shared_ptr<const GltfSkin>& skin, GltfLosses&,
                                                       const GltfReport&);

struct GltfPrimitive {
    std::vector<Vec3> positions;               ///< only vertices that a triangle uses, in the order of the file
    std::vector<Vec3> normals;                 ///< one per position or none
    std::vector<std::vector<Vec2>> texcoords;  ///< by layer, each one per position or none
    std::vector<VertexColor> colors;           ///< one per position, or none where all are white
    std::vector<std::uint32_t> indices;
    std::uint16_t material = 0;
};

/// Throws Error for an index out of range.
GltfPrimitive decode_gltf_primitive(const GltfPrimitiveSource&, GltfLosses&, const GltfReport&);

}  // namespace raycache::tracer
