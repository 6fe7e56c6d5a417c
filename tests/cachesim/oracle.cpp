#include "oracle.hpp"

#include <algorithm>
#include <bit>
#include <map>
#include <set>
#include <utility>

#include "cachesim/replay/replay.hpp"
#include "naive_cache.hpp"

namespace raycache::cachesim::test {

namespace {

/// Distinct (line, sectors) in order of first touch.
std::vector<std::pair<std::uint64_t, std::set<unsigned>>> naive_coalesce(const traces::Region& region,
                                                                         const std::uint32_t* elements, unsigned lanes,
                                                                         const CacheGeometry& cache) {
    std::vector<std::pair<std::uint64_t, std::set<unsigned>>> lines;
    for (unsigned lane = 0; lane < lanes; ++lane) {
        for (std::uint64_t byte = 0; byte < region.element_size; ++byte) {
            const std::uint64_t address = region.address(elements[lane]) + byte;
            const std::uint64_t line = address / cache.line_bytes;
            const auto sector = static_cast<unsigned>(address % cache.line_bytes / cache.sector_bytes);
            auto at = std::find_if(lines.begin(), lines.end(), [&](const auto& l) { return l.first == line; });
            if (at == lines.end()) at = lines.insert(lines.end(), {line, {}});
            at->second.insert(sector);
        }
    }
    return lines;
}

struct Cursor {
    const traces::WarpTrace* warp = nullptr;
    std::size_t record = 0, element = 0;
    unsigned lane = 0;  ///< of the record: those before it are done
};

class NaiveReplay {
public:
    NaiveReplay(const Gpu& gpu, const Launch& launch)
        : gpu_(gpu),
          launch_(launch),
          slots_(std::max(1u, gpu.warps_per_sm / gpu.warps_per_cta) * gpu.warps_per_cta),
          resident_(gpu.sms),
          last_(gpu.sms, slots_ - 1),
          caches_(gpu.levels.size()) {
        for (std::size_t level = 0; level < caches_.size(); ++level) {
            const bool shared = level + 1 == caches_.size();
            const unsigned caches = shared ? 1 : level == 0 ? gpu.sms * gpu.l1_per_sm : gpu.sms;
            for (unsigned i = 0; i < caches; ++i) caches_[level].emplace_back(gpu.levels[level], i);
        }
        for (std::size_t w = 0; w < launch.warps.size(); w += gpu.warps_per_cta) {
            std::vector<const traces::WarpTrace*> cta;
            bool any = false;
            for (std::size_t i = w; i < std::min<std::size_t>(w + gpu.warps_per_cta, launch.warps.size()); ++i) {
                cta.push_back(launch.warps[i].get());
                any = any || !launch.warps[i]->elements.empty();
                for (const traces::Record& r : launch.warps[i]->records)
                    if (!r.is_access()) group(r).rays += r.lanes();
            }
            if (any) ctas_.push_back(cta);
        }
    }

    std::vector<RayGroup> run() {
        for (unsigned slot = 0; slot < slots_; slot += gpu_.warps_per_cta)
            for (unsigned sm = 0; sm < gpu_.sms; ++sm) place(sm, slot);
        for (bool any = true; any;) {
            any = false;
            for (unsigned sm = 0; sm < gpu_.sms; ++sm) any = turn(sm) || any;
        }
        std::vector<RayGroup> groups;
        for (auto& [key, g] : groups_) groups.push_back(g);
        return groups;
    }

    LineFills last_level_fills() const { return caches_.back().front().fills(); }

private:
    void place(unsigned sm, unsigned first_slot) {
        if (next_cta_ == ctas_.size()) return;
        unsigned slot = first_slot;
        for (const traces::WarpTrace* warp : ctas_[next_cta_++]) {
            if (!warp->elements.empty()) resident_[sm][slot] = {warp, 0, 0, 0};
            ++slot;
        }
    }

    bool turn(unsigned sm) {
        auto& warps = resident_[sm];
        if (warps.empty()) return false;
        auto at = warps.upper_bound(last_[sm]);
        if (at == warps.end()) at = warps.begin();
        const unsigned slot = last_[sm] = at->first;
        Cursor& c = at->second;
        while (!c.warp->records[c.record].is_access()) ++c.record;
        const traces::Record& record = c.warp->records[c.record];
        std::uint32_t vector = 0;
        for (; vector == 0; c.lane += gpu_.simd_width)
            for (unsigned lane = c.lane; lane < c.lane + gpu_.simd_width; ++lane)
                vector |= record.mask & std::uint32_t{1} << lane;
        access(record, vector, &c.warp->elements[c.element], sm, slot);
        c.element += static_cast<unsigned>(std::popcount(vector));
        const bool lanes_left = c.lane < traces::warp_lanes && record.mask >> c.lane != 0;
        if (!lanes_left) {
            c.lane = 0;
            ++c.record;
        }
        if (c.element < c.warp->elements.size()) return true;
        warps.erase(at);
        const unsigned first = slot / gpu_.warps_per_cta * gpu_.warps_per_cta;
        const auto other = warps.lower_bound(first);
        if (other == warps.end() || other->first >= first + gpu_.warps_per_cta) place(sm, first);
        return true;
    }

    /// One vector of lanes; `elements` are those of its active lanes.
    void access(const traces::Record& record, std::uint32_t mask, const std::uint32_t* elements, unsigned sm,
                unsigned slot) {
        const traces::Region& region = launch_.regions[record.region];
        const auto lanes = static_cast<unsigned>(std::popcount(mask));
        Counters& c = group(record).by_kind[static_cast<unsigned>(region.kind)];
        c.warp_accesses += 1;
        c.lane_accesses += lanes;
        if (region.kind != traces::ObjectKind::texel) c.steps += lanes;
        count_loads(region, mask, elements, c);
        for (const auto& [line, sectors] : naive_coalesce(region, elements, lanes, gpu_.levels[0])) {
            std::set<unsigned> asked = sectors;
            for (std::size_t level = 0; level < gpu_.levels.size() && !asked.empty(); ++level) {
                const bool shared = level + 1 == gpu_.levels.size();
                const unsigned cache = shared ? 0 : level == 0 ? sm * gpu_.l1_per_sm + slot % gpu_.l1_per_sm : sm;
                const auto answer = caches_[level][cache].look_up(line, asked);
                c.levels[level].sectors += asked.size();
                c.levels[level].hits += asked.size() - answer.missing.size();
                asked = answer.fetched;
            }
            c.dram_sectors += asked.size();
            for (const unsigned sector : asked) c.dram_first_sectors += held_.emplace(line, sector).second;
        }
    }

    /// Load by load, group by group.
    void count_loads(const traces::Region& region, std::uint32_t mask, const std::uint32_t* elements, Counters& c) {
        std::uint32_t bytes = 1;
        while (bytes < gpu_.front_end.load_bytes && bytes < region.element_size) bytes *= 2;
        const std::uint32_t together = bytes == 16  ? gpu_.front_end.lanes_per_request_16
                                       : bytes == 8 ? gpu_.front_end.lanes_per_request_8
                                                    : gpu_.front_end.lanes_per_request_4;
        for (std::uint32_t begin = 0; begin < region.element_size; begin += bytes) {
            c.loads += 1;
            std::set<std::pair<unsigned, std::uint64_t>> requests;  // group and sector
            const std::uint32_t* element = elements;
            for (unsigned lane = 0; lane < traces::warp_lanes; ++lane) {
                if (!(mask >> lane & 1)) continue;
                const std::uint64_t address = region.address(*element), sector = gpu_.levels[0].sector_bytes;
                const std::uint32_t end = std::min(begin + bytes, region.element_size);
                for (std::uint64_t n = (address + begin) / sector; n <= (address + end - 1) / sector; ++n)
                    requests.insert({lane / together, n});
                ++element;
            }
            c.requests += requests.size();
        }
    }

    RayGroup& group(const traces::Record& r) {
        RayGroup& g = groups_[{r.ray, r.bounce}];
        g.ray = r.ray;
        g.bounce = r.bounce;
        return g;
    }

    Gpu gpu_;
    const Launch& launch_;
    unsigned slots_;
    std::vector<std::vector<const traces::WarpTrace*>> ctas_;
    std::size_t next_cta_ = 0;
    std::vector<std::map<unsigned, Cursor>> resident_;  ///< per SM: unfinished warps by slot
    std::vector<unsigned> last_;                        ///< per SM: slot of the last turn
    std::vector<std::vector<NaiveCache>> caches_;       ///< of each level
    std::map<std::pair<traces::RayType, std::uint8_t>, RayGroup> groups_;
    std::set<std::pair<std::uint64_t, unsigned>> held_;  ///< lines and sectors that ever came from DRAM
};

}  // namespace

LaunchStatistics naive_replay(const Gpu& gpu, const Launch& launch, std::uint32_t sample) {
    return {sample, NaiveReplay(gpu, launch).run()};
}

LineFills naive_last_level_fills(const Gpu& gpu, const Launch& launch) {
    NaiveReplay replay(gpu, launch);
    replay.run();
    return replay.last_level_fills();
}

LaunchStatistics replay(const Gpu& gpu, const Launch& launch, std::uint32_t sample, InstructionSet instructions) {
    Replay replay(gpu, launch.regions, sample, instructions);
    for (const auto& warp : launch.warps) replay.push(warp);
    return replay.finish();
}

}  // namespace raycache::cachesim::test
