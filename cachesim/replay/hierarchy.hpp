// The memory system behind the front end: warp accesses in, counts out. What an SM issues in a window of rounds is
// coalesced and looked up in the caches of its own at once, level after level; what the last of them lacks waits for
// the end of the window, then goes to the shared level in order of issue. Nothing comes back.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "cachesim/cache/fill.hpp"
#include "cachesim/cache/level.hpp"
#include "cachesim/cache/line_ids.hpp"
#include "cachesim/cache/lookups.hpp"
#include "cachesim/cache/set_finder.hpp"
#include "cachesim/frontend/coalesce.hpp"
#include "cachesim/frontend/load_counter.hpp"
#include "cachesim/frontend/warp_access.hpp"
#include "cachesim/gpus/gpu.hpp"
#include "cachesim/instruction_set.hpp"
#include "cachesim/replay/first_touches.hpp"
#include "cachesim/replay/miss_window.hpp"
#include "cachesim/replay/request_sink.hpp"
#include "cachesim/replay/tally.hpp"
#include "cachesim/replay/write_back.hpp"

namespace raycache::cachesim {

class Hierarchy {
public:
    Hierarchy(const Gpu&, const std::vector<traces::Region>&, InstructionSet);
    Hierarchy(const Hierarchy&) = delete;
    Hierarchy& operator=(const Hierarchy&) = delete;

    /// From now on the sink, which must outlive this object, hears of the caches that it wants. Throws Error for the
    /// regions of a wavefront.
    void observe(RequestSink&);

    /// Rounds of a window: every SM may run so many rounds ahead of the others.
    std::size_t rounds() const { return misses_.rounds(); }

    void add_rays(const traces::Record& record) { tally_.add_rays(record); }

    /// The warp access that an SM issues through one of its L1s in this round of the window; `elements`: one index per
    /// active lane, valid until end_sm(); `warp`: whose number. Accesses of one SM come in order of rounds, accesses in
    /// one round in order of SMs; end_sm() comes between accesses of different SMs.
    void access(const traces::Record& record, const std::uint32_t* elements, std::uint32_t warp, unsigned l1,
                std::size_t round) {
        const std::uint32_t group = tally_.group(record);
        if (sink_) [[unlikely]]
            sink_->issued({record, elements, warp});
        if (traces::is_stream(kinds_[record.region])) [[unlikely]] {
            pass_all(group, record);
            return;
        }
        accesses_[issued_] = {elements, record.mask, record.region};
        origins_[issued_] = {group, static_cast<std::uint16_t>(round), record.region, static_cast<std::uint8_t>(l1)};
        ++issued_;
    }

    /// The SM's accesses so far are all for now.
    void end_sm(unsigned sm);

    /// All SMs have run all rounds: the shared level's turn.
    void end_window();

    /// All windows have ended, and so has a kernel: the next finds nothing in the L1s of a GPU, all in what is below.
    /// Caches of a CPU (three levels) keep what they have.
    void end_kernel();

    /// The counts of all windows that have ended.
    std::vector<RayGroup> groups() const { return tally_.groups(levels_.size(), count_loads_); }

private:
    /// Where an access of this window comes from.
    struct Origin {
        std::uint32_t group;
        std::uint16_t round;
        std::uint8_t region, l1;
    };

    void pass_all(std::uint32_t group, const traces::Record&);
    void count_accesses();
    void set_writes_apart();
    void look_up(std::size_t level, Lookups&, unsigned sm);
    void look_up_written(Lookups&);
    const std::uint32_t* sets(std::size_t level, const Lookups&, unsigned sm);
    void report(std::size_t level, const Lookups&, unsigned sm) const;

    Gpu gpu_;
    InstructionSet instructions_;
    LineIds ids_;
    Coalescer coalesce_;
    LoadCounter count_loads_;
    std::vector<std::unique_ptr<Level>> levels_;  ///< from L1 down
    std::vector<SetFinder> find_sets_;            ///< of each of them
    std::vector<Fill> fills_;                     ///< likewise
    std::size_t shared_;                          ///< the last of them: one cache for all SMs
    std::vector<traces::ObjectKind> kinds_;       ///< of each region
    std::vector<std::uint32_t> element_bytes_;    ///< likewise
    std::optional<WriteBack> write_back_;         ///< where any region is written
    FirstTouches first_touches_;
    Tally tally_;
    RequestSink* sink_ = nullptr;
    std::vector<WarpAccess> accesses_;      ///< of this window
    std::vector<Origin> origins_;           ///< of each of them
    std::uint32_t issued_ = 0, batch_ = 0;  ///< accesses of this window, and those of SMs that have ended
    Lookups lookups_, written_;             ///< of one SM
    std::vector<std::uint32_t> sectors_;    ///< of each access: count_accesses()
    std::vector<std::uint32_t> asked_;      ///< sectors asked for, while a level answers
    MissWindow misses_;
};

}  // namespace raycache::cachesim
