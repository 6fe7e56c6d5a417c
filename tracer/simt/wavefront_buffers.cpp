#include "tracer/simt/wavefront_buffers.hpp"

namespace raycache::tracer {

WavefrontBuffers add_wavefront_buffers(std::vector<traces::Region>& regions, std::uint32_t slots,
                                       const SortCost& sort) {
    using traces::ObjectKind;
    std::uint64_t base = 0x40'0000'0000;
    const auto add = [&](ObjectKind kind, std::uint32_t bytes, std::uint32_t count) {
        traces::Region region;
        region.kind = kind;
        region.base = base;
        region.element_size = region.stride = bytes;
        region.count = count;
        regions.push_back(region);
        return static_cast<std::uint8_t>(regions.size() - 1);
    };
    const auto buffer = [&](ObjectKind read, ObjectKind write, std::uint32_t bytes, std::uint32_t count) {
        const WavefrontBuffers::Buffer made{add(read, bytes, count), add(write, bytes, count)};
        base += 0x10'0000'0000;
        return made;
    };
    WavefrontBuffers b;
    b.slots = slots;
    b.rays = buffer(ObjectKind::ray_state, ObjectKind::ray_state_write, 32, slots);
    b.paths = buffer(ObjectKind::ray_state, ObjectKind::ray_state_write, 32, slots);
    b.hits = buffer(ObjectKind::hit, ObjectKind::hit_write, 16, slots);
    b.queues = buffer(ObjectKind::queue, ObjectKind::queue_write, 4, 2 * slots);
    b.shadows = buffer(ObjectKind::ray_state, ObjectKind::ray_state_write, 48, slots);
    if (sort.bytes_per_ray != 0) b.sort_rays = add(ObjectKind::sort, sort.bytes_per_ray, slots);
    base += 0x10'0000'0000;
    if (sort.bytes_per_run != 0) b.sort_runs = add(ObjectKind::sort, sort.bytes_per_run, slots);
    return b;
}

}  // namespace raycache::tracer
