#include "cachesim/analysis/explainer.hpp"

#include <algorithm>
#include <bit>

namespace raycache::cachesim {

namespace {

/// The sectors of a look-up, by what became of them.
struct MissVerdict {
    std::uint32_t asked, compulsory, capacity, conflict, lucky;

    void add_to(MissCounts& counts, std::uint32_t sectors = ~std::uint32_t{0}) const {
        const auto count = [&](std::uint32_t which) { return static_cast<unsigned>(std::popcount(which & sectors)); };
        counts.lookups += count(asked);
        counts.compulsory += count(compulsory);
        counts.capacity += count(capacity);
        counts.conflict += count(conflict);
        counts.lucky_hits += count(lucky);
    }
};

/// `first`: those of the missing sectors that no cache can have held.
MissVerdict judge(const ServedRequest& request, const ShadowCache::Answer& shadow, std::uint32_t first) {
    const std::uint32_t missing = request.missing, again = missing & ~first;
    return {request.asked, first, again & shadow.absent, again & ~shadow.absent,
            request.asked & ~missing & shadow.absent};
}

}  // namespace

Explainer::Explainer(const Gpu& gpu, const std::vector<traces::Region>& regions, const ElementDepth& depth,
                     const LanePixels* pixels, History history)
    : history_(history),
      l1_per_sm_(gpu.l1_per_sm),
      warps_per_cta_(gpu.warps_per_cta),
      sectors_per_line_(gpu.l1().line_bytes / gpu.l1().sector_bytes),
      line_bytes_(gpu.l1().line_bytes),
      ids_(regions, line_bytes_),
      depth_(depth),
      log_(regions, gpu.l1().line_bytes, gpu.l1().sector_bytes),
      fetchers_(std::size_t{gpu.sms} * gpu.l1_per_sm),
      with_pixels_(pixels != nullptr),
      pixel_costs_(pixels ? PixelCosts(*pixels) : PixelCosts()) {
    const std::size_t levels = gpu.levels.size();
    for (std::size_t level = 0; level < levels; ++level) {
        const CacheGeometry& geometry = gpu.levels[level];
        const std::size_t caches = level + 1 == levels ? 1 : level == 0 ? fetchers_.size() : gpu.sms;
        const unsigned fill = std::max(1u, geometry.fill_bytes / geometry.sector_bytes);
        shadows_.emplace_back(caches, ShadowCache(geometry.bytes() / geometry.line_bytes, fill));
    }
    findings_.levels.resize(levels);
}

void Explainer::issued(std::span<const IssuedAccess> accesses) {
    for (const IssuedAccess& access : accesses) {
        log_.add(access);
        if (with_pixels_ && access.counted) pixel_costs_.add_access(access);
    }
}

void Explainer::served(std::size_t level, std::span<const ServedRequest> requests) {
    for (const ServedRequest& request : requests) explain(level, request);
}

void Explainer::explain(std::size_t level, const ServedRequest& request) {
    const std::size_t cache = level == 0 ? request.sm * l1_per_sm_ + request.cache : request.sm;
    const std::uint8_t region = log_[request.access].region;
    // What a full cache has not held since the replay began was asked for longer ago than it keeps anything.
    const bool touched_before = history_ == History::endless && shadows_[level][cache].is_full();
    const auto shadow =
        shadows_[level][cache].look_up(ids_.id(request.address / line_bytes_, region), request.asked, request.missing);
    if (level == 0) find_owners(request, cache, shadow.number);
    if (!request.counted) return;
    const MissVerdict verdict = judge(request, shadow, touched_before ? 0 : request.missing & shadow.never_held);

    LevelFindings& found = findings_.levels[level];
    verdict.add_to(found.of_group(LevelFindings::place(request.ray, request.bounce), request.kind));
    if (depth_.known()) {
        std::uint32_t left = request.asked;
        log_.for_each_lane(request, [&](unsigned, std::uint32_t element, std::uint32_t sectors) {
            const std::uint8_t depth = depth_(region, element);
            if (depth != ElementDepth::none) verdict.add_to(found.by_depth[depth], sectors & left);
            left &= ~sectors;
            return left != 0;
        });
    }
    if (!with_pixels_) return;
    if (level == 0) pixel_costs_.add_l1(log_, request);
    if (level + 1 == shadows_.size()) pixel_costs_.add_last(log_, request);
}

void Explainer::find_owners(const ServedRequest& request, std::size_t cache, std::uint32_t line) {
    std::deque<std::uint32_t>& fetchers = fetchers_[cache];
    const std::size_t of_line = std::size_t{line} * sectors_per_line_;
    if (fetchers.size() == of_line) fetchers.resize(of_line + sectors_per_line_);
    const std::uint32_t warp = log_[request.access].warp;
    Sharing& sharing = findings_.sharing;
    for (std::uint32_t left = request.counted ? request.asked & ~request.missing : 0; left != 0; left &= left - 1) {
        const std::uint32_t fetcher = fetchers[of_line + static_cast<unsigned>(std::countr_zero(left))];
        ++(fetcher == warp                                     ? sharing.same_warp
           : fetcher / warps_per_cta_ == warp / warps_per_cta_ ? sharing.same_cta
                                                               : sharing.other_cta);
    }
    // What a fill brings beside the missing sectors came with them, unless it was there already: asked for and found.
    const std::uint32_t found = request.asked & ~request.missing;
    for (std::uint32_t left = shadows_[0][cache].filled(request.missing) & ~found; left != 0; left &= left - 1)
        fetchers[of_line + static_cast<unsigned>(std::countr_zero(left))] = warp;
}

}  // namespace raycache::cachesim
