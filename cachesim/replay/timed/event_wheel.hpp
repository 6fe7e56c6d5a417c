// What happens to which flight when: a timing wheel (Varghese, Lauck 1987, "Hashed and hierarchical timing wheels").
// Events within a turn of the wheel take constant time; those later wait in a heap.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include "cachesim/replay/timed/cycle.hpp"

namespace raycache::cachesim {

class EventWheel {
public:
    /// Each flight has at most one event under way. At most 65534 flights.
    explicit EventWheel(std::size_t flights) : next_(flights, none) { first_.fill(none); }

    /// Of the earliest event, or `never`.
    Cycle time() const { return time_; }

    /// Not before the event that was taken last.
    void push(Cycle time, std::uint32_t flight) {
        if (time - base_ >= turn) [[unlikely]] {
            later_.emplace(time, flight);
        } else {
            insert(time, flight);
        }
        time_ = std::min(time_, time);
    }

    /// Takes the earliest event; of several the one of the lowest flight. There must be one.
    std::uint32_t pop() {
        base_ = time_;
        while (!later_.empty() && later_.top().first - base_ < turn) {
            insert(later_.top().first, later_.top().second);
            later_.pop();
        }
        const std::size_t at = base_ % turn;
        const std::uint16_t flight = first_[at];
        first_[at] = next_[flight];
        if (first_[at] == none) {
            some_[at / 64] &= ~(std::uint64_t{1} << at % 64);
            find_next();
        }
        return flight;
    }

private:
    static constexpr std::size_t turn = 1024;
    static constexpr std::uint16_t none = 0xffff;

    void insert(Cycle time, std::uint32_t flight) {
        const std::size_t at = time % turn;
        some_[at / 64] |= std::uint64_t{1} << at % 64;
        std::uint16_t* link = &first_[at];
        while (*link != none && *link < flight) link = &next_[*link];
        next_[flight] = *link;
        *link = static_cast<std::uint16_t>(flight);
    }

    /// From base_ on, whose place on the wheel is empty.
    void find_next() {
        time_ = later_.empty() ? never : later_.top().first;
        const std::size_t from = base_ % turn;
        std::size_t word = from / 64;
        std::uint64_t bits = some_[word] & ~std::uint64_t{0} << from % 64;
        for (std::size_t i = 0; i <= some_.size(); ++i) {
            if (bits) {
                const std::size_t at = word * 64 + static_cast<std::size_t>(std::countr_zero(bits));
                time_ = std::min(time_, base_ + (at - from) % turn);
                return;
            }
            word = (word + 1) % some_.size();
            bits = some_[word];
        }
    }

    using Later = std::pair<Cycle, std::uint32_t>;

    Cycle base_ = 0, time_ = never;
    std::array<std::uint16_t, turn> first_{};      ///< flight of the lowest number, of each place
    std::array<std::uint64_t, turn / 64> some_{};  ///< bit: whether there is one
    std::vector<std::uint16_t> next_;              ///< of each flight, another at its place
    std::priority_queue<Later, std::vector<Later>, std::greater<>> later_;
};

}  // namespace raycache::cachesim
