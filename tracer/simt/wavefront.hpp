// One launch of a wavefront path tracer (S. Laine, T. Karras, T. Aila: "Megakernels Considered Harmful: Wavefront Path
// Tracing on GPUs", High Performance Graphics 2013): a kernel per vertex and stage, over the paths that are left.
//
//   sort     where rays are ordered, from vertex 1 on: sorts the queue of paths by the keys of their rays
//   extend   vertex 0: makes camera rays, walks them, writes rays, paths and hits.
//            Later: reads queue and ray, walks it, writes the hit
//   shade    reads queue, hit, ray and path, and texels; writes the path. Appends to the list of shadow rays those that
//            may reach a light; writes the next rays of paths that go on, and appends these to the other queue
//   connect  reads the list of shadow rays, walks them; adds the light of those that meet nothing to their path
//
// Laine's stages for materials, one kernel each, are one kernel here: a scene has few. Camera rays are made where they
// are walked, so that they need no queue. Appending compacts: entries follow each other in order of warp and lane, as
// with a prefix sum, so that nothing depends on timing. Shadow rays are not sorted; they come in the order of the paths
// that cast them. Vertex v uses warps 0 … ceil(n/32) - 1 of a kernel for its n rays.
//
// Every path does what it does in a megakernel, with the same numbers in the same order: its radiance is bit for bit
// the same, whatever the order of rays.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "tracer/simt/orders/ray_order.hpp"
#include "tracer/simt/recording_worker.hpp"
#include "tracer/simt/wavefront_buffers.hpp"
#include "traces/record.hpp"

namespace raycache::tracer {

struct WavefrontKernel {
    enum class Stage { sort, extend, shade, connect } stage;
    std::uint32_t vertex;
    bool operator==(const WavefrontKernel&) const = default;
};

/// The kernels of every launch, in order. `sorted`: queues are.
std::vector<WavefrontKernel> wavefront_kernels(const StagePlan&, bool sorted);

class Wavefront {
public:
    /// The jobs of a warp of the launch grid; returns their mask.
    using Jobs = std::function<std::uint32_t(std::uint32_t warp, std::array<PathLane, traces::warp_lanes>&)>;

    /// `order` may be null; it and `kernels` must outlive this object.
    Wavefront(const std::vector<WavefrontKernel>& kernels, const WavefrontBuffers&, const RayOrder* order, const Jobs&);

    /// Traces a warp of the present kernel, 0 … slots / 32 - 1, each once. Thread-safe with one worker per thread, of
    /// an integrator that is cut into stages. Sets the records and elements of `out`.
    void trace_warp(RecordingWorker&, std::uint32_t warp, traces::WarpTrace& out);

    /// All warps of the present kernel have been traced: on to the next.
    void end_kernel();

    /// Of the path in a slot, after the last kernel.
    Vec3 radiance(std::uint32_t slot) const { return state_[slot / lanes].radiance[slot % lanes]; }

private:
    static constexpr std::uint32_t lanes = traces::warp_lanes;

    /// What a warp of `extend` leaves for `shade`, which has the same lanes.
    struct Shaded {
        std::uint32_t mask = 0, shadow = 0, alive = 0;
        traces::WarpTrace texels;
        std::uint32_t first_shadow = 0, first_alive = 0;  ///< places in the lists, known when `extend` has ended
    };
    /// The lanes of a warp that work on list entries [32 w, 32 w + 32).
    struct Work {
        std::uint32_t mask = 0;
        std::array<std::uint32_t, lanes> place{}, slot{};
    };

    Work work(const std::vector<std::uint32_t>& list, std::uint32_t warp) const;
    Work camera_work(std::uint32_t warp) const;
    void trace_sort(RecordingWorker&, std::uint32_t warp) const;
    void trace_extend(RecordingWorker&, std::uint32_t warp, traces::WarpTrace& out);
    void trace_shade(RecordingWorker&, std::uint32_t warp) const;
    void trace_connect(RecordingWorker&, std::uint32_t warp);
    void append();
    void make_keys();

    const WavefrontKernel& kernel() const { return kernels_[present_]; }
    Ray& ray(std::uint32_t slot) { return state_[slot / lanes].rays[slot % lanes]; }

    const std::vector<WavefrontKernel>& kernels_;
    WavefrontBuffers buffers_;
    const RayOrder* order_;
    std::size_t present_ = 0;
    std::vector<PathLanes> state_;                             ///< by slot / 32
    std::vector<std::uint32_t> camera_masks_;                  ///< by warp: slots that have a path
    std::vector<Shaded> shaded_;                               ///< by warp
    std::vector<std::uint32_t> queue_, next_queue_, shadows_;  ///< slots
    std::vector<std::uint32_t> keys_;                          ///< of queue_, before it is sorted
};

}  // namespace raycache::tracer
