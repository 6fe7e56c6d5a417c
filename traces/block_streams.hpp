// The raw streams of a block while it is written (FORMAT.md, "Block"). Internal to traces/.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>

#include "traces/block_format.hpp"
#include "traces/bytes.hpp"
#include "traces/format.hpp"
#include "traces/record.hpp"
#include "traces/schedule.hpp"

namespace raycache::traces {

class BlockStreams {
public:
    /// Symbols may be written up to this many bytes beyond the end of their stream, which then does not count them.
    static constexpr std::size_t overrun = warp_lanes;

    /// Empties all streams and makes room for this many symbols.
    void begin_block(std::size_t symbols) {
        control_.clear();
        for (Bytes& plane : literals_) plane.clear();
        if (linked_.size() < symbols + overrun) linked_.resize(symbols + overrun);
        if (other_.size() < symbols + overrun) other_.resize(symbols + overrun);
        linked_end = linked_.data();
        other_end = other_.data();
    }

    void begin_warp(const WarpTrace& warp, std::uint32_t lanes_at_start) {
        append_varint(control_, static_cast<std::uint32_t>(warp.records.size()));
        append_varint(control_, static_cast<std::uint32_t>(warp.elements.size()));
        append_varint(control_, lanes_at_start);
        recent_.fill(0);
        run_ = 0;
    }

    /// What the schedule, in its state before the record, does not predict about it.
    void record(const Schedule&, const Record&);

    void literal(std::uint32_t region, std::uint32_t element) {
        const std::uint32_t code = zigzag(element - std::exchange(recent_[region], element));
        literals_[0].push_back(static_cast<std::uint8_t>(region));
        for (unsigned i = 0; i < 4; ++i) literals_[1 + i].push_back(static_cast<std::uint8_t>(code >> (8 * i)));
    }

    void end_warp() {
        if (run_ != 0) append_varint(control_, std::exchange(run_, 0));
    }

    /// Behind end_warp(): the warp's issue steps.
    void issue(const WarpTrace&);

    /// Compresses the streams into a block. `head` says what is in it; its sizes are filled in.
    Bytes assemble(BlockHead head) const;

    std::uint8_t *linked_end = nullptr, *other_end = nullptr;  ///< where the next symbol of either stream goes

private:
    Bytes control_, linked_, other_;
    std::array<Bytes, 5> literals_;
    std::array<std::uint32_t, 256> recent_{};  ///< per region, the latest literal of the warp
    std::uint32_t run_ = 0;                    ///< predicted records since the last one in `control_`
};

}  // namespace raycache::traces
