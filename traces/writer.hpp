// Writes a trace file. The name appears only when the file is whole: until finish() the bytes go to a partial file
// (partial_file.hpp).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "traces/header.hpp"
#include "traces/record.hpp"
#include "traces/symbols.hpp"

namespace raycache::traces {

/// A run of consecutive warps of one launch, encoded and compressed: the unit of checksums and of random access.
struct Block {
    std::uint32_t launch = 0, first_warp = 0, warps = 0;
    std::uint64_t records = 0, lane_accesses = 0, rays = 0;
    std::vector<std::uint8_t> bytes;  ///< as in the file, block header included
};

/// Encodes consecutive warps (all of the same launch), at most 2^25 lane accesses and rays; 16 to 256 warps suit best.
/// Pure: same warps, same bytes, on any thread. Throws Error if a record breaks a rule of record.hpp.
/// `symbols`, if not empty: those of each warp, an empty one for "not known". A tracer knows them, and to find them
/// takes longer than all the rest. They are believed: wrong ones make a trace of other records. They need a ray start
/// before each lane's first access; with more than three regions they are not used.
Block encode_block(const Header&, std::span<const WarpTrace> warps, std::span<const WarpSymbols> symbols = {});

class Writer {
public:
    /// Throws Error if the file cannot be created.
    Writer(const std::string& path, const Header&);
    ~Writer();  ///< without finish(): removes the partial file
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;

    /// Blocks must arrive in (launch, warp) order without gaps. Throws Error when the disk is full.
    void append(const Block&);
    /// Writes the footer and gives the file its name. Throws Error unless every warp of every launch was appended.
    void finish();
    std::uint64_t bytes_written() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace raycache::traces
