#include "cachesim/replay/timed/resident_warp.hpp"

#include <bit>
#include <utility>

#include "cachesim/replay/vectors.hpp"

namespace raycache::cachesim {

void ResidentWarp::begin(std::shared_ptr<const traces::WarpTrace> trace, Cycle since) {
    trace_ = std::move(trace);
    next_ = trace_->records.data();
    end_ = next_ + trace_->records.size();
    elements_ = trace_->elements.data();
    left_ = 0;
    among_triangles_ = false;
    accesses_ = 0;
    const bool steps = !trace_->issue.empty();
    step_ = steps ? trace_->issue.data() : nullptr;
    step_end_ = steps ? step_ + trace_->issue.size() : nullptr;
    since_ = since;
}

/// Instructions that the next access, by so many lanes, takes for a leaf that begins there.
std::uint32_t ResidentWarp::leaf(const TimedRules& rules, std::uint32_t region, unsigned lanes) {
    const LeafStarts& leaves = *rules.leaves;
    const bool triangles = leaves.is_triangle(region);
    const bool begins = triangles && leaves.begins(region, {elements_, lanes}, among_triangles_);
    // Texels, no steps, are read between the triangles of a leaf; vectors of one record begin together.
    if (left_ == 0 && leaves.is_step(region)) among_triangles_ = triangles;
    return begins ? rules.timing.leaf_instructions : 0;
}

std::optional<ResidentWarp::Access> ResidentWarp::next(const TimedRules& rules) {
    if (next_ == end_) return std::nullopt;
    const traces::Record& record = *next_;
    if (left_ == 0) {
        left_ = record.mask;
        ++accesses_;
    }
    Access access;
    access.region = record.region;
    access.mask = first_vector(left_, rules.gpu.simd_width);
    left_ &= ~access.mask;
    access.lanes = static_cast<unsigned>(std::popcount(access.mask));
    if (left_ == 0) ++next_;
    if (rules.ideal.full_warps) {
        for (; left_ == 0 && next_ != end_; ++next_) {
            if (!next_->is_access()) continue;
            if (next_->region != record.region || access.lanes + next_->lanes() > rules.gpu.simd_width) break;
            access.lanes += next_->lanes();
            ++accesses_;
        }
        // What stands between them is left out.
        while (step_ != step_end_ && step_->access < accesses_) ++step_;
        access.mask = access.lanes == traces::warp_lanes ? ~0u : (1u << access.lanes) - 1;
    }
    access.elements = elements_;
    if (rules.leaves) access.leaf_instructions = leaf(rules, record.region, access.lanes);
    elements_ += access.lanes;
    return access;
}

}  // namespace raycache::cachesim
