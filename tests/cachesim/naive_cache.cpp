#include "naive_cache.hpp"

#include <algorithm>

#include "naive_place.hpp"

namespace raycache::cachesim::test {

namespace {

/// The first output of the generator of Steele, Lea and Flood (2014) that starts with this state.
std::uint64_t splitmix64(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15ull;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

/// floor(factor * numerator / 2^64), by long multiplication.
std::uint64_t scaled(std::uint64_t numerator, std::uint64_t factor) {
    const std::uint64_t low = (numerator & 0xffffffff) * factor, high = (numerator >> 32) * factor;
    return (high + (low >> 32)) >> 32;  // for factors below 2^31
}

}  // namespace

NaiveCache::Answer NaiveCache::look_up(std::uint64_t line, const std::set<unsigned>& sectors) {
    ++now_;
    const std::uint64_t set_number = number_ * geometry_.slices * geometry_.sets + naive_set(geometry_, line);
    Set& set = sets_[set_number];
    auto way = std::find_if(set.ways.begin(), set.ways.end(), [&](const Line& l) { return l.number == line; });
    if (way == set.ways.end()) {
        const Line fresh{line, now_, now_, {}};
        ++fills_.line_misses;
        if (set.ways.size() < geometry_.ways) {
            ++fills_.of_empty_ways;
            way = set.ways.insert(set.ways.end(), fresh);
        } else {
            way = set.ways.begin() + static_cast<std::ptrdiff_t>(victim(set_number, set));
            *way = fresh;
        }
    }
    way->used = now_;
    use_tree(set, static_cast<std::uint64_t>(way - set.ways.begin()), 0, geometry_.ways);
    Answer answer;
    for (const unsigned s : sectors)
        if (!way->sectors.count(s)) answer.missing.insert(s);
    for (const unsigned s : widened(answer.missing))
        if (!way->sectors.count(s)) answer.fetched.insert(s);
    way->sectors.insert(answer.fetched.begin(), answer.fetched.end());
    return answer;
}

std::set<unsigned> NaiveCache::widened(const std::set<unsigned>& missing) const {
    std::set<unsigned> all = missing;
    const std::uint32_t fill = std::max(geometry_.fill_bytes, geometry_.sector_bytes);
    for (const unsigned s : missing)
        for (unsigned other = 0; other < geometry_.line_bytes / geometry_.sector_bytes; ++other)
            if (other * geometry_.sector_bytes / fill == s * geometry_.sector_bytes / fill) all.insert(other);
    return all;
}

std::uint64_t NaiveCache::victim(std::uint64_t set_number, Set& set) const {
    const auto place = [&](auto before) {
        return static_cast<std::uint64_t>(std::min_element(set.ways.begin(), set.ways.end(), before) -
                                          set.ways.begin());
    };
    if (geometry_.policy == "lru") return place([](const Line& a, const Line& b) { return a.used < b.used; });
    if (geometry_.policy == "fifo") return place([](const Line& a, const Line& b) { return a.came < b.came; });
    if (geometry_.policy == "tree_plru") return tree_victim(set, 0, geometry_.ways);
    const std::uint64_t n = set.evictions++;
    return scaled(splitmix64(splitmix64(splitmix64(geometry_.seed) ^ set_number) ^ n), geometry_.ways);
}

void NaiveCache::use_tree(Set& set, std::uint64_t way, std::uint64_t first, std::uint64_t ways) {
    if (ways == 1) return;
    const std::uint64_t left = ways - ways / 2;
    const bool is_right = way >= first + left;
    set.goes_right[{first, ways}] = !is_right;
    is_right ? use_tree(set, way, first + left, ways - left) : use_tree(set, way, first, left);
}

std::uint64_t NaiveCache::tree_victim(Set& set, std::uint64_t first, std::uint64_t ways) {
    if (ways == 1) return first;
    const std::uint64_t left = ways - ways / 2;
    return set.goes_right[{first, ways}] ? tree_victim(set, first + left, ways - left) : tree_victim(set, first, left);
}

}  // namespace raycache::cachesim::test
