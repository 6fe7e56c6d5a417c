#include "tools/jobs/make_ahead.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "on_threads.hpp"

using raycache::tools::make_ahead;

namespace {

template <class Test>
void on_one_and_four(const Test& test) {
    for (const int threads : {1, 4}) {
        CAPTURE(threads);
        raycache::test::on_threads(threads, [&] { test(threads); });
    }
}

}  // namespace

TEST_CASE("parts that are made ahead are used in order, few at a time", "[threads]") {
    on_one_and_four([](int threads) {
        std::vector<std::size_t> used;
        std::atomic<int> waiting{0}, most{0};
        make_ahead(
            500,
            [&](std::size_t i) {
                const int now = ++waiting;
                for (int before = most; before < now && !most.compare_exchange_weak(before, now);) continue;
                return std::vector<std::size_t>(1 + i % 3, i);
            },
            [&](std::vector<std::size_t>&& part) {
                --waiting;
                used.push_back(part.at(0));
            });
        REQUIRE(used.size() == 500);
        for (std::size_t i = 0; i < used.size(); ++i) REQUIRE(used[i] == i);
        CHECK(most <= 2 * threads);
    });
}

TEST_CASE("of parts that cannot be made the first says why, after those before it were used", "[threads]") {
    on_one_and_four([](int) {
        for (int round = 0; round < 20; ++round) {
            std::size_t used = 0;
            CHECK_THROWS_WITH(make_ahead(
                                  100,
                                  [](std::size_t i) {
                                      if (i % 10 == 7) throw std::runtime_error("part " + std::to_string(i));
                                      return i;
                                  },
                                  [&](std::size_t) { ++used; }),
                              "part 7");
            CHECK(used == 7);
        }
    });
}

TEST_CASE("a part that cannot be used is the last, and none is none", "[threads]") {
    on_one_and_four([](int) {
        std::size_t used = 0;
        CHECK_THROWS_WITH(make_ahead(
                              100, [](std::size_t i) { return i; },
                              [&](std::size_t i) {
                                  ++used;
                                  if (i == 5) throw std::runtime_error("enough");
                              }),
                          "enough");
        CHECK(used == 6);
        make_ahead(
            0, [](std::size_t i) { return i; }, [&](std::size_t) { ++used; });
        CHECK(used == 6);
    });
}
