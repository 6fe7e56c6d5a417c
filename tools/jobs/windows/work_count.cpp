#include "tools/jobs/windows/work_count.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <utility>

namespace raycache::tools {
namespace {

/// Vectors of so many lanes that have an active one.
unsigned vectors_of(std::uint32_t mask, std::uint32_t width) {
    unsigned count = 0;
    for (std::uint32_t lane = 0; lane < traces::warp_lanes; lane += width)
        count += (mask >> lane & ((1U << width) - 1)) != 0;
    return count;
}

std::uint64_t scaled(std::uint64_t count, double factor) {
    return static_cast<std::uint64_t>(std::llround(static_cast<double>(count) * factor));
}

/// All counts by one factor; what is a part of something else stays at most as large.
cachesim::Counters scaled(const cachesim::Counters& c, double factor) {
    cachesim::Counters out;
    out.rays = scaled(c.rays, factor);
    out.steps = scaled(c.steps, factor);
    out.lane_accesses = scaled(c.lane_accesses, factor);
    out.warp_accesses = scaled(c.warp_accesses, factor);
    out.loads = scaled(c.loads, factor);
    out.requests = scaled(c.requests, factor);
    for (std::size_t l = 0; l < c.levels.size(); ++l) {
        out.levels[l].sectors = scaled(c.levels[l].sectors, factor);
        out.levels[l].hits = out.levels[l].sectors - scaled(c.levels[l].sectors - c.levels[l].hits, factor);
    }
    out.dram_sectors = scaled(c.dram_sectors, factor);
    out.written_sectors = scaled(c.written_sectors, factor);
    out.sort_sectors = scaled(c.sort_sectors, factor);
    return out;  // the steady state has no first touches
}

/// Counts of windows, ready to be scaled to any number of accesses.
class Sampled {
public:
    explicit Sampled(const cachesim::LaunchStatistics& windows) {
        for (const cachesim::RayGroup& group : windows.groups) {
            groups_[{group.ray, group.bounce}] = &group;
            for (std::size_t k = 0; k < traces::object_kinds; ++k) of_kind_[k] += group.by_kind[k];
        }
    }

    cachesim::Counters per_access(traces::RayType ray, unsigned bounce, std::size_t kind, double accesses) const {
        const auto found = groups_.find({ray, bounce});
        const cachesim::Counters* from = found == groups_.end() ? nullptr : &found->second->by_kind[kind];
        if (!from || from->warp_accesses == 0) from = &of_kind_[kind];
        if (from->warp_accesses == 0) return {};
        return scaled(*from, accesses / static_cast<double>(from->warp_accesses));
    }

private:
    std::map<std::pair<traces::RayType, unsigned>, const cachesim::RayGroup*> groups_;
    std::array<cachesim::Counters, traces::object_kinds> of_kind_{};
};

/// What is asked of level `last` is what SMs' own caches miss; what it misses is told by windows of the whole GPU. A
/// window that asks more of it than SMs do on average misses more, but not in proportion, for it also finds more there:
/// so half of the misses are those of the windows, the other half their miss rate of what SMs ask. Both halves are
/// unbiased, as a root of the two requests, which scatters as little, is not (docs/estimates.md).
cachesim::Counters joined(const cachesim::Counters& of_sm, const cachesim::Counters& of_gpu, std::size_t last) {
    cachesim::Counters c = of_sm;
    const auto asked = static_cast<double>(of_sm.levels[last].sectors);
    const auto asked_in_windows = static_cast<double>(of_gpu.levels[last].sectors);
    const cachesim::Counters below = scaled(of_gpu, asked_in_windows > 0 ? (1 + asked / asked_in_windows) / 2 : 1);
    const std::uint64_t missed = below.levels[last].sectors - below.levels[last].hits;
    c.levels[last].hits = c.levels[last].sectors - std::min(c.levels[last].sectors, missed);
    c.dram_sectors = below.dram_sectors;
    return c;
}

}  // namespace

WorkCount::WorkCount(const std::vector<traces::Region>& regions, std::vector<std::uint32_t> simd_widths)
    : widths_(std::move(simd_widths)), groups_(traces::ray_types * (traces::max_bounce + 1)) {
    for (const traces::Region& region : regions) kinds_.push_back(region.kind);
}

void WorkCount::add(const traces::WarpTrace& trace) {
    for (const traces::Record& record : trace.records) {
        Group& group = groups_[place(record.ray, record.bounce)];
        if (!record.is_access()) {
            group.rays += record.lanes();
            rays_ += record.lanes();
            continue;
        }
        Accesses& accesses = group.kinds[static_cast<std::size_t>(kinds_[record.region])];
        ++accesses.warps;
        ++warp_accesses_;
        accesses.lanes += record.lanes();
        if (widths_.empty()) continue;
        accesses.vectors.resize(widths_.size());
        for (std::size_t w = 0; w < widths_.size(); ++w) accesses.vectors[w] += vectors_of(record.mask, widths_[w]);
    }
}

double WorkCount::accesses(const Accesses& a, std::uint32_t simd_width) const {
    const auto width = std::find(widths_.begin(), widths_.end(), simd_width);
    if (width == widths_.end()) return static_cast<double>(a.warps);
    const auto w = static_cast<std::size_t>(width - widths_.begin());
    return w < a.vectors.size() ? static_cast<double>(a.vectors[w]) : 0;
}

std::vector<cachesim::RayGroup> WorkCount::launch(const cachesim::LaunchStatistics& of_sms,
                                                  const cachesim::LaunchStatistics& windows, const cachesim::Gpu& gpu,
                                                  double scale) const {
    const Sampled sm_windows(of_sms), gpu_windows(windows);
    const std::size_t last = gpu.levels.size() - 1;
    std::vector<cachesim::RayGroup> all;
    for (unsigned r = 0; r < traces::ray_types; ++r)
        for (unsigned bounce = 0; bounce <= traces::max_bounce; ++bounce) {
            const auto ray = static_cast<traces::RayType>(r);
            const Group& work = groups_[place(ray, bounce)];
            cachesim::RayGroup group;
            group.ray = ray;
            group.bounce = static_cast<std::uint8_t>(bounce);
            group.rays = scaled(work.rays, scale);
            bool occurs = work.rays != 0;
            for (std::size_t k = 0; k < traces::object_kinds; ++k) {
                const double wanted = accesses(work.kinds[k], gpu.simd_width) * scale;
                if (wanted == 0) continue;
                occurs = true;
                cachesim::Counters& to = group.by_kind[k];
                to = joined(sm_windows.per_access(ray, bounce, k, wanted),
                            gpu_windows.per_access(ray, bounce, k, wanted), last);
                to.warp_accesses = static_cast<std::uint64_t>(std::llround(wanted));
                to.lane_accesses = scaled(work.kinds[k].lanes, scale);
                if (traces::role_of(static_cast<traces::ObjectKind>(k)).is_step) to.steps = to.lane_accesses;
            }
            if (occurs) all.push_back(group);
        }
    return all;
}

void WorkCount::scale(cachesim::TimedStatistics& launch, double scale) const {
    if (launch.warp_accesses == 0) return;
    launch *= static_cast<double>(warp_accesses_) * scale / static_cast<double>(launch.warp_accesses);
    launch.rays = scaled(rays_, scale);
}

}  // namespace raycache::tools
