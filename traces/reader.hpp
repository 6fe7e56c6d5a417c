// Reads a trace file, any block in any order, from any number of threads.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "traces/header.hpp"
#include "traces/record.hpp"

namespace raycache::traces {

/// One entry of the footer index.
struct BlockInfo {
    std::uint64_t offset = 0;  ///< of the block header in the file
    std::uint32_t bytes = 0;   ///< block header included
    std::uint32_t launch = 0, first_warp = 0, warps = 0;
    std::uint64_t records = 0, lane_accesses = 0, rays = 0;
};

class Reader {
public:
    /// Throws Error (with the offset) if the file is missing, no trace, of a newer version, truncated or damaged in its
    /// header or footer, or if it asks for more than memory_limit() bytes: its head, or later one of its blocks.
    explicit Reader(const std::string& path);
    ~Reader();
    Reader(Reader&&) noexcept;

    const Header& header() const;
    const std::vector<BlockInfo>& blocks() const;  ///< in (launch, warp) order
    std::uint64_t file_bytes() const;
    /// Decodes block i, replacing `out`. Throws Error with the offset if a checksum or a value is wrong. Thread-safe.
    void read_block(std::size_t i, std::vector<WarpTrace>& out) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace raycache::traces
