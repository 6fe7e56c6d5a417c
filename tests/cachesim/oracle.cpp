#include "oracle.hpp"

#include <algorithm>
#include <list>
#include <map>
#include <set>
#include <utility>

#include "cachesim/replay/replay.hpp"

namespace raycache::cachesim::test {

namespace {

/// One sectored LRU cache.
class NaiveCache {
public:
    explicit NaiveCache(const CacheGeometry& geometry) : geometry_(geometry) {}

    bool hit(std::uint64_t line, unsigned sector) const {
        const auto set = sets_.find(naive_set(geometry_, line));
        if (set == sets_.end()) return false;
        for (const auto& [tag, sectors] : set->second)
            if (tag == line) return sectors.count(sector) > 0;
        return false;
    }

    void use(std::uint64_t line, const std::set<unsigned>& sectors) {
        auto& set = sets_[naive_set(geometry_, line)];  // newest first
        auto entry = std::find_if(set.begin(), set.end(), [&](const auto& e) { return e.first == line; });
        if (entry == set.end()) {
            set.push_front({line, {}});
            if (set.size() > geometry_.ways) set.pop_back();
        } else {
            set.splice(set.begin(), set, entry);
        }
        set.front().second.insert(sectors.begin(), sectors.end());
    }

private:
    CacheGeometry geometry_;
    std::map<std::uint64_t, std::list<std::pair<std::uint64_t, std::set<unsigned>>>> sets_;
};

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
};

class NaiveReplay {
public:
    NaiveReplay(const Gpu& gpu, const Launch& launch)
        : gpu_(gpu),
          launch_(launch),
          slots_(std::max(1u, gpu.warps_per_sm / gpu.warps_per_cta) * gpu.warps_per_cta),
          resident_(gpu.sms),
          last_(gpu.sms, slots_ - 1),
          l1_(gpu.sms * gpu.l1_per_sm, NaiveCache(gpu.levels[0])),
          l2_(gpu.levels[1]) {
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

private:
    void place(unsigned sm, unsigned first_slot) {
        if (next_cta_ == ctas_.size()) return;
        unsigned slot = first_slot;
        for (const traces::WarpTrace* warp : ctas_[next_cta_++]) {
            if (!warp->elements.empty()) resident_[sm][slot] = {warp, 0, 0};
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
        access(c.warp->records[c.record], &c.warp->elements[c.element], sm * gpu_.l1_per_sm + slot % gpu_.l1_per_sm);
        c.element += c.warp->records[c.record].lanes();
        ++c.record;
        if (c.element < c.warp->elements.size()) return true;
        warps.erase(at);
        const unsigned first = slot / gpu_.warps_per_cta * gpu_.warps_per_cta;
        const auto other = warps.lower_bound(first);
        if (other == warps.end() || other->first >= first + gpu_.warps_per_cta) place(sm, first);
        return true;
    }

    void access(const traces::Record& record, const std::uint32_t* elements, unsigned l1) {
        const traces::Region& region = launch_.regions[record.region];
        Counters& c = group(record).by_kind[static_cast<unsigned>(region.kind)];
        c.warp_accesses += 1;
        c.lane_accesses += record.lanes();
        if (region.kind != traces::ObjectKind::texel) c.steps += record.lanes();
        for (const auto& [line, sectors] : naive_coalesce(region, elements, record.lanes(), gpu_.levels[0])) {
            std::set<unsigned> l1_misses;
            for (const unsigned sector : sectors) {
                c.sectors += 1;
                if (l1_[l1].hit(line, sector)) {
                    c.l1_hits += 1;
                } else {
                    l1_misses.insert(sector);
                }
            }
            l1_[l1].use(line, sectors);
            for (const unsigned sector : l1_misses) {
                c.l2_sectors += 1;
                (l2_.hit(line, sector) ? c.l2_hits : c.dram_sectors) += 1;
            }
            if (!l1_misses.empty()) l2_.use(line, l1_misses);
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
    std::vector<NaiveCache> l1_;
    NaiveCache l2_;
    std::map<std::pair<traces::RayType, std::uint8_t>, RayGroup> groups_;
};

}  // namespace

LaunchStatistics naive_replay(const Gpu& gpu, const Launch& launch, std::uint32_t sample) {
    return {sample, NaiveReplay(gpu, launch).run()};
}

LaunchStatistics replay(const Gpu& gpu, const Launch& launch, std::uint32_t sample, InstructionSet instructions) {
    Replay replay(gpu, launch.regions, sample, instructions);
    for (const auto& warp : launch.warps) replay.push(warp);
    return replay.finish();
}

}  // namespace raycache::cachesim::test
