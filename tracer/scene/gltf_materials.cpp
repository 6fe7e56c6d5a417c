#include "tracer/scene/gltf_materials.hpp"
#include "traces/printable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace raycache::tracer {

namespace {

/// Materials that are treated otherwise than their author meant; each kind becomes at most one warning.
struct Approximations {
    std::size_t missing_images = 0, out_of_range = 0, bright = 0, normal_maps = 0, transmission_textures = 0,
                absorbing = 0;
    void report(const GltfReport& out) const {
        const auto warn = [&](std::size_t count, const char* what) {
            if (count > 0) out.warning(fmt::format("{} materials {}", count, what));
        };
        warn(missing_images, "have a texture without an image we can read; the factors alone are used");
        warn(out_of_range, "have a factor out of glTF's range; the nearest value in it is used");
        warn(bright, "have an emissive factor above 1, which glTF does not allow; it is taken as it is");
        warn(normal_maps, "have a normal map; it is left out, and the surface is as smooth as its geometry");
        warn(transmission_textures, "have a transmission texture; the factors alone are used");
        warn(absorbing, "absorb light in their volume; they are rendered clear");
    }
};

Wrap wrap_of(int mode, const std::string& where, const GltfReport& report) {
    switch (mode) {
        case TINYGLTF_TEXTURE_WRAP_REPEAT:
            return Wrap::repeat;
        case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
            return Wrap::clamp;
        case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
            return Wrap::mirror;
        default:
            report.fail(where, "a wrap mode: 10497, 33071 or 33648", fmt::format("{}", mode));
    }
}

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
        result.texcoords.emplace_back();
        result.blended.push_back(source.alphaMode == "BLEND");
        result.double_sided.push_back(source.doubleSided);
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
        approximations.transmission_textures +=
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
        const auto radiance = [&](double f) {
            in_range_ = in_range_ && f >= 0 && strength >= 0;
            return static_cast<float>(std::max(0.0, f) * std::max(0.0, strength));
        };
        material.emission = {radiance(factor[0]), radiance(factor[1]), radiance(factor[2])};
        if (!(max_component(material.emission) <= 1e18F))
            report_.fail(where + " emission", "a radiance of at most 1e18",
                         fmt::format("a factor of {:g}, {:g}, {:g} and a strength of {:g}", factor[0], factor[1],
                                     factor[2], strength),
                         "make the light weaker");
        approximations.bright += used && std::max({factor[0], factor[1], factor[2]}) > 1;
    }

    void read_textures(const tinygltf::Material& source, const std::string& where, Material& material) {
        const auto& pbr = source.pbrMetallicRoughness;
        material.base_color_texture = read_texture(pbr.baseColorTexture, where, material.base_color_lookup);
        material.metallic_roughness_texture =
            read_texture(pbr.metallicRoughnessTexture, where, material.metallic_roughness_lookup);
        if (max_component(material.emission) > 0)
            material.emission_texture = read_texture(source.emissiveTexture, where, material.emission_lookup);
        approximations.normal_maps += source.normalTexture.index != -1;
    }

    /// The slot of its image, or -1 where it has none.
    template <class TextureInfo>
    int read_texture(const TextureInfo& info, const std::string& where, TextureLookup& lookup) {
        if (info.index == -1) return -1;
        const auto check = [&](int index, std::size_t count, const std::string& kind) {
            if (index < 0 || static_cast<std::size_t>(index) >= count)
                report_.fail(where, fmt::format("{} below {}", kind, count), fmt::format("{}", index));
            return static_cast<std::size_t>(index);
        };
        const tinygltf::Texture& texture = model_.textures[check(info.index, model_.textures.size(), "a texture")];
        if (texture.source == -1) {  // an extension has it, in a format we lack
            ++approximations.missing_images;
            return -1;
        }
        if (texture.sampler != -1) {
            const auto& sampler = model_.samplers[check(texture.sampler, model_.samplers.size(), "a sampler")];
            const std::string place = fmt::format("sampler {}", texture.sampler);
            lookup.s = wrap_of(sampler.wrapS, place, report_);
            lookup.t = wrap_of(sampler.wrapT, place, report_);
        }
        lookup.layer = layer_of(texcoords_of(info));
        int& slot = slot_of_image_[check(texture.source, images_, "an image")];
        if (slot < 0) {
            slot = static_cast<int>(result.images.size());
            result.images.push_back(texture.source);
        }
        return slot;
    }

    /// Of the material being read.
    std::uint8_t layer_of(const GltfTexcoords& wanted) {
        auto& layers = result.texcoords.back();
        const auto found = std::find(layers.begin(), layers.end(), wanted);
        const auto layer = static_cast<std::uint8_t>(found - layers.begin());
        if (found == layers.end()) layers.push_back(wanted);
        return layer;
    }

    template <class TextureInfo>
    static GltfTexcoords texcoords_of(const TextureInfo& info) {
        GltfTexcoords result;
        result.set = info.texCoord;
        const auto found = info.extensions.find("KHR_texture_transform");
        if (found == info.extensions.end()) return result;
        const tinygltf::Value& transform = found->second;
        const auto pair = [&](const char* key, int i, double otherwise) {
            return transform.Has(key) ? transform.Get(key).Get(i).GetNumberAsDouble() : otherwise;
        };
        if (transform.Has("texCoord")) result.set = transform.Get("texCoord").GetNumberAsInt();
        const double angle = transform.Has("rotation") ? transform.Get("rotation").GetNumberAsDouble() : 0;
        // Counter-clockwise as one sees the texture, whose v grows downwards.
        const double c = std::cos(angle), s = std::sin(angle), x = pair("scale", 0, 1), y = pair("scale", 1, 1);
        result.rows = {c * x, s * y, pair("offset", 0, 0), -s * x, c * y, pair("offset", 1, 0)};
        return result;
    }

    const tinygltf::Model& model_;
    std::size_t images_;
    const GltfReport& report_;
    std::vector<int> slot_of_image_;
    bool in_range_ = true;  ///< of the material being read
};

}  // namespace

Vec2 GltfTexcoords::operator()(Vec2 stored) const {
    const auto row = [&](std::size_t r) {
        return static_cast<float>(rows[r] * stored.x + rows[r + 1] * stored.y + rows[r + 2]);
    };
    return {row(0), row(3)};
}

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
        reader.result.texcoords.emplace_back();
        reader.result.blended.push_back(false);
        reader.result.double_sided.push_back(false);
    }
    reader.approximations.report(report);
    return std::move(reader.result);
}

}  // namespace raycache::tracer
