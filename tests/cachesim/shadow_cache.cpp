// The fully associative shadow of a cache against one that is written for obviousness, and by hand.
#include "cachesim/analysis/shadow_cache.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <deque>
#include <map>
#include <random>

using raycache::cachesim::ShadowCache;

namespace {

/// Every look-up searches the whole list.
class NaiveLru {
public:
    explicit NaiveLru(std::size_t lines) : lines_(lines) {}

    /// The sectors that were absent.
    std::uint32_t look_up(std::uint64_t line, std::uint32_t asked) {
        const auto at = std::find_if(list_.begin(), list_.end(), [&](const auto& l) { return l.first == line; });
        std::uint32_t present = 0;
        if (at != list_.end()) {
            present = at->second;
            list_.erase(at);
        }
        list_.push_front({line, present | asked});
        if (list_.size() > lines_) list_.pop_back();
        return asked & ~present;
    }

private:
    std::size_t lines_;
    std::deque<std::pair<std::uint64_t, std::uint32_t>> list_;  // newest first
};

}  // namespace

TEST_CASE("a shadow cache of two lines answers as computed by hand") {
    ShadowCache cache(2);
    const auto absent = [&](std::uint32_t line, std::uint32_t asked) { return cache.look_up(line, asked, 0).absent; };
    CHECK(absent(7, 0b0011) == 0b0011);
    CHECK(absent(7, 0b0110) == 0b0100);  // a sector miss in a line that is there
    CHECK(absent(8, 0b0001) == 0b0001);
    CHECK(absent(7, 0b0111) == 0);       // now 8 is the older one
    CHECK(absent(9, 0b1000) == 0b1000);  // evicts 8
    CHECK(absent(7, 0b0001) == 0);
    CHECK(absent(8, 0b0001) == 0b0001);  // evicts 9
    CHECK(absent(9, 0b1000) == 0b1000);  // evicts 7
    CHECK(absent(7, 0b0001) == 0b0001);
    CHECK(cache.lines_seen() == 3);
}

TEST_CASE("a shadow cache agrees with a search through a list on random look-ups") {
    const auto lines = GENERATE(1u, 2u, 3u, 17u, 256u);
    std::mt19937_64 random(lines);
    ShadowCache cache(lines);
    NaiveLru naive(lines);
    std::map<std::uint64_t, std::uint32_t> held;
    for (int i = 0; i < 20000; ++i) {
        // Far apart, so that hashing is put to the test; more of them than fit.
        const auto line = static_cast<std::uint32_t>((random() % (3 * lines + 2)) << (random() % 2 ? 0 : 21));
        const auto asked = static_cast<std::uint32_t>(random() % 15 + 1);
        const auto missing = asked & static_cast<std::uint32_t>(random());
        const auto answer = cache.look_up(line, asked, missing);
        REQUIRE(answer.absent == naive.look_up(line, asked));
        REQUIRE(answer.never_held == (asked & ~held[line]));
        held[line] |= asked;
    }
    CHECK(cache.lines_seen() == held.size());
}

TEST_CASE("a fill brings the whole aligned group of each missing sector") {
    ShadowCache pairs(4, 2);
    CHECK(pairs.filled(0b0001) == 0b0011);
    CHECK(pairs.filled(0b0110) == 0b1111);
    CHECK(pairs.look_up(1, 0b0001, 0b0001).absent == 0b0001);
    const auto second = pairs.look_up(1, 0b0110, 0b0100);
    CHECK(second.absent == 0b0100);
    CHECK(second.never_held == 0b0100);  // sector 1 came along with sector 0
    CHECK(ShadowCache(1, 32).filled(1) == 0xffffffffu);
}
