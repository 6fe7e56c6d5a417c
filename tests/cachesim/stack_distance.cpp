#include "cachesim/analysis/stack_distance.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <list>
#include <random>

#include "cachesim/analysis/shadow_cache.hpp"

using namespace raycache::cachesim;

namespace {

/// A fully associative LRU cache of so many lines, as naive as can be.
class NaiveCache {
public:
    NaiveCache(std::size_t lines, unsigned fill_sectors) : lines_(lines), fill_(fill_sectors) {}

    /// Whether that sector of the line was there, for all that are asked for.
    std::vector<bool> look_up(std::uint32_t line, std::uint32_t asked) {
        auto at = std::find_if(held_.begin(), held_.end(), [&](const auto& l) { return l.first == line; });
        if (at == held_.end()) {
            held_.emplace_front(line, 0);
            if (held_.size() > lines_) held_.pop_back();
        } else {
            held_.splice(held_.begin(), held_, at);
        }
        std::vector<bool> there;
        std::uint32_t fetched = 0;
        for (unsigned s = 0; s < 32; ++s) {
            if (!(asked >> s & 1)) continue;
            there.push_back(held_.front().second >> s & 1);
            for (unsigned f = s / fill_ * fill_; f < (s / fill_ + 1) * fill_; ++f) fetched |= 1U << f;
        }
        held_.front().second |= fetched;
        return there;
    }

private:
    std::size_t lines_;
    unsigned fill_;
    std::list<std::pair<std::uint32_t, std::uint32_t>> held_;
};

struct LookUp {
    std::uint32_t line, asked;
};

/// Some lines often, others hardly ever.
std::vector<LookUp> random_lookups(std::size_t count, std::uint32_t lines, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<LookUp> all;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t range = random() % 3 ? std::max(1U, lines / 8) : lines;
        all.push_back({static_cast<std::uint32_t>(random() % range), static_cast<std::uint32_t>(random() % 15 + 1)});
    }
    return all;
}

}  // namespace

TEST_CASE("a stack distance tells the hits of every fully associative cache that a naive one has") {
    const unsigned fill = GENERATE(1U, 2U, 4U);
    const std::uint32_t lines = GENERATE(1U, 7U, 60U);
    const auto lookups = random_lookups(4000, lines, fill + lines);
    for (const std::size_t capacity : {1, 2, 3, 5, 8, 20, 59, 60, 61}) {
        StackDistance distances(4, fill);
        NaiveCache cache(capacity, fill);
        DistanceCounts counts;
        std::uint64_t hits = 0;
        bool equal = true;
        for (const LookUp& l : lookups) {
            const std::vector<bool> there = cache.look_up(l.line, l.asked);
            std::size_t next = 0;
            distances.look_up(l.line, l.asked, [&](std::uint32_t distance, unsigned) {
                const bool first = distance == StackDistance::never;
                first ? counts.add_first(1) : counts.add(distance, 1);
                equal &= there[next] == (!first && distance < capacity);
                hits += there[next++];
            });
            equal &= next == there.size();
        }
        INFO("capacity " << capacity << ", " << lines << " lines, fills of " << fill);
        CHECK(equal);
        CHECK(counts.hits(capacity) == hits);
    }
}

TEST_CASE("stack distances agree with the shadow cache over many lines") {
    constexpr std::uint64_t capacity = 7000;
    StackDistance distances(4);
    ShadowCache shadow(capacity);
    bool equal = true;
    for (const LookUp& l : random_lookups(200000, 50000, 1)) {  // more than a block of RecencyOrder
        std::uint32_t absent = 0;
        distances.look_up(l.line, l.asked, [&](std::uint32_t distance, unsigned sector) {
            if (distance >= capacity) absent |= 1U << sector;
        });
        equal &= absent == shadow.look_up(l.line, l.asked, 0).absent;
    }
    CHECK(equal);
    CHECK(distances.lines() == shadow.lines_seen());
}

TEST_CASE("distances of a cycle through lines are one less than its length") {
    StackDistance distances(1);
    for (int round = 0; round < 300; ++round)
        for (std::uint32_t line = 0; line < 5; ++line)
            distances.look_up(line, 1, [&](std::uint32_t distance, unsigned) {
                if (distance != (round == 0 ? StackDistance::never : 4U)) FAIL(distance);
            });
    CHECK(distances.lines() == 5);
}
