// The walk of a GPU, on the processor here: lane by lane, without a clock.
#include <algorithm>
#include <cstring>

#include "tools/gpu/replay/backend.hpp"

namespace raycache::gpu {
namespace {

/// A lane that walks alone.
struct Alone {
    static bool any(bool condition) { return condition; }
};

class CpuBackend final : public Backend {
public:
    DeviceFacts facts() const override {
        return {{"name", std::string("none: the processor stands in, without times")}};
    }
    bool is_timed() const override { return false; }

    void load(const BvhFile& bvh) override {
        tree_ = bvh.head().tree;
        in_.nodes = bvh.part().nodes.data();
        in_.triangles = bvh.part().triangles.data();
    }
    void load(const LaunchPart& launch) override {
        in_.rays = launch.rays.data();
        in_.holes = {launch.hole_firsts.data(), launch.hole_triangles.data()};
        hits_.resize(launch.rays.size());
    }
    void load(const WarpPlan& plan) override { plan_ = &plan; }

    Visits walk_counting() override {
        if (!hits_.empty()) std::memset(hits_.data(), 0xff, hits_.size() * sizeof(Hit));
        if (tree_ == TreeKind::bvh2) return walk_plan<WalkBvh2>();
        if (tree_ == TreeKind::bvh4) return walk_plan<WalkBvh4>();
        return walk_plan<WalkCwbvh8>();
    }
    double walk() override {
        walk_counting();
        return 0;
    }
    std::vector<Hit> hits() const override { return hits_; }
    void flush_l2() override {}

private:
    template <class Tree>
    Visits walk_plan() {
        Visits visits{0, 0};
        for (const Batch& batch : plan_->batches)
            for (std::uint32_t i = 0; i < count_bits(batch.mask); ++i)
                hits_[batch.first_ray + i] =
                    gpu::walk<Tree, Alone>(in_, std::uint64_t{batch.first_ray} + i, true, batch.any_hit(), visits);
        return visits;
    }

    TreeKind tree_ = TreeKind::bvh2;
    WalkInput in_{};
    std::vector<Hit> hits_;
    const WarpPlan* plan_ = nullptr;
};

}  // namespace

std::unique_ptr<Backend> make_backend(const BackendOptions&) { return std::make_unique<CpuBackend>(); }
const char* program_name() { return "gpu_replay_cpu"; }

}  // namespace raycache::gpu
