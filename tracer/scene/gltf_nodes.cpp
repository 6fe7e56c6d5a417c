#include "tracer/scene/gltf_nodes.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace raycache::tracer {

namespace {

Transform local_transform(const tinygltf::Node& node, const std::string& where, const GltfReport& report) {
    const auto check = [&](const std::vector<double>& numbers, std::size_t expected, const char* name) {
        if (!numbers.empty() && numbers.size() != expected)
            report.fail(fmt::format("{} {}", where, name), fmt::format("{} numbers", expected),
                        fmt::format("{}", numbers.size()));
    };
    check(node.matrix, 16, "matrix");
    check(node.translation, 3, "translation");
    check(node.rotation, 4, "rotation");
    check(node.scale, 3, "scale");
    if (!node.matrix.empty()) return transform_from_matrix(node.matrix);
    if (std::all_of(node.rotation.begin(), node.rotation.end(), [](double v) { return v == 0; }) &&
        !node.rotation.empty())
        report.fail(where + " rotation", "a unit quaternion", "all zeros");
    return transform_from_trs(node.translation, node.rotation, node.scale);
}

std::vector<int> root_nodes(const tinygltf::Model& model, const GltfReport& report) {
    if (!model.scenes.empty()) {
        const int scene = model.defaultScene == -1 ? 0 : model.defaultScene;
        if (scene < 0 || static_cast<std::size_t>(scene) >= model.scenes.size())
            report.fail("scene", fmt::format("a scene below {}", model.scenes.size()), fmt::format("{}", scene));
        return model.scenes[static_cast<std::size_t>(scene)].nodes;
    }
    std::vector<bool> is_child(model.nodes.size(), false);
    for (const auto& node : model.nodes)
        for (const int child : node.children)
            if (child >= 0 && static_cast<std::size_t>(child) < is_child.size())
                is_child[static_cast<std::size_t>(child)] = true;
    std::vector<int> roots;
    for (std::size_t i = 0; i < is_child.size(); ++i)
        if (!is_child[i]) roots.push_back(static_cast<int>(i));
    return roots;
}

}  // namespace

GltfNodes place_gltf_nodes(const GltfDocument& document, const GltfReport& report) {
    const tinygltf::Model& model = document.model;
    struct Pending {
        int node;
        Transform parent;
    };
    std::vector<Pending> pending;  // a stack, so that depth in the file is no depth here
    const auto push = [&](const std::vector<int>& nodes, const Transform& parent) {
        for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) pending.push_back({*node, parent});
    };
    GltfNodes result;
    std::vector<bool> reached(model.nodes.size(), false);
    bool skinned = false;
    push(root_nodes(model, report), {});
    while (!pending.empty()) {
        const int index = pending.back().node;
        const Transform parent = pending.back().parent;
        pending.pop_back();
        if (index < 0 || static_cast<std::size_t>(index) >= model.nodes.size())
            report.fail("node hierarchy", fmt::format("a node below {}", model.nodes.size()), fmt::format("{}", index));
        const auto i = static_cast<std::size_t>(index);
        const std::string where = fmt::format("node {}", index);
        if (reached[i]) report.fail(where, "one parent at most", "a cycle or a second parent");
        reached[i] = true;

        const tinygltf::Node& node = model.nodes[i];
        const Transform to_world = parent * local_transform(node, where, report);
        const auto place = [&](std::vector<GltfPlacement>& list, int object, std::size_t count, const char* kind) {
            if (object == -1) return;
            if (object < 0 || static_cast<std::size_t>(object) >= count)
                report.fail(where, fmt::format("a {} below {}", kind, count), fmt::format("{}", object));
            list.push_back({index, object, to_world});
        };
        place(result.meshes, node.mesh, model.meshes.size(), "mesh");
        place(result.cameras, node.camera, model.cameras.size(), "camera");
        skinned = skinned || (node.skin != -1 && node.mesh != -1);
        push(node.children, to_world);
    }
    std::sort(result.cameras.begin(), result.cameras.end(),
              [](const GltfPlacement& a, const GltfPlacement& b) { return a.node < b.node; });
    if (skinned) report.warning("skins are ignored; skinned meshes keep the pose they are stored in");
    return result;
}

}  // namespace raycache::tracer
