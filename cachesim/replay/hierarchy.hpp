// The memory system behind the front end: warp accesses in, counts out. What an SM requests is collected and looked up
// in the caches of its own in batches, level after level; what the last of them lacks waits for the end of the window
// of rounds, then goes to the shared level in order of issue. Nothing comes back.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "cachesim/cache/fill.hpp"
#include "cachesim/cache/level.hpp"
#include "cachesim/cache/registry.hpp"
#include "cachesim/frontend/coalesce.hpp"
#include "cachesim/frontend/line_ids.hpp"
#include "cachesim/frontend/load_counter.hpp"
#include "cachesim/gpus/gpu.hpp"
#include "cachesim/instruction_set.hpp"
#include "cachesim/replay/miss_window.hpp"
#include "cachesim/replay/request_sink.hpp"
#include "cachesim/replay/tally.hpp"
#include "cachesim/replay/write_back.hpp"
#include "traces/error.hpp"

namespace raycache::cachesim {

using WarpPointer = std::shared_ptr<const traces::WarpTrace>;

class Hierarchy {
public:
    Hierarchy(const Gpu& gpu, const std::vector<traces::Region>& regions, InstructionSet instructions)
        : gpu_(gpu),
          instructions_(instructions),
          l1_per_sm_(gpu.l1_per_sm),
          ids_(regions, gpu.l1().line_bytes),
          coalesce_(regions, LineShape(gpu.l1().line_bytes, gpu.l1().sector_bytes), instructions),
          count_loads_(regions, gpu.front_end, LineShape(gpu.l1().line_bytes, gpu.l1().sector_bytes)),
          shared_(gpu.levels.size() - 1),
          requests_(batch_size + coalesce_.max_requests()),
          rounds_(requests_.size()),
          line_bytes_(gpu.l1().line_bytes),
          misses_(std::clamp<std::size_t>(accesses_per_window / gpu.sms, 8, 512), coalesce_.max_requests()) {
        for (std::size_t level = 0; level <= shared_; ++level) {
            const unsigned caches = level == shared_ ? 1 : level == 0 ? gpu.sms * gpu.l1_per_sm : gpu.sms;
            levels_.push_back(make_level(gpu.levels[level], caches, ids_, instructions));
            fills_.emplace_back(gpu.levels[level]);
        }
        for (const traces::Region& region : regions) {
            kinds_.push_back(region.kind);
            element_bytes_.push_back(region.element_size);
            writes_ |= traces::is_write(region.kind);
            plain_ &= region.kind < traces::ObjectKind::ray_state;
        }
        if (writes_) write_back_.emplace(ids_);
    }

    /// From now on the sink, which must outlive this object, hears of the caches that it wants.
    void observe(RequestSink& sink) {
        if (!plain_) throw Error("trace of a wavefront: expected one of a megakernel, whose requests can be followed");
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
        if (!plain_ && kinds_[record.region] >= traces::ObjectKind::ray_state_write) {
            pass_l1(record, elements, like, round);
            return;
        }
        const Coalesced made = coalesce_(elements, lanes, like, &requests_[pending_]);
        tally_.add_access(like.group, lanes, made.sectors,
                          count_loads_(record.region, record.mask, elements, made.sectors));
        misses_.reserve(round);
        mark(round, made.requests);
        if (sink_) [[unlikely]]
            announce({record, elements, warp->warp}, made.requests);
        pending_ += made.requests;
        if (pending_ >= batch_size) end_sm(sm);
    }

    /// The SM's accesses so far are all for now.
    void end_sm(unsigned sm) {
        look_up(0, {requests_.data(), pending_}, sm * l1_per_sm_, sm, accesses_);
        for (std::size_t level = 1; level < shared_; ++level) {
            keep_fetched();
            look_up(level, {requests_.data(), pending_}, sm, sm, accesses_);
        }
        for (std::size_t i = 0; i < pending_; ++i) misses_.add(rounds_[i], requests_[i]);
        if (sink_)
            for (std::size_t i = 0; i < pending_; ++i)
                if (requests_[i].sectors) missing_for_[rounds_[i]].push_back(accesses_[i]);
        pending_ = 0;
    }

    /// All SMs have run all rounds: the shared level's turn.
    void end_window() {
        for (std::size_t round = 0; round < misses_.rounds(); ++round) {
            const std::span<Request> requests = misses_.take(round);
            if (writes_)
                look_up_written(requests);
            else
                look_up(shared_, requests, 0, 0, missing_for_.empty() ? accesses_ : missing_for_[round]);
            if (sink_) missing_for_[round].clear();
        }
        if (sink_) sink_->end_window();
        issued_ = 0;
    }

    /// All windows have ended, and so has a kernel: the next finds nothing in the L1s of a GPU, all in what is below.
    /// Caches of a CPU (three levels) keep what they have.
    void end_kernel() {
        if (shared_ == 1) levels_[0] = make_level(gpu_.levels[0], gpu_.sms * gpu_.l1_per_sm, ids_, instructions_);
    }

    /// The counts of all windows that have ended.
    std::vector<RayGroup> groups() const { return tally_.groups(levels_.size()); }

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

    /// Leaves in the requests what the level fetches for them. `accesses`: of each of them, while a sink listens.
    void look_up(std::size_t level, std::span<Request> requests, std::uint32_t first_cache, unsigned sm,
                 const std::vector<std::uint32_t>& accesses) {
        const bool observed = sink_ && sink_->wants(level, sm), widens = fills_[level].widens();
        if (observed || widens) {
            asked_.clear();
            for (const Request& request : requests) asked_.push_back(request.sectors);
        }
        levels_[level]->process(requests, first_cache);
        if (observed) report(level, requests, sm, accesses);
        if (widens) tally_.add_unasked(level, requests, asked_);
        tally_.add_fetched(level, requests);
    }

    /// Writes go through to the shared level and leave no trace above; what a sort moves goes past all levels.
    void pass_l1(const traces::Record& record, const std::uint32_t* elements, const Request& like, std::size_t round) {
        const unsigned lanes = record.lanes();
        if (kinds_[record.region] == traces::ObjectKind::sort) {
            const std::uint32_t sector = gpu_.l1().sector_bytes;
            const auto sectors = (lanes * element_bytes_[record.region] + sector - 1) / sector;
            tally_.add_access(like.group, lanes, sectors, {0, sectors});
            tally_.add_passing(shared_, like.group, sectors);
            return;
        }
        written_.resize(coalesce_.max_requests());
        const Coalesced made = coalesce_(elements, lanes, like, written_.data());
        tally_.add_access(like.group, lanes, made.sectors,
                          count_loads_(record.region, record.mask, elements, made.sectors));
        tally_.add_passing(shared_ - 1, like.group, made.sectors);
        misses_.reserve(round);
        for (std::size_t i = 0; i < made.requests; ++i) misses_.add(round, written_[i]);
    }

    /// The shared level of a launch that writes: a written sector is there afterwards without being read from DRAM, and
    /// is written to DRAM once for each time that it was changed and then evicted (or was left at the end).
    void look_up_written(std::span<Request> requests) {
        asked_.clear();
        for (const Request& request : requests) asked_.push_back(request.sectors);
        levels_[shared_]->process(requests, 0);
        std::size_t reads = 0;
        for (std::size_t i = 0; i < requests.size(); ++i) {
            Request& r = requests[i];
            if (traces::is_write(kinds_[r.region])) {
                tally_.add_fetched(shared_, r.group, write_back_->write(r, asked_[i]));
            } else {
                write_back_->read(r);
                asked_[reads] = asked_[i];
                requests[reads++] = r;
            }
        }
        const auto read = requests.first(reads);
        if (fills_[shared_].widens()) tally_.add_unasked(shared_, read, asked_);
        tally_.add_fetched(shared_, read);
    }

    void report(std::size_t level, std::span<const Request> answers, unsigned sm,
                const std::vector<std::uint32_t>& accesses) const {
        for (std::size_t i = 0; i < answers.size(); ++i) {
            const Request& answer = answers[i];
            const GroupKey key = tally_.key(answer.group);
            sink_->served(level, {answer.line * line_bytes_, asked_[i], answer.sectors & asked_[i], sm,
                                  level == 0 ? answer.cache : 0u, key.ray, key.bounce, key.kind, accesses[i]});
        }
    }

    /// Of the pending requests, keeps those that a level did not answer alone, for the SM's one cache of the next.
    void keep_fetched() {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < pending_; ++i) {
            requests_[kept] = requests_[i];
            requests_[kept].cache = 0;
            rounds_[kept] = rounds_[i];
            if (sink_) accesses_[kept] = accesses_[i];
            kept += requests_[i].sectors != 0;
        }
        pending_ = kept;
    }

    /// Tells the sink of an access, and notes the number it has there for the requests that are about to be pending.
    void announce(const IssuedAccess& access, std::size_t requests) {
        sink_->issued(access);
        std::fill_n(accesses_.begin() + static_cast<std::ptrdiff_t>(pending_), requests, issued_++);
    }

    Gpu gpu_;
    InstructionSet instructions_;
    unsigned l1_per_sm_;
    LineIds ids_;
    Coalescer coalesce_;
    LoadCounter count_loads_;
    std::vector<std::unique_ptr<Level>> levels_;  ///< from L1 down
    std::vector<Fill> fills_;                     ///< of each of them
    std::size_t shared_;                          ///< the last of them: one cache for all SMs
    std::vector<traces::ObjectKind> kinds_;       ///< of each region
    std::vector<std::uint32_t> element_bytes_;    ///< likewise
    bool writes_ = false;                         ///< whether any region is written
    bool plain_ = true;                           ///< all regions are those of a megakernel
    std::optional<WriteBack> write_back_;         ///< where any is
    std::vector<Request> written_;                ///< of one access
    Tally tally_;
    std::vector<Request> requests_;      ///< of one SM, not yet looked up
    std::vector<std::uint16_t> rounds_;  ///< of each of them
    std::size_t pending_ = 0;
    std::uint32_t line_bytes_;
    RequestSink* sink_ = nullptr;
    std::vector<std::uint32_t> asked_;                     ///< sectors asked for, while a level answers
    std::uint32_t issued_ = 0;                             ///< accesses of this window, while a sink listens
    std::vector<std::uint32_t> accesses_;                  ///< of each pending request, while a sink listens
    std::vector<std::vector<std::uint32_t>> missing_for_;  ///< likewise, of each request in misses_, by round
    MissWindow misses_;
};

}  // namespace raycache::cachesim
