#include "cachesim/replay/timed/calendar.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <random>
#include <vector>

using namespace raycache::cachesim;

TEST_CASE("a calendar hands out what comes in order of time, then of coming") {
    Calendar<int> calendar(8);
    calendar.push(5, 1);
    calendar.push(3, 2);
    calendar.push(5, 3);
    calendar.push(8, 4);
    CHECK(calendar.time() == 3);
    std::vector<int> taken;
    calendar.take(0, 8, [&](int item) { taken.push_back(item); });
    CHECK(taken == std::vector{2, 1, 3});
    CHECK(calendar.time() == 8);
    calendar.take(8, 16, [&](int item) { taken.push_back(item); });
    CHECK(taken == std::vector{2, 1, 3, 4});
    CHECK(calendar.time() == never);
    calendar.push(2, 5);  // too late: as soon as possible
    CHECK(calendar.time() == 16);
    calendar.take(16, 17, [&](int item) { taken.push_back(item); });
    CHECK(taken.back() == 5);
}

TEST_CASE("a calendar agrees with a stable sort, however far ahead things come") {
    struct Item {
        Cycle time;
        int number;
        bool operator==(const Item&) const = default;
    };
    const auto reach = GENERATE(Cycle{1}, Cycle{300}, Cycle{3000}, Cycle{40'000});
    const Cycle window = 200;
    std::mt19937_64 random(reach);
    Calendar<Item> calendar(window);
    std::vector<Item> waiting;
    int number = 0;
    for (Cycle begin = 0; begin < 200'000;) {
        for (auto left = random() % 8; left > 0; --left) {
            const Item item{begin + random() % reach, number++};
            calendar.push(item.time, item);
            waiting.push_back(item);
        }
        std::stable_sort(waiting.begin(), waiting.end(), [](const Item& a, const Item& b) { return a.time < b.time; });
        REQUIRE(calendar.time() == (waiting.empty() ? never : waiting.front().time));
        if (!waiting.empty() && random() % 16 == 0)
            begin = std::max(begin, waiting.front().time);  // leaves out the rest
        const auto later =
            std::find_if(waiting.begin(), waiting.end(), [&](const Item& item) { return item.time >= begin + window; });
        std::vector<Item> taken;
        calendar.take(begin, begin + window, [&](const Item& item) { taken.push_back(item); });
        REQUIRE(taken == std::vector<Item>(waiting.begin(), later));
        waiting.erase(waiting.begin(), later);
        begin += window;
    }
}
