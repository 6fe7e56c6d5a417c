#include "cachesim/frontend/load_counter.hpp"

#include <catch2/catch.hpp>

#include "random_launch.hpp"
#include "traces/record.hpp"

using namespace raycache;
using namespace raycache::cachesim;
using namespace raycache::cachesim::test;
using traces::ObjectKind;

namespace {

/// Loads and requests of lanes `mask`. `sectors`: what coalescing would say, where it matters.
std::pair<std::uint64_t, std::uint64_t> count(const traces::Region& r, const FrontEnd& front_end, std::uint32_t mask,
                                              const std::vector<std::uint32_t>& elements, unsigned sectors = 0) {
    const LoadCounter loads({r}, front_end, LineShape(128, 32));
    return {loads.loads(0),
            loads.requests_follow(0) ? loads.requests(0, sectors) : loads.requests(0, mask, elements.data())};
}

using Count = std::pair<std::uint64_t, std::uint64_t>;

const traces::Region nodes = region(ObjectKind::node, 0x200000, 64, 64, 1000);
const traces::Region triangles = region(ObjectKind::triangle, 0x200000, 48, 48, 1000);
const traces::Region texels = region(ObjectKind::texel, 0x200000, 4, 4, 1000);

FrontEnd pascal() {
    FrontEnd f;
    f.lanes_per_request_16 = 2;
    f.lanes_per_request_8 = 4;
    f.lanes_per_request_4 = 8;
    return f;
}

}  // namespace

TEST_CASE("a visit to a node is four loads and asks for each node's sectors once per load") {
    CHECK(count(nodes, {}, 0b1, {7}, 2) == Count{4, 4});
    CHECK(count(nodes, {}, 0b111, {7, 7, 7}, 2) == Count{4, 4});
    CHECK(count(nodes, {}, 0b111, {7, 8, 7}, 4) == Count{4, 8});
}

TEST_CASE("a test of a triangle is three loads") {
    CHECK(count(triangles, {}, 0b1, {1}, 2) == Count{3, 3});
    CHECK(count(triangles, {}, 0b111, {1, 2, 1}, 3) == Count{3, 6});  // they share a sector, but no load of them does
}

TEST_CASE("a texel is one load, and lanes that share a sector share a request") {
    CHECK(count(texels, {}, 0b1111, {0, 1, 7, 8}, 2) == Count{1, 2});
}

TEST_CASE("narrower loads are more of them") {
    FrontEnd f;
    f.load_bytes = 4;
    CHECK(count(nodes, f, 0b11, {0, 1}, 4) == Count{16, 32});
    CHECK(count(region(ObjectKind::texel, 0, 20, 32, 9), {}, 0b1, {3}, 1) == Count{2, 2});  // 16 and 4 bytes
}

TEST_CASE("Maxwell and Pascal ask for pairs of neighbouring lanes by themselves") {
    CHECK(count(nodes, pascal(), 0b1111, {5, 5, 5, 5}) == Count{4, 8});
    CHECK(count(nodes, pascal(), 0b1111, {5, 5, 5, 6}) == Count{4, 12});
    CHECK(count(nodes, pascal(), 0b0110, {5, 5}) == Count{4, 8});  // lanes 1 and 2 are of different pairs
    CHECK(count(nodes, pascal(), 0xc0000000, {5, 5}) == Count{4, 4});
    CHECK(count(triangles, pascal(), 0b11, {5, 5}) == Count{3, 3});
    CHECK(count(texels, pascal(), 0x1ff, {0, 1, 2, 3, 4, 5, 6, 7, 0}) == Count{1, 2});
    CHECK(count(texels, pascal(), 0x103, {0, 8, 0}) == Count{1, 3});
}

TEST_CASE("a load that straddles sectors asks for both") {
    CHECK(count(region(ObjectKind::node, 24, 16, 100, 9), {}, 0b1, {0}, 2) == Count{1, 2});
    CHECK(count(region(ObjectKind::node, 24, 32, 100, 9), {}, 0b1, {0}, 2) == Count{2, 3});
}
