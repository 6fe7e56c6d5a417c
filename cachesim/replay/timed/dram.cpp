#include "cachesim/replay/timed/dram.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace raycache::cachesim {

Dram::Dram(const Timing& timing, double cost, Cycle latency)
    : cost_(cost),
      latency_(latency),
      bank_bits_(timing.dram_bank_bits),
      row_bit_(timing.dram_row_bit),
      bus_free_(timing.dram_channels),
      opening_free_(timing.dram_channels) {
    if (bank_bits_.empty()) return;
    rows_.resize(std::size_t{timing.dram_channels} << bank_bits_.size());
    const double cycle = timing.clock_mhz / timing.dram_mhz;
    rcd_ = timing.dram_rcd * cycle;
    rp_ = timing.dram_rp * cycle;
    ras_ = timing.dram_ras * cycle;
    rc_ = timing.dram_rc * cycle;
    rrd_ = timing.dram_rrd * cycle;
}

Cycle Dram::read(std::size_t channel, std::uint64_t address, Cycle time) {
    double& free = bus_free_[channel];
    const double start = std::max(static_cast<double>(time), free);
    free = start + cost_;
    const double readable = has_rows() ? open_row(channel, address, static_cast<double>(time)) : 0;
    return static_cast<Cycle>(std::ceil(std::max(start, readable))) + latency_;
}

/// When the row can be read.
double Dram::open_row(std::size_t channel, std::uint64_t address, double time) {
    std::size_t bank = channel;
    for (const std::uint32_t bit : bank_bits_) bank = bank << 1 | (address >> bit & 1);
    const std::uint64_t row = address >> row_bit_;
    std::vector<OpenRow>& rows = rows_[bank];
    for (std::size_t i = rows.size(); i-- > 0 && rows[i].closed > time;)
        if (rows[i].row == row) return std::max(time, rows[i].readable);
    double opens = time;
    if (!rows.empty()) {
        OpenRow& before = rows.back();
        before.closed = std::max({time, before.readable, before.opened + ras_});
        opens = std::max(before.closed + rp_, before.opened + rc_);
        const auto past = std::find_if(rows.begin(), rows.end(), [&](const OpenRow& r) { return r.closed > time; });
        rows.erase(rows.begin(), past);
    }
    double& free = opening_free_[channel];
    opens = std::max(opens, free);
    free = std::max(time, free) + rrd_;
    rows.push_back({row, opens, opens + rcd_, std::numeric_limits<double>::infinity()});
    return rows.back().readable;
}

}  // namespace raycache::cachesim
