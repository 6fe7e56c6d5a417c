// A warp that is resident: what it reads next, record by record, vector by vector.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "cachesim/replay/timed/cycle.hpp"
#include "cachesim/replay/timed/timed_rules.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

class ResidentWarp {
public:
    /// From its first record on.
    void begin(std::shared_ptr<const traces::WarpTrace>, Cycle since);
    bool resident() const { return trace_ != nullptr; }
    Cycle since() const { return since_; }
    void end() { trace_.reset(); }

    /// The trace says what the warp waits for and issues beside its accesses (traces::WarpTrace::issue).
    bool has_steps() const { return step_end_ != nullptr; }
    /// The step that stands before the next access, which stays until it is taken; nullptr: none.
    const traces::IssueStep* step() const {
        return step_ != step_end_ && left_ == 0 && step_->access <= accesses_ ? step_ : nullptr;
    }
    void take_step() { ++step_; }
    /// Nothing is left to read, once rays that begin have been passed (shading()).
    bool at_end() const { return next_ == end_; }
    /// Records of accesses that the warp has begun.
    std::uint32_t accesses() const { return accesses_; }

    /// Instructions before the next access, for the rays that begin there. None where the trace has steps.
    std::uint32_t shading(const TimedRules& rules) {
        std::uint32_t starts = 0;
        for (; next_ != end_ && !next_->is_access(); ++next_) ++starts;
        if (starts > 0) among_triangles_ = false;
        return has_steps() ? 0 : starts * rules.timing.shading_instructions;
    }

    /// The next access is about to be taken: its record and its elements come nearer.
    void prefetch() const {
        __builtin_prefetch(next_);
        __builtin_prefetch(elements_);
        __builtin_prefetch(elements_ + 16);
    }

    /// What one visit reads.
    struct Access {
        std::uint32_t region = 0;
        std::uint32_t mask = 0;  ///< active lanes
        unsigned lanes = 0;      ///< how many
        const std::uint32_t* elements = nullptr;
        std::uint32_t leaf_instructions = 0;
    };
    /// Takes the next access, which stands before no ray that begins; none if there is none.
    std::optional<Access> next(const TimedRules&);

private:
    std::uint32_t leaf(const TimedRules&, std::uint32_t region, unsigned lanes);

    std::shared_ptr<const traces::WarpTrace> trace_;
    const traces::Record *next_ = nullptr, *end_ = nullptr;
    const std::uint32_t* elements_ = nullptr;  ///< of `next_`, from the first lane left on
    std::uint32_t left_ = 0;                   ///< lanes of `next_` that have not had their turn; 0: none has
    bool among_triangles_ = false;             ///< the last step was to triangles (LeafStarts)
    const traces::IssueStep *step_ = nullptr, *step_end_ = nullptr;  ///< the next; of a trace without: nullptr
    std::uint32_t accesses_ = 0;
    Cycle since_ = 0;
};

}  // namespace raycache::cachesim
