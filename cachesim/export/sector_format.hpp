// What a cache is asked, one 32 B sector (the GPU's own sector size) at a time, in formats that other cache simulators
// and scripts read. A new format is one function and one line of sector_formats().
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "cachesim/replay/request_sink.hpp"

namespace raycache::cachesim {

/// A look-up of one sector.
struct SectorAccess {
    std::uint64_t address = 0;  ///< of the sector's first byte
    std::uint32_t cache = 0;    ///< which L1 of the SM; 0 for the levels below
    traces::RayType ray = {};
    std::uint8_t bounce = 0;
    traces::ObjectKind kind = {};
    bool hit = false;
};

struct SectorFormat {
    std::string name, description;
    std::string head;  ///< what a file begins with
    bool names_cache;  ///< whether a reader can tell apart the L1s of an SM
    void (*append)(const SectorAccess&, std::string& out);
};

/// dinero: "0 HEX" a line, a read in the "din" input of Dinero IV. u64: 8 bytes, little-endian. csv: with a header.
const std::vector<SectorFormat>& sector_formats();

}  // namespace raycache::cachesim
