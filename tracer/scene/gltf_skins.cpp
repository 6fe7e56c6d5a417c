#include "tracer/scene/gltf_skins.hpp"

#include <fmt/format.h>

#include "tracer/scene/gltf_nodes.hpp"

namespace raycache::tracer {

namespace {

/// From each node to the world, whether a scene holds it or not.
class NodeWorlds {
public:
    NodeWorlds(const GltfDocument& document, const GltfReport& report) : document_(document), report_(report) {
        const auto& nodes = document.model.nodes;
        parent_.assign(nodes.size(), -1);
        for (std::size_t i = 0; i < nodes.size(); ++i)
            for (const int child : nodes[i].children)
                if (child >= 0 && static_cast<std::size_t>(child) < nodes.size())
                    parent_[static_cast<std::size_t>(child)] = static_cast<int>(i);
    }

    Transform of(int node) const {
        Transform result = gltf_local_transform(document_, node, report_);
        std::size_t steps = 0;
        for (int up = parent(node); up != -1; up = parent(up)) {
            if (++steps > parent_.size()) report_.fail(fmt::format("node {}", node), "one parent at most", "a cycle");
            result = gltf_local_transform(document_, up, report_) * result;
        }
        return result;
    }

private:
    int parent(int node) const { return parent_[static_cast<std::size_t>(node)]; }

    const GltfDocument& document_;
    const GltfReport& report_;
    std::vector<int> parent_;
};

Transform matrix_at(const GltfAccessor& matrices, std::uint64_t element) {
    std::vector<double> numbers;
    for (int i = 0; i < 16; ++i) numbers.push_back(double{matrices.number(element, i)});
    return transform_from_matrix(numbers);
}

}  // namespace

std::vector<GltfSkin> read_gltf_skins(const GltfDocument& document, const GltfReport& report) {
    std::vector<GltfSkin> result;
    if (document.model.skins.empty()) return result;
    const NodeWorlds worlds(document, report);
    for (std::size_t s = 0; s < document.model.skins.size(); ++s) {
        const tinygltf::Skin& skin = document.model.skins[s];
        const std::string where = fmt::format("skins[{}].inverseBindMatrices", s);
        std::optional<GltfAccessor> inverse;
        if (skin.inverseBindMatrices != -1) {
            inverse.emplace(document, skin.inverseBindMatrices, 16, false, where, report);
            if (inverse->count() < skin.joints.size())
                report.fail(where, fmt::format("{} matrices, one per joint", skin.joints.size()),
                            fmt::format("{}", inverse->count()));
        }
        GltfSkin& made = result.emplace_back();
        for (std::size_t j = 0; j < skin.joints.size(); ++j) {
            const Transform world = worlds.of(skin.joints[j]);
            made.joints.push_back(inverse ? world * matrix_at(*inverse, j) : world);
        }
    }
    return result;
}

void bend_vertex(const GltfSkin& skin, const std::vector<GltfAccessor>& joints,
                 const std::vector<GltfAccessor>& weights, std::uint64_t v, Vec3& position, Vec3* normal,
                 const std::string& where, const GltfReport& report) {
    Transform sum;
    for (auto& row : sum.rows) row = {};
    double total = 0;
    for (std::size_t set = 0; set < joints.size(); ++set) {
        const auto weight = weights[set].vec4(v);
        for (int k = 0; k < 4; ++k) {
            const double w = double{weight[static_cast<std::size_t>(k)]};
            if (!(w > 0)) continue;
            const std::uint32_t joint = joints[set].integer(v, k);
            if (joint >= skin.joints.size())
                report.fail(fmt::format("{} JOINTS_{}", where, set), fmt::format("joints below {}", skin.joints.size()),
                            fmt::format("{}", joint));
            for (std::size_t r = 0; r < 3; ++r)
                for (std::size_t c = 0; c < 4; ++c) sum.rows[r][c] += w * skin.joints[joint].rows[r][c];
            total += w;
        }
    }
    if (!(total > 0)) return;
    for (auto& row : sum.rows)
        for (double& number : row) number /= total;
    position = sum.point(position);
    if (normal) *normal = NormalTransform(sum)(*normal);
}

}  // namespace raycache::tracer
