// DRAM channels in time: data buses with a rate, and, where the preset tells its banks, the rows that are open.
//
// A bank has one row open at a time. To read another it closes that one, tRP, and opens the other, tRCD; tRAS and tRC
// keep it from doing so too soon, tRRD keeps the channel from opening rows too fast (JEDEC GDDR6, JESD250). Requests
// for the row that is open, or about to be, go first (first-ready, first come first served: Rixner et al. 2000, "Memory
// access scheduling").
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cachesim/gpus/timing.hpp"
#include "cachesim/replay/timed/cycle.hpp"

namespace raycache::cachesim {

class Dram {
public:
    /// `cost`: cycles that a sector takes the bus of a channel. `latency`: of a lone read beyond what stands above it;
    /// with banks, of an open row.
    Dram(const Timing&, double cost, Cycle latency);

    bool has_rows() const { return !rows_.empty(); }
    std::size_t channels() const { return bus_free_.size(); }
    double cost() const { return cost_; }

    /// Reads a sector; returns when it is there. `address`: of its line, needed where there are rows. Times of one
    /// channel mostly ascend.
    Cycle read(std::size_t channel, std::uint64_t address, Cycle time);

private:
    /// While a row of a bank is open, or will be.
    struct OpenRow {
        std::uint64_t row;
        double opened, readable, closed;
    };
    double open_row(std::size_t channel, std::uint64_t address, double time);

    double cost_;
    Cycle latency_;
    std::vector<std::uint32_t> bank_bits_;
    std::uint32_t row_bit_;
    double rcd_, rp_, ras_, rc_, rrd_;        ///< cycles of the SM clock
    std::vector<double> bus_free_;            ///< when the bus of each channel is free
    std::vector<double> opening_free_;        ///< when each channel can open another row
    std::vector<std::vector<OpenRow>> rows_;  ///< of each bank of each channel, in order of time
};

}  // namespace raycache::cachesim
