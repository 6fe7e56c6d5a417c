// What becomes of tests that skip. The hidden ones are run by tests/cli/skips.py, which looks at what is made of them.
#include <catch2/catch.hpp>

#include "tests/real_data.hpp"
#include "tests/skip.hpp"

using raycache::test::skip;

TEST_CASE("a test that asks for a real scene without the tag [data] fails", "[!shouldfail]") {
    raycache::test::real_scene("sponza.glb");
}

TEST_CASE("skips: as a whole", "[.skips]") { skip("a \"moon\" is absent", "wait for the night"); }

TEST_CASE("skips: one section of two, the other passes", "[.skips]") {
    SECTION("skipped") { skip("a sun is absent", "wait for the day"); }
    SECTION("passing") { CHECK(true); }
}

TEST_CASE("skips: one section of two, the other fails", "[.skips]") {
    SECTION("skipped") { skip("a sun is absent", "wait for the day"); }
    SECTION("failing") { CHECK(false); }
}

TEST_CASE("skips: nothing", "[.skips]") { CHECK(true); }
