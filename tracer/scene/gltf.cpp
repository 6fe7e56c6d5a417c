// load_gltf(): the stages of reading a glTF file, in order.
#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <new>
#include <stdexcept>

#include "tracer/scene/emission.hpp"
#include "tracer/scene/gltf_cameras.hpp"
#include "tracer/scene/gltf_document.hpp"
#include "tracer/scene/gltf_flatten.hpp"
#include "tracer/scene/gltf_frame.hpp"
#include "tracer/scene/gltf_lights.hpp"
#include "tracer/scene/gltf_materials.hpp"
#include "tracer/scene/gltf_nodes.hpp"
#include "tracer/scene/gltf_primitive.hpp"
#include "tracer/scene/gltf_sides.hpp"
#include "tracer/scene/gltf_skins.hpp"
#include "tracer/scene/gltf_textures.hpp"
#include "tracer/scene/scene.hpp"

namespace raycache::tracer {

namespace {

/// Index of a primitive's material; the one past the file's own is glTF's default.
std::size_t material_index(const tinygltf::Model& model, int mesh, const tinygltf::Primitive& primitive,
                           const GltfReport& report) {
    if (primitive.material == -1) return model.materials.size();
    if (primitive.material < 0 || static_cast<std::size_t>(primitive.material) >= model.materials.size())
        report.fail(fmt::format("mesh {}", mesh), fmt::format("a material below {}", model.materials.size()),
                    fmt::format("{}", primitive.material));
    return static_cast<std::size_t>(primitive.material);
}

std::vector<bool> used_materials(const tinygltf::Model& model, const std::vector<GltfShape>& shapes,
                                 const GltfReport& report) {
    std::vector<bool> used(model.materials.size() + 1, false);
    for (const GltfShape& shape : shapes)
        for (const tinygltf::Primitive& primitive : model.meshes[static_cast<std::size_t>(shape.mesh)].primitives)
            used[material_index(model, shape.mesh, primitive, report)] = true;
    return used;
}

/// By shape.
std::vector<std::vector<GltfPrimitiveSource>> open_shapes(const GltfDocument& document,
                                                          const std::vector<GltfShape>& shapes,
                                                          const std::vector<std::vector<GltfTexcoords>>& texcoords,
                                                          GltfLosses& losses, const GltfReport& report) {
    std::vector<std::shared_ptr<const GltfSkin>> skins;
    for (GltfSkin& skin : read_gltf_skins(document, report))
        skins.push_back(std::make_shared<const GltfSkin>(std::move(skin)));
    std::vector<std::vector<GltfPrimitiveSource>> result(shapes.size());
    for (std::size_t s = 0; s < shapes.size(); ++s) {
        const GltfShape& shape = shapes[s];
        const auto& primitives = document.model.meshes[static_cast<std::size_t>(shape.mesh)].primitives;
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            const std::size_t material = material_index(document.model, shape.mesh, primitives[p], report);
            auto opened = open_gltf_primitive(
                document, shape, p, texcoords[material], static_cast<std::uint16_t>(material),
                shape.skin == -1 ? nullptr : skins[static_cast<std::size_t>(shape.skin)], losses, report);
            if (opened) result[s].push_back(std::move(*opened));
        }
    }
    return result;
}

/// By shape, as the sources are.
std::vector<std::vector<GltfPrimitive>> decode_shapes(const std::vector<std::vector<GltfPrimitiveSource>>& sources,
                                                      GltfLosses& losses, const GltfReport& report) {
    std::vector<std::vector<GltfPrimitive>> result(sources.size());
    for (std::size_t s = 0; s < sources.size(); ++s)
        for (const GltfPrimitiveSource& source : sources[s])
            result[s].push_back(decode_gltf_primitive(source, losses, report));
    return result;
}

/// Materials whose alpha counts, where vertices have one.
void mark_vertex_alpha(const std::vector<std::vector<GltfPrimitive>>& shapes, const std::vector<bool>& blended,
                       std::vector<Material>& materials) {
    for (const auto& primitives : shapes)
        for (const GltfPrimitive& primitive : primitives) {
            Material& material = materials[primitive.material];
            if (!material.alpha_mask && !blended[primitive.material]) continue;
            const bool has_alpha = std::any_of(primitive.colors.begin(), primitive.colors.end(),
                                               [](const VertexColor& color) { return color.alpha != 1; });
            material.vertex_alpha = material.vertex_alpha || has_alpha;
            material.alpha_blend = material.alpha_blend || (has_alpha && blended[primitive.material]);
        }
}

void check_not_empty(const Scene& scene, const GltfReport& report) {
    if (scene.triangle_count() == 0)
        report.fail("scene", "at least one triangle with finite vertices", "none",
                    "export its meshes as triangles into the default scene");
    for (std::size_t t = 0; t < scene.triangle_count(); ++t)
        if (has_area(scene, t)) return;
    report.fail("scene", "at least one triangle with an area",
                fmt::format("{} whose corners lie in a line or point", scene.triangle_count()),
                "export its meshes as they are seen");
}

std::uint64_t hash_of(const GltfDocument& document, const std::vector<GltfImageBytes>& images) {
    const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state(XXH3_createState(), XXH3_freeState);
    if (!state) throw std::bad_alloc();
    XXH3_64bits_reset(state.get());
    const auto add = [&](std::span<const std::uint8_t> bytes) {
        XXH3_64bits_update(state.get(), bytes.data(), bytes.size());
    };
    add(document.container.bytes);
    for (const auto bytes : document.external_buffers) add(bytes);
    for (const GltfImageBytes& image : images)
        if (!image.file.empty()) add(image.bytes);
    return XXH3_64bits_digest(state.get());
}

template <class T>
std::uint64_t bytes_of(const std::vector<T>& list) {
    return list.capacity() * sizeof(T);
}

/// What stays in memory of the scene.
std::uint64_t bytes_of(const Scene& scene) {
    std::uint64_t bytes = bytes_of(scene.positions) + bytes_of(scene.normals) + bytes_of(scene.texcoords) +
                          bytes_of(scene.indices) + bytes_of(scene.material_of) + bytes_of(scene.colors);
    for (const auto& layer : scene.more_texcoords) bytes += bytes_of(layer);
    for (const Texture& texture : scene.textures) bytes += bytes_of(texture.rgba);
    return bytes;
}

Scene load(const GltfReport& report) {
    const GltfDocument document = read_gltf_document(report);
    const GltfNodes nodes = place_gltf_nodes(document, report);
    GltfMaterials materials =
        read_gltf_materials(document, used_materials(document.model, nodes.shapes, report), report);

    Scene scene;
    scene.memory = report.memory();
    scene.name = std::filesystem::path(report.path()).filename().string();
    scene.materials = std::move(materials.materials);
    GltfLosses losses;
    {
        const auto sources = open_shapes(document, nodes.shapes, materials.texcoords, losses, report);
        check_scene_size(nodes.meshes, sources, report);
        const auto meshes = decode_shapes(sources, losses, report);
        mark_vertex_alpha(meshes, materials.blended, scene.materials);
        const GltfPlacedMeshes placed_meshes{nodes.meshes, meshes};
        const GltfFrame frame = choose_gltf_frame(placed_meshes, nodes.cameras, document);
        report_coarse_places(placed_meshes, frame, report);
        scene.frame = frame.frame;
        flatten_gltf_meshes(nodes.meshes, meshes, scene, losses);
        scene.cameras = read_gltf_cameras(document, nodes.cameras, scene.frame, report);
        if (scene.cameras.empty() && scene.triangle_count() > 0)
            scene.cameras.push_back(overview_camera(box_in_view(scene, report), scene.frame));
        losses.open_back_faces = count_open_back_faces(scene, nodes.meshes, meshes, materials.double_sided);
    }
    losses.report(report);
    check_not_empty(scene, report);

    const std::vector<GltfImageBytes> images = read_gltf_images(document, materials.images, report);
    scene.hash = hash_of(document, images);
    scene.files = document.files;
    scene.files.push_back(report.path());
    for (const GltfImageBytes& image : images)
        if (!image.file.empty()) scene.files.push_back(image.file);
    scene.textures = decode_gltf_textures(images, scene.materials, report);
    scene.punctual_lights = read_gltf_lights(document, nodes.lights, scene.frame, report);
    const std::uint64_t used = scene.memory->used(), kept = bytes_of(scene);
    if (used > kept) scene.memory->release(used - kept);  // the file itself is no longer needed
    return scene;
}

}  // namespace

Scene load_gltf(const std::string& path, const Warn& warn) {
    const GltfReport report(path, warn);
    try {
        return load(report);
    } catch (const std::bad_alloc&) {
        report.fail("scene", "to fit into memory", "too little of it", "close other programs or use a smaller scene");
    } catch (const std::length_error&) {
        report.fail("scene", "to fit into memory", "a size beyond any memory");
    }
}

}  // namespace raycache::tracer
