// What comes in which cycle, in order of time and of coming: a calendar of one page per cycle, used over and over
// (Brown 1988, "Calendar queues: a fast O(1) priority queue implementation for the simulation event set problem").
// What lies further ahead than the calendar reaches waits in a heap.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

#include "cachesim/replay/timed/cycle.hpp"
#include "cachesim/replay/timed/pool.hpp"

namespace raycache::cachesim {

template <class Item>
class Calendar {
public:
    /// `window`: the most cycles of one take().
    explicit Calendar(std::size_t window)
        : turn_(std::max<std::size_t>(1024, std::bit_ceil(4 * window))),
          first_(turn_, none),
          last_(turn_, none),
          some_(turn_ / 64) {}

    /// What should have come before the end of the last take() comes then.
    void push(Cycle time, const Item& item) {
        time = std::max(time, base_);
        const std::uint32_t number = entries_.take({item});
        if (time - base_ < turn_) [[likely]]
            append(time, number);
        else
            later_.emplace(time, pushed_, number);
        ++pushed_;
    }

    /// Calls use(item) for all that come in these cycles, in order. None that was pushed may come before `begin`, which
    /// is not before the end of the last take().
    template <class Use>
    void take(Cycle begin, Cycle end, Use&& use) {
        move_base(begin);
        const std::size_t from = begin & (turn_ - 1), to = from + (end - begin);
        for (std::size_t word = from / 64; word * 64 < to; ++word) {
            std::uint64_t& some = some_[word & (some_.size() - 1)];
            std::uint64_t bits = some;
            if (word == from / 64) bits &= ~std::uint64_t{0} << from % 64;
            if (to - word * 64 < 64) bits &= (std::uint64_t{1} << (to - word * 64)) - 1;
            some &= ~bits;
            for (; bits; bits &= bits - 1) {
                const std::size_t at = (word * 64 + static_cast<std::size_t>(std::countr_zero(bits))) & (turn_ - 1);
                for (std::uint32_t number = first_[at]; number != none; number = entries_[number].next)
                    use(entries_[number].item);
                entries_.give_back(first_[at], last_[at]);
                first_[at] = none;
            }
        }
        move_base(end);
    }

    /// When the earliest comes, or `never`.
    Cycle time() const {
        const std::size_t from = base_ & (turn_ - 1);
        for (std::size_t i = 0; i <= some_.size(); ++i) {
            const std::size_t word = (from / 64 + i) & (some_.size() - 1);
            std::uint64_t bits = some_[word];
            if (i == 0) bits &= ~std::uint64_t{0} << from % 64;
            if (bits)
                return base_ + ((word * 64 + static_cast<std::size_t>(std::countr_zero(bits)) - from) & (turn_ - 1));
        }
        return later_.empty() ? never : std::get<0>(later_.top());
    }

private:
    static constexpr std::uint32_t none = ~std::uint32_t{0};
    struct Entry {
        Item item{};
        std::uint32_t next = none;
    };
    using Later = std::tuple<Cycle, std::uint64_t, std::uint32_t>;  ///< time, order of coming, entry

    void append(Cycle time, std::uint32_t number) {
        const std::size_t at = time & (turn_ - 1);
        entries_[number].next = none;
        (first_[at] == none ? first_[at] : entries_[last_[at]].next) = number;
        last_[at] = number;
        some_[at / 64] |= std::uint64_t{1} << at % 64;
    }
    void move_base(Cycle to) {
        base_ = to;
        while (!later_.empty() && std::get<0>(later_.top()) - base_ < turn_) {
            append(std::get<0>(later_.top()), std::get<2>(later_.top()));
            later_.pop();
        }
    }

    std::size_t turn_;  ///< cycles, a power of two
    Cycle base_ = 0;    ///< nothing comes before
    std::uint64_t pushed_ = 0;
    std::vector<std::uint32_t> first_, last_;  ///< of each cycle, modulo turn_
    std::vector<std::uint64_t> some_;          ///< bit: whether there is one
    Pool<Entry> entries_;
    std::priority_queue<Later, std::vector<Later>, std::greater<>> later_;
};

}  // namespace raycache::cachesim
