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

/// Corners that the mode leaves over, or all where they are too few for one triangle.
std::uint64_t spare_corners(int mode, std::uint64_t corners) {
    if (mode == TINYGLTF_MODE_TRIANGLES) return corners % 3;
    return corners < 3 ? corners : 0;
}

/// Targets that have a weight, and what they hold that is not used.
void open_targets(const GltfDocument& document, const tinygltf::Primitive& source, const GltfShape& shape,
                  GltfPrimitiveSource& result, GltfLosses& losses, const GltfReport& report) {
    for (std::size_t t = 0; t < source.targets.size() && t < shape.weights.size(); ++t) {
        if (shape.weights[t] == 0) continue;
        GltfTarget target;
        target.weight = shape.weights[t];
        for (const auto& [name, index] : source.targets[t]) {
            const std::string what = fmt::format("{} target {} {}", result.where, t, name);
            auto* slot = name == "POSITION" ? &target.positions : name == "NORMAL" ? &target.normals : nullptr;
            if (!slot) {
                losses.other_targets += name != "TANGENT";
                continue;
            }
            slot->emplace(document, index, 3, false, what, report);
            if ((*slot)->count() != result.positions.count())
                report.fail(what, fmt::format("{} elements, as many as POSITION", result.positions.count()),
                            fmt::format("{}", (*slot)->count()));
        }
        result.targets.push_back(std::move(target));
    }
}

Vec3 with_targets(Vec3 base, const GltfPrimitiveSource& source, std::uint64_t v,
                  const std::optional<GltfAccessor> GltfTarget::*what) {
    if (source.targets.empty()) return base;
    double x = base.x, y = base.y, z = base.z;
    for (const GltfTarget& target : source.targets) {
        if (!(target.*what)) continue;
        const Vec3 more = (target.*what)->vec3(v);
        x += target.weight * more.x;
        y += target.weight * more.y;
        z += target.weight * more.z;
    }
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

VertexColor color_at(const GltfAccessor& accessor, std::uint64_t v, GltfLosses& losses) {
    std::array<float, 4> c = accessor.vec4(v);
    if (!std::all_of(c.begin(), c.end(), [](float f) { return std::isfinite(f); })) {
        ++losses.bad_attributes;
        c = {1, 1, 1, 1};
    }
    bool clamped = false;
    for (float& f : c) {
        const float kept = std::clamp(f, 0.0F, 1.0F);
        clamped = clamped || kept != f;
        f = kept;
    }
    losses.clamped_colors += clamped;
    return {{c[0], c[1], c[2]}, c[3]};
}

}  // namespace

void GltfLosses::report(const GltfReport& out) const {
    if (bad_triangles > 0)
        out.warning(fmt::format("skipped {} triangles with a vertex that is not finite or beyond {:g} m", bad_triangles,
                                max_coordinate));
    if (bad_attributes > 0)
        out.warning(
            fmt::format("{} normals, texture coordinates or colours are not finite; replaced by the face "
                        "normal, 0 or white",
                        bad_attributes));
    if (points_and_lines > 0)
        out.warning(fmt::format("skipped {} primitives made of points or lines", points_and_lines));
    if (without_positions > 0)
        out.warning(fmt::format("skipped {} primitives without a POSITION attribute", without_positions));
    if (without_texcoords > 0)
        out.warning(
            fmt::format("{} textured primitives lack the texture coordinates their texture asks for; (0,0) used",
                        without_texcoords));
    if (clamped_colors > 0)
        out.warning(
            fmt::format("{} colours of vertices are beyond 0 to 1; the nearest in it are used", clamped_colors));
    if (spare_corners > 0)
        out.warning(fmt::format("{} indices or vertices at the end of primitives make no whole triangle; left out",
                                spare_corners));
    if (other_targets > 0)
        out.warning(
            fmt::format("{} morph targets of attributes other than POSITION and NORMAL are left out", other_targets));
    if (open_back_faces > 0)
        out.warning(
            fmt::format("{} triangles show a camera the back of an open, single-sided mesh; both sides of a "
                        "surface are there (glTF's doubleSided: false would hide them)",
                        open_back_faces));
}

std::optional<GltfPrimitiveSource> open_gltf_primitive(const GltfDocument& document, const GltfShape& shape,
                                                       std::size_t primitive, const std::vector<GltfTexcoords>& layers,
                                                       std::uint16_t material,
                                                       const std::shared_ptr<const GltfSkin>& skin, GltfLosses& losses,
                                                       const GltfReport& report) {
    const auto& source = document.model.meshes[static_cast<std::size_t>(shape.mesh)].primitives[primitive];
    const std::string where = fmt::format("mesh {} primitive {}", shape.mesh, primitive);
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
    result.where = where;
    const std::uint64_t vertices = result.positions.count();
    const auto not_empty = [&](std::uint64_t count, int accessor, const char* what) {
        if (count == 0)
            report.fail(fmt::format("accessor {} ({} {})", accessor, where, what), "a count of 1 or more", "0");
    };
    not_empty(vertices, position->second, "POSITION");
    if (vertices >= unused) report.fail(where, "less than 4294967295 vertices", fmt::format("{}", vertices));
    const auto open = [&](const std::string& name, int components, bool integers) -> std::optional<GltfAccessor> {
        const auto found = source.attributes.find(name);
        if (found == source.attributes.end()) return std::nullopt;
        GltfAccessor accessor(document, found->second, components, integers, where + " " + name, report);
        if (accessor.count() != vertices)
            report.fail(where + " " + name, fmt::format("{} elements, as many as POSITION", vertices),
                        fmt::format("{}", accessor.count()));
        return accessor;
    };
    result.normals = open("NORMAL", 3, false);
    result.colors = open("COLOR_0", 0, false);
    bool lacks_texcoords = false;
    for (const GltfTexcoords& layer : layers) {
        result.texcoords.emplace_back(layer, open(fmt::format("TEXCOORD_{}", layer.set), 2, false));
        lacks_texcoords = lacks_texcoords || !result.texcoords.back().second;
    }
    losses.without_texcoords += lacks_texcoords;
    open_targets(document, source, shape, result, losses, report);
    for (int set = 0; skin; ++set) {
        auto joints = open(fmt::format("JOINTS_{}", set), 4, true);
        auto weights = open(fmt::format("WEIGHTS_{}", set), 4, false);
        if (!joints || !weights) break;
        result.skin = skin;
        result.joints.push_back(std::move(*joints));
        result.weights.push_back(std::move(*weights));
    }
    if (source.indices != -1) {
        result.indices.emplace(document, source.indices, 1, true, where + " indices", report);
        not_empty(result.indices->count(), source.indices, "indices");
    }
    result.mode = source.mode;
    result.material = material;
    const std::uint64_t corners = result.indices ? result.indices->count() : vertices;
    result.triangles = triangles_of(source.mode, corners);
    losses.spare_corners += spare_corners(source.mode, corners);
    return result;
}

GltfPrimitive decode_gltf_primitive(const GltfPrimitiveSource& source, GltfLosses& losses, const GltfReport& report) {
    const std::uint64_t vertex_count = source.positions.count();
    GltfPrimitive result;
    result.material = source.material;
    result.indices.reserve(3 * source.triangles);
    const auto position_at = [&](std::uint64_t v) {
        return with_targets(source.positions.vec3(v), source, v, &GltfTarget::positions);
    };
    std::uint32_t first = unused, last = 0;
    for (std::uint64_t t = 0; t < source.triangles; ++t) {
        std::array<std::uint32_t, 3> vertices{};
        bool usable = true;
        const auto corners = corners_of(source.mode, t);
        for (std::size_t k = 0; k < 3; ++k) {
            vertices[k] = source.indices ? source.indices->integer(corners[k]) : static_cast<std::uint32_t>(corners[k]);
            if (vertices[k] >= vertex_count)
                report.fail(fmt::format("{} triangle {}", source.where, t),
                            fmt::format("a vertex below {}", vertex_count), fmt::format("{}", vertices[k]),
                            GltfReport::damaged);
            usable = usable && is_usable_position(position_at(vertices[k]));
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
    result.texcoords.resize(source.texcoords.size());
    for (std::uint32_t v = first; v <= last; ++v) {
        if (new_index[v - first] == unused) continue;
        new_index[v - first] = static_cast<std::uint32_t>(result.positions.size());
        result.positions.push_back(position_at(v));
        if (source.normals) {
            Vec3 normal = with_targets(source.normals->vec3(v), source, v, &GltfTarget::normals);
            if (!is_finite(normal)) {
                ++losses.bad_attributes;
                normal = {0, 0, 0};
            }
            result.normals.push_back(normal);
        }
        for (std::size_t layer = 0; layer < source.texcoords.size(); ++layer) {
            const auto& [use, accessor] = source.texcoords[layer];
            if (!accessor) continue;
            Vec2 texcoord = use(accessor->vec2(v));
            if (!std::isfinite(texcoord.x) || !std::isfinite(texcoord.y)) {
                ++losses.bad_attributes;
                texcoord = {0, 0};
            }
            result.texcoords[layer].push_back(texcoord);
        }
        if (source.colors) result.colors.push_back(color_at(*source.colors, v, losses));
        if (source.skin)
            bend_vertex(*source.skin, source.joints, source.weights, v, result.positions.back(),
                        result.normals.empty() ? nullptr : &result.normals.back(), source.where, report);
    }
    if (std::all_of(result.colors.begin(), result.colors.end(),
                    [](const VertexColor& c) { return c == VertexColor{}; }))
        result.colors.clear();
    for (std::uint32_t& index : result.indices) index = new_index[index - first];
    return result;
}

}  // namespace raycache::tracer
