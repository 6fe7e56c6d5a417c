// The memory system behind the front end: warp accesses in, counts out. What an SM requests is collected and looked up
// in its L1s in batches; what is missing there waits for the end of the window of rounds, then goes to L2 in order of
// issue. Nothing comes back.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "cachesim/cache/level.hpp"
#include "cachesim/cache/registry.hpp"
#include "cachesim/frontend/coalesce.hpp"
#include "cachesim/frontend/line_ids.hpp"
#include "cachesim/gpus/gpu.hpp"
#include "cachesim/instruction_set.hpp"
#include "cachesim/replay/miss_window.hpp"
#include "cachesim/replay/request_sink.hpp"
#include "cachesim/replay/tally.hpp"

namespace raycache::cachesim {

using WarpPointer = std::shared_ptr<const traces::WarpTrace>;

class Hierarchy {
public:
    Hierarchy(const Gpu& gpu, const std::vector<traces::Region>& regions, InstructionSet instructions)
        : l1_per_sm_(gpu.l1_per_sm),
          ids_(regions, gpu.levels[0].line_bytes),
          coalesce_(regions, LineShape(gpu.levels[0].line_bytes, gpu.levels[0].sector_bytes), instructions),
          l1_(make_level(gpu.levels[0], gpu.sms * gpu.l1_per_sm, ids_, instructions)),
          l2_(make_level(gpu.levels[1], 1, ids_, instructions)),
          requests_(batch_size + coalesce_.max_requests()),
          rounds_(requests_.size()),
          line_bytes_(gpu.levels[0].line_bytes),
          misses_(std::clamp<std::size_t>(accesses_per_window / gpu.sms, 8, 512), coalesce_.max_requests()) {
        for (const traces::Region& region : regions) kinds_.push_back(region.kind);
    }

    /// From now on the sink, which must outlive this object, hears of the caches that it wants.
    void observe(RequestSink& sink) {
        sink_ = &sink;
        accesses_.resize(requests_.size());
        missing_for_.resize(misses_.rounds());
    }

    /// Rounds of a window: every SM may run so many rounds ahead of the others.
    std::size_t rounds() const { return misses_.rounds(); }

    void add_rays(const traces::Record& record) { tally_.add_rays(record); }

    /// The warp access that an SM issues through one of its L1s in this round of the window; `elements`: one index per
    /// active lane; `warp`: whose. Accesses of one SM come in order of rounds, accesses in one round in order of SMs;
    /// end_sm() comes between accesses of different SMs.
    void access(const traces::Record& record, const std::uint32_t* elements, const WarpPointer& warp, unsigned sm,
                unsigned l1, std::size_t round) {
        Request like;
        like.group = tally_.group(record, kinds_[record.region]);
        like.region = record.region;
        like.cache = static_cast<std::uint8_t>(l1);
        const unsigned lanes = record.lanes();
        const Coalesced made = coalesce_(elements, lanes, like, &requests_[pending_]);
        tally_.add_access(like.group, lanes, made.sectors);
        misses_.reserve(round);
        mark(round, made.requests);
        if (sink_) [[unlikely]]
            announce({record, elements, warp->warp}, made.requests);
        pending_ += made.requests;
        if (pending_ >= batch_size) end_sm(sm);
    }

    /// The SM's accesses so far are all for now.
    void end_sm(unsigned sm) {
        const std::span<Request> asked(requests_.data(), pending_);
        const bool observed = sink_ && sink_->wants_l1(sm);
        if (observed) note(asked);
        l1_->process(asked, sm * l1_per_sm_);
        if (observed)
            for (std::size_t i = 0; i < pending_; ++i) sink_->l1(served(i, asked[i], sm, asked[i].cache, accesses_));
        tally_.add_l2(asked);
        for (std::size_t i = 0; i < pending_; ++i) misses_.add(rounds_[i], asked[i]);
        if (sink_)
            for (std::size_t i = 0; i < pending_; ++i)
                if (asked[i].sectors) missing_for_[rounds_[i]].push_back(accesses_[i]);
        pending_ = 0;
    }

    /// All SMs have run all rounds: L2's turn.
    void end_window() {
        for (std::size_t round = 0; round < misses_.rounds(); ++round) {
            const std::span<Request> asked = misses_.take(round);
            const bool observed = sink_ && sink_->wants_l2();
            if (observed) note(asked);
            l2_->process(asked, 0);
            if (observed)
                for (std::size_t i = 0; i < asked.size(); ++i)
                    sink_->l2(served(i, asked[i], 0, 0, missing_for_[round]));
            tally_.add_dram(asked);
            if (sink_) missing_for_[round].clear();
        }
        if (sink_) sink_->end_window();
        issued_ = 0;
    }

    /// The counts of all windows that have ended.
    std::vector<RayGroup> groups() const { return tally_.groups(); }

private:
    static constexpr std::size_t batch_size = 1024;
    /// Enough that an SM finds its L1s in the machine's caches most of the time; few enough that the misses of a window
    /// stay there, too.
    static constexpr std::size_t accesses_per_window = 8192;

    /// Notes the round of the requests that are about to be pending.
    void mark(std::size_t round, std::size_t requests) {
        std::uint16_t* const rounds = &rounds_[pending_];
        for (std::size_t i = 0; i < few; ++i)
            rounds[i] = static_cast<std::uint16_t>(round);  // a number known beforehand
        for (std::size_t i = few; i < requests; ++i) rounds[i] = static_cast<std::uint16_t>(round);
    }
    static constexpr std::size_t few = 16;

    /// Tells the sink of an access, and notes the number it has there for the requests that are about to be pending.
    void announce(const IssuedAccess& access, std::size_t requests) {
        sink_->issued(access);
        std::fill_n(accesses_.begin() + static_cast<std::ptrdiff_t>(pending_), requests, issued_++);
    }

    /// Keeps what is asked: the answer will stand in its place.
    void note(std::span<const Request> asked) {
        noted_.clear();
        for (const Request& request : asked) noted_.push_back(request.sectors);
    }
    /// Request i of those noted, now answered.
    ServedRequest served(std::size_t i, const Request& answer, unsigned sm, unsigned cache,
                         const std::vector<std::uint32_t>& accesses) const {
        const GroupKey key = tally_.key(answer.group);
        return {answer.line * line_bytes_,
                noted_[i],
                answer.sectors,
                sm,
                cache,
                key.ray,
                key.bounce,
                key.kind,
                accesses[i]};
    }

    unsigned l1_per_sm_;
    LineIds ids_;
    Coalescer coalesce_;
    std::unique_ptr<Level> l1_, l2_;
    std::vector<traces::ObjectKind> kinds_;  ///< of each region
    Tally tally_;
    std::vector<Request> requests_;      ///< of one SM, not yet looked up
    std::vector<std::uint16_t> rounds_;  ///< of each of them
    std::size_t pending_ = 0;
    std::uint32_t line_bytes_;
    RequestSink* sink_ = nullptr;
    std::vector<std::uint32_t> noted_;     ///< sectors asked for, while a level answers and the sink listens
    std::uint32_t issued_ = 0;             ///< accesses of this window, while a sink listens
    std::vector<std::uint32_t> accesses_;  ///< of each pending request, while a sink listens
    std::vector<std::vector<std::uint32_t>> missing_for_;  ///< likewise, of each request in misses_, by round
    MissWindow misses_;
};

}  // namespace raycache::cachesim
