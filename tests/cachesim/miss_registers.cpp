#include "cachesim/replay/timed/miss_registers.hpp"

#include <catch2/catch.hpp>
#include <vector>

using namespace raycache::cachesim;

TEST_CASE("registers are full when as many sectors are on their way, and free again as these arrive") {
    MissRegisters registers(2, 10);
    CHECK(registers.empty());
    const auto a = registers.take(3, 0, 100), b = registers.take(3, 2, 101);
    CHECK(registers.full());
    CHECK(registers.find(3, 0) == a);
    CHECK(registers.find(3, 2) == b);
    CHECK(registers[b].since == 101);
    CHECK(registers[b].arrival == never);
    registers.give_back(b);
    CHECK_FALSE(registers.full());
    CHECK(registers.find(3, 0) == a);
    const auto c = registers.take(4, 1, 102);
    CHECK(registers.find(4, 1) == c);
    registers.give_back(a);
    registers.give_back(c);
    CHECK(registers.empty());
}

TEST_CASE("who waits at a register is told once, those that came last first") {
    MissRegisters registers(2, 2);
    const auto a = registers.take(0, 0, 0), b = registers.take(1, 0, 0);
    for (std::uint32_t who = 0; who < 3; ++who) registers.wait(a, who, 1);
    registers.wait(b, 7);
    std::vector<std::pair<std::uint32_t, unsigned>> told;
    const auto tell = [&](std::uint32_t who, std::uint8_t l1) { told.emplace_back(who, l1); };
    registers.tell_waiters(a, tell);
    CHECK(told == std::vector<std::pair<std::uint32_t, unsigned>>{{2, 1}, {1, 1}, {0, 1}});
    registers.tell_waiters(a, tell);
    CHECK(told.size() == 3);
    registers.tell_waiters(b, tell);
    CHECK(told.back() == std::pair<std::uint32_t, unsigned>{7, 0});
}
