// Traffic of a wavefront that a timed replay charges as bandwidth alone: what warps write, and what sorts move.
//
// A store needs no answer, so no warp waits for it. Every distinct sector that a warp access writes is taken to go to
// DRAM once, which is more than the functional replay finds (there a sector changed twice in L2 is written once). The
// time of these bytes at the bandwidth of DRAM is added to the launch, as if nothing overlapped it: true of a sort,
// pessimistic for writes. Where the trace says what else a warp issues, the store is one instruction of it.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <memory>
#include <vector>

#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

class StreamedTraffic {
public:
    StreamedTraffic(const std::vector<traces::Region>& regions, std::uint32_t sector_bytes)
        : regions_(regions), sector_bytes_(sector_bytes) {
        for (const traces::Region& r : regions) any_ |= streams(r);
    }

    /// The warp without the records that stream, whose sectors are added up.
    std::shared_ptr<const traces::WarpTrace> take(std::shared_ptr<const traces::WarpTrace> warp) {
        if (!any_) return warp;
        auto rest = std::make_shared<traces::WarpTrace>();
        rest->launch = warp->launch;
        rest->warp = warp->warp;
        const std::uint32_t* element = warp->elements.data();
        std::vector<bool> kept;
        for (const traces::Record& record : warp->records) {
            const unsigned lanes = record.is_access() ? record.lanes() : 0;
            if (lanes != 0 && streams(regions_[record.region])) {
                sectors_ += sectors_of(regions_[record.region], element, lanes);
            } else {
                rest->records.push_back(record);
                rest->elements.insert(rest->elements.end(), element, element + lanes);
            }
            if (lanes != 0) kept.push_back(!streams(regions_[record.region]));
            element += lanes;
        }
        if (!warp->issue.empty()) rest->issue = steps_of(*warp, kept);
        return rest;
    }

    std::uint64_t sectors() const { return sectors_; }

    /// From now on addresses of written sectors are kept, one for each that sectors() has but for those of sorts.
    void keep_written() { keep_ = true; }
    const std::vector<std::uint64_t>& written() const { return written_; }
    void forget_written() { written_.clear(); }

private:
    static bool streams(const traces::Region& r) { return traces::role_of(r.kind).access != traces::AccessType::read; }

    /// Where some accesses are left out: each of them is an instruction that nothing waits for.
    static std::vector<traces::IssueStep> steps_of(const traces::WarpTrace& warp, const std::vector<bool>& kept) {
        std::vector<std::uint32_t> before(1, 0);  // kept accesses before each
        for (const bool keeps : kept) before.push_back(before.back() + keeps);
        std::vector<traces::IssueStep> steps;
        const auto add = [&](const traces::IssueStep& step) {
            if (step.needs == 0 && !steps.empty() && steps.back().access == step.access)
                steps.back().instructions += step.instructions;
            else
                steps.push_back(step);
        };
        auto next = warp.issue.begin();
        for (std::uint32_t access = 0; access < before.size(); ++access) {
            for (; next != warp.issue.end() && next->access == access; ++next) {
                const bool needs = next->needs != 0 && kept[next->needs - 1];
                add({before[access], needs ? before[next->needs - 1] + 1 : 0, next->instructions});
            }
            if (access < kept.size() && !kept[access]) add({before[access], 0, 1});
        }
        return steps;
    }

    std::uint64_t sectors_of(const traces::Region& region, const std::uint32_t* elements, unsigned lanes) {
        if (traces::is_stream(region.kind))
            return (std::uint64_t{lanes} * region.element_size + sector_bytes_ - 1) / sector_bytes_;
        touched_.clear();
        for (unsigned i = 0; i < lanes; ++i) {
            const std::uint64_t first = region.address(elements[i]) / sector_bytes_;
            const std::uint64_t last = (region.address(elements[i]) + region.element_size - 1) / sector_bytes_;
            for (std::uint64_t s = first; s <= last; ++s) touched_.push_back(s);
        }
        std::sort(touched_.begin(), touched_.end());
        touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
        if (keep_)
            for (const std::uint64_t sector : touched_) written_.push_back(sector * sector_bytes_);
        return touched_.size();
    }

    const std::vector<traces::Region>& regions_;
    std::uint32_t sector_bytes_;
    bool any_ = false;
    std::uint64_t sectors_ = 0;
    std::vector<std::uint64_t> touched_;
    bool keep_ = false;
    std::vector<std::uint64_t> written_;  ///< addresses
};

}  // namespace raycache::cachesim
