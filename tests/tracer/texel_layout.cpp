// Where texels lie.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "test_meshes.hpp"
#include "tracer/scene/texel_layout.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

/// Red and green of a texel tell where it is.
Texture numbered(std::uint32_t width, std::uint32_t height) {
    Texture texture{width, height, {}, "numbered"};
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            for (const std::uint32_t byte : {x % 256, y % 256, 0U, 255 - x % 256})
                texture.rgba.push_back(static_cast<std::uint8_t>(byte));
    return texture;
}

Scene textured(std::vector<Texture> textures) {
    Scene scene = mesh({}, {});
    scene.textures = std::move(textures);
    return scene;
}

Vec2 centre(std::uint32_t x, std::uint32_t y, const Texture& t) {
    return {(static_cast<float>(x) + 0.5F) / static_cast<float>(t.width),
            (static_cast<float>(y) + 0.5F) / static_cast<float>(t.height)};
}

}  // namespace

TEST_CASE("texel layout: every texel has an address of its own below the count, in all textures together") {
    const Scene scene = textured({numbered(16, 16), numbered(1, 1), numbered(13, 7), numbered(8, 4), numbered(256, 2)});
    const TexelLayout layout(scene);
    std::vector<int> used(layout.count());
    std::size_t texels = 0;
    for (std::size_t i = 0; i < scene.textures.size(); ++i) {
        const Texture& t = scene.textures[i];
        for (std::uint32_t y = 0; y < t.height; ++y)
            for (std::uint32_t x = 0; x < t.width; ++x) {
                const auto texel = layout.fetch(static_cast<int>(i), centre(x, y, t));
                REQUIRE(texel.element < layout.count());
                REQUIRE(++used[texel.element] == 1);
                REQUIRE(texel.alpha == static_cast<float>(255 - x % 256) / 255);
                ++texels;
            }
    }
    CHECK(texels == 256 + 1 + 91 + 32 + 512);
    CHECK(layout.count() == 256 + 32 + 128 + 32 + 1024);
}

TEST_CASE("texel layout: a 128 byte line is a tile of 8x4 texels, a 32 byte sector 4x2 of them") {
    const Scene scene = textured({numbered(3, 3), numbered(24, 20)});
    const TexelLayout layout(scene);
    std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> line_tile, sector_block;
    for (std::uint32_t y = 0; y < 20; ++y)
        for (std::uint32_t x = 0; x < 24; ++x) {
            const std::uint32_t byte = 4 * layout.fetch(1, centre(x, y, scene.textures[1])).element;
            REQUIRE(line_tile.try_emplace(byte / 128, x / 8, y / 4).first->second == std::pair(x / 8, y / 4));
            REQUIRE(sector_block.try_emplace(byte / 32, x / 4, y / 2).first->second == std::pair(x / 4, y / 2));
        }
    CHECK(line_tile.size() == 15);
    CHECK(sector_block.size() == 60);
    CHECK(layout.fetch(1, {0, 0}).element % 32 == 0);  // a texture begins a line
}

TEST_CASE("texel layout: coordinates repeat, negative and large ones too") {
    const Scene scene = textured({numbered(16, 8)});
    const TexelLayout layout(scene);
    for (std::uint32_t y = 0; y < 8; ++y)
        for (std::uint32_t x = 0; x < 16; ++x) {
            const Vec2 at = centre(x, y, scene.textures[0]);
            const std::uint32_t element = layout.fetch(0, at).element;
            for (const float turns : {-1000.0F, -3.0F, -1.0F, 1.0F, 2.0F, 1100.0F}) {
                REQUIRE(layout.fetch(0, {at.x + turns, at.y}).element == element);
                REQUIRE(layout.fetch(0, {at.x, at.y - turns}).element == element);
            }
        }
    CHECK(layout.fetch(0, {1, 1}).element == layout.fetch(0, {0, 0}).element);
    CHECK(layout.fetch(0, {-1, -1}).element == layout.fetch(0, {0, 0}).element);
}

TEST_CASE("texel layout: any coordinate gives some texel: NaN, infinite, huge, tiny") {
    const Scene scene = textured({numbered(5, 3)});
    const TexelLayout layout(scene);
    const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    for (const float odd : {nan, infinity, -infinity, 1e30F, -1e30F, 3.4e38F, -1e-30F, -1e-45F, 1e-45F, 16777215.5F,
                            -8388607.5F, std::nextafter(1.0F, 0.0F), -0.0F}) {
        REQUIRE(layout.fetch(0, {odd, 0.5F}).element < layout.count());
        REQUIRE(layout.fetch(0, {0.5F, odd}).element < layout.count());
    }
}

TEST_CASE("texel layout: colours are decoded from sRGB, alpha is linear") {
    Texture texture{2, 1, {0, 255, 188, 51, 10, 11, 128, 255}, "colours"};
    const Scene scene = textured({texture});
    const TexelLayout layout(scene);
    const auto first = layout.fetch(0, {0.25F, 0.5F}), second = layout.fetch(0, {0.75F, 0.5F});
    CHECK(first.color.x == 0);
    CHECK(first.color.y == 1);
    CHECK(first.color.z == Approx(0.502886).epsilon(1e-5));
    CHECK(first.alpha == 0.2F);
    CHECK(second.color.x == Approx(10 / 255.0 / 12.92).epsilon(1e-5));
    CHECK(second.color.y == Approx(std::pow((11 / 255.0 + 0.055) / 1.055, 2.4)).epsilon(1e-5));
    CHECK(second.color.z == Approx(0.215861).epsilon(1e-5));
}

TEST_CASE("texel layout: a scene without textures has no texels") { CHECK(TexelLayout(mesh({}, {})).count() == 0); }

TEST_CASE("texel layout: textures of more than 2^30 - 2 texels together are refused in one line") {
    Texture large;  // its size alone counts
    large.width = large.height = 16384;
    Scene scene = textured({large, large, large});
    CHECK(TexelLayout(scene).count() == 3U << 28);
    scene.textures.push_back(large);
    CHECK_THROWS_AS(TexelLayout(scene), Error);
    CHECK_THROWS_WITH(TexelLayout(scene), Catch::Contains("1073741822") && !Catch::Contains("\n"));
}

TEST_CASE("texel layout: the texture coordinate of a point is the weighted mean of its vertices'") {
    Scene scene = mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {2, 0, 1});
    CHECK(texcoord_at(scene, 0, 0.25F, 0.5F) == Vec2{0, 0});
    scene.texcoords = {{1, 0}, {0, 1}, {4, 8}};
    CHECK(texcoord_at(scene, 0, 0, 0) == Vec2{4, 8});
    CHECK(texcoord_at(scene, 0, 1, 0) == Vec2{1, 0});
    CHECK(texcoord_at(scene, 0, 0, 1) == Vec2{0, 1});
    CHECK(texcoord_at(scene, 0, 0.25F, 0.5F) == Vec2{1.25F, 2.5F});
}
