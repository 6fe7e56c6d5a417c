#include "tracer/scene/gltf_materials.hpp"
#include "traces/printable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace raycache::tracer {

namespace {

/// Materials that are treated otherwise than their author meant; each kind becomes at most one warning.
struct Approximations {
    std::size_t emissive_textures = 0, clamped = 0, missing_images = 0, out_of_range = 0, other_textures = 0,
                absorbing = 0;
    void report(const GltfReport& out) const {
        if (emissive_textures > 0)
            out.warning(fmt::format("{} materials have an emissive texture; it is ignored and the emissive factor used",
                                    emissive_textures));
        if (clamped > 0)
            out.warning(fmt::format("{} materials have a texture that clamps or mirrors; it is repeated", clamped));
        if (missing_images > 0)
            out.warning(
                fmt::format("{} materials have a texture without an image we can read; the factors alone are used",
                            missing_images));
        if (out_of_range > 0)
            out.warning(fmt::format("{} materials have a factor out of glTF's range; the nearest value in it is used",
                                    out_of_range));
        if (other_textures > 0)
            out.warning(
                fmt::format("{} materials have a metallic-roughness texture with texture coordinates of its own "
                            "or a transmission texture; the factors alone are used",
                            other_textures));
        if (absorbing > 0)
            out.warning(fmt::format("{} materials absorb light in their volume; they are rendered clear", absorbing));
    }
};

class MaterialReader {
public:
    MaterialReader(const GltfDocument& document, const GltfReport& report)
        : model_(document.model), images_(document.images.size()), report_(report), slot_of_image_(images_, -1) {}

    void add(std::size_t index, bool used) {
        const tinygltf::Material& source = model_.materials[index];
        const std::string where = fmt::format("material {}", index);
        Material material;
        material.name = printable_line(source.name);
        const auto& factor = source.pbrMetallicRoughness.baseColorFactor;  // tinygltf: always 4
        in_range_ = true;
        material.base_color = {unit_interval(factor[0]), unit_interval(factor[1]), unit_interval(factor[2])};
        material.alpha = unit_interval(factor[3]);
        material.metallic = unit_interval(source.pbrMetallicRoughness.metallicFactor);
        material.roughness = unit_interval(source.pbrMetallicRoughness.roughnessFactor);
        read_alpha_mode(source, where, material);
        read_emission(source, used, where, material);
        read_glass(source, used, where, material);
        approximations.out_of_range += used && !in_range_;
        result.texcoord_set.push_back(-1);
        if (used) read_textures(source, where, material);
        result.materials.push_back(std::move(material));
    }

    GltfMaterials result;
    Approximations approximations;

private:
    float clamp(double value, double least, double most) {
        in_range_ = in_range_ && value >= least && value <= most;
        return static_cast<float>(std::clamp(value, least, most));
    }
    float unit_interval(double value) { return clamp(value, 0, 1); }

    /// A number of an extension, or `otherwise` where the file has none.
    double number(const tinygltf::Material& source, const char* extension, const char* key, double otherwise,
                  const std::string& where) {
        const auto found = source.extensions.find(extension);
        if (found == source.extensions.end() || !found->second.Has(key)) return otherwise;
        const tinygltf::Value& value = found->second.Get(key);
        if (!value.IsNumber()) report_.fail(where + " " + key, "a number", "something else");
        return value.GetNumberAsDouble();
    }

    void read_glass(const tinygltf::Material& source, bool used, const std::string& where, Material& material) {
        constexpr double largest_ior = 100;  // beyond any matter; squares stay small
        const double ior = number(source, "KHR_materials_ior", "ior", 1.5, where);
        material.ior = ior == 0 ? 0 : clamp(ior, 1, largest_ior);
        const char* transmission = "KHR_materials_transmission";
        material.transmission = unit_interval(number(source, transmission, "transmissionFactor", 0, where));
        const char* volume = "KHR_materials_volume";
        material.thin = !(number(source, volume, "thicknessFactor", 0, where) > 0);
        const bool absorbs = number(source, volume, "attenuationDistance", 0, where) > 0;
        approximations.absorbing += used && absorbs && material.transmission > 0 && !material.thin;
        const auto found = source.extensions.find(transmission);
        approximations.other_textures +=
            used && found != source.extensions.end() && found->second.Has("transmissionTexture");
    }

    void read_alpha_mode(const tinygltf::Material& source, const std::string& where, Material& material) {
        if (source.alphaMode == "MASK") {
            material.alpha_mask = true;
            material.alpha_cutoff = static_cast<float>(std::clamp(source.alphaCutoff, 0.0, 1e6));
        } else if (source.alphaMode == "BLEND") {
            material.alpha_blend = material.alpha < 1 || source.pbrMetallicRoughness.baseColorTexture.index != -1;
        } else if (source.alphaMode != "OPAQUE") {
            report_.fail(where + " alphaMode", "OPAQUE, MASK or BLEND", "\"" + source.alphaMode + "\"");
        }
    }

    void read_emission(const tinygltf::Material& source, bool used, const std::string& where, Material& material) {
        const double strength = number(source, "KHR_materials_emissive_strength", "emissiveStrength", 1, where);
        const auto& factor = source.emissiveFactor;  // tinygltf: always 3
        const auto radiance = [&](double f) { return static_cast<float>(std::max(0.0, f * strength)); };
        material.emission = {radiance(factor[0]), radiance(factor[1]), radiance(factor[2])};
        if (!(max_component(material.emission) <= 1e18F))
            report_.fail(where + " emission", "a radiance of at most 1e18", fmt::format("strength {}", strength));
        approximations.emissive_textures += used && source.emissiveTexture.index != -1;
    }

    void read_textures(const tinygltf::Material& source, const std::string& where, Material& material) {
        const auto& color = source.pbrMetallicRoughness.baseColorTexture;
        const auto& rough = source.pbrMetallicRoughness.metallicRoughnessTexture;
        int& set = result.texcoord_set.back();
        if (color.index != -1) {
            material.base_color_texture = read_texture(color, where);
            if (material.base_color_texture >= 0) set = color.texCoord;
        }
        if (rough.index == -1) return;
        const int slot = read_texture(rough, where);
        if (slot >= 0 && set >= 0 && set != rough.texCoord) {
            ++approximations.other_textures;
        } else if (slot >= 0) {
            material.metallic_roughness_texture = slot;
            set = rough.texCoord;
        }
    }

    /// The slot of its image, or -1 where it has none.
    int read_texture(const tinygltf::TextureInfo& info, const std::string& where) {
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
            return -1;
        }
        int& slot = slot_of_image_[check(texture.source, images_, "an image")];
        if (slot < 0) {
            slot = static_cast<int>(result.images.size());
            result.images.push_back(texture.source);
        }
        return slot;
    }

    const tinygltf::Model& model_;
    std::size_t images_;
    const GltfReport& report_;
    std::vector<int> slot_of_image_;
    bool in_range_ = true;  ///< of the material being read
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
        Material& material = reader.result.materials.emplace_back();
        material.name = "default";
        material.metallic = 1;
        reader.result.texcoord_set.push_back(-1);
    }
    reader.approximations.report(report);
    return std::move(reader.result);
}

}  // namespace raycache::tracer
