// Trees kept for the next command.
#include "tools/jobs/bvh_cache.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "tests/tracer/trees.hpp"
#include "tests/traces/files.hpp"
#include "tracer/bvh/bvh_file.hpp"
#include "traces/error.hpp"

namespace raycache {
namespace {

using Catch::Matchers::Contains;
using tracer::test::equal;
namespace fs = std::filesystem;

struct Cache {
    TemporaryFolder parent{};
    std::string folder = parent / "made/by it";
    tracer::Scene scene = tracer::test::soup(300, 0.3F, 1);
    tracer::BvhSettings settings{};
    std::string key = tracer::bvh_key(scene, settings), file = folder + "/" + tracer::bvh_file_name(key);
    std::vector<std::string> warnings{};

    tracer::Bvh get() {
        return tools::cached_bvh(folder, scene, settings, [&](const std::string& line) { warnings.push_back(line); });
    }
};

/// All triangles in the same boxes as in the tree, in another order within a leaf: sound, but not what is built.
tracer::Bvh with_a_leaf_turned(tracer::Bvh bvh) {
    for (const tracer::Bvh::Node& node : bvh.nodes)
        if (node.count > 1) {
            std::swap(bvh.triangles[node.first], bvh.triangles[node.first + 1]);
            return bvh;
        }
    return bvh;
}

TEST_CASE("A BVH is built once, kept, and read from then on") {
    Cache cache;
    const tracer::Bvh built = tracer::build_bvh(cache.scene, cache.settings);
    CHECK(equal(cache.get(), built));
    REQUIRE(fs::exists(cache.file));
    const tracer::Bvh other = with_a_leaf_turned(built);
    REQUIRE_FALSE(equal(other, built));
    tracer::write_bvh(cache.file, other, cache.scene, cache.key);
    CHECK(equal(cache.get(), other));  // read, not built
    CHECK(cache.warnings.empty());
}

TEST_CASE("A kept BVH that is damaged, cut or foreign is built again, with a warning, and replaced") {
    Cache cache;
    const tracer::Bvh built = cache.get();
    const std::vector<std::uint8_t> good = read_file(cache.file);
    std::vector<std::uint8_t> flipped = good;
    flipped[good.size() / 2] ^= 1;
    const std::vector<std::uint8_t> cut(good.begin(), good.end() - 5), foreign{'h', 'e', 'l', 'l', 'o'}, none;
    for (const auto& bad : {flipped, cut, foreign, none}) {
        write_file(cache.file, bad);
        cache.warnings.clear();
        CHECK(equal(cache.get(), built));
        REQUIRE(cache.warnings.size() == 1);
        CHECK_THAT(cache.warnings[0], Contains("cached BVH built again: " + cache.file + ": expected"));
        CHECK(read_file(cache.file) == good);
    }
}

TEST_CASE("A BVH that cannot be kept is built all the same, with a warning") {
    Cache cache;
    const tracer::Bvh built = tracer::build_bvh(cache.scene, cache.settings);
    write_file(cache.parent / "made", {1});  // no folder can be made below it
    CHECK(equal(cache.get(), built));
    REQUIRE(cache.warnings.size() == 1);
    CHECK_THAT(cache.warnings[0], Contains("the BVH is not kept: " + cache.file));

    Cache blocked;
    fs::create_directories(blocked.file);
    CHECK(equal(blocked.get(), built));
    REQUIRE(blocked.warnings.size() == 2);
    CHECK_THAT(blocked.warnings[0], Contains("built again") && Contains("a folder"));
    CHECK_THAT(blocked.warnings[1], Contains("the BVH is not kept"));
}

TEST_CASE("A BVH cache that is a file is refused; one that does not exist is not") {
    const TemporaryFolder parent;
    write_file(parent / "file", {1});
    CHECK_THAT(refusal([&] { tools::check_bvh_cache(parent / "file"); }),
               Contains("expected a folder") && Contains("--bvh-cache"));
    CHECK_NOTHROW(tools::check_bvh_cache(parent / "none"));
    CHECK_NOTHROW(tools::check_bvh_cache(parent.path().string()));
}

}  // namespace
}  // namespace raycache
