#include "cachesim/frontend/coalesce.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <random>

#include "cachesim/cache/line_ids.hpp"
#include "random_launch.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;
using traces::ObjectKind;

namespace {

struct Touched {
    std::uint64_t line;
    std::uint32_t sectors;
    bool operator==(const Touched&) const = default;
    auto operator<=>(const Touched&) const = default;
};

/// What accesses to one region become, those of each access for itself.
std::vector<std::vector<Touched>> coalesce_all(const traces::Region& r,
                                               const std::vector<std::vector<std::uint32_t>>& accesses,
                                               std::uint32_t line, std::uint32_t sector, InstructionSet instructions) {
    constexpr std::uint32_t first = 2300;
    LineIds ids({r}, line);
    Coalescer coalescer({r}, LineShape(line, sector), ids, instructions);
    std::vector<WarpAccess> list;
    for (const auto& elements : accesses)
        list.push_back({elements.data(), static_cast<std::uint32_t>((std::uint64_t{1} << elements.size()) - 1), 0});
    Lookups out;
    out.reserve(1);
    out.add(7, 7, 7);  // is left alone
    coalescer(list, first, out);
    CHECK((out.lines[0] == 7 && out.sectors[0] == 7 && out.accesses[0] == 7));
    std::vector<std::vector<Touched>> touched(accesses.size());
    for (std::size_t i = 1; i < out.count; ++i) {
        if (i > 1) CHECK(out.accesses[i - 1] <= out.accesses[i]);
        touched.at(out.accesses[i] - first).push_back({ids.line(out.lines[i], 0), out.sectors[i]});
    }
    return touched;
}
std::vector<Touched> coalesce(const traces::Region& r, const std::vector<std::uint32_t>& elements, std::uint32_t line,
                              std::uint32_t sector, InstructionSet instructions) {
    return coalesce_all(r, {elements}, line, sector, instructions).front();
}

/// By every instruction set of this machine, which must agree.
std::vector<Touched> coalesce(const traces::Region& r, const std::vector<std::uint32_t>& elements,
                              std::uint32_t line = 128, std::uint32_t sector = 32) {
    const auto touched = coalesce(r, elements, line, sector, InstructionSet::scalar);
    for (const InstructionSet instructions : instruction_sets())
        CHECK(coalesce(r, elements, line, sector, instructions) == touched);
    return touched;
}

const traces::Region nodes = region(ObjectKind::node, 0x200000, 64, 64, 1000);          // line 0x4000
const traces::Region triangles = region(ObjectKind::triangle, 0x200000, 48, 48, 1000);  // line 0x4000

}  // namespace

TEST_CASE("lanes at the same node share its two sectors") {
    CHECK(coalesce(nodes, {4, 4, 4}) == std::vector<Touched>{{0x4002, 0b0011}});
}

TEST_CASE("the two nodes of a line make one look-up of four sectors") {
    CHECK(coalesce(nodes, {5, 4}) == std::vector<Touched>{{0x4002, 0b1111}});
}

TEST_CASE("lines come in the order in which lanes first touch them") {
    CHECK(coalesce(nodes, {9, 0, 8, 3, 1}) ==
          std::vector<Touched>{{0x4004, 0b1111}, {0x4000, 0b1111}, {0x4001, 0b1100}});
}

TEST_CASE("a triangle that straddles a line makes two look-ups") {
    // Bytes 96 … 143: the last sector of line 0, the first of line 1.
    CHECK(coalesce(triangles, {2}) == std::vector<Touched>{{0x4000, 0b1000}, {0x4001, 0b0001}});
    CHECK(coalesce(triangles, {2, 0}) == std::vector<Touched>{{0x4000, 0b1011}, {0x4001, 0b0001}});
}

TEST_CASE("an object longer than a line touches every line in between") {
    const auto r = region(ObjectKind::texel, 96, 4096, 4096, 2);
    const auto touched = coalesce(r, {0}, 64, 32);
    REQUIRE(touched.size() == 65);
    CHECK(touched.front() == Touched{1, 0b10});
    CHECK(touched[1] == Touched{2, 0b11});
    CHECK(touched.back() == Touched{65, 0b01});
}

TEST_CASE("a line of 32 sectors has 32 bits") {
    CHECK(coalesce(region(ObjectKind::texel, 0, 128, 128, 1), {0}, 128, 4) == std::vector<Touched>{{0, 0xffffffffu}});
}

TEST_CASE("32 lanes in 32 lines make 32 look-ups") {
    std::vector<std::uint32_t> elements;
    for (std::uint32_t lane = 0; lane < 32; ++lane) elements.push_back(lane * 2);
    CHECK(coalesce(nodes, elements).size() == 32);
}

TEST_CASE("permuting the lanes changes neither lines nor sectors") {
    std::mt19937 random(1);
    for (int round = 0; round < 200; ++round) {
        std::vector<std::uint32_t> elements(1 + random() % 32);
        for (auto& e : elements) e = random() % 40;
        auto before = coalesce(triangles, elements);
        std::shuffle(elements.begin(), elements.end(), random);
        auto after = coalesce(triangles, elements);
        std::sort(before.begin(), before.end());
        std::sort(after.begin(), after.end());
        CHECK(before == after);
    }
}

TEST_CASE("every instruction set coalesces alike, for every layout of a region") {
    std::mt19937 random(4);
    for (const auto& [size, stride, offset] :
         {std::array{64u, 64u, 0u}, std::array{48u, 48u, 0u}, std::array{4u, 4u, 0u}, std::array{100u, 36u, 16u},
          std::array{128u, 130u, 127u}, std::array{129u, 129u, 1u}, std::array{80u, 0u, 64u},
          std::array{16u, 0xfffffff0u, 0u}})
        for (const auto& [line, sector] : {std::pair{128u, 32u}, std::pair{128u, 128u}, std::pair{64u, 8u},
                                           std::pair{128u, 4u}, std::pair{4096u, 512u}})
            for (unsigned lanes = 1; lanes <= traces::warp_lanes; ++lanes) {
                const auto r = region(ObjectKind::node, (1ull << 40) + offset, size, stride, 1000);
                std::vector<std::uint32_t> elements(lanes);
                for (auto& e : elements) e = random() % (random() % 2 ? 8 : r.count);
                CHECK(!coalesce(r, elements, line, sector).empty());
            }
}

TEST_CASE("many accesses become what each becomes alone") {
    std::mt19937 random(6);
    for (const auto& r : {nodes, triangles, region(ObjectKind::texel, 0x200000, 4, 4, 1000),
                          region(ObjectKind::node, 0x200010, 100, 36, 1000)})
        for (const InstructionSet instructions : instruction_sets()) {
            std::vector<std::vector<std::uint32_t>> accesses(500);
            for (auto& elements : accesses) {
                elements.resize(1 + (random() % 3 ? random() % 4 : random() % 32));
                for (auto& e : elements) e = random() % (random() % 2 ? 8 : r.count);
            }
            const auto together = coalesce_all(r, accesses, 128, 32, instructions);
            for (std::size_t i = 0; i < accesses.size(); ++i)
                REQUIRE(together[i] == coalesce(r, accesses[i], 128, 32, InstructionSet::scalar));
        }
}

TEST_CASE("the last byte of the address space is an address like any other") {
    const auto r = region(ObjectKind::node, ~std::uint64_t{0} - 127, 64, 64, 2);
    CHECK(coalesce(r, {1, 0}) == std::vector<Touched>{{~std::uint64_t{0} / 128, 0b1111}});
}

TEST_CASE("line ids leave out the gaps, keep the low bits, and are shared by regions that share lines") {
    const std::vector<traces::Region> regions{region(ObjectKind::texel, 0x7f0000000000, 64, 64, 4),
                                              region(ObjectKind::node, 0x100001000, 64, 64, 4),
                                              region(ObjectKind::triangle, 0x100001040, 64, 64, 5)};
    LineIds ids(regions, 128);
    REQUIRE(ids.dense());
    CHECK(ids.id(0x100001000 / 128, 1) == 0x1000 / 128);
    CHECK(ids.id(0x100001040 / 128, 2) == ids.id(0x100001000 / 128, 1));
    const std::uint64_t texels = 0x7f0000000000 / 128;
    CHECK(ids.id(texels, 0) == 1u << LineIds::equal_bits);  // the next multiple, as in `texels`
    CHECK(ids.bound() == (1u << LineIds::equal_bits) + 2);
    CHECK(ids.line(ids.id(texels + 1, 0), 0) == texels + 1);
    CHECK(ids.last_line() == texels + 1);
}

TEST_CASE("regions of too many lines are numbered as they are touched") {
    const std::vector<traces::Region> regions{region(ObjectKind::node, 0, 64, 0xffffffff, 0xffffffff),
                                              region(ObjectKind::node, 1ull << 63, 64, 64, 4)};
    LineIds ids(regions, 128);
    REQUIRE(!ids.dense());
    CHECK(ids.id(5, 0) == 0);
    CHECK(ids.id(1ull << 56, 1) == 1);
    CHECK(ids.id(5, 1) == 0);
    CHECK(ids.line(1, 1) == 1ull << 56);
}

TEST_CASE("impossible regions are refused") {
    CHECK_THROWS_AS(LineIds({region(ObjectKind::node, 0, 0, 64, 1)}, 128), Error);
    CHECK_THROWS_AS(LineIds({region(ObjectKind::node, ~std::uint64_t{0} - 63, 64, 64, 2)}, 128), Error);
    CHECK_NOTHROW(LineIds({region(ObjectKind::node, ~std::uint64_t{0} - 63, 64, 64, 1)}, 128));
}
