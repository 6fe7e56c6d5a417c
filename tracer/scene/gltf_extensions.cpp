#include "tracer/scene/gltf_extensions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace raycache::tracer {

namespace {

using nlohmann::json;

enum class Support {
    full,
    look,     ///< left out; what is seen differs
    nothing,  ///< left out; a picture at rest is the same
    missing   ///< left out; geometry is missing
};

struct Extension {
    std::string_view name;
    Support support;
    std::string_view lost{};  ///< words for what the picture lacks, or for the remedy where geometry is missing
};

constexpr Extension extensions[] = {
    {"EXT_mesh_gpu_instancing", Support::full},
    {"EXT_meshopt_compression", Support::full},
    {"EXT_texture_webp", Support::full},
    {"KHR_draco_mesh_compression", Support::full},
    {"KHR_lights_punctual", Support::full},
    {"KHR_materials_emissive_strength", Support::full},
    {"KHR_materials_ior", Support::full},
    {"KHR_materials_transmission", Support::full},
    {"KHR_materials_volume", Support::full},
    {"KHR_mesh_quantization", Support::full},
    {"KHR_node_visibility", Support::full},
    {"KHR_texture_transform", Support::full},

    {"ADOBE_materials_clearcoat_specular", Support::look, "the coat's reflectance"},
    {"ADOBE_materials_clearcoat_tint", Support::look, "tinted coats"},
    {"ADOBE_materials_thin_transparency", Support::look, "thin glass is opaque"},
    {"AGI_stk_metadata", Support::nothing},
    {"AGI_articulations", Support::nothing},
    {"CESIUM_primitive_outline", Support::look, "outlines"},
    {"CESIUM_RTC", Support::look, "the place on the globe"},
    {"EXT_feature_metadata", Support::nothing},
    {"EXT_instance_features", Support::nothing},
    {"EXT_lights_ies", Support::look, "lights of measured shape"},
    {"EXT_lights_image_based", Support::look, "light of the environment"},
    {"EXT_mesh_features", Support::nothing},
    {"EXT_mesh_manifold", Support::nothing},
    {"EXT_property_animation", Support::nothing},
    {"EXT_structural_metadata", Support::nothing},
    {"EXT_texture_avif", Support::look, "AVIF images, unless a texture names another as well"},
    {"FB_geometry_metadata", Support::nothing},
    {"FB_materials_modmap", Support::look, "modulation maps"},
    {"GODOT_single_root", Support::nothing},
    {"GRIFFEL_bim_data", Support::nothing},
    {"KHR_animation_pointer", Support::nothing},
    {"KHR_audio_emitter", Support::nothing},
    {"KHR_environment_map", Support::look, "light of the environment"},
    {"KHR_implicit_shapes", Support::nothing},
    {"KHR_interactivity", Support::nothing},
    {"KHR_lights_environment", Support::look, "light of the environment"},
    {"KHR_materials_anisotropy", Support::look, "brushed highlights"},
    {"KHR_materials_clearcoat", Support::look, "clear coats"},
    {"KHR_materials_coat", Support::look, "clear coats"},
    {"KHR_materials_diffuse_transmission", Support::look, "light through thin matter"},
    {"KHR_materials_dispersion", Support::look, "colours of prisms"},
    {"KHR_materials_iridescence", Support::look, "iridescence"},
    {"KHR_materials_pbrSpecularGlossiness", Support::look,
     "its specular textures; diffuse colour, its texture and glossiness are used"},
    {"KHR_materials_sheen", Support::look, "sheen"},
    {"KHR_materials_specular", Support::look, "specular strength and tint"},
    {"KHR_materials_subsurface", Support::look, "light inside matter"},
    {"KHR_materials_unlit", Support::look, "unlit materials are lit like others"},
    {"KHR_materials_variants", Support::look, "variants; materials are the default ones"},
    {"KHR_materials_volume_scatter", Support::look, "light inside matter"},
    {"KHR_node_hoverability", Support::nothing},
    {"KHR_node_selectability", Support::nothing},
    {"KHR_physics_rigid_bodies", Support::nothing},
    {"KHR_techniques_webgl", Support::look, "its shaders; materials are glTF's default"},
    {"KHR_texture_basisu", Support::look, "KTX2 images, unless a texture names another as well"},
    {"KHR_texture_procedurals", Support::look, "procedural textures"},
    {"KHR_xmp", Support::nothing},
    {"KHR_xmp_json_ld", Support::nothing},
    {"MSFT_lod", Support::nothing},
    {"MSFT_packing_normalRoughnessMetallic", Support::look, "packed textures"},
    {"MSFT_packing_occlusionRoughnessMetallic", Support::look, "packed textures"},
    {"MSFT_texture_dds", Support::look, "DDS images, unless a texture names another as well"},
    {"MPEG_media", Support::look, "media"},
    {"NV_materials_mdl", Support::look, "materials of MDL"},
    {"VRM", Support::look, "the look of its materials"},
    {"VRMC_materials_hdr_emissiveMultiplier", Support::look, "strength of emission"},
    {"VRMC_materials_mtoon", Support::look, "the look of cartoons"},
    {"VRMC_node_constraint", Support::nothing},
    {"VRMC_springBone", Support::nothing},
    {"VRMC_vrm", Support::nothing},

    {"KHR_meshopt_compression", Support::missing, "decompress it, as `gltf-transform copy IN OUT` does"},
};

const Extension* find_extension(const std::string& name) {
    const auto* found = std::find_if(std::begin(extensions), std::end(extensions),
                                     [&](const Extension& extension) { return extension.name == name; });
    return found == std::end(extensions) ? nullptr : found;
}

std::vector<std::string> extension_names(const json& document, const char* key) {
    const auto array = document.find(key);
    return array == document.end() ? std::vector<std::string>{} : array->get<std::vector<std::string>>();
}

}  // namespace

void check_gltf_extensions(const json& document, const GltfReport& report) {
    const std::vector<std::string> required = extension_names(document, "extensionsRequired");
    for (const std::string& name : required) {
        const Extension* known = find_extension(name);
        if (known && known->support != Support::missing) continue;
        report.fail("extensionsRequired", "extensions that raycache reads (docs/scenes.md lists them)", name,
                    known ? std::string(known->lost) : "it may hold geometry; export the scene without it");
    }
    std::vector<std::string> used = extension_names(document, "extensionsUsed");
    for (const std::string& name : required)
        if (std::find(used.begin(), used.end(), name) == used.end()) used.push_back(name);
    std::vector<std::string> ignored;
    for (const std::string& name : used) {
        const Extension* known = find_extension(name);
        if (known && (known->support == Support::full || known->support == Support::nothing)) continue;
        ignored.push_back(known && known->support == Support::look ? fmt::format("{} ({})", name, known->lost) : name);
    }
    if (!ignored.empty())
        report.warning(fmt::format("ignored extensions; what the picture lacks or has otherwise, in brackets: {}",
                                   fmt::join(ignored, ", ")));
}

}  // namespace raycache::tracer
