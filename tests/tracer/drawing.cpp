// Pictures with labels, as OpenImageIO draws them.
#include "tracer/drawing.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

namespace raycache {
namespace {

using tracer::Colour;

constexpr Colour white{255, 255, 255}, black{0, 0, 0};

struct Ink {
    int left = 1 << 20, right = -1, top = 1 << 20, bottom = -1;
};
/// Where a picture is not white.
Ink ink_of(const tracer::ScreenImage& image) {
    Ink ink;
    for (int y = 0; y < static_cast<int>(image.height); ++y)
        for (int x = 0; x < static_cast<int>(image.width); ++x)
            if (image.pixels[static_cast<std::size_t>(y) * image.width + x] != white)
                ink = {std::min(ink.left, x), std::max(ink.right, x), std::min(ink.top, y), std::max(ink.bottom, y)};
    return ink;
}

Colour pixel(const tracer::ScreenImage& image, int x, int y) {
    return image.pixels[static_cast<std::size_t>(y) * image.width + x];
}

TEST_CASE("A label stands where it was asked for, as wide as was said") {
    const std::string label = "R8 1.25 ±0.1 of micro-jitter";
    const int width = tracer::text_width(label, 17);
    CHECK(width > 150);
    CHECK(width < 300);
    for (const auto align : {tracer::TextAlign::left, tracer::TextAlign::centre, tracer::TextAlign::right}) {
        const auto drawing = tracer::make_drawing(800, 60);
        drawing->text(400, 20, label, 17, align);
        const Ink ink = ink_of(drawing->image());
        const int left = align == tracer::TextAlign::left     ? 400
                         : align == tracer::TextAlign::centre ? 400 - width / 2
                                                              : 400 - width;
        CHECK(std::abs(ink.left - left) <= 3);
        CHECK(std::abs(ink.right - (left + width)) <= 3);
        CHECK(ink.top >= 18);
        CHECK(ink.bottom <= 20 + 22);
    }
}

TEST_CASE("Lines of small and of tall letters stand on one base line") {
    const auto bottom = [](const std::string& text) {
        const auto drawing = tracer::make_drawing(100, 40);
        drawing->text(5, 5, text, 17);
        return ink_of(drawing->image()).bottom;
    };
    CHECK(bottom("nnn") == bottom("HHH"));
    CHECK(bottom("nnn") < bottom("ggg"));
}

TEST_CASE("A map shows the ends of its colours exactly, what is between in steps, and NaN in grey") {
    const std::vector<Colour> colours{{10, 20, 30}, {110, 220, 130}, {250, 0, 40}};
    const std::vector<float> shares{0, 0.25F, 0.5F, 1, -3, 7, std::nanf("")};
    const auto drawing = tracer::make_drawing(9, 3);
    drawing->map(1, 1, 7, shares, colours);
    const auto image = drawing->image();
    const std::vector<Colour> expected{{10, 20, 30}, {60, 120, 80}, {110, 220, 130}, {250, 0, 40},
                                       {10, 20, 30}, {250, 0, 40},  tracer::no_value};
    for (int i = 0; i < 7; ++i) {
        CHECK(pixel(image, 1 + i, 1) == expected[static_cast<std::size_t>(i)]);
        CHECK(pixel(image, 1 + i, 0) == white);
        CHECK(pixel(image, 1 + i, 2) == white);
    }
}

TEST_CASE("A frame is one pixel thick and lies within its rectangle; a picture is pasted as it is") {
    const auto drawing = tracer::make_drawing(12, 10);
    drawing->frame(2, 3, 5, 4, black);
    drawing->paste(3, 4, {3, 2, {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 12}, {13, 14, 15}, {16, 17, 18}}});
    const auto image = drawing->image();
    for (int x = 2; x < 7; ++x) CHECK((pixel(image, x, 3) == black && pixel(image, x, 6) == black));
    for (int y = 3; y < 7; ++y) CHECK((pixel(image, 2, y) == black && pixel(image, 6, y) == black));
    CHECK(pixel(image, 3, 4) == Colour{1, 2, 3});
    CHECK(pixel(image, 5, 5) == Colour{16, 17, 18});
    const Ink ink = ink_of(image);
    CHECK((ink.left == 2 && ink.right == 6 && ink.top == 3 && ink.bottom == 6));
}

TEST_CASE("What lies outside of a picture is left out") {
    const auto drawing = tracer::make_drawing(20, 20);
    drawing->text(15, 10, "a long label", 17);
    drawing->text(-30, -5, "another", 17);
    drawing->frame(-5, -5, 100, 100, black);
    drawing->map(18, 18, 2, std::vector<float>{0, 0, 0, 0}, std::vector<Colour>{black, white});
    drawing->paste(15, 15, {10, 10, std::vector<Colour>(100, black)});
    CHECK(drawing->image().pixels.size() == 400);
    CHECK(pixel(drawing->image(), 19, 19) == black);
}

}  // namespace
}  // namespace raycache
