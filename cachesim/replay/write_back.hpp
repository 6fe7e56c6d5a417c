// Which sectors of the shared cache differ from DRAM, kept beside the cache: it needs no dirty bits of its own.
//
// A changed sector is written to DRAM when it is evicted, at the latest at the end of the launch, so writes to DRAM are
// changes of a sector that equalled DRAM before. Evictions show late but surely: nobody reads or writes a sector
// without a look-up, and the first look-up after an eviction misses.
#pragma once

#include <cstdint>
#include <vector>

#include "cachesim/cache/request.hpp"
#include "cachesim/frontend/line_ids.hpp"

namespace raycache::cachesim {

class WriteBack {
public:
    explicit WriteBack(const LineIds& ids) : ids_(ids), changed_(ids.count()) {}

    /// `answer`: of the level, to a write of `sectors`. Returns those that will have to be written to DRAM once more.
    std::uint32_t write(const Request& answer, std::uint32_t sectors) {
        std::uint32_t& changed = changed_[answer.line - ids_.offset(answer.region)];
        changed &= ~answer.sectors;  // evicted since
        const std::uint32_t more = sectors & ~changed;
        changed |= sectors;
        return more;
    }

    /// `answer`: of the level, to a read.
    void read(const Request& answer) { changed_[answer.line - ids_.offset(answer.region)] &= ~answer.sectors; }

private:
    LineIds ids_;
    std::vector<std::uint32_t> changed_;  ///< by line id: sectors
};

}  // namespace raycache::cachesim
