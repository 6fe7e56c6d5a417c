#include "cachesim/analysis/findings.hpp"

namespace raycache::cachesim {

MissCounts& MissCounts::operator+=(const MissCounts& other) {
    lookups += other.lookups;
    compulsory += other.compulsory;
    capacity += other.capacity;
    conflict += other.conflict;
    lucky_hits += other.lucky_hits;
    return *this;
}

MissCounts LevelFindings::all() const {
    MissCounts sum;
    for (const MissCounts& c : by_group) sum += c;
    return sum;
}

MissCounts LevelFindings::by_ray(std::size_t place) const {
    MissCounts sum;
    for (std::size_t kind = 0; kind < traces::object_kinds; ++kind)
        sum += by_group[place * traces::object_kinds + kind];
    return sum;
}

MissCounts LevelFindings::by_kind(traces::ObjectKind kind) const {
    MissCounts sum;
    for (std::size_t i = static_cast<std::size_t>(kind); i < by_group.size(); i += traces::object_kinds)
        sum += by_group[i];
    return sum;
}

LevelFindings& LevelFindings::operator+=(const LevelFindings& other) {
    for (std::size_t i = 0; i < by_group.size(); ++i) by_group[i] += other.by_group[i];
    for (std::size_t i = 0; i < by_depth.size(); ++i) by_depth[i] += other.by_depth[i];
    return *this;
}

Sharing& Sharing::operator+=(const Sharing& other) {
    same_warp += other.same_warp;
    same_cta += other.same_cta;
    other_cta += other.other_cta;
    return *this;
}

Findings& Findings::operator+=(const Findings& other) {
    if (levels.empty()) levels.resize(other.levels.size());
    for (std::size_t i = 0; i < levels.size(); ++i) levels[i] += other.levels[i];
    sharing += other.sharing;
    return *this;
}

}  // namespace raycache::cachesim
