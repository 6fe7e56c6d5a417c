// The index at the end of a trace file. Internal to traces/.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "traces/bytes.hpp"
#include "traces/fault.hpp"
#include "traces/header.hpp"
#include "traces/reader.hpp"

namespace raycache::traces {

Bytes encode_index(std::span<const BlockInfo>);

/// The last bytes of a file: `tail` (format::index_tail_bytes of them) tells how long the index is.
std::uint64_t index_bytes(std::span<const std::uint8_t> tail, std::uint64_t file_bytes, const Origin&);

/// Decodes a whole index that lies at `origin`. Refuses blocks that do not fill the file from `head_bytes` to the index
/// or do not hold each warp of each launch once and in order.
std::vector<BlockInfo> decode_index(const Header&, std::uint64_t head_bytes, std::span<const std::uint8_t> index,
                                    const Origin&);

/// Follows blocks in (launch, warp) order.
class WarpCursor {
public:
    explicit WarpCursor(const Header& header)
        : launches_(static_cast<std::uint32_t>(header.launches.size())), warps_(header.warps_per_launch) {}

    std::uint32_t launch() const { return launch_; }
    std::uint32_t warp() const { return warp_; }
    bool done() const { return launch_ == launches_; }
    bool accepts(std::uint32_t launch, std::uint32_t first_warp, std::uint32_t warps) const {
        return !done() && launch == launch_ && first_warp == warp_ && warps != 0 && warps <= warps_ - warp_;
    }
    void advance(std::uint32_t warps) {
        warp_ += warps;
        if (warp_ == warps_) {
            warp_ = 0;
            ++launch_;
        }
    }

private:
    std::uint32_t launches_, warps_, launch_ = 0, warp_ = 0;
};

}  // namespace raycache::traces
