#include "tracer/scene/gltf_primitive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace raycache::tracer {

namespace {

constexpr std::uint32_t unused = 0xFFFFFFFFU;

std::uint64_t triangles_of(int mode, std::uint64_t corners) {
    if (mode == TINYGLTF_MODE_TRIANGLES) return corners / 3;
    return corners < 3 ? 0 : corners - 2;
}

/// Positions, in the list of corners, of the three corners of a triangle; see the glTF specification, 3.7.2.1.
std::array<std::uint64_t, 3> corners_of(int mode, std::uint64_t triangle) {
    switch (mode) {
        case TINYGLTF_MODE_TRIANGLE_STRIP:
            return {triangle, triangle + 1 + triangle % 2, triangle + 2 - triangle % 2};
        case TINYGLTF_MODE_TRIANGLE_FAN:
            return {triangle + 1, triangle + 2, 0};
        default:
            return {3 * triangle, 3 * triangle + 1, 3 * triangle + 2};
    }
}

}  // namespace

void GltfLosses::report(const GltfReport& out) const {
    if (bad_triangles > 0)
        out.warning(fmt::format("skipped {} triangles with a vertex that is not finite or beyond {:g} m", bad_triangles,
                                max_coordinate));
    if (bad_attributes > 0)
        out.warning(fmt::format("{} normals or texture coordinates are not finite; replaced by the face normal or 0",
                                bad_attributes));
    if (points_and_lines > 0)
        out.warning(fmt::format("skipped {} primitives made of points or lines", points_and_lines));
    if (without_positions > 0)
        out.warning(fmt::format("skipped {} primitives without a POSITION attribute", without_positions));
    if (without_texcoords > 0)
        out.warning(
            fmt::format("{} textured primitives lack the texture coordinates their texture asks for; (0,0) used",
                        without_texcoords));
}

std::optional<GltfPrimitiveSource> open_gltf_primitive(const GltfDocument& document, int mesh, std::size_t primitive,
                                                       int texcoord_set, std::uint16_t material, GltfLosses& losses,
                                                       const GltfReport& report) {
    const auto& source = document.model.meshes[static_cast<std::size_t>(mesh)].primitives[primitive];
    const std::string where = fmt::format("mesh {} primitive {}", mesh, primitive);
    if (source.mode < TINYGLTF_MODE_POINTS || source.mode > TINYGLTF_MODE_TRIANGLE_FAN)
        report.fail(where, "a mode from 0 to 6", fmt::format("{}", source.mode));
    if (source.mode < TINYGLTF_MODE_TRIANGLES) {
        ++losses.points_and_lines;
        return std::nullopt;
    }
    const auto position = source.attributes.find("POSITION");
    if (position == source.attributes.end()) {
        ++losses.without_positions;
        return std::nullopt;
    }
    GltfPrimitiveSource result(GltfAccessor(document, position->second, 3, false, where + " POSITION", report));
    const std::uint64_t vertices = result.positions.count();
    if (vertices >= unused) report.fail(where, "less than 4294967295 vertices", fmt::format("{}", vertices));
    const auto open = [&](const std::string& name, int components) -> std::optional<GltfAccessor> {
        const auto found = source.attributes.find(name);
        if (found == source.attributes.end()) return std::nullopt;
        GltfAccessor accessor(document, found->second, components, false, where + " " + name, report);
        if (accessor.count() != vertices)
            report.fail(where + " " + name, fmt::format("{} elements, as many as POSITION", vertices),
                        fmt::format("{}", accessor.count()));
        return accessor;
    };
    result.normals = open("NORMAL", 3);
    if (texcoord_set >= 0) {
        result.texcoords = open(fmt::format("TEXCOORD_{}", texcoord_set), 2);
        if (!result.texcoords) ++losses.without_texcoords;
    }
    if (source.indices != -1) result.indices.emplace(document, source.indices, 1, true, where + " indices", report);
    result.mode = source.mode;
    result.material = material;
    result.triangles = triangles_of(source.mode, result.indices ? result.indices->count() : vertices);
    return result;
}

GltfPrimitive decode_gltf_primitive(const GltfPrimitiveSource& source, GltfLosses& losses, const GltfReport& report) {
    const std::uint64_t vertex_count = source.positions.count();
    GltfPrimitive result;
    result.material = source.material;
    result.indices.reserve(3 * source.triangles);
    std::uint32_t first = unused, last = 0;
    for (std::uint64_t t = 0; t < source.triangles; ++t) {
        std::array<std::uint32_t, 3> vertices{};
        bool usable = true;
        const auto corners = corners_of(source.mode, t);
        for (std::size_t k = 0; k < 3; ++k) {
            vertices[k] = source.indices ? source.indices->integer(corners[k]) : static_cast<std::uint32_t>(corners[k]);
            if (vertices[k] >= vertex_count)
                report.fail(fmt::format("triangle {} of a mesh", t), fmt::format("a vertex below {}", vertex_count),
                            fmt::format("{}", vertices[k]));
            usable = usable && is_usable_position(source.positions.vec3(vertices[k]));
        }
        if (!usable) {
            ++losses.bad_triangles;
            continue;
        }
        for (const std::uint32_t v : vertices) {
            first = std::min(first, v);
            last = std::max(last, v);
        }
        result.indices.insert(result.indices.end(), vertices.begin(), vertices.end());
    }
    if (result.indices.empty()) return result;

    // Several primitives may share one long accessor: keep, and look at, only what this one uses.
    std::vector<std::uint32_t> new_index(last - first + 1, unused);
    for (const std::uint32_t index : result.indices) new_index[index - first] = 0;
    for (std::uint32_t v = first; v <= last; ++v) {
        if (new_index[v - first] == unused) continue;
        new_index[v - first] = static_cast<std::uint32_t>(result.positions.size());
        result.positions.push_back(source.positions.vec3(v));
        if (source.normals) {
            Vec3 normal = source.normals->vec3(v);
            if (!is_finite(normal)) {
                ++losses.bad_attributes;
                normal = {0, 0, 0};
            }
            result.normals.push_back(normal);
        }
        if (source.texcoords) {
            Vec2 texcoord = source.texcoords->vec2(v);
            if (!std::isfinite(texcoord.x) || !std::isfinite(texcoord.y)) {
                ++losses.bad_attributes;
                texcoord = {0, 0};
            }
            result.texcoords.push_back(texcoord);
        }
    }
    for (std::uint32_t& index : result.indices) index = new_index[index - first];
    return result;
}

}  // namespace raycache::tracer
