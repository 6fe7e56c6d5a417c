// LRU stack distances: how large a fully associative cache would have had to be for each look-up to hit, for all sizes
// at once (Mattson, Gecsei, Slutz, Traiger 1970, "Evaluation techniques for storage hierarchies").
//
// The distance of a line is the number of other lines looked up since it was last; a cache of C lines with LRU holds it
// if that is less than C. Sectors are fetched one by one, or in aligned groups: one is there if its line has never been
// evicted since it was fetched, so its distance is the largest of its line since it was last asked for. Exact for any
// sequence of look-ups and, for each C, equal to ShadowCache.
//
// Lines lie in a Fenwick tree by the time of their last look-up (Bennett & Kruskal 1975, "LRU stack processing"), whose
// times are numbered anew when they run out. A look-up costs O(log n) for n lines; memory, about 40 bytes a line and 4
// a sector, grows with the highest line.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace raycache::cachesim {

/// How many sectors were asked for at each distance.
class DistanceCounts {
public:
    void add(std::uint64_t distance, std::uint64_t sectors) {
        if (distance >= by_distance_.size()) by_distance_.resize(distance + 1 + distance / 2);
        by_distance_[distance] += sectors;
        asked_ += sectors;
    }
    /// For the first time.
    void add_first(std::uint64_t sectors) { asked_ += sectors; }

    std::uint64_t asked() const { return asked_; }
    /// Of a fully associative cache of so many lines.
    std::uint64_t hits(std::uint64_t lines) const {
        std::uint64_t sum = 0;
        for (std::uint64_t d = 0; d < std::min<std::uint64_t>(lines, by_distance_.size()); ++d) sum += by_distance_[d];
        return sum;
    }

private:
    std::vector<std::uint64_t> by_distance_;
    std::uint64_t asked_ = 0;
};

class StackDistance {
public:
    /// `sectors`: of a line, 1 to 32. `fill_sectors`: a power of two; a miss fetches the aligned group of this many
    /// sectors that holds the missing one.
    explicit StackDistance(unsigned sectors, unsigned fill_sectors = 1)
        : sectors_(sectors), fill_sectors_(fill_sectors) {}

    /// Of a sector that was never fetched.
    static constexpr std::uint32_t never = ~std::uint32_t{0};

    /// The next look-up: some sectors of one line; lines are numbered from 0 without large gaps (LineIds). Calls
    /// each(distance, sector) for each of them, lowest first.
    template <class Each>
    void look_up(std::uint32_t line, std::uint32_t asked, Each&& each) {
        if (line >= lines_.size()) make_room(line);
        Line& found = lines_[line];
        const std::uint32_t distance = found.time == 0 || found.time == now_ ? 0 : later(found.time);
        std::uint32_t* const farthest = &farthest_[std::size_t{line} * sectors_];
        for (std::uint32_t left = found.fetched; left; left &= left - 1) {
            const auto sector = static_cast<unsigned>(std::countr_zero(left));
            farthest[sector] = std::max(farthest[sector], distance);
        }
        for (std::uint32_t left = asked; left; left &= left - 1) {
            const auto sector = static_cast<unsigned>(std::countr_zero(left));
            each(found.fetched >> sector & 1 ? farthest[sector] : never, sector);
        }
        const std::uint32_t filled = with_group(asked);
        for (std::uint32_t left = filled; left; left &= left - 1) farthest[std::countr_zero(left)] = 0;
        found.fetched |= filled;
        touch(line);
    }

    /// Lines looked up so far.
    std::uint32_t lines() const { return live_; }

private:
    struct Line {
        std::uint32_t time = 0;     ///< of its last look-up, from 1; 0: none yet
        std::uint32_t fetched = 0;  ///< sectors, ever
    };

    std::uint32_t with_group(std::uint32_t sectors) const {
        if (fill_sectors_ == 1) return sectors;
        std::uint32_t all = 0;
        for (unsigned first = 0; first < sectors_; first += fill_sectors_) {
            const auto group = static_cast<std::uint32_t>(((std::uint64_t{1} << fill_sectors_) - 1) << first);
            if (sectors & group) all |= group;
        }
        return all;
    }

    void make_room(std::uint32_t line) {
        lines_.resize(std::size_t{line} + 1 + line / 2);
        farthest_.resize(lines_.size() * sectors_);
    }

    /// Lines whose last look-up is later than that.
    std::uint32_t later(std::uint32_t time) const {
        std::uint32_t until = 0;
        for (std::uint32_t i = time; i; i &= i - 1) until += tree_[i];
        return live_ - until;
    }
    void add(std::uint32_t time, std::uint32_t one) {
        for (std::uint32_t i = time; i < tree_.size(); i += i & -i) tree_[i] += one;  // modulo 2^32: -1 is added too
    }

    void touch(std::uint32_t line) {
        if (lines_[line].time == now_ && now_ != 0) return;
        if (now_ + 1 >= tree_.size()) renumber();
        Line& touched = lines_[line];
        if (touched.time == 0) {
            ++live_;
        } else {
            add(touched.time, ~std::uint32_t{0});
            line_at_[touched.time] = never;
        }
        touched.time = ++now_;
        line_at_[now_] = line;
        add(now_, 1);
    }

    /// Times 1, 2, 3 … in the same order.
    void renumber() {
        std::uint32_t kept = 0;
        for (std::uint32_t time = 1; time <= now_; ++time) {
            const std::uint32_t line = line_at_[time];
            if (line == never) continue;
            line_at_[++kept] = line;
            lines_[line].time = kept;
        }
        now_ = kept;
        const std::size_t size = std::max<std::size_t>(64, 4 * std::size_t{kept});
        line_at_.resize(size);
        tree_.assign(size, 0);
        for (std::uint32_t time = 1; time < size; ++time) {
            tree_[time] += time <= kept;
            if (const std::size_t above = time + (time & -time); above < size) tree_[above] += tree_[time];
        }
    }

    unsigned sectors_, fill_sectors_;
    std::vector<Line> lines_;
    std::vector<std::uint32_t> farthest_;  ///< by line and sector: largest distance since it was last asked for
    std::vector<std::uint32_t> tree_;      ///< Fenwick, from 1: lines by time
    std::vector<std::uint32_t> line_at_;   ///< by time; never: none any more
    std::uint32_t now_ = 0, live_ = 0;
};

}  // namespace raycache::cachesim
