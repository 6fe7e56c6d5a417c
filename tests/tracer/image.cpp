#include "tracer/image.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "tests/tracer/gltf_files.hpp"
#include "tracer/png_chunks.hpp"
#include "tracer/tone_map.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;

namespace {

template <class F>
std::string message_of(F&& f) {
    try {
        f();
    } catch (const Error& e) {
        return e.what();
    }
    return "(no error)";
}

Image gradient() {
    Image image{16, 8, {}};
    for (std::uint32_t i = 0; i < 128; ++i)
        image.pixels.push_back({static_cast<float>(i) / 64, 0.5F, static_cast<float>(i % 16)});
    return image;
}

}  // namespace

TEST_CASE("an RGBA image keeps its colours unmultiplied and its rows from top to bottom") {
    const Texture texture = decode_image(png_rgba, "tile");
    CHECK(texture.width == 2);
    CHECK(texture.height == 2);
    CHECK(texture.name == "tile");
    CHECK(texture.rgba == std::vector<std::uint8_t>{255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 255, 0, 200, 100, 50, 64});
}

TEST_CASE("grey becomes RGB and missing alpha becomes 255") {
    CHECK(decode_image(png_grey, "g").rgba == std::vector<std::uint8_t>{10, 10, 10, 255, 200, 200, 200, 255});
    CHECK(decode_image(png_grey_alpha, "ga").rgba == std::vector<std::uint8_t>{10, 10, 10, 20, 200, 200, 200, 0});
    CHECK(decode_image(png_rgb, "rgb").rgba == std::vector<std::uint8_t>{1, 2, 3, 255});
}

TEST_CASE("the size of an image is known without decoding it") {
    const ImageSize size = image_size(png_grey_alpha, "ga");
    CHECK(size.width == 1);
    CHECK(size.height == 2);
}

TEST_CASE("bytes that are no whole PNG or JPEG are an error that names the image") {
    for (std::size_t cut = 0; cut + 13 < png_rgba.size(); cut += 3) {
        const std::vector<std::uint8_t> bytes(png_rgba.begin(), png_rgba.begin() + static_cast<long>(cut));
        const std::string message = message_of([&] { decode_image(bytes, "brick"); });
        INFO(cut << ": " << message);
        CHECK(message.starts_with("brick: "));
        CHECK(message.find('\n') == std::string::npos);
    }
    CHECK(message_of([] { decode_image({}, "none"); }).starts_with("none: "));
    const std::string huge = message_of([] { decode_image(png_huge, "huge"); });
    CHECK(huge.find("60000 x 60000") != std::string::npos);
}

TEST_CASE("a PNG with any byte of a chunk changed is not whole") {
    CHECK(is_whole_png(png_rgba));
    CHECK(is_whole_png(png_huge));
    CHECK_FALSE(is_whole_png({}));
    for (std::size_t i = 0; i < png_rgba.size(); ++i) {
        auto bytes = png_rgba;
        bytes[i] ^= 0x10;
        INFO(i);
        CHECK_FALSE(is_whole_png(bytes));
        CHECK_FALSE(is_whole_png(std::span(png_rgba).first(i)));
    }
}

TEST_CASE("mutated images decode or are refused with an Error") {
    const TempFolder folder;
    write_image(folder.file("a.jpg"), gradient());
    const auto jpeg = bytes_of_file(folder.file("a.jpg"));
    std::uint32_t state = 1;
    const auto random = [&] { return (state = state * 1664525U + 1013904223U) >> 8; };
    for (int i = 0; i < 600; ++i) {
        auto bytes = i % 8 == 0 ? png_rgba : jpeg;
        for (int edits = 0; edits < 3; ++edits) bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
        try {
            const Texture texture = decode_image(bytes, "mutant");
            CHECK(texture.rgba.size() == std::size_t{4} * texture.width * texture.height);
        } catch (const Error& e) {
            CHECK(std::string(e.what()).find('\n') == std::string::npos);
        }
    }
}

TEST_CASE("only .png, .jpg, .jpeg, .exr and .hdr name an image, in any case") {
    for (const char* name : {"a.png", "a.PNG", "b/c.jpg", "x.jpeg", "y.exr", "z.hdr"})
        CHECK_NOTHROW(check_image_name(name));
    for (const char* name : {"a", "a.bmp", "a.png.txt", "", ".", "png"})
        CHECK_THROWS_AS(check_image_name(name), UsageError);
    CHECK_THROWS_AS(write_image("a.bmp", gradient()), UsageError);
}

TEST_CASE("every format is written whole, the same bytes each time, and nothing else is left behind") {
    const TempFolder folder;
    for (const char* name : {"a.png", "a.jpg", "a.exr", "a.hdr"}) {
        write_image(folder.file(name), gradient());
        const auto first = bytes_of_file(folder.file(name));
        CHECK(first.size() > 100);
        write_image(folder.file(name), gradient());
        CHECK(bytes_of_file(folder.file(name)) == first);
    }
    CHECK(folder.entries() == 4);
    CHECK(bytes_of_file(folder.file("a.exr"))[0] == 0x76);
    CHECK(bytes_of_file(folder.file("a.hdr"))[0] == '#');
}

TEST_CASE("a written PNG holds the tone-mapped pixels") {
    const TempFolder folder;
    const Image image = gradient();
    write_image(folder.file("a.png"), image, 1.5F);
    const Texture texture = decode_image(bytes_of_file(folder.file("a.png")), "a");
    REQUIRE(texture.width == 16);
    REQUIRE(texture.height == 8);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const auto expected = tone_map(image.pixels[i], 1.5F);
        for (std::size_t c = 0; c < 3; ++c) REQUIRE(texture.rgba[4 * i + c] == expected[c]);
    }
}

TEST_CASE("an image that cannot be written is an Error of one line and leaves nothing behind") {
    const TempFolder folder;
    const std::string message = message_of([&] { write_image(folder.file("none/a.png"), gradient()); });
    INFO(message);
    CHECK(message != "(no error)");
    CHECK(message.find('\n') == std::string::npos);
    CHECK_THROWS_AS(write_image(folder.file("a.png"), Image{}), Error);
    CHECK_THROWS_AS(write_image(folder.file("a.png"), Image{4, 4, {}}), Error);
    CHECK(folder.entries() == 0);
}

TEST_CASE("tone mapping is monotonic, keeps black, and survives every float") {
    const float inf = std::numeric_limits<float>::infinity();
    CHECK(tone_map({0, 0, 0}, 0) == std::array<std::uint8_t, 3>{0, 0, 0});
    CHECK(tone_map({-1, std::nanf(""), inf}, 0) == std::array<std::uint8_t, 3>{0, 0, 255});
    CHECK(tone_map({1e-40F, 3e38F, -inf}, 200) == std::array<std::uint8_t, 3>{255, 255, 0});
    CHECK(tone_map({0.25F, 1, 4}, 0) == tone_map({1, 4, 16}, -2));
    int previous = 0;
    for (float v = 0; v < 20; v += 0.01F) {
        const int value = tone_map({v, v, v}, 0)[0];
        CHECK(value >= previous);
        previous = value;
    }
    CHECK(previous >= 254);
}

TEST_CASE("a screen image is written as it is") {
    const TempFolder folder;
    ScreenImage image{3, 2, {}};
    for (std::uint8_t i = 0; i < 6; ++i) image.pixels.push_back({i, static_cast<std::uint8_t>(40 * i), 255});
    write_screen_image(folder.file("a.png"), image);
    const Texture texture = decode_image(bytes_of_file(folder.file("a.png")), "a");
    REQUIRE(texture.width == 3);
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t c = 0; c < 3; ++c) CHECK(texture.rgba[4 * i + c] == image.pixels[i][c]);
    CHECK_THROWS_AS(write_screen_image(folder.file("b.png"), ScreenImage{}), Error);
}

TEST_CASE("named channels are written with their names, the same bytes each time") {
    const TempFolder folder;
    const std::vector<Channel> channels{{"base.L1 miss rate", {0, 0.25F, 1, 2}}, {"other.active lanes", {1, 2, 3, 4}}};
    write_channels(folder.file("a.exr"), 2, 2, channels);
    const auto bytes = bytes_of_file(folder.file("a.exr"));
    const std::string text(bytes.begin(), bytes.end());
    for (const Channel& channel : channels) CHECK(text.find(channel.name + '\0') != std::string::npos);
    write_channels(folder.file("a.exr"), 2, 2, channels);
    CHECK(bytes_of_file(folder.file("a.exr")) == bytes);
    CHECK_THROWS_AS(write_channels(folder.file("b.exr"), 3, 2, channels), Error);
}
