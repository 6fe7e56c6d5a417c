// What a cache would have held if it were fully associative with LRU, and what it has held at any time: the two
// questions that sort its misses into compulsory, capacity and conflict (Hill 1987, "Aspects of Cache Memory and
// Instruction Buffer Performance", section 2.5; there for lines, here for the sectors of a line).
//
// Exact for any sequence of look-ups. A look-up costs one search in a hash table; memory grows with the lines that were
// ever looked up, not with the number of look-ups.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace raycache::cachesim {

/// A look-up asks for some sectors of one line. The most recently asked `lines` lines are present, each with the
/// sectors that were asked for (or filled) since it became present.
class ShadowCache {
public:
    /// `lines`: how many the cache holds, at least 1. `fill_sectors`: a power of two; a miss fetches all sectors of the
    /// aligned group of so many that the missing sector lies in.
    explicit ShadowCache(std::uint64_t lines, unsigned fill_sectors = 1)
        : lines_(lines), fill_sectors_(fill_sectors), table_(1 << 10, none) {}

    struct Answer {
        std::uint32_t never_held;  ///< of the sectors asked for: those the real cache had never held
        std::uint32_t absent;      ///< of the sectors asked for: those the fully associative cache lacks
        std::uint32_t entry;       ///< a number of the line, from 0 in order of first look-up; never changes
    };

    /// The next look-up of the real cache: what it was asked for and what it lacked.
    Answer look_up(std::uint64_t line, std::uint32_t asked, std::uint32_t missing) {
        const std::uint32_t at = find(line);
        Entry& entry = entries_[at];
        const Answer answer{asked & ~entry.held, asked & ~entry.present, at};
        entry.held |= asked | filled(missing);
        entry.present |= asked | filled(answer.absent);
        touch(at);
        return answer;
    }

    /// Lines ever looked up.
    std::size_t entries() const { return entries_.size(); }

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

    struct Entry {
        std::uint64_t line = 0;
        std::uint32_t held = 0;     ///< sectors that the real cache has held at any time
        std::uint32_t present = 0;  ///< sectors that the fully associative cache holds; 0 if it lacks the line
        std::uint32_t newer = none, older = none;  ///< neighbours in order of use, if present
    };

    /// The entry of a line, made if there is none. Multiplicative hashing (Knuth, The Art of Computer Programming 3,
    /// section 6.4), linear probing.
    std::uint32_t find(std::uint64_t line) {
        const std::size_t mask = table_.size() - 1;
        std::size_t at = slot(line);
        for (; table_[at] != none; at = (at + 1) & mask)
            if (entries_[table_[at]].line == line) return table_[at];
        const auto made = static_cast<std::uint32_t>(entries_.size());
        entries_.push_back({line});
        table_[at] = made;
        if (2 * entries_.size() > table_.size()) grow();
        return made;
    }

    std::size_t slot(std::uint64_t line) const {
        return static_cast<std::size_t>((line * 0x9e3779b97f4a7c15ull) >> (64 - std::countr_zero(table_.size())));
    }

    void grow() {
        table_.assign(2 * table_.size(), none);
        for (std::uint32_t e = 0; e < entries_.size(); ++e) {
            std::size_t at = slot(entries_[e].line);
            while (table_[at] != none) at = (at + 1) & (table_.size() - 1);
            table_[at] = e;
        }
    }

    /// Makes a line the most recently used; drops the least recently used one if that makes too many.
    void touch(std::uint32_t at) {
        if (newest_ == at) return;
        Entry& entry = entries_[at];
        if (entry.newer != none) {  // it stands in the list, and not first
            entries_[entry.newer].older = entry.older;
            (entry.older == none ? oldest_ : entries_[entry.older].newer) = entry.newer;
        } else {
            ++count_;
        }
        entry.newer = none;
        entry.older = newest_;
        (newest_ == none ? oldest_ : entries_[newest_].newer) = at;
        newest_ = at;
        if (count_ <= lines_) return;
        Entry& dropped = entries_[oldest_];
        oldest_ = dropped.newer;
        entries_[oldest_].older = none;
        dropped.newer = none;
        dropped.present = 0;
        --count_;
    }

    std::uint64_t lines_;
    unsigned fill_sectors_;
    std::vector<std::uint32_t> table_;  ///< entries by hash of their line; a power of two, at most half full
    std::vector<Entry> entries_;
    std::uint32_t newest_ = none, oldest_ = none;
    std::uint64_t count_ = 0;  ///< lines present
};

}  // namespace raycache::cachesim
