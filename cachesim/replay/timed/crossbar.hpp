// One direction of a crossbar with a queue at each input: an output takes one packet at a time, first come first served
// among the packets at the head of their queues, and goes on with an input as long as its next packet is for it, too.
// What stands behind a head waits with it (head-of-line blocking), which is what keeps such a switch from using all of
// its outputs (Karol, Hluchyj, Morgan 1987, "Input versus output queueing on a space-division packet switch").
// As in GPGPU-Sim's local crossbar, an input can send packets to several outputs in one cycle.
#pragma once

#include <algorithm>
#include <cmath>
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
    /// `cost`: cycles that a packet takes an output. 0: as many packets at once as there are.
    Crossbar(std::size_t inputs, std::size_t outputs, double cost)
        : queues_(inputs), input_free_(inputs), output_free_(outputs), cost_(cost) {}

    /// Packets of one input leave in order of readiness, ties in order of coming.
    void add(std::size_t input, Packet packet) {
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
            auto& queue = queues_[input];
            const std::uint32_t output = queue.top().packet.output;
            double granted = std::max(time, output_free_[output]);
            for (;;) {
                const Packet packet = queue.top().packet;
                queue.pop();
                --packets_;
                output_free_[output] = granted + cost_;
                input_free_[input] = granted;
                arrived(packet, static_cast<Cycle>(std::ceil(granted)));
                if (queue.empty() || queue.top().packet.output != output) break;
                if (static_cast<double>(queue.top().packet.ready) > output_free_[output] ||
                    output_free_[output] >= limit)
                    break;
                granted = output_free_[output];
            }
            if (!queue.empty()) add_head(input, limit);
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
    double cost_;
    std::uint64_t order_ = 0, packets_ = 0;
    std::priority_queue<Head, std::vector<Head>, std::greater<>> heads_;
};

}  // namespace raycache::cachesim
