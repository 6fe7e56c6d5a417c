// Which sectors of the shared cache differ from DRAM, kept beside the cache: it needs no dirty bits of its own.
//
// A changed sector is written to DRAM when it is evicted, at the latest at the end of the launch, so writes to DRAM are
// changes of a sector that equalled DRAM before. Evictions show late but surely: nobody reads or writes a sector
// without a look-up, and the first look-up after an eviction misses.
#pragma once

#include <cstdint>
#include <vector>

namespace raycache::cachesim {

class WriteBack {
public:
    /// A write of sectors of a line, of which the cache fetched some. Returns those that will have to be written to
    /// DRAM once more.
    std::uint32_t write(std::uint32_t line, std::uint32_t sectors, std::uint32_t fetched) {
        std::uint32_t& changed = of(line);
        changed &= ~fetched;  // evicted since
        const std::uint32_t more = sectors & ~changed;
        changed |= sectors;
        return more;
    }

    /// A read, for which the cache fetched sectors.
    void read(std::uint32_t line, std::uint32_t fetched) { of(line) &= ~fetched; }

private:
    std::uint32_t& of(std::uint32_t line) {
        if (line >= changed_.size()) changed_.resize(2 * std::size_t{line} + 1);
        return changed_[line];
    }

    std::vector<std::uint32_t> changed_;  ///< by line id: sectors
};

}  // namespace raycache::cachesim
