#include "tracer/scene/gltf_instances.hpp"

#include <fmt/format.h>

#include <optional>

#include "tracer/scene/gltf_accessor.hpp"

namespace raycache::tracer {

std::vector<Transform> read_gltf_instances(const GltfDocument& document, const tinygltf::Value& extension,
                                           const std::string& where, const GltfReport& report) {
    const std::string place = where + " EXT_mesh_gpu_instancing";
    const tinygltf::Value& attributes = extension.Get("attributes");
    std::optional<std::uint64_t> count;
    const auto open = [&](const char* name, int components) -> std::optional<GltfAccessor> {
        if (!attributes.Has(name)) return std::nullopt;
        const std::string what = fmt::format("{} {}", place, name);
        GltfAccessor accessor(document, attributes.Get(name).GetNumberAsInt(), components, false, what, report);
        if (count.value_or(accessor.count()) != accessor.count())
            report.fail(what, fmt::format("{} elements, as many as the others", *count),
                        fmt::format("{}", accessor.count()));
        count = accessor.count();
        return accessor;
    };
    const auto translation = open("TRANSLATION", 3), rotation = open("ROTATION", 4), scale = open("SCALE", 3);
    if (!count) report.fail(place, "TRANSLATION, ROTATION or SCALE", "none of them");

    const auto numbers = [](const std::optional<GltfAccessor>& accessor, std::uint64_t i) {
        std::vector<double> result;
        for (int k = 0; accessor && k < accessor->components(); ++k) result.push_back(double{accessor->number(i, k)});
        return result;
    };
    report.charge(*count * sizeof(Transform) * 2, place);
    std::vector<Transform> result;
    result.reserve(*count);
    for (std::uint64_t i = 0; i < *count; ++i) {
        const auto turn = numbers(rotation, i);
        if (!turn.empty() && turn == std::vector<double>(4, 0))
            report.fail(fmt::format("{} ROTATION {}", place, i), "a unit quaternion", "all zeros");
        result.push_back(transform_from_trs(numbers(translation, i), turn, numbers(scale, i)));
    }
    return result;
}

}  // namespace raycache::tracer
