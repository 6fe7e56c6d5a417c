#include "tracer/scene/gltf_materials.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace raycache::tracer {

namespace {

/// Materials that are treated otherwise than their author meant; each kind becomes at most one warning.
struct Approximations {
    std::size_t blended = 0, emissive_textures = 0, clamped = 0, missing_images = 0;
    void report(const GltfReport& out) const {
        if (blended > 0)
            out.warning(fmt::format("{} materials have alphaMode BLEND; they are rendered opaque", blended));
        if (emissive_textures > 0)
            out.warning(fmt::format("{} materials have an emissive texture; it is ignored and the emissive factor used",
                                    emissive_textures));
        if (clamped > 0)
            out.warning(fmt::format("{} materials have a texture that clamps or mirrors; it is repeated", clamped));
        if (missing_images > 0)
            out.warning(
                fmt::format("{} materials have a texture without an image we can read; the base colour factor "
                            "alone is used",
                            missing_images));
    }
};

float unit_interval(double value) { return static_cast<float>(std::clamp(value, 0.0, 1.0)); }

class MaterialReader {
public:
    MaterialReader(const GltfDocument& document, const GltfReport& report)
        : model_(document.model), images_(document.images.size()), report_(report), slot_of_image_(images_, -1) {}

    void add(std::size_t index, bool used) {
        const tinygltf::Material& source = model_.materials[index];
        const std::string where = fmt::format("material {}", index);
        Material material;
        material.name = one_line(source.name);
        const auto& factor = source.pbrMetallicRoughness.baseColorFactor;  // tinygltf: always 4
        material.base_color = {unit_interval(factor[0]), unit_interval(factor[1]), unit_interval(factor[2])};
        material.alpha = unit_interval(factor[3]);
        read_alpha_mode(source, used, where, material);
        read_emission(source, used, where, material);
        result.texcoord_set.push_back(-1);
        if (const auto& texture = source.pbrMetallicRoughness.baseColorTexture; used && texture.index != -1)
            read_texture(texture, where, material);
        result.materials.push_back(std::move(material));
    }

    GltfMaterials result;
    Approximations approximations;

private:
    void read_alpha_mode(const tinygltf::Material& source, bool used, const std::string& where, Material& material) {
        if (source.alphaMode == "MASK") {
            material.alpha_mask = true;
            material.alpha_cutoff = static_cast<float>(std::clamp(source.alphaCutoff, 0.0, 1e6));
        } else if (source.alphaMode == "BLEND") {
            approximations.blended += used;
        } else if (source.alphaMode != "OPAQUE") {
            report_.fail(where + " alphaMode", "OPAQUE, MASK or BLEND", "\"" + source.alphaMode + "\"");
        }
    }

    void read_emission(const tinygltf::Material& source, bool used, const std::string& where, Material& material) {
        double strength = 1;
        if (const auto found = source.extensions.find("KHR_materials_emissive_strength");
            found != source.extensions.end() && found->second.Has("emissiveStrength")) {
            const tinygltf::Value& value = found->second.Get("emissiveStrength");
            if (!value.IsNumber()) report_.fail(where + " emissiveStrength", "a number", "something else");
            strength = value.GetNumberAsDouble();
        }
        const auto& factor = source.emissiveFactor;  // tinygltf: always 3
        const auto radiance = [&](double f) { return static_cast<float>(std::max(0.0, f * strength)); };
        material.emission = {radiance(factor[0]), radiance(factor[1]), radiance(factor[2])};
        if (!(max_component(material.emission) <= 1e18F))
            report_.fail(where + " emission", "a radiance of at most 1e18", fmt::format("strength {}", strength));
        approximations.emissive_textures += used && source.emissiveTexture.index != -1;
    }

    void read_texture(const tinygltf::TextureInfo& info, const std::string& where, Material& material) {
        const auto check = [&](int index, std::size_t count, const std::string& kind) {
            if (index < 0 || static_cast<std::size_t>(index) >= count)
                report_.fail(where, fmt::format("{} below {}", kind, count), fmt::format("{}", index));
            return static_cast<std::size_t>(index);
        };
        const tinygltf::Texture& texture = model_.textures[check(info.index, model_.textures.size(), "a texture")];
        if (info.texCoord < 0) report_.fail(where + " texCoord", "0 or more", fmt::format("{}", info.texCoord));
        if (texture.sampler != -1) {
            const auto& sampler = model_.samplers[check(texture.sampler, model_.samplers.size(), "a sampler")];
            approximations.clamped +=
                sampler.wrapS != TINYGLTF_TEXTURE_WRAP_REPEAT || sampler.wrapT != TINYGLTF_TEXTURE_WRAP_REPEAT;
        }
        if (texture.source == -1) {  // an extension has it, in a format we lack
            ++approximations.missing_images;
            return;
        }
        int& slot = slot_of_image_[check(texture.source, images_, "an image")];
        if (slot < 0) {
            slot = static_cast<int>(result.images.size());
            result.images.push_back(texture.source);
        }
        material.base_color_texture = slot;
        result.texcoord_set.back() = info.texCoord;
    }

    const tinygltf::Model& model_;
    std::size_t images_;
    const GltfReport& report_;
    std::vector<int> slot_of_image_;
};

}  // namespace

GltfMaterials read_gltf_materials(const GltfDocument& document, const std::vector<bool>& used,
                                  const GltfReport& report) {
    const std::size_t count = document.model.materials.size();
    constexpr std::size_t max_materials = 65535;
    if (count > max_materials)
        report.fail("materials", fmt::format("at most {}", max_materials), fmt::format("{}", count),
                    "merge materials or split the scene");
    MaterialReader reader(document, report);
    for (std::size_t i = 0; i < count; ++i) reader.add(i, used[i]);
    if (used[count] || count == 0) {
        reader.result.materials.emplace_back().name = "default";
        reader.result.texcoord_set.push_back(-1);
    }
    reader.approximations.report(report);
    return std::move(reader.result);
}

}  // namespace raycache::tracer
