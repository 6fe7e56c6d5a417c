// load_gltf(): the stages of reading a glTF file, in order.
#include <fmt/format.h>
#include <xxhash.h>

#include <filesystem>
#include <memory>
#include <new>
#include <stdexcept>

#include "tracer/scene/gltf_cameras.hpp"
#include "tracer/scene/gltf_document.hpp"
#include "tracer/scene/gltf_flatten.hpp"
#include "tracer/scene/gltf_materials.hpp"
#include "tracer/scene/gltf_nodes.hpp"
#include "tracer/scene/gltf_primitive.hpp"
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

/// For each mesh of the file, whether it is placed.
std::vector<bool> placed_meshes(const tinygltf::Model& model, const std::vector<GltfPlacement>& placements) {
    std::vector<bool> placed(model.meshes.size(), false);
    for (const GltfPlacement& placement : placements) placed[static_cast<std::size_t>(placement.object)] = true;
    return placed;
}

std::vector<bool> used_materials(const tinygltf::Model& model, const std::vector<bool>& placed,
                                 const GltfReport& report) {
    std::vector<bool> used(model.materials.size() + 1, false);
    for (std::size_t m = 0; m < placed.size(); ++m)
        for (const tinygltf::Primitive& primitive : model.meshes[m].primitives)
            if (placed[m]) used[material_index(model, static_cast<int>(m), primitive, report)] = true;
    return used;
}

std::vector<std::vector<GltfPrimitiveSource>> open_meshes(const GltfDocument& document, const std::vector<bool>& placed,
                                                          const std::vector<int>& texcoord_set, GltfLosses& losses,
                                                          const GltfReport& report) {
    std::vector<std::vector<GltfPrimitiveSource>> result(placed.size());
    for (std::size_t m = 0; m < placed.size(); ++m) {
        if (!placed[m]) continue;
        const auto& primitives = document.model.meshes[m].primitives;
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            const auto mesh = static_cast<int>(m);
            const std::size_t material = material_index(document.model, mesh, primitives[p], report);
            auto opened = open_gltf_primitive(document, mesh, p, texcoord_set[material],
                                              static_cast<std::uint16_t>(material), losses, report);
            if (opened) result[m].push_back(std::move(*opened));
        }
    }
    return result;
}

std::vector<std::vector<GltfPrimitive>> decode_meshes(const std::vector<std::vector<GltfPrimitiveSource>>& sources,
                                                      GltfLosses& losses, const GltfReport& report) {
    std::vector<std::vector<GltfPrimitive>> result(sources.size());
    for (std::size_t m = 0; m < sources.size(); ++m)
        for (const GltfPrimitiveSource& source : sources[m])
            result[m].push_back(decode_gltf_primitive(source, losses, report));
    return result;
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
                          bytes_of(scene.indices) + bytes_of(scene.material_of);
    for (const Texture& texture : scene.textures) bytes += bytes_of(texture.rgba);
    return bytes;
}

Scene load(const GltfReport& report) {
    const GltfDocument document = read_gltf_document(report);
    const GltfNodes nodes = place_gltf_nodes(document, report);
    const std::vector<bool> placed = placed_meshes(document.model, nodes.meshes);
    GltfMaterials materials = read_gltf_materials(document, used_materials(document.model, placed, report), report);

    Scene scene;
    scene.memory = report.memory();
    scene.name = std::filesystem::path(report.path()).filename().string();
    scene.materials = std::move(materials.materials);
    GltfLosses losses;
    {
        const auto sources = open_meshes(document, placed, materials.texcoord_set, losses, report);
        check_scene_size(nodes.meshes, sources, report);
        flatten_gltf_meshes(nodes.meshes, decode_meshes(sources, losses, report), scene, losses);
    }
    losses.report(report);
    if (scene.triangle_count() == 0)
        report.fail("scene", "at least one triangle with finite vertices", "none",
                    "export its meshes as triangles into the default scene");

    const std::vector<GltfImageBytes> images = read_gltf_images(document, materials.images, report);
    scene.hash = hash_of(document, images);
    scene.files = document.files;
    scene.files.push_back(report.path());
    for (const GltfImageBytes& image : images)
        if (!image.file.empty()) scene.files.push_back(image.file);
    scene.textures = decode_gltf_textures(images, scene.materials, report);
    scene.cameras = read_gltf_cameras(document, nodes.cameras, report);
    if (scene.cameras.empty()) scene.cameras.push_back(overview_camera(scene.bounds()));
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
