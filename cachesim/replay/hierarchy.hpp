// The memory system behind the front end: requests in, counts out. Requests are collected and looked up in batches,
// first in the L1s, then what is missing in L2; nothing comes back, so the order at each level stays that of issue.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "cachesim/cache/level.hpp"
#include "cachesim/cache/registry.hpp"
#include "cachesim/frontend/coalesce.hpp"
#include "cachesim/frontend/line_ids.hpp"
#include "cachesim/gpus/gpu.hpp"
#include "cachesim/replay/tally.hpp"

namespace raycache::cachesim {

class Hierarchy {
public:
    Hierarchy(const Gpu& gpu, const std::vector<traces::Region>& regions)
        : ids_(regions, gpu.l1.line_bytes),
          coalesce_(regions, ids_, gpu.l1.line_bytes, gpu.l1.sector_bytes),
          l1_(make_level(gpu.l1, gpu.sms * gpu.l1_per_sm, ids_.count())),
          l2_(make_level(gpu.l2, 1, ids_.count())),
          batch_(batch_size + coalesce_.max_requests()) {
        for (const traces::Region& region : regions) kinds_.push_back(region.kind);
    }

    void add_rays(const traces::Record& record) { tally_.add_rays(record); }

    /// One warp access through this L1; `elements`: one index per active lane.
    void access(const traces::Record& record, const std::uint32_t* elements, std::uint16_t l1) {
        Request like;
        like.cache = l1;
        like.group = tally_.group(record, kinds_[record.region]);
        const unsigned lanes = record.lanes();
        const Coalesced made = coalesce_(record.region, elements, lanes, like, &batch_[pending_]);
        tally_.add_access(like.group, lanes, made.sectors);
        pending_ += made.requests;
        if (pending_ >= batch_size) look_up();
    }

    /// The counts so far.
    std::vector<RayGroup> groups() {
        look_up();
        return tally_.groups();
    }

private:
    static constexpr std::size_t batch_size = 1024;

    void look_up() {
        const std::size_t to_l2 = l1_->process({batch_.data(), pending_}, batch_.data());
        tally_.add_l2({batch_.data(), to_l2});
        const std::size_t to_dram = l2_->process({batch_.data(), to_l2}, batch_.data());
        tally_.add_dram({batch_.data(), to_dram});
        pending_ = 0;
    }

    LineIds ids_;
    Coalescer coalesce_;
    std::unique_ptr<Level> l1_, l2_;
    std::vector<traces::ObjectKind> kinds_;  ///< of each region
    Tally tally_;
    std::vector<Request> batch_;
    std::size_t pending_ = 0;
};

}  // namespace raycache::cachesim
