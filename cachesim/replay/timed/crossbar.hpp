// One direction of a crossbar with a queue at each input: an output takes one packet at a time, first come first served
// among the packets at the head of their queues. What stands behind a head waits with it (head-of-line blocking), which
// is what keeps such a switch from using all of its outputs (Karol, Hluchyj, Morgan 1987, "Input versus output queueing
// on a space-division packet switch").
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

#include "cachesim/replay/timed/sector_tags.hpp"

namespace raycache::cachesim {

/// `Packet` has `Cycle ready` and `std::uint32_t output`.
template <class Packet>
class Crossbar {
public:
    /// Costs: cycles that a packet takes an input, an output. 0: as many packets at once as there are.
    Crossbar(std::size_t inputs, std::size_t outputs, double input_cost, double output_cost)
        : queues_(inputs),
          input_free_(inputs),
          output_free_(outputs),
          input_cost_(input_cost),
          output_cost_(output_cost) {}

    /// Packets of one input leave in order of readiness, ties in order of coming.
    void add(std::size_t input, const Packet& packet) {
        queues_[input].push({packet, order_++});
        ++packets_;
    }

    bool empty() const { return packets_ == 0; }

    /// No packet reaches the output before that time.
    void block_output(std::size_t output, Cycle until) {
        output_free_[output] = std::max(output_free_[output], static_cast<double>(until));
    }

    /// Moves every packet that comes to the head of its queue before `end`, in order of time, and calls
    /// arrived(packet, cycle) for each. Packets added later must not be ready before `end`.
    template <class Arrived>
    void run(Cycle end, Arrived&& arrived) {
        const auto limit = static_cast<double>(end);
        for (std::size_t input = 0; input < queues_.size(); ++input)
            if (!queues_[input].empty()) add_head(input, limit);
        while (!heads_.empty()) {
            const auto [time, input] = heads_.top();
            heads_.pop();
            const Packet packet = queues_[input].top().packet;
            queues_[input].pop();
            --packets_;
            const double granted = std::max(time, output_free_[packet.output]);
            output_free_[packet.output] = granted + output_cost_;
            input_free_[input] = granted + input_cost_;
            arrived(packet, static_cast<Cycle>(granted + 0.999999));
            if (!queues_[input].empty()) add_head(input, limit);
        }
    }

private:
    struct Queued {
        Packet packet;
        std::uint64_t order;
        bool operator>(const Queued& other) const {
            return packet.ready != other.packet.ready ? packet.ready > other.packet.ready : order > other.order;
        }
    };
    using Head = std::pair<double, std::size_t>;  ///< since when, input

    void add_head(std::size_t input, double limit) {
        const double time = std::max(static_cast<double>(queues_[input].top().packet.ready), input_free_[input]);
        if (time < limit) heads_.push({time, input});
    }

    std::vector<std::priority_queue<Queued, std::vector<Queued>, std::greater<>>> queues_;
    std::vector<double> input_free_, output_free_;
    double input_cost_, output_cost_;
    std::uint64_t order_ = 0, packets_ = 0;
    std::priority_queue<Head, std::vector<Head>, std::greater<>> heads_;
};

}  // namespace raycache::cachesim
