#include "cachesim/cache/line_map.hpp"

#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <map>
#include <random>

#include "cachesim/gpus/limits.hpp"
#include "naive_place.hpp"

using namespace raycache::cachesim;
using namespace raycache::cachesim::test;

namespace {

CacheGeometry geometry(std::uint64_t sets, SetIndex index = SetIndex::modulo) {
    CacheGeometry g;
    g.sets = sets;
    g.ways = 1;
    g.index = index;
    return g;
}

/// The L2s of the two configurations that the reference was simulated with.
CacheGeometry rtx_3070_l2() {
    CacheGeometry g = geometry(64, SetIndex::ipoly);
    g.ways = 16;
    g.slices = 32;
    g.slice_hash = SliceHash::ipoly;
    g.slice_bits = {7, 8, 9, 10, 11};
    g.slice_hash_from = 13;
    return g;
}
CacheGeometry qv100_l2() {
    CacheGeometry g = geometry(32, SetIndex::ipoly);
    g.ways = 24;
    g.slices = 64;
    g.slice_hash = SliceHash::ipoly;
    g.slice_bits = {13, 8, 9, 10, 11, 12};
    g.slice_hash_from = 14;
    return g;
}
/// The measured function of the AD102 L1.
CacheGeometry ad102_l1() {
    CacheGeometry g = geometry(256, SetIndex::parity);
    g.ways = 4;
    g.index_masks = {0xc3901e00, 0x119a80a00, 0x167041b00, 0xdbc21d80, 0x47810400, 0x1b4e09180, 0xb6405400, 0xdc202c80};
    return g;
}

void check_against_formulas(const CacheGeometry& g) {
    CAPTURE(g.sets, g.slices, static_cast<int>(g.index), static_cast<int>(g.slice_hash), g.line_bytes,
            g.interleave_bytes);
    const LineMap map(g);
    const auto check = [&](std::uint64_t line) {
        const NaivePlace expected = naive_place(g, line);
        // One check for each line: Catch takes longer for one than the map does.
        const bool right = expected.slice < g.slices && expected.set < g.sets && map(line) == naive_set(g, line) &&
                           map.general(line) == map(line) && map.place(line).slice == expected.slice &&
                           map.place(line).set == expected.set;
        if (!right)
            FAIL_CHECK("line " << line << ": slice " << map.place(line).slice << ", set " << map.place(line).set
                               << "; expected " << expected.slice << ", " << expected.set);
    };
    const std::uint64_t last = ~std::uint64_t{0} / g.line_bytes;
    for (const std::uint64_t line :
         {std::uint64_t{0}, g.sets - 1, g.sets, last - 1, last, (std::uint64_t{1} << 48) / g.line_bytes})
        check(std::min(line, last));
    std::mt19937_64 random(g.sets * 4096 + g.slices);
    for (int i = 0; i < 200; ++i) check((random() >> random() % 64) & last);
}

/// H5 and H6 of the reference: the remainder of x:b modulo t^5+t^2+1, t^6+t+1.
std::uint64_t remainder(std::uint64_t x, std::uint64_t b, unsigned bits) {
    std::uint64_t value = x << bits | b;
    const std::uint64_t polynomial = bits == 5 ? 0b100101 : 0b1000011;
    for (unsigned at = 63; at >= bits; --at)
        if (value >> at & 1) value ^= polynomial << (at - bits);
    return value;
}

}  // namespace

TEST_CASE("slice and set are the documented ones for every number of slices and sets") {
    const auto sets = GENERATE(1ull, 2ull, 3ull, 16ull, 24ull, 32ull, 64ull, 128ull, 1000ull, 1024ull, 65536ull);
    const auto slices = GENERATE(1u, 2u, 3u, 16u, 24u, 32u, 36u, 48u, 64u, 80u, 128u, 160u, 4096u);
    const auto index = GENERATE(SetIndex::modulo, SetIndex::xor_fold, SetIndex::ipoly);
    const auto hash = GENERATE(SliceHash::modulo, SliceHash::xor_fold, SliceHash::ipoly);
    CacheGeometry g = geometry(sets, index);
    g.slices = slices;
    g.slice_hash = hash;
    const bool divides = slices == 16 || slices == 32 || slices == 64;
    if (index == SetIndex::ipoly && sets != 16 && sets != 32 && sets != 64) return;
    if (hash == SliceHash::ipoly && !divides) return;
    for (const std::uint32_t line_bytes : {16u, 128u, 4096u}) {
        g.line_bytes = line_bytes;
        g.interleave_bytes = std::max(256u, line_bytes);
        if (hash == SliceHash::ipoly) {
            g.slice_bits.clear();
            const auto first = static_cast<std::uint32_t>(std::countr_zero(line_bytes)) + 1;
            for (std::uint32_t bit = 0; std::uint64_t{1} << bit < slices; ++bit) g.slice_bits.push_back(first + bit);
            std::swap(g.slice_bits.front(), g.slice_bits.back());
            g.slice_hash_from = first + 9;
        }
        check_against_formulas(g);
    }
}

TEST_CASE("the set is the documented one for numbers of sets near and above 2^32") {
    for (const std::uint64_t sets : {1536ull, 20480ull, (1ull << 32) - 5, 1ull << 33})
        for (const auto index : {SetIndex::modulo, SetIndex::xor_fold}) check_against_formulas(geometry(sets, index));
}

TEST_CASE("slices change after every interleave, whatever its size") {
    for (const std::uint32_t interleave : {128u, 256u, 4096u, 1u << 30}) {
        CacheGeometry g = geometry(128);
        g.slices = 36;
        g.interleave_bytes = interleave;
        check_against_formulas(g);
        const LineMap map(g);
        const std::uint64_t lines = interleave / g.line_bytes;
        CHECK(map.place(0).slice == 0);
        CHECK(map.place(lines - 1).slice == 0);
        CHECK(map.place(lines).slice == 1);
        CHECK(map.place(36 * lines).slice == 0);
        CHECK(map.place(36 * lines).set == lines % 128);  // as if the other slices' lines did not exist
    }
}

TEST_CASE("the documented polynomials divide as long division does") {
    CHECK(polynomial_remainder(0, 13, 4) == 13);
    CHECK(polynomial_remainder(1, 0, 4) == 3);         // t^4 = t + 1
    CHECK(polynomial_remainder(1, 0, 5) == 5);         // t^5 = t^2 + 1
    CHECK(polynomial_remainder(1, 0, 6) == 3);         // t^6 = t + 1
    CHECK(polynomial_remainder(1, 3, 6) == 0);         // t^6 + t + 1
    CHECK(polynomial_remainder(2, 10, 5) == 0);        // t (t^5 + t^2 + 1)
    CHECK(polynomial_remainder(1u << 15, 7, 5) == 7);  // only 15 bits of high count
    CHECK(polynomial_remainder(1u << 19, 7, 6) == 7);  // only 19
    CHECK(naive_remainder("100101", "100101") == 0);
    CHECK(naive_remainder("100000", "100101") == 5);
}

TEST_CASE("slices and sets are those of the simulator's RTX 3070 configuration") {
    const CacheGeometry g = rtx_3070_l2();
    check_against_formulas(g);
    const LineMap map(g);
    std::mt19937_64 random(1);
    for (int i = 0; i < 10000; ++i) {
        const std::uint64_t a = (random() >> random() % 64) & ~127ull, l = a >> 12;
        REQUIRE(map.place(a / 128).slice == remainder((a >> 13) % (1 << 15), (a >> 7) % 32, 5));
        REQUIRE(map.place(a / 128).set == remainder((l >> 6) % (1 << 19), l % 64, 6));
    }
    CHECK(map.place(0x2000 / 128).slice == 5);  // bit 13 alone: x = 1, b = 0, t^5 = t^2 + 1
    CHECK(map.place(0x2000 / 128).set == 2);    // L = 2
    CHECK(map.place(0x40000 / 128).set == 3);   // L = 64: t^6 = t + 1
}

TEST_CASE("slices and sets are those of the simulator's QV100 configuration") {
    const CacheGeometry g = qv100_l2();
    check_against_formulas(g);
    const LineMap map(g);
    std::mt19937_64 random(2);
    for (int i = 0; i < 10000; ++i) {
        const std::uint64_t a = (random() >> random() % 64) & ~127ull, l = 2 * (a >> 14) + ((a >> 7) % 2);
        REQUIRE(map.place(a / 128).slice == remainder((a >> 14) % (1 << 19), 2 * ((a >> 8) % 32) + ((a >> 13) % 2), 6));
        REQUIRE(map.place(a / 128).set == remainder((l >> 5) % (1 << 15), l % 32, 5));
    }
    CHECK(map.place(0x2000 / 128).slice == 1);  // bit 13 alone is the lowest of the low bits
    CHECK(map.place(0x100 / 128).slice == 2);
    CHECK(map.place(0x4000 / 128).slice == 3);  // t^6 = t + 1
}

TEST_CASE("the measured function of the AD102 L1 fills every set with four lines of each 128 KiB block") {
    const CacheGeometry g = ad102_l1();
    check_against_formulas(g);
    const LineMap map(g);
    for (const std::uint64_t block : {0ull, 1ull, 37ull, 0x7f5000000000ull >> 17, (1ull << 47) - 1}) {
        std::map<std::uint64_t, int> lines;
        for (std::uint64_t line = 0; line < 1024; ++line) ++lines[map(block * 1024 + line)];
        CHECK(lines.size() == 256);
        CHECK(std::all_of(lines.begin(), lines.end(), [](const auto& set) { return set.second == 4; }));
    }
}

TEST_CASE("the folded index spreads lines of equal low bits over all sets") {
    const LineMap fold(geometry(64, SetIndex::xor_fold)), modulo(geometry(64));
    std::vector<int> uses(64);
    for (std::uint64_t i = 0; i < 64; ++i) {
        ++uses[fold(i * 64)];
        CHECK(modulo(i * 64) == 0);
    }
    CHECK(std::all_of(uses.begin(), uses.end(), [](int n) { return n == 1; }));
}

TEST_CASE("hashed slices share consecutive lines evenly") {
    for (const std::uint32_t slices : {36u, 48u, 80u, 160u}) {
        CacheGeometry g = geometry(128, SetIndex::xor_fold);
        g.slices = slices;
        g.slice_hash = SliceHash::xor_fold;
        const LineMap map(g);
        std::map<std::uint32_t, int> lines;
        for (std::uint64_t line = 0; line < slices * 2 * 256; ++line) ++lines[map.place(line).slice];
        CHECK(lines.size() == slices);
        for (const auto& [slice, count] : lines) CHECK(std::abs(count - 512) <= 64);
    }
}
