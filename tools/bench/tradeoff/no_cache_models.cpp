#include "tools/bench/tradeoff/no_cache_models.hpp"

#include <bit>

namespace raycache::bench {
namespace {

std::uint64_t lines_of(const cachesim::CacheGeometry& g) { return std::uint64_t{g.slices} * g.sets * g.ways; }

cachesim::StackDistance distances_of(const cachesim::CacheGeometry& g) {
    return cachesim::StackDistance(g.line_bytes / g.sector_bytes, std::max(1U, g.fill_bytes / g.sector_bytes));
}

}  // namespace

Waves::Waves(const cachesim::Gpu& gpu, const std::vector<traces::Region>& regions)
    : sms_(gpu.sms),
      warps_per_cta_(gpu.warps_per_cta),
      ids_(regions, gpu.l1().line_bytes),
      coalesce_(regions, {gpu.l1().line_bytes, gpu.l1().sector_bytes}, ids_, cachesim::best_instruction_set()),
      loads_(regions, gpu.front_end, {gpu.l1().line_bytes, gpu.l1().sector_bytes}),
      warps_(gpu.sms),
      turn_(gpu.sms) {
    for (const traces::Region& region : regions) kinds_.push_back(region.kind);
}

void Waves::place(const Wave& warps) {
    for (auto& of_sm : warps_) of_sm.clear();
    for (std::size_t w = 0; w < warps.size(); ++w) {
        const traces::WarpTrace& trace = *warps[w];
        warps_[w / warps_per_cta_ % sms_].push_back(
            {trace.records.data(), trace.records.data() + trace.records.size(), trace.elements.data()});
    }
    for (std::size_t& turn : turn_) turn = 0;
}

bool Waves::issue(std::uint32_t sm, bool counted, Demand& counts) {
    auto& warps = warps_[sm];
    std::size_t& turn = turn_[sm];
    while (!warps.empty()) {
        if (turn >= warps.size()) turn = 0;
        Warp& warp = warps[turn];
        for (; warp.next != warp.end && !warp.next->is_access(); ++warp.next)
            if (counted) counts.rays += warp.next->lanes();
        if (warp.next == warp.end) {
            warps.erase(warps.begin() + static_cast<std::ptrdiff_t>(turn));
            continue;
        }
        const traces::Record& record = *warp.next++;
        const cachesim::WarpAccess access{warp.elements, record.mask, record.region};
        warp.elements += record.lanes();
        ++turn;
        found_.count = 0;
        coalesce_({&access, 1}, 0, found_);
        if (counted) {
            ++counts.accesses[static_cast<std::size_t>(kinds_[record.region])];
            counts.loads += loads_.loads(record.region);
            for (std::size_t i = 0; i < found_.count; ++i)
                counts.l1 += static_cast<unsigned>(std::popcount(found_.sectors[i]));
        }
        return true;
    }
    return false;
}

UniqueSectors::UniqueSectors(const cachesim::Gpu& gpu, const std::vector<traces::Region>& regions)
    : waves_(gpu, regions), seen_(gpu.sms + 1) {}

std::uint32_t UniqueSectors::add(std::vector<Seen>& all, std::uint32_t line, std::uint32_t sectors) const {
    if (line >= all.size()) all.resize(std::size_t{line} + 1 + line / 2);
    Seen& seen = all[line];
    if (seen.wave != wave_) seen = {wave_, 0};
    const std::uint32_t fresh = sectors & ~seen.sectors;
    seen.sectors |= sectors;
    return fresh;
}

void UniqueSectors::wave(const Wave& warps, bool counted) {
    ++wave_;
    waves_.run(warps, counted, counts_, [&](std::uint32_t sm, std::uint32_t line, std::uint32_t sectors) {
        const std::uint32_t of_sm = add(seen_[sm], line, sectors);
        const std::uint32_t of_gpu = of_sm ? add(seen_.back(), line, of_sm) : 0;
        if (!counted) return;
        counts_.l2 += static_cast<unsigned>(std::popcount(of_sm));
        counts_.dram += static_cast<unsigned>(std::popcount(of_gpu));
    });
}

ReuseDistances::ReuseDistances(const cachesim::Gpu& gpu, const std::vector<traces::Region>& regions)
    : waves_(gpu, regions),
      l2_(distances_of(gpu.levels.back())),
      l1_lines_(lines_of(gpu.l1())),
      l2_lines_(lines_of(gpu.levels.back())) {
    for (std::uint32_t sm = 0; sm < gpu.sms; ++sm) l1_.push_back(distances_of(gpu.l1()));
}

void ReuseDistances::wave(const Wave& warps, bool counted) {
    waves_.run(warps, counted, counts_, [&](std::uint32_t sm, std::uint32_t line, std::uint32_t sectors) {
        std::uint32_t missing = 0;
        l1_[sm].look_up(line, sectors, [&](std::uint32_t distance, unsigned sector) {
            if (distance >= l1_lines_) missing |= 1U << sector;
        });
        if (!missing) return;
        std::uint32_t from_dram = 0;
        l2_.look_up(line, missing, [&](std::uint32_t distance, unsigned) { from_dram += distance >= l2_lines_; });
        if (!counted) return;
        counts_.l2 += static_cast<unsigned>(std::popcount(missing));
        counts_.dram += from_dram;
    });
}

}  // namespace raycache::bench
