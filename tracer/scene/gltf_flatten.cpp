#include "tracer/scene/gltf_flatten.hpp"

#include "tracer/scene/gltf_frame.hpp"

#include <fmt/format.h>
#include <algorithm>

namespace raycache::tracer {

namespace {

template <class T>
void append(std::vector<T>& list, std::size_t count, T value) {
    list.insert(list.end(), count, value);
}

bool is_within(Vec3 p, float limit) {
    return std::abs(p.x) <= limit && std::abs(p.y) <= limit && std::abs(p.z) <= limit;
}

/// Takes back the vertices from `first_vertex` on, appending instead those of the usable triangles, unshared. Rare:
/// it needs a transform that sends finite vertices beyond what we accept.
void append_usable_triangles(const GltfPrimitive& primitive, std::size_t first_vertex, bool turn, float limit,
                             Scene& scene, GltfLosses& losses) {
    const std::vector<Vec3> moved(scene.positions.begin() + static_cast<std::ptrdiff_t>(first_vertex),
                                  scene.positions.end());
    scene.positions.resize(first_vertex);
    const bool has_normals = !scene.normals.empty(), has_texcoords = !scene.texcoords.empty();
    const std::vector<Vec3> normals(scene.normals.begin() + static_cast<std::ptrdiff_t>(has_normals ? first_vertex : 0),
                                    scene.normals.end());
    const std::vector<Vec2> texcoords(
        scene.texcoords.begin() + static_cast<std::ptrdiff_t>(has_texcoords ? first_vertex : 0), scene.texcoords.end());
    const auto more = [&](auto& list) {  // what the moved vertices have of a list; none where it is empty
        const std::size_t first = std::min(first_vertex, list.size());
        const std::decay_t<decltype(list)> part(list.begin() + static_cast<std::ptrdiff_t>(first), list.end());
        list.resize(first);
        return part;
    };
    std::vector<std::vector<Vec2>> layers;
    for (auto& layer : scene.more_texcoords) layers.push_back(more(layer));
    const std::vector<VertexColor> colors = more(scene.colors);
    if (has_normals) scene.normals.resize(first_vertex);
    if (has_texcoords) scene.texcoords.resize(first_vertex);
    for (std::size_t t = 0; t + 2 < primitive.indices.size(); t += 3) {
        const std::uint32_t* corners = &primitive.indices[t];
        if (!std::all_of(corners, corners + 3, [&](std::uint32_t v) { return is_within(moved[v], limit); })) {
            ++losses.bad_triangles;
            continue;
        }
        for (const int k : {0, turn ? 2 : 1, turn ? 1 : 2}) {
            scene.indices.push_back(static_cast<std::uint32_t>(scene.positions.size()));
            scene.positions.push_back(moved[corners[k]]);
            if (has_normals) scene.normals.push_back(normals[corners[k]]);
            if (has_texcoords) scene.texcoords.push_back(texcoords[corners[k]]);
            for (std::size_t l = 0; l < layers.size(); ++l) scene.more_texcoords[l].push_back(layers[l][corners[k]]);
            if (!colors.empty()) scene.colors.push_back(colors[corners[k]]);
        }
        scene.material_of.push_back(primitive.material);
    }
}

/// What some placed primitive has, and so every vertex gets.
struct Attributes {
    bool normals = false, colors = false;
    std::size_t layers = 0;
};

/// The list that holds a layer of texture coordinates.
std::vector<Vec2>& layer_of(Scene& scene, std::size_t layer) {
    return layer == 0 ? scene.texcoords : scene.more_texcoords[layer - 1];
}

void append_primitive(const GltfPrimitive& primitive, const Transform& to_frame, const Attributes& with, Scene& scene,
                      GltfLosses& losses) {
    const std::size_t first_vertex = scene.positions.size(), count = primitive.positions.size();
    // Whatever the unit, a vertex beyond `max_coordinate` metres is refused.
    const auto limit = static_cast<float>(double{max_coordinate} / std::max(1.0, scene.frame.unit));
    bool usable = true;
    for (const Vec3 p : primitive.positions) {
        const Vec3 place = to_frame.point(p);
        usable = usable && is_within(place, limit);
        scene.positions.push_back(place);
    }
    if (with.normals && primitive.normals.empty()) append(scene.normals, count, Vec3{0, 0, 0});
    const NormalTransform turned(to_frame);
    for (const Vec3 n : primitive.normals) scene.normals.push_back(turned(n));
    for (std::size_t layer = 0; layer < with.layers; ++layer) {
        auto& list = layer_of(scene, layer);
        const bool has = layer < primitive.texcoords.size() && !primitive.texcoords[layer].empty();
        if (has)
            list.insert(list.end(), primitive.texcoords[layer].begin(), primitive.texcoords[layer].end());
        else
            append(list, count, Vec2{0, 0});
    }
    if (with.colors && primitive.colors.empty()) append(scene.colors, count, VertexColor{});
    scene.colors.insert(scene.colors.end(), primitive.colors.begin(), primitive.colors.end());

    const bool turn = to_frame.determinant() < 0;
    if (!usable) {
        append_usable_triangles(primitive, first_vertex, turn, limit, scene, losses);
        return;
    }
    const auto base = static_cast<std::uint32_t>(first_vertex);
    for (std::size_t t = 0; t + 2 < primitive.indices.size(); t += 3) {
        scene.indices.push_back(base + primitive.indices[t]);
        scene.indices.push_back(base + primitive.indices[t + (turn ? 2 : 1)]);
        scene.indices.push_back(base + primitive.indices[t + (turn ? 1 : 2)]);
    }
    append(scene.material_of, primitive.indices.size() / 3, primitive.material);
}

}  // namespace

void check_scene_size(const std::vector<GltfPlacement>& placements,
                      const std::vector<std::vector<GltfPrimitiveSource>>& sources, const GltfReport& report) {
    constexpr std::uint64_t triangle_bytes = 3 * sizeof(std::uint32_t) + sizeof(std::uint16_t);
    constexpr std::uint64_t plain_vertex_bytes = 2 * sizeof(Vec3) + sizeof(Vec2) + sizeof(std::uint32_t);
    std::uint64_t vertex_bytes = plain_vertex_bytes;
    std::size_t layers = 1;
    bool colors = false;
    for (const auto& mesh : sources)
        for (const auto& primitive : mesh) {
            layers = std::max(layers, primitive.texcoords.size());
            colors = colors || primitive.colors;
        }
    vertex_bytes += (layers - 1) * sizeof(Vec2) + (colors ? sizeof(VertexColor) : 0);
    constexpr std::uint64_t placement_bytes = 16;  // none in truth: bounds the time that placing nothing takes
    std::uint64_t triangles = 0, bytes = 0;
    const auto add = [&](const GltfPrimitiveSource& primitive) {
        const std::uint64_t vertices = std::min(primitive.positions.count(), 3 * primitive.triangles);
        triangles += primitive.triangles;
        bytes += primitive.triangles * triangle_bytes + vertices * vertex_bytes;
        if (triangles > max_scene_triangles)
            report.fail("scene", fmt::format("at most {} triangles", max_scene_triangles), "more",
                        "export a part of the scene");
    };
    for (const auto& mesh : sources)
        for (const auto& primitive : mesh) add(primitive);  // each is decoded once
    triangles = 0;
    for (const GltfPlacement& placement : placements)
        for (const auto& primitive : sources[static_cast<std::size_t>(placement.object)]) {
            add(primitive);
            bytes += placement_bytes;
            if (bytes > report.memory()->left()) break;  // enough to refuse it; there may be many more
        }
    report.charge(bytes, fmt::format("its {} triangles", triangles));
}

void flatten_gltf_meshes(const std::vector<GltfPlacement>& placements,
                         const std::vector<std::vector<GltfPrimitive>>& meshes, Scene& scene, GltfLosses& losses) {
    std::size_t vertices = 0, indices = 0;
    Attributes with;
    for (const GltfPlacement& placement : placements) {
        for (const GltfPrimitive& primitive : meshes[static_cast<std::size_t>(placement.object)]) {
            vertices += primitive.positions.size();
            indices += primitive.indices.size();
            with.normals = with.normals || !primitive.normals.empty();
            with.colors = with.colors || !primitive.colors.empty();
            for (std::size_t layer = 0; layer < primitive.texcoords.size(); ++layer)
                if (!primitive.texcoords[layer].empty()) with.layers = std::max(with.layers, layer + 1);
        }
    }
    scene.positions.reserve(vertices);
    if (with.normals) scene.normals.reserve(vertices);
    if (with.colors) scene.colors.reserve(vertices);
    scene.more_texcoords.resize(with.layers > 1 ? with.layers - 1 : 0);
    for (std::size_t layer = 0; layer < with.layers; ++layer) layer_of(scene, layer).reserve(vertices);
    scene.indices.reserve(indices);
    scene.material_of.reserve(indices / 3);
    for (const GltfPlacement& placement : placements)
        for (const GltfPrimitive& primitive : meshes[static_cast<std::size_t>(placement.object)])
            append_primitive(primitive, in_frame(placement.to_world, scene.frame), with, scene, losses);
}

}  // namespace raycache::tracer
