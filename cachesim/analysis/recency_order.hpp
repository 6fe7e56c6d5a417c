// Lines in order of their last look-up, and how many were looked up later than a given one: an LRU stack that is asked
// for depths.
//
// Every look-up has a time; a time is live if it is the last of its line. Live times are bits, and counts of them for
// runs of 512 and of 32768 times say how many are later than a given one without reading all bits (Bennett & Kruskal
// 1975, "LRU stack processing", keep such counts in a tree; three levels suffice here). A look-up changes two bits and
// four counts. Times are numbered anew when they run out, which is when three of four are dead.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace raycache::cachesim {

class RecencyOrder {
public:
    /// Lines looked up so far.
    std::uint32_t lines() const { return live_; }

    /// How many lines were looked up later than the one whose last look-up was at `time`.
    std::uint32_t later(std::uint32_t time) const {
        if (time == now_) return 0;
        const std::size_t word = time / word_times, run = time / run_times, block = time / block_times;
        std::uint64_t count = static_cast<unsigned>(std::popcount(bits_[word] >> (time % word_times) >> 1));
        const std::size_t last_word = std::min<std::size_t>((run + 1) * words_of_run, now_ / word_times + 1);
        for (std::size_t w = word + 1; w < last_word; ++w) count += static_cast<unsigned>(std::popcount(bits_[w]));
        const std::size_t last_run = std::min<std::size_t>((block + 1) * runs_of_block, now_ / run_times + 1);
        for (std::size_t r = run + 1; r < last_run; ++r) count += runs_[r];
        for (std::size_t b = block + 1; b <= now_ / block_times; ++b) count += blocks_[b];
        return static_cast<std::uint32_t>(count);
    }

    /// A line is looked up: its last look-up before was at `time`, 0 if there was none. Returns the time of this one.
    /// Where times are numbered anew, renumbered(line, time) says each line's first, this one's included.
    template <class Renumbered>
    std::uint32_t touch(std::uint32_t line, std::uint32_t time, Renumbered&& renumbered) {
        if (time == now_ && time != 0) return time;
        if (now_ + 1 >= line_at_.size()) [[unlikely]]
            time = renumber(time, renumbered);
        if (time == 0) {
            ++live_;
        } else {
            bits_[time / word_times] &= ~bit(time);
            --runs_[time / run_times];
            --blocks_[time / block_times];
        }
        ++now_;
        line_at_[now_] = line;
        bits_[now_ / word_times] |= bit(now_);
        ++runs_[now_ / run_times];
        ++blocks_[now_ / block_times];
        return now_;
    }

    /// Memory that it takes.
    std::size_t bytes() const {
        return line_at_.capacity() * sizeof(line_at_[0]) + bits_.capacity() * sizeof(bits_[0]) +
               runs_.capacity() * sizeof(runs_[0]) + blocks_.capacity() * sizeof(blocks_[0]);
    }

private:
    static constexpr std::uint32_t word_times = 64, run_times = 512, block_times = 32768;
    static constexpr std::size_t words_of_run = run_times / word_times, runs_of_block = block_times / run_times;

    static std::uint64_t bit(std::uint32_t time) { return std::uint64_t{1} << (time % word_times); }
    bool is_live(std::uint32_t time) const { return bits_[time / word_times] & bit(time); }

    /// Times 1, 2, 3 … in the same order. Returns the new one of what was at `time`.
    template <class Renumbered>
    std::uint32_t renumber(std::uint32_t time, Renumbered&& renumbered) {
        std::uint32_t kept = 0, moved = 0;
        for (std::uint32_t t = 1; t <= now_; ++t) {
            if (!is_live(t)) continue;
            line_at_[++kept] = line_at_[t];
            if (t == time) moved = kept;
            renumbered(line_at_[kept], kept);
        }
        now_ = kept;
        const std::size_t size = std::max<std::size_t>(16, 4 * std::size_t{kept} + 1);
        line_at_.resize(size);
        bits_.assign(size / word_times + 1, 0);
        runs_.assign(size / run_times + 1, 0);
        blocks_.assign(size / block_times + 1, 0);
        for (std::uint32_t t = 1; t <= kept; ++t) {
            bits_[t / word_times] |= bit(t);
            ++runs_[t / run_times];
            ++blocks_[t / block_times];
        }
        return moved;
    }

    std::vector<std::uint32_t> line_at_;  ///< by time; of live times
    std::vector<std::uint64_t> bits_;     ///< by time: whether it is live
    std::vector<std::uint16_t> runs_;     ///< live times of each 512
    std::vector<std::uint32_t> blocks_;   ///< and of each 32768
    std::uint32_t now_ = 0, live_ = 0;
};

}  // namespace raycache::cachesim
