// What a warp has under way where its trace says what waits for what (traces::WarpTrace::issue): its accesses in order,
// each until its data are there.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "cachesim/replay/timed/cycle.hpp"
#include "cachesim/replay/timed/port.hpp"

namespace raycache::cachesim {

class PendingAccesses {
public:
    /// Of a warp at once; the next one waits for the oldest. More than the registers of a thread hold of 16 B each.
    static constexpr std::uint32_t most = 64;

    struct Place {
        std::uint32_t first = 0, last = 0;  ///< numbers of the warp's accesses that it stands for
        Cycle ready = 0;                    ///< when the data are there; `never`: it is not known yet
        Cycle first_issue = never;          ///< of its loads
        VisitAtPort* visit = nullptr;       ///< while loads have not passed the port
    };

    void clear() {
        opened_ = 0;
        waits = false;
        places_.fill({});
    }

    /// When the place of the next visit is free.
    Cycle room() const { return places_[opened_ % most].ready; }
    /// A visit begins, to these accesses of the warp. Several visits may belong to one access, and the other way round.
    std::uint32_t open(std::uint32_t first, std::uint32_t last, VisitAtPort* visit) {
        const std::uint32_t at = opened_++ % most;
        places_[at] = {first, last, never, never, visit};
        return at;
    }
    Place& operator[](std::uint32_t place) { return places_[place]; }
    /// The place of the latest visit.
    std::uint32_t latest() const { return (opened_ - 1) % most; }

    /// When the data of that access are there, which has begun.
    Cycle ready(std::uint32_t access) const {
        Cycle time = 0;
        for (std::uint32_t back = 1; back <= std::min(opened_, most); ++back) {
            const Place& place = places_[(opened_ - back) % most];
            if (place.last < access) break;
            if (place.first <= access) time = std::max(time, place.ready);
        }
        return time;
    }
    /// When those of all are.
    Cycle all() const {
        Cycle time = 0;
        for (const Place& place : places_) time = std::max(time, place.ready);
        return time;
    }

    bool waits = false;  ///< the warp, for data whose time is not known

private:
    std::uint32_t opened_ = 0;
    std::array<Place, most> places_{};
};

}  // namespace raycache::cachesim
