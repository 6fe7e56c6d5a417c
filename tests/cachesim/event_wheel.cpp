#include "cachesim/replay/timed/event_wheel.hpp"

#include <catch2/catch.hpp>
#include <random>
#include <set>
#include <vector>

using namespace raycache::cachesim;

TEST_CASE("events come in order of time, then of flight, near and far ahead") {
    std::mt19937_64 random(1);
    EventWheel wheel(40);
    std::set<std::pair<Cycle, std::uint32_t>> plain;
    std::vector<std::uint32_t> idle;
    for (std::uint32_t f = 0; f < 40; ++f) idle.push_back(f);
    CHECK(wheel.time() == never);
    Cycle now = 0;
    for (int step = 0; step < 200'000; ++step) {
        if (!idle.empty() && (plain.empty() || random() % 2)) {
            const std::uint32_t flight = idle.back();
            idle.pop_back();
            const Cycle ahead = random() % 4 == 0 ? random() % 5000 : random() % 30;
            wheel.push(now + ahead, flight);
            plain.emplace(now + ahead, flight);
        } else {
            const auto [time, flight] = *plain.begin();
            plain.erase(plain.begin());
            REQUIRE(wheel.time() == time);
            REQUIRE(wheel.pop() == flight);
            idle.push_back(flight);
            now = time;
        }
        REQUIRE(wheel.time() == (plain.empty() ? never : plain.begin()->first));
    }
}
