// The sectors that one load of a visit asks for, in the order in which the port takes them: group of lanes after group
// of lanes, in descending order in each.
#pragma once

#include <cstdint>

#include "cachesim/cache/line_ids.hpp"
#include "cachesim/replay/timed/cycle.hpp"
#include "cachesim/replay/timed/timed_rules.hpp"
#include "cachesim/replay/timed/visit.hpp"

namespace raycache::cachesim {

/// Where a load goes on that did not pass in one go.
struct LoadPlace {
    std::uint32_t element = 0;  ///< of the visit
    std::uint32_t sector = 0;   ///< how many of its sectors are done
    bool begun = false;
};

/// A step of a walk: another sector, another group of lanes, or nothing is left.
enum class LoadStep { sector, group, end };

/// Any load.
class AnyWalk {
public:
    static constexpr bool apart = false;

    AnyWalk(const TimedRules& rules, LineIds& ids, const LoadShape& shape, std::uint32_t region, const Visit& visit,
            std::uint32_t load, const LoadPlace& from)
        : rules_(rules), ids_(ids), shape_(shape), visit_(visit), region_(region), load_(load), at_(from) {
        if (at_.sector > 0)
            before_ = shape_.last_sector(visit_[at_.element], load_) - at_.sector + 1;
        else if (at_.element > 0 && !visit_.ends_group(at_.element - 1))
            before_ = shape_.first_sector(visit_[at_.element - 1], load_);
    }

    LoadStep find() {
        for (;;) {
            const std::uint64_t first = shape_.first_sector(visit_[at_.element], load_),
                                last = shape_.last_sector(visit_[at_.element], load_);
            for (; at_.sector <= last - first; ++at_.sector) {
                sector_ = last - at_.sector;
                if (sector_ < before_) return LoadStep::sector;
            }
            const bool ends = visit_.ends_group(at_.element);
            if (at_.element + 1 == visit_.count()) return LoadStep::end;
            ++at_.element;
            at_.sector = 0;
            if (!ends) continue;
            before_ = never;
            return LoadStep::group;
        }
    }

    // The sector that was found.
    const LoadPlace& place() const { return at_; }
    std::uint32_t sector() const { return static_cast<std::uint32_t>(sector_); }  ///< its number, modulo 2^32
    bool new_line() const {
        return before_ == never || sector_ >> rules_.line_of_sector != before_ >> rules_.line_of_sector;
    }
    std::uint32_t id() const { return ids_.id(sector_ >> rules_.line_of_sector, region_); }
    std::uint32_t in_line() const { return sector() & (rules_.sectors_per_line - 1); }
    /// Of VisitAtPort::entries.
    std::uint32_t entry() const {
        return 2 * at_.element + static_cast<std::uint32_t>(sector_ >> rules_.line_of_sector & 1);
    }
    /// It is done.
    void next() {
        before_ = sector_;
        ++at_.sector;
    }

    /// At most that number of sectors.
    std::uint32_t most() const {
        return traces::warp_lanes * static_cast<std::uint32_t>((shape_.load_bytes >> shape_.sector_shift) + 2);
    }

private:
    const TimedRules& rules_;
    LineIds& ids_;
    const LoadShape& shape_;
    const Visit& visit_;
    std::uint32_t region_, load_;
    LoadPlace at_;
    std::uint64_t sector_ = 0;
    std::uint64_t before_ = never;  ///< the lowest sector of this group so far
};

/// LoadShape::apart: the same in fewer instructions.
class ApartWalk {
public:
    static constexpr bool apart = true;

    ApartWalk(const TimedRules& rules, LineIds& /*ids*/, const LoadShape& shape, std::uint32_t /*region*/,
              const Visit& visit, std::uint32_t load, const LoadPlace& from)
        : pieces_(visit.data()),
          count_(visit.count()),
          load_(load),
          first_id_(shape.first_id),
          in_line_mask_(rules.sectors_per_line - 1),
          sector_of_piece_(shape.sector_of_piece),
          line_of_sector_(rules.line_of_sector),
          steady_(shape.steady),
          at_(from) {
        if (at_.element > 0) id_before_ = first_id_ + (sector_of(at_.element - 1) >> line_of_sector_);
    }

    LoadStep find() {
        if (at_.element == count_) return LoadStep::end;
        sector_ = sector_of(at_.element);
        id_ = first_id_ + (sector_ >> line_of_sector_);
        return LoadStep::sector;
    }

    const LoadPlace& place() const { return at_; }
    std::uint32_t sector() const { return sector_; }  ///< counted from the start of a page of banks
    bool new_line() const { return id_ != id_before_; }
    std::uint32_t id() const { return id_; }
    std::uint32_t in_line() const { return sector_ & in_line_mask_; }
    std::uint32_t entry() const { return steady_ ? at_.element : 2 * at_.element + (id_ & 1); }
    void next() {
        id_before_ = id_;
        ++at_.element;
    }
    static std::uint32_t most() { return traces::warp_lanes; }

private:
    std::uint32_t sector_of(std::uint32_t element) const { return (pieces_[element] + load_) >> sector_of_piece_; }

    const std::uint32_t* pieces_;
    std::uint32_t count_, load_, first_id_, in_line_mask_;
    int sector_of_piece_, line_of_sector_;
    bool steady_;
    LoadPlace at_;
    std::uint32_t sector_ = 0, id_ = 0, id_before_ = ~std::uint32_t{0};
};

}  // namespace raycache::cachesim
