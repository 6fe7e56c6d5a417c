#include "tracer/scene/gltf_nodes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tracer/scene/gltf_instances.hpp"

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
    if (!node.matrix.empty()) {
        constexpr double rounding = 1e-4;
        for (std::size_t column = 0; column < 4; ++column) {
            const double last = node.matrix[4 * column + 3], wanted = column == 3 ? 1 : 0;
            if (!(std::abs(last - wanted) <= rounding))
                report.fail(where + " matrix", "an affine one, whose last row is 0 0 0 1 (it is stored by columns)",
                            fmt::format("{:g} as number {}", last, 4 * column + 3));
        }
        return transform_from_matrix(node.matrix);
    }
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

bool is_visible(const tinygltf::Node& node) {
    const auto found = node.extensions.find("KHR_node_visibility");
    return found == node.extensions.end() || !found->second.Has("visible") || found->second.Get("visible").Get<bool>();
}

/// A skin moves vertices only where they say by how much.
bool is_skinned(const tinygltf::Model& model, const tinygltf::Node& node) {
    if (node.skin == -1 || node.mesh == -1) return false;
    const auto& primitives = model.meshes[static_cast<std::size_t>(node.mesh)].primitives;
    return std::any_of(primitives.begin(), primitives.end(), [](const tinygltf::Primitive& primitive) {
        return primitive.attributes.count("JOINTS_0") != 0 && primitive.attributes.count("WEIGHTS_0") != 0;
    });
}

/// The shape that the node's mesh has there; added to the list unless it is there already.
int shape_of(const tinygltf::Model& model, const tinygltf::Node& node, std::vector<GltfShape>& shapes) {
    GltfShape wanted{node.mesh, is_skinned(model, node) ? node.skin : -1,
                     node.weights.empty() ? model.meshes[static_cast<std::size_t>(node.mesh)].weights : node.weights};
    while (!wanted.weights.empty() && wanted.weights.back() == 0) wanted.weights.pop_back();
    constexpr std::size_t looked_at = 64;  // nodes that share a mesh and differ stand near each other, if at all
    const std::size_t count = std::min(shapes.size(), looked_at);
    const auto found = std::find(shapes.rbegin(), shapes.rbegin() + static_cast<std::ptrdiff_t>(count), wanted);
    if (found != shapes.rbegin() + static_cast<std::ptrdiff_t>(count))
        return static_cast<int>(shapes.rend() - found) - 1;
    shapes.push_back(std::move(wanted));
    return static_cast<int>(shapes.size()) - 1;
}

}  // namespace

Transform gltf_local_transform(const GltfDocument& document, int node, const GltfReport& report) {
    return local_transform(document.model.nodes[static_cast<std::size_t>(node)], fmt::format("node {}", node), report);
}

GltfNodes place_gltf_nodes(const GltfDocument& document, const GltfReport& report) {
    const tinygltf::Model& model = document.model;
    struct Pending {
        int node;
        Transform parent;
        bool visible;
    };
    std::vector<Pending> pending;  // a stack, so that depth in the file is no depth here
    const auto push = [&](const std::vector<int>& nodes, const Transform& parent, bool visible) {
        for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) pending.push_back({*node, parent, visible});
    };
    GltfNodes result;
    std::vector<bool> reached(model.nodes.size(), false);
    push(root_nodes(model, report), {}, true);
    while (!pending.empty()) {
        const int index = pending.back().node;
        const Transform parent = pending.back().parent;
        const bool parent_visible = pending.back().visible;
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
        const bool visible = parent_visible && is_visible(node);
        if (visible && node.mesh != -1) {
            if (static_cast<std::size_t>(node.mesh) >= model.meshes.size())
                report.fail(where, fmt::format("a mesh below {}", model.meshes.size()), fmt::format("{}", node.mesh));
            const int shape = shape_of(model, node, result.shapes);
            const auto instancing = node.extensions.find("EXT_mesh_gpu_instancing");
            if (is_skinned(model, node))
                result.meshes.push_back({index, shape, {}});
            else if (instancing != node.extensions.end())
                for (const Transform& instance : read_gltf_instances(document, instancing->second, where, report))
                    result.meshes.push_back({index, shape, to_world * instance});
            else
                result.meshes.push_back({index, shape, to_world});
        }
        if (const auto light = node.extensions.find("KHR_lights_punctual"); visible && light != node.extensions.end())
            place(result.lights, light->second.Get("light").GetNumberAsInt(), model.lights.size(), "light");
        place(result.cameras, node.camera, model.cameras.size(), "camera");
        push(node.children, to_world, visible);
    }
    std::sort(result.cameras.begin(), result.cameras.end(),
              [](const GltfPlacement& a, const GltfPlacement& b) { return a.node < b.node; });
    return result;
}

}  // namespace raycache::tracer
