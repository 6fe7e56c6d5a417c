// Scales of pictures, and labels broken into lines.
#include "tools/jobs/colour_scale.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

namespace raycache {
namespace {

TEST_CASE("Labels are broken between words so that every line fits, and nothing is lost") {
    const std::string text = "Scales end at about the 1st and 99th percentile of what they show; ± and → count as one";
    for (const int width : {120, 200, 400, 5000}) {
        const auto lines = tools::label_lines(text, width);
        for (const std::string& line : lines) CHECK(tracer::text_width(line, tools::label_size) <= width);
        const std::string joined =
            std::accumulate(lines.begin() + 1, lines.end(), lines.front(),
                            [](const std::string& all, const std::string& line) { return all + ' ' + line; });
        CHECK(joined == text);
        CHECK((lines.size() == 1) == (width == 5000));
    }
}

TEST_CASE("A word that is too long for a line is broken between letters") {
    const std::string word = "cranley-patterson-rotation-±±±±±±±±±±±±±±±±±±±±±±±±±±±±±±±";
    const auto lines = tools::label_lines("of " + word, 100);
    REQUIRE(lines.size() > 3);
    std::string joined;
    for (const std::string& line : lines) {
        CHECK(tracer::text_width(line, tools::label_size) <= 100);
        CHECK((static_cast<unsigned char>(line.front()) & 0xC0) != 0x80);
        joined += line;
    }
    CHECK(joined == "of" + word);
    CHECK(tools::label_lines("", 100) == std::vector<std::string>{""});
    CHECK(tools::label_lines("ab", 1) == std::vector<std::string>{"a", "b"});  // no room for any: one letter a line
}

TEST_CASE("A symmetric scale ends at a round number that 99 of 100 sizes do not exceed") {
    std::vector<double> values(1000, -0.7);
    values[3] = 50;
    values[4] = std::nan("");
    const tools::Scale scale = tools::symmetric_scale(values);
    CHECK(scale.high == Approx(0.8));
    CHECK(scale.low == -scale.high);
    CHECK(scale.share(0) == 0.5F);
    CHECK(std::isnan(scale.share(std::nan(""))));
    CHECK(tools::symmetric_scale({}).high == 1);
}

}  // namespace
}  // namespace raycache
