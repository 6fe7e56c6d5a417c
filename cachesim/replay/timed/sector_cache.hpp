// The tags of one sectored set-associative cache in time: which sectors of which lines are there, and which are on
// their way. A line with a sector on its way is never evicted.
//
// Evicts the least recently used of the other lines, or the one that came first (fifo), by the time noted in each line;
// under other policies the line that VictimOrder names, or the next way after it whose line can go.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "cachesim/cache/divider.hpp"
#include "cachesim/cache/policies/victim_order.hpp"

namespace raycache::cachesim {

class SectorCache {
public:
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    struct Line {
        std::uint32_t id = none;                 ///< LineIds; `none`: no line
        std::uint32_t used = 0;                  ///< when it was last used, or came (fifo)
        std::uint32_t present = 0, pending = 0;  ///< bit s: sector s is there, is on its way
    };

    enum class Policy { lru, fifo, ordered };

    /// All sets empty. `order`: Policy::ordered asks it. sets * ways < 2^31.
    SectorCache(std::uint64_t sets, std::uint64_t ways, Policy, std::unique_ptr<VictimOrder> order = nullptr);

    std::size_t entries() const { return lines_.size(); }

    /// The entry that holds the line, or none.
    std::uint32_t find(std::uint32_t id) const {
        for (std::uint32_t at = home(id);; at = next(at)) {
            const Slot slot = slots_[at];
            if (slot.id == id || slot.entry == none) return slot.entry;
        }
    }

    /// The line is about to be looked for.
    void prefetch(std::uint32_t id) const { __builtin_prefetch(&slots_[home(id)]); }
    /// The entry is about to be used.
    void prefetch_entry(std::uint32_t entry) const { __builtin_prefetch(&lines_[entry], 1); }

    Line& operator[](std::uint32_t entry) { return lines_[entry]; }
    const Line& operator[](std::uint32_t entry) const { return lines_[entry]; }

    /// The line was looked up.
    void use(std::uint32_t entry) {
        if (policy_ == Policy::lru) [[likely]]
            lines_[entry].used = tick();
        else if (policy_ == Policy::ordered)
            use_ordered(entry);
    }

    /// For many look-ups at once, where the policy is lru: all lines, and the time of the last use, which the caller
    /// counts up by one for each use and gives back. Makes sure that it can do so `uses` times.
    bool is_lru() const { return policy_ == Policy::lru; }
    Line* lines() { return lines_.data(); }
    std::uint32_t take_time(std::uint32_t uses) {
        if (end_of_time - now_ <= uses) [[unlikely]]
            start_time_anew();
        return now_;
    }
    void give_time(std::uint32_t now) { now_ = now; }

    /// No line that was used after this time was ever evicted (lru).
    std::uint32_t newest_evicted() const { return newest_evicted_; }

    /// Evicts a line of the set for this one, which is absent; its sectors are absent as yet. `none` if every line of
    /// the set has a sector on its way.
    std::uint32_t replace(std::uint64_t set, std::uint32_t id);

    /// The entry holds no line any more.
    void remove(std::uint32_t entry);

private:
    struct Slot {
        std::uint32_t id = none, entry = none;
    };
    /// A line that may be the next to go, if it was not used since.
    struct Candidate {
        std::uint32_t used, entry;
    };
    struct Queue {
        std::vector<Candidate> candidates;  ///< oldest first
        std::size_t begin = 0;
        std::uint32_t horizon = 0, step = 64;  ///< times: up to here lines are candidates, and how much further next
    };

    /// Multiplicative hashing (Knuth, The Art of Computer Programming 3, section 6.4).
    std::uint32_t home(std::uint32_t id) const {
        return static_cast<std::uint32_t>((id * 0x9e3779b97f4a7c15ull) >> shift_);
    }
    std::uint32_t next(std::uint32_t at) const { return (at + 1) & static_cast<std::uint32_t>(slots_.size() - 1); }

    std::uint32_t tick() {
        if (now_ == end_of_time) [[unlikely]]
            start_time_anew();
        return ++now_;
    }
    static constexpr std::uint32_t end_of_time = ~std::uint32_t{0};

    void use_ordered(std::uint32_t entry);
    void start_time_anew();
    std::uint32_t victim(std::uint64_t set);
    std::uint32_t oldest(std::uint64_t set) const;
    void refill(Queue&, std::uint64_t set) const;
    void unlink(std::uint32_t entry);

    std::uint64_t ways_;
    Policy policy_;
    std::unique_ptr<VictimOrder> order_;
    Divider by_ways_;
    int shift_;
    std::uint32_t now_ = 0, newest_evicted_ = 0;
    std::vector<Line> lines_;
    std::vector<Slot> slots_;    ///< lines by their hash, linear probing, at most half full
    std::vector<Queue> queues_;  ///< of each set, where there are many ways
};

}  // namespace raycache::cachesim
