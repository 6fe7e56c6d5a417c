// Which texel a texture coordinate means: sets, transforms, wrap modes.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/tracer/pictures.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

constexpr Vec3 red{1, 0, 0}, green{0, 1, 0};

/// A square with red on the left half of the texture, green on the right one.
SquareFile two_colors(const json& transform, const std::vector<float>& uv = {0, 1, 1, 1, 1, 0, 0, 0}) {
    json material = grey(1);
    material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    if (!transform.is_null())
        material["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"] = transform;
    SquareFile file(material, uv);
    file.add("textures", {{"source", 0}, {"sampler", 0}});
    file.add("samplers", json::object());
    file.add("images", image_of(png_of(2, 1, {{255, 0, 0}, {0, 255, 0}})));
    return file;
}

/// Colour at a point of the square, (0, 0) bottom left.
Vec3 color_at(const Scene& scene, float x, float y) {
    const TexelLayout texels(scene);
    const Material& m = scene.materials[0];
    const bool lower = y < x;  // triangles (0,1,2) and (0,2,3)
    const float u = lower ? x - y : x, v = lower ? y : y - x;
    const auto uv = texcoord_at(scene, lower ? 0 : 1, u, v, m.base_color_lookup.layer);
    return texels.fetch(m.base_color_texture, uv, m.base_color_lookup).color;
}

}  // namespace

TEST_CASE("a texture transform moves, turns and scales coordinates about their origin") {
    const auto colors = [](const json& transform) {
        const Scene scene = load(two_colors(transform).finish()).scene;
        return std::pair{color_at(scene, 0.25F, 0.4F), color_at(scene, 0.75F, 0.4F)};
    };
    CHECK(colors(nullptr) == std::pair{red, green});
    CHECK(colors({{"offset", {0.5, 0}}}) == std::pair{green, red});
    CHECK(colors({{"offset", {0, 0.5}}}) == std::pair{red, green});
    CHECK(colors({{"scale", {0.5, 1}}}) == std::pair{red, red});
    CHECK(colors({{"scale", {3, 1}}, {"offset", {0.01, 0}}}) == std::pair{green, red});
    // A quarter turn counter-clockwise: u' = v, so rows differ, columns do not.
    const Scene turned = load(two_colors({{"rotation", 1.5707963267948966}}).finish()).scene;
    CHECK(color_at(turned, 0.2F, 0.9F) == red);  // v = 0.1
    CHECK(color_at(turned, 0.8F, 0.9F) == red);
    CHECK(color_at(turned, 0.2F, 0.1F) == green);  // v = 0.9
}

TEST_CASE("a texture transform may name another set of texture coordinates") {
    SquareFile file = two_colors({{"texCoord", 1}});
    file.primitive["attributes"]["TEXCOORD_1"] = file.floats({1, 1, 0, 1, 0, 0, 1, 0}, "VEC2");
    const Scene scene = load(file.finish()).scene;
    CHECK(color_at(scene, 0.25F, 0.4F) == green);
    CHECK(color_at(scene, 0.75F, 0.4F) == red);
}

TEST_CASE("coordinates beyond a texture repeat it, clamp to its edge or mirror it, along each axis") {
    const auto row = [](json sampler) {
        SquareFile file = two_colors(nullptr, {-1, 1, 3, 1, 3, 0, -1, 0});
        file.doc["samplers"][0] = std::move(sampler);
        const auto [scene, warnings] = load(file.finish());
        CHECK(warnings.empty());
        std::string seen;
        for (int i = 0; i < 8; ++i)
            seen += color_at(scene, (static_cast<float>(i) + 0.5F) / 8, 0.02F) == red ? 'r' : 'g';
        return seen;
    };
    CHECK(row(json::object()) == "rgrgrgrg");
    CHECK(row({{"wrapS", 10497}, {"wrapT", 33071}}) == "rgrgrgrg");
    CHECK(row({{"wrapS", 33071}}) == "rrrggggg");
    CHECK(row({{"wrapS", 33648}}) == "grrggrrg");
    SquareFile odd = two_colors(nullptr);
    odd.doc["samplers"][0] = {{"wrapS", 5}};
    CHECK(error_of(odd.finish()).find("sampler 0: expected a wrap mode: 10497, 33071 or 33648, found 5") !=
          std::string::npos);
}

TEST_CASE("wrap modes agree with their definition, from far away and at the edges too") {
    Scene scene;
    Texture texture;
    texture.width = 5;
    texture.height = 1;
    for (int i = 0; i < 5; ++i) texture.rgba.insert(texture.rgba.end(), {static_cast<std::uint8_t>(i), 0, 0, 255});
    scene.textures = {texture};
    const TexelLayout texels(scene);
    for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror})
        for (int i = -40; i < 40; ++i) {
            const float u = (static_cast<float>(i) + 0.5F) / 5;
            CHECK(std::uint32_t{texels.fetch(0, {u, 0}, {0, wrap, wrap}).stored[0]} == wrap_texel(i, 5, wrap));
        }
    const float inf = std::numeric_limits<float>::infinity();
    for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror})
        for (const float u : {0.0F, 1.0F, -1.0F, 1e30F, -1e30F, inf, -inf, std::nanf(""), -1e-20F, 0x1.fffffep-1F})
            CHECK(texels.fetch(0, {u, u}, {0, wrap, wrap}).stored[0] < 5);
    CHECK(texels.fetch(0, {1, 0}, {0, Wrap::clamp, Wrap::clamp}).stored[0] == 4);
    CHECK(texels.fetch(0, {1, 0}, {0, Wrap::mirror, Wrap::clamp}).stored[0] == 4);
}

TEST_CASE("a WebP image is a texture's, alone or in place of its PNG, with its alpha") {
    // 2 x 1: (200,100,50,64) (0,0,255,255)
    const std::vector<std::uint8_t> bytes{82,  73,  70,  70,  32, 0,   0,  0,  87, 69,  66,  80, 86, 80,
                                          56,  76,  20,  0,   0,  0,   47, 1,  0,  0,   16,  15, 48, 100,
                                          131, 252, 153, 255, 7,  253, 7,  15, 50, 162, 255, 1};
    for (const bool alone : {false, true}) {
        SquareFile file = two_colors(nullptr);
        const std::string uri = "data:image/webp;base64," + base64(bytes);
        const int image = file.add("images", {{"uri", uri}, {"mimeType", "image/webp"}});
        file.doc["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = image;
        if (alone) file.doc["textures"][0].erase("source");
        file.doc["extensionsUsed"] = file.doc["extensionsRequired"] = {"EXT_texture_webp"};
        const auto [scene, warnings] = load(file.finish());
        CHECK(warnings.empty());
        REQUIRE(scene.textures.size() == 1);
        const auto& texels = scene.textures[0].rgba;
        CHECK(texels == std::vector<std::uint8_t>{200, 100, 50, 64, 0, 0, 255, 255});
    }
    SquareFile cut = two_colors(nullptr);
    cut.doc["images"][0] = {{"uri", "data:image/webp;base64," + base64({bytes.begin(), bytes.end() - 9})}};
    const auto [scene, warnings] = load(cut.finish());
    CHECK(scene.textures.empty());
    REQUIRE(warnings.size() == 1);
    CHECK(warnings[0].find("expected a whole PNG, JPEG or WebP image") != std::string::npos);
}
