// A kind of object and the version of the format that knows it.
#include <catch2/catch.hpp>

#include "traces/error.hpp"
#include "traces/header_codec.hpp"

using namespace raycache;
using namespace raycache::traces;

namespace {

Header header_with(ObjectKind kind) {
    Header header;
    header.regions = {{kind, 0x200000, 32, 32, 10, 0, {}}};
    header.launches = {0};
    header.warps_per_launch = 1;
    return header;
}

}  // namespace

TEST_CASE("a trace has the lowest version that knows the kinds of its regions") {
    for (const ObjectKindRole& role : object_kind_roles)
        CHECK(encode_header(header_with(role.kind))[8] == role.version);
}

TEST_CASE("pages and issue steps do not lower the version that a kind needs, whichever region comes first") {
    Region paged{ObjectKind::node, 0, 4, 4, 1024, 0, {}, PageTable({7})};
    Header header = header_with(ObjectKind::depth);
    header.regions.push_back(paged);
    CHECK(encode_header(header)[8] == 5);
    std::swap(header.regions[0], header.regions[1]);
    CHECK(encode_header(header)[8] == 5);
    header.issue = true;
    CHECK(encode_header(header)[8] == 5);
}

TEST_CASE("a kind that no version knows is refused, and has no name") {
    const auto unknown = static_cast<ObjectKind>(object_kinds);
    CHECK_THROWS_WITH(encode_header(header_with(unknown)), Catch::Contains("kind of region 0"));
    CHECK(name_of(unknown) == std::string("?"));
}

TEST_CASE("each version of the format knows the kinds that it brought and those before") {
    CHECK(object_kinds_of(0) == 0);
    CHECK(object_kinds_of(1) == 3);
    CHECK(object_kinds_of(2) == 10);
    CHECK(object_kinds_of(4) == 10);
    CHECK(object_kinds_of(5) == object_kinds);
}
