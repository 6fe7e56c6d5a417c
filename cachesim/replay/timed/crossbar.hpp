// One direction of a crossbar with a queue at each input: an output takes one packet at a time, first come first served
// among the packets at the head of their queues, and goes on with an input as long as its next packet is for it, too.
// What stands behind a head waits with it (head-of-line blocking), which is what keeps such a switch from using all of
// its outputs (Karol, Hluchyj, Morgan 1987, "Input versus output queueing on a space-division packet switch").
// As in GPGPU-Sim's local crossbar, an input can send packets to several outputs in one cycle.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "cachesim/replay/timed/calendar.hpp"
#include "cachesim/replay/timed/cycle.hpp"
#include "cachesim/replay/timed/ring.hpp"

namespace raycache::cachesim {

/// `Packet` has `Cycle ready` and `std::uint32_t output`.
template <class Packet>
class Crossbar {
public:
    /// `cost`: cycles that a packet takes an output. 0: as many packets at once as there are. `window`: the most cycles
    /// of one run().
    Crossbar(std::size_t inputs, std::size_t outputs, double cost, std::size_t window)
        : coming_(window),
          queues_(inputs),
          input_free_(inputs),
          output_free_(outputs),
          cost_(cost),
          head_time_(inputs),
          next_head_(inputs, none),
          first_head_(window, none),
          some_(window / 64 + 1) {}

    /// Packets of one input leave in order of readiness, ties in order of coming.
    void add(std::size_t input, const Packet& packet) {
        coming_.push(packet.ready, {packet, static_cast<std::uint32_t>(input)});
        ++packets_;
    }

    bool empty() const { return packets_ == 0; }

    /// Before this cycle no packet moves.
    Cycle next_time() const {
        if (packets_ == 0) return never;
        Cycle next = coming_.time();
        for (std::size_t input = 0; input < queues_.size(); ++input)
            if (!queues_[input].empty())
                next = std::min(next, std::max(queues_[input].front().ready, static_cast<Cycle>(input_free_[input])));
        return next;
    }

    /// Moves every packet that comes to the head of its queue before `end`, in order of time, and calls
    /// arrived(packet, time) for each, in parts of a cycle. A run begins where the one before ended; packets that are
    /// added later though they are ready before `end` come first in the next.
    template <class Arrived>
    void run(Cycle begin, Cycle end, Arrived&& arrived) {
        coming_.take(begin, end, [&](const Coming& c) { queues_[c.input].push(c.packet); });
        if (packets_ == 0) return;
        begin_ = static_cast<double>(begin);
        const auto limit = static_cast<double>(end);
        for (std::size_t input = 0; input < queues_.size(); ++input)
            if (!queues_[input].empty()) add_head(static_cast<std::uint32_t>(input), limit);
        for (std::size_t word = 0; word < some_.size(); ++word) {
            while (some_[word]) {
                const std::size_t at = word * 64 + static_cast<std::size_t>(std::countr_zero(some_[word]));
                const std::uint32_t input = first_head_[at];
                first_head_[at] = next_head_[input];
                if (first_head_[at] == none) some_[word] &= some_[word] - 1;
                serve(input, limit, arrived);
            }
        }
    }

private:
    static constexpr std::uint32_t none = ~std::uint32_t{0};

    struct Coming {
        Packet packet{};
        std::uint32_t input = 0;
    };

    /// The head of an input's queue is the next.
    template <class Arrived>
    void serve(std::uint32_t input, double limit, Arrived& arrived) {
        Ring<Packet>& queue = queues_[input];
        const std::uint32_t output = queue.front().output;
        double granted = std::max(head_time_[input], output_free_[output]);
        for (;;) {
            const Packet packet = queue.front();
            queue.pop();
            --packets_;
            output_free_[output] = granted + cost_;
            input_free_[input] = granted;
            arrived(packet, granted);
            if (queue.empty() || queue.front().output != output) break;
            if (static_cast<double>(queue.front().ready) > output_free_[output] || output_free_[output] >= limit) break;
            granted = output_free_[output];
        }
        if (!queue.empty()) add_head(input, limit);
    }

    /// Notes since when the input's next packet is the head of its queue, if that is before the limit: in a list for
    /// each cycle, in order of time, then of input.
    void add_head(std::uint32_t input, double limit) {
        const double time = std::max(static_cast<double>(queues_[input].front().ready), input_free_[input]);
        if (time >= limit) return;
        head_time_[input] = time;
        const auto at = static_cast<std::size_t>(std::max(0.0, time - begin_));
        some_[at / 64] |= std::uint64_t{1} << at % 64;
        std::uint32_t* link = &first_head_[at];
        while (*link != none && (head_time_[*link] < time || (head_time_[*link] == time && *link < input)))
            link = &next_head_[*link];
        next_head_[input] = *link;
        *link = input;
    }

    Calendar<Coming> coming_;  ///< packets that are not ready yet
    std::vector<Ring<Packet>> queues_;
    std::vector<double> input_free_, output_free_;
    double cost_;
    std::uint64_t packets_ = 0;
    double begin_ = 0;                       ///< of the run
    std::vector<double> head_time_;          ///< by input
    std::vector<std::uint32_t> next_head_;   ///< by input: the next in its list
    std::vector<std::uint32_t> first_head_;  ///< by cycle of the run: input
    std::vector<std::uint64_t> some_;        ///< by cycle: bit, whether there is one
};

}  // namespace raycache::cachesim
