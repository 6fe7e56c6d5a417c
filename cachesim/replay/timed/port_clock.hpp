// When the port of an L1 takes one more sector: L1Port, one clock for each kind. Sectors come in order of time.
#pragma once

#include <algorithm>
#include <cstdint>

#include "cachesim/gpus/timing.hpp"
#include "cachesim/replay/timed/cycle.hpp"

namespace raycache::cachesim {

/// L1Port::tags. A tag stage of some lines a cycle, a data path of some bytes a cycle, whole or not. What a cycle has
/// left is of no use in a later one, but for the part of a sector that is under way.
class TagClock {
public:
    static constexpr bool counts_tags = true;

    TagClock(const Timing& timing, std::uint32_t sector_bytes)
        : full_(static_cast<std::uint64_t>(std::clamp(timing.l1_bytes_per_cycle * unit, 1.0, most))),
          sector_(std::uint64_t{sector_bytes} * unit),
          tags_per_cycle_(timing.tags_per_cycle) {}

    /// Not before `time`. `new_line`: it lies in another line than the sector before.
    Cycle ready(std::uint32_t /*sector*/, bool new_line, Cycle time) const {
        time = std::max(time, data_cycle_);
        return new_line ? std::max(time, tag_cycle_) : time;
    }

    void take(std::uint32_t /*sector*/, bool new_line, Cycle time) {
        if (time > data_cycle_) {
            data_cycle_ = time;
            data_used_ = 0;
        }
        data_used_ += sector_;
        if (data_used_ >= full_) end_data_cycle();
        if (!new_line) return;
        if (time > tag_cycle_) {
            tag_cycle_ = time;
            tags_used_ = 0;
        }
        if (++tags_used_ == tags_per_cycle_) {
            ++tag_cycle_;
            tags_used_ = 0;
        }
    }

private:
    /// Parts of a byte, so that rates need not be whole, and the most bytes a cycle: more than a load asks for.
    static constexpr std::uint32_t unit = 1u << 20;
    static constexpr double most = 0x1p62;

    void end_data_cycle() {
        ++data_cycle_;
        data_used_ -= full_;
        if (data_used_ < full_) [[likely]]
            return;
        data_cycle_ += data_used_ / full_;
        data_used_ %= full_;
    }

    std::uint64_t full_, sector_;           ///< of a cycle, of a sector: parts of bytes
    std::uint64_t data_used_ = 0;           ///< of data_cycle_
    Cycle data_cycle_ = 0, tag_cycle_ = 0;  ///< the first that has something left
    std::uint32_t tags_used_ = 0;           ///< of tag_cycle_
    std::uint32_t tags_per_cycle_;
};

/// L1Port::banks. A bank gives one sector a cycle.
class BankClock {
public:
    static constexpr bool counts_tags = false;

    BankClock(const Timing& timing, std::uint32_t /*sector_bytes*/) : mask_(timing.l1_banks - 1) {}

    Cycle ready(std::uint32_t sector, bool /*new_line*/, Cycle time) const {
        return time + (time == cycle_ && (used_ >> (sector & mask_) & 1));
    }

    void take(std::uint32_t sector, bool /*new_line*/, Cycle time) {
        if (time != cycle_) used_ = 0;
        cycle_ = time;
        used_ |= 1u << (sector & mask_);
    }

private:
    std::uint32_t mask_;
    Cycle cycle_ = never;     ///< of the last sector
    std::uint32_t used_ = 0;  ///< bit: bank that is taken in it
};

}  // namespace raycache::cachesim
