// The walk on a GPU: a warp of 32 lanes for each warp of the plan, one launch each walk.
#include <algorithm>
#include <string>

#include "tools/gpu/cuda_memory.cuh"
#include "tools/gpu/replay/backend.hpp"

namespace raycache::gpu {
namespace {

constexpr std::uint32_t lanes = 32;

/// The lanes of a warp, which agree by votes.
struct Together {
    static __device__ bool any(bool condition) { return __any_sync(0xffffffffU, condition) != 0; }
};

struct PlanInput {
    const Batch* batches;
    const std::uint32_t* firsts;
    std::uint32_t warps;
};

/// One block dimension: warps. `counting`: sums up what is read in *visits.
template <class Tree, bool counting>
__global__ void walk_rays(WalkInput in, PlanInput plan, Hit* hits, unsigned long long* visits) {
    const std::uint32_t warp = (blockIdx.x * blockDim.x + threadIdx.x) / lanes, lane = threadIdx.x % lanes;
    if (warp >= plan.warps) return;  // all lanes of it
    Visits own{0, 0};
    for (std::uint32_t b = plan.firsts[warp], end = plan.firsts[warp + 1]; b < end; ++b) {
        const Words words = load16(plan.batches + b);  // mask, first ray, warp, kind
        const std::uint32_t mask = words.x;
        const bool active = (mask >> lane & 1) != 0, any_hit = (words.w & 0xff) == 2;
        const std::uint64_t number = std::uint64_t{words.y} + count_bits(mask & ((1U << lane) - 1));
        const Hit hit = walk<Tree, Together>(in, number, active, any_hit, own);
        if (active) hits[number] = hit;
    }
    if (counting) {
        atomicAdd(visits, static_cast<unsigned long long>(own.nodes));
        atomicAdd(visits + 1, static_cast<unsigned long long>(own.triangles));
    }
}

template <class T>
DeviceBuffer to_device(std::span<const T> elements, const char* what) {
    return {elements.data(), elements.size_bytes(), what};
}

class CudaBackend final : public Backend {
public:
    explicit CudaBackend(const BackendOptions& options) : options_(options), device_(options.device) {
        // A kernel that this program has no code for is found here, not at the first launch.
        device_.check_code(reinterpret_cast<const void*>(&walk_rays<WalkBvh2, true>));
        check(cudaEventCreate(&begin_), "making an event");
        check(cudaEventCreate(&end_), "making an event");
        visits_ = DeviceBuffer(nullptr, 2 * sizeof(unsigned long long), "counters");
    }
    ~CudaBackend() override {
        cudaEventDestroy(begin_);
        cudaEventDestroy(end_);
    }
    CudaBackend(const CudaBackend&) = delete;
    CudaBackend& operator=(const CudaBackend&) = delete;

    DeviceFacts facts() const override { return device_.facts(); }
    bool is_timed() const override { return true; }

    void load(const BvhFile& bvh) override {
        tree_ = bvh.head().tree;
        nodes_ = to_device(bvh.part().nodes, "the nodes");
        triangles_ = to_device(bvh.part().triangles, "the triangles");
    }
    void load(const LaunchPart& launch) override {
        firsts_ = DeviceBuffer();
        batches_ = DeviceBuffer();
        rays_ = to_device(launch.rays, "the rays");
        hole_firsts_ = to_device(launch.hole_firsts, "the lists of holes");
        hole_triangles_ = to_device(launch.hole_triangles, "the lists of holes");
        count_ = launch.rays.size();
        hits_ = DeviceBuffer(nullptr, count_ * sizeof(Hit), "the hits");
    }
    void load(const WarpPlan& plan) override {
        batches_ = to_device(std::span(plan.batches), "the batches");
        firsts_ = to_device(std::span(plan.firsts), "the warps");
        warps_ = plan.warps();
    }

    Visits walk_counting() override {
        check(cudaMemset(hits_.data(), 0xff, hits_.bytes()), "clearing the hits");
        check(cudaMemset(visits_.data(), 0, visits_.bytes()), "clearing counters");
        launch<true>();
        check(cudaDeviceSynchronize(), "walking");
        unsigned long long counted[2];
        check(cudaMemcpy(counted, visits_.data(), sizeof counted, cudaMemcpyDeviceToHost), "copying counters");
        return {counted[0], counted[1]};
    }
    double walk() override {
        check(cudaEventRecord(begin_), "an event");
        launch<false>();
        check(cudaEventRecord(end_), "an event");
        check(cudaEventSynchronize(end_), "walking");
        float milliseconds = 0;
        check(cudaEventElapsedTime(&milliseconds, begin_, end_), "an event's time");
        return 1e-3 * double{milliseconds};
    }
    std::vector<Hit> hits() const override {
        std::vector<Hit> hits(count_);
        check(cudaMemcpy(hits.data(), hits_.data(), hits_.bytes(), cudaMemcpyDeviceToHost), "copying the hits");
        return hits;
    }
    void flush_l2() override {
        if (flush_.bytes() == 0) flush_ = DeviceBuffer(nullptr, 2 * device_.l2_bytes(), "a buffer that flushes L2");
        check(cudaMemset(flush_.data(), 0, flush_.bytes()), "flushing L2");
        check(cudaDeviceSynchronize(), "flushing L2");
    }

private:
    template <bool counting>
    void launch() {
        if (tree_ == TreeKind::bvh2)
            launch_of<WalkBvh2, counting>();
        else if (tree_ == TreeKind::bvh4)
            launch_of<WalkBvh4, counting>();
        else
            launch_of<WalkCwbvh8, counting>();
    }
    template <class Tree, bool counting>
    void launch_of() {
        if (warps_ == 0) return;
        const std::uint32_t blocks = (warps_ + options_.block_warps - 1) / options_.block_warps;
        const WalkInput in{nodes_.data(),
                           triangles_.data(),
                           rays_.as<PackedRay>(),
                           {hole_firsts_.as<std::uint32_t>(), hole_triangles_.as<std::uint32_t>()}};
        const PlanInput plan{batches_.as<Batch>(), firsts_.as<std::uint32_t>(), warps_};
        walk_rays<Tree, counting>
            <<<blocks, options_.block_warps * lanes>>>(in, plan, hits_.as<Hit>(), visits_.as<unsigned long long>());
        check(cudaGetLastError(), "launching the walk; fewer --block-warps need fewer registers");
    }

    BackendOptions options_;
    CudaDevice device_;
    TreeKind tree_ = TreeKind::bvh2;
    DeviceBuffer nodes_, triangles_, rays_, hole_firsts_, hole_triangles_, hits_, batches_, firsts_, visits_, flush_;
    std::size_t count_ = 0;
    std::uint32_t warps_ = 0;
    cudaEvent_t begin_ = nullptr, end_ = nullptr;
};

}  // namespace

std::unique_ptr<Backend> make_backend(const BackendOptions& options) { return std::make_unique<CudaBackend>(options); }
const char* program_name() { return "gpu_replay"; }

}  // namespace raycache::gpu
