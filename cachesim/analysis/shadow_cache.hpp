// What a cache would have held if it were fully associative with LRU, and what it has held at any time: the two
// questions that sort its misses into compulsory, capacity and conflict (Hill 1987, "Aspects of Cache Memory and
// Instruction Buffer Performance", section 2.5; there for lines, here for the sectors of a line).
//
// Exact for any sequence of look-ups. A look-up costs one search in a hash table; memory, about 25 bytes a line, grows
// with the lines that were ever looked up, not with the number of look-ups.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace raycache::cachesim {

/// A look-up asks for some sectors of one line. The most recently asked `lines` lines are present, each with the
/// sectors that were asked for (or filled) since it became present.
class ShadowCache {
public:
    /// `lines`: how many the cache holds, at least 1. `fill_sectors`: a power of two; a miss fetches the aligned
    /// group of this many sectors that holds the missing one.
    explicit ShadowCache(std::uint64_t lines, unsigned fill_sectors = 1)
        : lines_(lines), fill_sectors_(fill_sectors), table_(64) {}

    struct Answer {
        std::uint32_t never_held;  ///< of the sectors asked for: those the real cache had never held
        std::uint32_t absent;      ///< of the sectors asked for: those the fully associative cache lacks
        std::uint32_t number;      ///< of the line, from 0 in order of first look-up; never changes
    };

    /// The next look-up of the real cache: what it was asked for and what it lacked. `line`: below 2^32 - 1.
    Answer look_up(std::uint32_t line, std::uint32_t asked, std::uint32_t missing) {
        Line& found = find(line);
        const std::uint32_t present = found.place == none ? 0 : places_[found.place].sectors;
        const Answer answer{asked & ~found.held, asked & ~present, found.number};
        found.held |= asked | filled(missing);
        touch(found);
        places_[newest_].sectors = present | asked | filled(answer.absent);
        return answer;
    }

    /// Whether the fully associative cache has no room left.
    bool is_full() const { return places_.size() == lines_; }
    /// Lines ever looked up.
    std::size_t lines_seen() const { return count_; }

    /// The sectors that a fill of these brings.
    std::uint32_t filled(std::uint32_t sectors) const {
        if (fill_sectors_ == 1) return sectors;
        std::uint32_t all = 0;
        for (unsigned first = 0; first < 32; first += fill_sectors_) {
            const auto group = static_cast<std::uint32_t>(((std::uint64_t{1} << fill_sectors_) - 1) << first);
            if (sectors & group) all |= group;
        }
        return all;
    }

private:
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    /// A line that was looked up.
    struct Line {
        std::uint32_t line = none;
        std::uint32_t held = 0;      ///< sectors that the real cache has held at any time
        std::uint32_t place = none;  ///< in the fully associative cache
        std::uint32_t number = 0;
    };

    /// A line of the fully associative cache.
    struct Place {
        std::uint32_t line, sectors;
        std::uint32_t newer, older;  ///< neighbours in order of use
    };

    /// Where a line stands in the table, or is to stand. Multiplicative hashing (Knuth, The Art of Computer
    /// Programming 3, section 6.4), linear probing.
    Line& slot(std::uint32_t line) {
        const std::uint64_t hash = line * std::uint64_t{0x9e3779b97f4a7c15} >> 32;
        auto at = static_cast<std::size_t>(hash * table_.size() >> 32);
        while (table_[at].line != line && table_[at].line != none)
            if (++at == table_.size()) at = 0;
        return table_[at];
    }

    Line& find(std::uint32_t line) {
        if (Line& found = slot(line); found.line == line) return found;
        if (4 * (std::size_t{count_} + 1) > 3 * table_.size()) grow();
        Line& made = slot(line);
        made = {line, 0, none, count_++};
        return made;
    }

    void grow() {
        std::vector<Line> before(table_.size() + table_.size() / 4);
        before.swap(table_);
        for (const Line& l : before)
            if (l.line != none) slot(l.line) = l;
    }

    /// Makes a line the most recently used, in the place of the least recently used one if there is no other.
    void touch(Line& line) {
        if (line.place == none) {
            line.place = free_place();
            places_[line.place].line = line.line;
        } else if (line.place == newest_) {
            return;
        } else {
            const Place& place = places_[line.place];
            places_[place.newer].older = place.older;
            (place.older == none ? oldest_ : places_[place.older].newer) = place.newer;
        }
        places_[line.place].newer = none;
        places_[line.place].older = newest_;
        (newest_ == none ? oldest_ : places_[newest_].newer) = line.place;
        newest_ = line.place;
    }

    std::uint32_t free_place() {
        if (places_.size() < lines_) {
            places_.push_back({});
            return static_cast<std::uint32_t>(places_.size() - 1);
        }
        const std::uint32_t at = oldest_;
        slot(places_[at].line).place = none;
        oldest_ = places_[at].newer;
        (oldest_ == none ? newest_ : places_[oldest_].older) = none;
        return at;
    }

    std::uint64_t lines_;
    unsigned fill_sectors_;
    std::vector<Line> table_;    ///< at most 3/4 full
    std::vector<Place> places_;  ///< at most `lines_`
    std::uint32_t newest_ = none, oldest_ = none;
    std::uint32_t count_ = 0;  ///< lines in the table
};

}  // namespace raycache::cachesim
