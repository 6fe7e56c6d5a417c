#include "tools/gpu/replay/replay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>

#include "traces/error.hpp"

namespace raycache::gpu {
namespace {

using Json = nlohmann::ordered_json;

const char* name_of(std::uint8_t type) { return type == 0 ? "camera" : type == 1 ? "bounce" : "shadow"; }

void add(WarpPlan& plan, const Batch& batch) {
    plan.batches.push_back(batch);
    plan.rays += count_bits(batch.mask);
}

Json to_json(const DeviceFacts& facts) {
    Json json = Json::object();
    for (const auto& [key, value] : facts) std::visit([&, &name = key](const auto& v) { json[name] = v; }, value);
    return json;
}

/// Rays of the plan that ended elsewhere than expected.
std::uint64_t wrong_hits(const WarpPlan& plan, std::span<const Hit> expected, const std::vector<Hit>& found) {
    std::uint64_t wrong = 0;
    for (const Batch& batch : plan.batches)
        for (std::uint64_t i = batch.first_ray, end = i + count_bits(batch.mask); i < end; ++i)
            wrong += std::memcmp(&expected[i], &found[i], sizeof(Hit)) != 0 ? 1 : 0;
    return wrong;
}

class Walks {
public:
    Walks(const ReplayOptions& options, Backend& backend, ReplayResult& result)
        : options_(options), backend_(backend), result_(result) {}

    /// All walks of one plan, as an element of the document's walks[].
    Json walk(const WarpPlan& plan, std::span<const Hit> expected) {
        Json json;
        json["warps"] = plan.warps();
        json["rays"] = plan.rays;
        backend_.load(plan);
        if (options_.profile) {
            backend_.walk();
            return json;
        }
        const Visits visits = backend_.walk_counting();
        std::uint64_t wrong = wrong_hits(plan, expected, backend_.hits());
        std::vector<double> seconds;
        if (backend_.is_timed()) {
            backend_.walk();  // warms up
            wrong = std::max(wrong, wrong_hits(plan, expected, backend_.hits()));
            for (std::uint32_t i = 0; i < options_.repeats; ++i) {
                if (options_.flush_l2) backend_.flush_l2();
                seconds.push_back(backend_.walk());
            }
        }
        json["wrong_rays"] = wrong;
        json["node_visits"] = visits.nodes;
        json["triangle_tests"] = visits.triangles;
        json["seconds"] = seconds;
        if (!seconds.empty()) {
            std::sort(seconds.begin(), seconds.end());
            const std::size_t n = seconds.size();
            const double median = (seconds[(n - 1) / 2] + seconds[n / 2]) / 2;
            json["median_seconds"] = median;
            json["rays_per_second"] = median > 0 ? Json(static_cast<double>(plan.rays) / median) : Json();
        }
        result_.rays += plan.rays;
        result_.wrong += wrong;
        return json;
    }

private:
    const ReplayOptions& options_;
    Backend& backend_;
    ReplayResult& result_;
};

Json provenance_of(const BvhFile& bvh, const std::string& folder) {
    Json json = Json::parse(bvh.head().provenance, nullptr, false);
    if (!json.is_object())
        throw Error(fmt::format("{}/{}: provenance: expected a JSON object, found something else; capture it again",
                                folder, bvh_file));
    return json;
}

}  // namespace

std::vector<KernelPlan> kernel_plans(const LaunchPart& launch) {
    std::vector<KernelPlan> kernels;
    for (const Batch& batch : launch.batches) {
        auto at = std::find_if(kernels.begin(), kernels.end(),
                               [&](const KernelPlan& k) { return k.type == batch.type && k.bounce == batch.bounce; });
        if (at == kernels.end()) at = kernels.insert(at, {batch.type, batch.bounce, {}});
        add(at->plan, batch);
    }
    // As a path goes: at each vertex the ray that arrives, then the shadow rays.
    std::sort(kernels.begin(), kernels.end(), [](const KernelPlan& a, const KernelPlan& b) {
        return std::pair(a.bounce, a.type) < std::pair(b.bounce, b.type);
    });
    for (KernelPlan& kernel : kernels)
        for (std::uint32_t i = 0; i <= kernel.plan.batches.size(); ++i) kernel.plan.firsts.push_back(i);
    return kernels;
}

WarpPlan megakernel_plan(const LaunchPart& launch, std::uint32_t warps) {
    WarpPlan plan;
    plan.firsts.reserve(std::size_t{warps} + 1);
    plan.firsts.push_back(0);
    std::size_t at = 0;
    for (std::uint32_t warp = 0; warp < warps; ++warp) {
        for (; at < launch.batches.size() && launch.batches[at].warp == warp; ++at) add(plan, launch.batches[at]);
        plan.firsts.push_back(static_cast<std::uint32_t>(at));
    }
    return plan;
}

ReplayResult replay(const ReplayOptions& options, Backend& backend) {
    const BvhFile bvh(options.folder);
    ReplayResult result;
    Walks walks(options, backend, result);
    Json document;
    document["schema_version"] = 1;
    document["program"] = program_name();
    document["device"] = to_json(backend.facts());
    document["settings"] = {{"repeats", backend.is_timed() && !options.profile ? options.repeats : 0},
                            {"flush_l2", options.flush_l2},
                            {"block_warps", options.backend.block_warps},
                            {"profile", options.profile}};
    document["package"] = {{"tree", to_string(bvh.head().tree)},    {"wavefront", bvh.head().wavefront},
                           {"node_bytes", bvh.part().nodes.size()}, {"triangle_bytes", bvh.part().triangles.size()},
                           {"stack_entries", bvh.stack_entries()},  {"trace", provenance_of(bvh, options.folder)}};
    document["launches"] = Json::array();
    backend.load(bvh);
    const std::uint32_t launches =
        options.launches == 0 ? bvh.head().launches : std::min(options.launches, bvh.head().launches);
    for (std::uint32_t i = 0; i < launches; ++i) {
        const LaunchFile launch(options.folder, bvh, i);
        backend.load(launch.part());
        Json list = Json::array();
        const auto add_walk = [&](Json head, const WarpPlan& plan) {
            head.update(walks.walk(plan, launch.part().hits));
            list.push_back(std::move(head));
        };
        for (const KernelPlan& kernel : options.wavefront ? kernel_plans(launch.part()) : std::vector<KernelPlan>())
            add_walk({{"kernel", "wavefront"}, {"ray", name_of(kernel.type)}, {"bounce", kernel.bounce}}, kernel.plan);
        if (options.megakernel && !bvh.head().wavefront)
            add_walk({{"kernel", "megakernel"}, {"ray", nullptr}, {"bounce", nullptr}},
                     megakernel_plan(launch.part(), launch.head().warps));
        document["launches"].push_back({{"ordinal", i},
                                        {"sample_index", launch.head().first_index},
                                        {"rays", launch.part().rays.size()},
                                        {"walks", std::move(list)}});
    }
    document["checked_rays"] = result.rays;
    document["wrong_rays"] = result.wrong;
    result.json = document.dump(1);
    return result;
}

}  // namespace raycache::gpu
