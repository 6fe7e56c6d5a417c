#include "tracer/simt/wavefront.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>

#include "traces/memory_budget.hpp"

namespace raycache::tracer {
namespace {

using Stage = WavefrontKernel::Stage;
using traces::RayType;
constexpr std::size_t warp_width = traces::warp_lanes;

RayType ray_type(std::uint32_t vertex) { return vertex == 0 ? RayType::camera : RayType::bounce; }

template <class Body>
void for_each_lane(std::uint32_t mask, Body body) {
    for (; mask != 0; mask &= mask - 1) body(static_cast<unsigned>(std::countr_zero(mask)));
}

/// So many warps, if the paths of a picture as large leave memory for other things.
std::size_t affordable(std::size_t warps) {
    constexpr std::uint64_t bytes =
        sizeof(PathLanes) + sizeof(traces::WarpTrace) + 5 * warp_width * sizeof(std::uint32_t);
    MemoryBudget().check(warps * bytes, "a wavefront", fmt::format("its {} paths", warps * warp_width));
    return warps;
}

/// The lanes of `mask` each access one element of a region: element(lane).
template <class Element>
void record(WarpRecorder& recorder, std::uint32_t mask, std::uint8_t region, Element element) {
    if (mask == 0) return;
    OpenRecord out = recorder.open(mask, region);
    for_each_lane(mask, [&](unsigned l) {
        *out.element++ = element(l);
        *out.symbol++ = traces::symbol::end_of_ray;
    });
    recorder.close(out);
}

/// Place of a lane among those of the mask.
std::uint32_t rank(std::uint32_t mask, unsigned lane) {
    return static_cast<std::uint32_t>(std::popcount(mask & ((1U << lane) - 1)));
}

}  // namespace

std::vector<WavefrontKernel> wavefront_kernels(const StagePlan& plan, bool sorted) {
    std::vector<WavefrontKernel> kernels;
    for (std::uint32_t vertex = 0; vertex <= plan.last_vertex; ++vertex) {
        if (sorted && vertex > 0) kernels.push_back({Stage::sort, vertex});
        kernels.push_back({Stage::extend, vertex});
        kernels.push_back({Stage::shade, vertex});
        if (plan.shadow_rays) kernels.push_back({Stage::connect, vertex});
    }
    return kernels;
}

Wavefront::Wavefront(const std::vector<WavefrontKernel>& kernels, const WavefrontBuffers& buffers,
                     const RayOrder* order, const Jobs& jobs)
    : kernels_(kernels),
      buffers_(buffers),
      order_(order),
      state_(affordable(buffers.slots / warp_width)),
      camera_masks_(state_.size()),
      shaded_(state_.size()) {
    std::array<PathLane, warp_width> of_warp;
    for (std::uint32_t warp = 0; warp < state_.size(); ++warp) {
        camera_masks_[warp] = jobs(warp, of_warp);
        for_each_lane(camera_masks_[warp], [&](unsigned l) { state_[warp].job[l] = of_warp[l]; });
    }
}

Wavefront::Work Wavefront::camera_work(std::uint32_t warp) const {
    Work w;
    w.mask = camera_masks_[warp];
    for_each_lane(w.mask, [&](unsigned l) { w.place[l] = w.slot[l] = warp * warp_width + l; });
    return w;
}

Wavefront::Work Wavefront::work(const std::vector<std::uint32_t>& list, std::uint32_t warp) const {
    Work w;
    const std::size_t first = std::size_t{warp} * warp_width;
    for (unsigned l = 0; l < warp_width && first + l < list.size(); ++l) {
        w.mask |= 1U << l;
        w.place[l] = static_cast<std::uint32_t>(first + l);
        w.slot[l] = list[first + l];
    }
    return w;
}

void Wavefront::trace_warp(RecordingWorker& worker, std::uint32_t warp, traces::WarpTrace& out) {
    worker.recorder.clear();
    out.clear();
    switch (kernel().stage) {
        case Stage::sort:
            trace_sort(worker, warp);
            break;
        case Stage::extend:
            trace_extend(worker, warp, out);
            return;
        case Stage::shade:
            trace_shade(worker, warp);
            break;
        case Stage::connect:
            trace_connect(worker, warp);
            break;
    }
    worker.recorder.store(out);
}

void Wavefront::trace_sort(RecordingWorker& worker, std::uint32_t warp) const {
    const Work w = work(queue_, warp);
    worker.recorder.kind(RayType::bounce, static_cast<std::uint8_t>(kernel().vertex));
    const auto place = [&](unsigned l) { return w.place[l]; };
    record(worker.recorder, w.mask, buffers_.sort_rays, place);
    if (!order_->compresses_runs()) return;
    std::uint32_t first_of_run = 0;
    for_each_lane(w.mask, [&](unsigned l) {
        const std::uint32_t i = w.place[l];
        if (i == 0 || keys_[i] != keys_[i - 1]) first_of_run |= 1U << l;
    });
    record(worker.recorder, first_of_run, buffers_.sort_runs, place);
}

void Wavefront::trace_extend(RecordingWorker& worker, std::uint32_t warp, traces::WarpTrace& out) {
    const std::uint32_t vertex = kernel().vertex;
    const auto bounce = static_cast<std::uint8_t>(vertex);
    const Work w = vertex == 0 ? camera_work(warp) : work(queue_, warp);
    Shaded& shaded = shaded_[warp];
    shaded = {};
    if (w.mask == 0) return;
    PathLanes& p = worker.lanes;
    PathStages& path = *worker.integrator->stages();
    WarpRecorder& recorder = worker.recorder;
    for_each_lane(w.mask, [&](unsigned l) { p.copy(l, state_[w.slot[l] / warp_width], w.slot[l] % warp_width); });

    const auto slot = [&](unsigned l) { return w.slot[l]; };
    recorder.kind(ray_type(vertex), bounce);
    if (vertex == 0) {
        path.generate(w.mask, p);
    } else {
        record(recorder, w.mask, buffers_.queues.read,
               [&](unsigned l) { return buffers_.queue_entry(vertex, w.place[l]); });
        record(recorder, w.mask, buffers_.rays.read, slot);
    }
    worker.traversal->closest(w.mask, ray_type(vertex), bounce, p.rays, p.hits);
    if (vertex == 0) {
        record(recorder, w.mask, buffers_.rays.write, slot);
        record(recorder, w.mask, buffers_.paths.write, slot);
    }
    record(recorder, w.mask, buffers_.hits.write, slot);
    recorder.store(out);

    // The next kernel has the same lanes: what it computes is known here; where it appends is not.
    recorder.clear();
    shaded.mask = w.mask;
    const std::uint32_t hit = path.arrive(w.mask, vertex, p);
    const std::uint32_t lit = path.shade(hit, vertex, p);
    shaded.shadow = path.aim_at_light(lit, vertex, p);
    shaded.alive = path.scatter(lit, vertex, p);
    recorder.store(shaded.texels);
    for_each_lane(w.mask, [&](unsigned l) { state_[w.slot[l] / warp_width].copy(w.slot[l] % warp_width, p, l); });
}

void Wavefront::trace_shade(RecordingWorker& worker, std::uint32_t warp) const {
    const std::uint32_t vertex = kernel().vertex;
    const Shaded& shaded = shaded_[warp];
    const Work w = vertex == 0 ? camera_work(warp) : work(queue_, warp);
    WarpRecorder& recorder = worker.recorder;
    const auto slot = [&](unsigned l) { return w.slot[l]; };
    recorder.kind(ray_type(vertex), static_cast<std::uint8_t>(vertex));
    if (vertex > 0)
        record(recorder, w.mask, buffers_.queues.read,
               [&](unsigned l) { return buffers_.queue_entry(vertex, w.place[l]); });
    record(recorder, w.mask, buffers_.hits.read, slot);
    record(recorder, w.mask, buffers_.rays.read, slot);
    record(recorder, w.mask, buffers_.paths.read, slot);
    const std::uint32_t* element = shaded.texels.elements.data();
    for (const traces::Record& texel : shaded.texels.records)
        record(recorder, texel.mask, texel.region, [&](unsigned) { return *element++; });
    record(recorder, w.mask, buffers_.paths.write, slot);
    record(recorder, shaded.shadow, buffers_.shadows.write,
           [&](unsigned l) { return shaded.first_shadow + rank(shaded.shadow, l); });
    record(recorder, shaded.alive, buffers_.rays.write, slot);
    record(recorder, shaded.alive, buffers_.queues.write,
           [&](unsigned l) { return buffers_.queue_entry(vertex + 1, shaded.first_alive + rank(shaded.alive, l)); });
}

void Wavefront::trace_connect(RecordingWorker& worker, std::uint32_t warp) {
    const Work w = work(shadows_, warp);
    if (w.mask == 0) return;
    const auto bounce = static_cast<std::uint8_t>(kernel().vertex);
    PathLanes& p = worker.lanes;
    WarpRecorder& recorder = worker.recorder;
    for_each_lane(w.mask, [&](unsigned l) { p.copy(l, state_[w.slot[l] / warp_width], w.slot[l] % warp_width); });
    recorder.kind(RayType::shadow, bounce);
    record(recorder, w.mask, buffers_.shadows.read, [&](unsigned l) { return w.place[l]; });
    const std::uint32_t unblocked =
        w.mask & ~worker.traversal->occluded(w.mask, RayType::shadow, bounce, p.shadow_rays);
    worker.integrator->stages()->collect_light(unblocked, p);
    const auto slot = [&](unsigned l) { return w.slot[l]; };
    record(recorder, unblocked, buffers_.paths.read, slot);
    record(recorder, unblocked, buffers_.paths.write, slot);
    for_each_lane(unblocked, [&](unsigned l) { state_[w.slot[l] / warp_width].copy(w.slot[l] % warp_width, p, l); });
}

void Wavefront::append() {
    shadows_.clear();
    next_queue_.clear();
    const std::uint32_t vertex = kernel().vertex;
    for (std::uint32_t warp = 0; warp < shaded_.size(); ++warp) {
        Shaded& shaded = shaded_[warp];
        if (shaded.mask == 0) continue;
        const Work w = vertex == 0 ? camera_work(warp) : work(queue_, warp);
        shaded.first_shadow = static_cast<std::uint32_t>(shadows_.size());
        shaded.first_alive = static_cast<std::uint32_t>(next_queue_.size());
        for_each_lane(shaded.shadow, [&](unsigned l) { shadows_.push_back(w.slot[l]); });
        for_each_lane(shaded.alive, [&](unsigned l) { next_queue_.push_back(w.slot[l]); });
    }
}

void Wavefront::make_keys() {
    keys_.resize(queue_.size());
    tbb::parallel_for(std::size_t{0}, queue_.size(), [&](std::size_t i) { keys_[i] = order_->key(ray(queue_[i])); });
}

void Wavefront::end_kernel() {
    switch (kernel().stage) {
        case Stage::sort: {
            std::vector<std::uint32_t> sorted;
            sorted.reserve(queue_.size());
            for (const std::uint32_t i : sorted_indices(keys_)) sorted.push_back(queue_[i]);
            queue_ = std::move(sorted);
            break;
        }
        case Stage::extend:
            append();
            break;
        case Stage::shade:
            queue_.swap(next_queue_);
            break;
        case Stage::connect:
            break;
    }
    ++present_;
    if (present_ < kernels_.size() && kernel().stage == Stage::sort) make_keys();
}

}  // namespace raycache::tracer
