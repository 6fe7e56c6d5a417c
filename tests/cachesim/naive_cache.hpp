// One sectored set-associative cache as its documentation says it, with every replacement policy: maps, sets and time
// stamps.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "cachesim/cache/line_fills.hpp"
#include "cachesim/gpus/gpu.hpp"

namespace raycache::cachesim::test {

class NaiveCache {
public:
    /// `number`: of the cache among those of its level.
    explicit NaiveCache(const CacheGeometry& geometry, std::uint64_t number = 0)
        : geometry_(geometry), number_(number) {}

    struct Answer {
        std::set<unsigned> missing, fetched;  ///< sectors of the line; `fetched` includes `missing`
    };
    Answer look_up(std::uint64_t line, const std::set<unsigned>& sectors);

    LineFills fills() const { return fills_; }

private:
    struct Line {
        std::uint64_t number = 0, came = 0, used = 0;  ///< the last two: points in time
        std::set<unsigned> sectors;
    };
    struct Set {
        std::vector<Line> ways;
        std::map<std::pair<std::uint64_t, std::uint64_t>, bool> goes_right;  ///< tree_plru: by first way and ways below
        std::uint64_t evictions = 0;
    };

    /// A way whose line goes.
    std::uint64_t victim(std::uint64_t set_number, Set&) const;
    static void use_tree(Set&, std::uint64_t way, std::uint64_t first, std::uint64_t ways);
    static std::uint64_t tree_victim(Set&, std::uint64_t first, std::uint64_t ways);
    std::set<unsigned> widened(const std::set<unsigned>& missing) const;

    CacheGeometry geometry_;
    std::uint64_t number_, now_ = 0;
    LineFills fills_;
    std::map<std::uint64_t, Set> sets_;
};

}  // namespace raycache::cachesim::test
