// Text of unknown origin on its way to a terminal.
#include "traces/printable.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <random>

using namespace raycache;
using namespace std::string_literals;

namespace {

/// Whether a terminal would do anything but show letters; a line feed is allowed if `lines`.
bool is_harmless(const std::string& text, bool lines) {
    if (!nlohmann::json::accept(nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)))
        return false;
    for (std::size_t i = 0; i < text.size();) {
        const auto byte = static_cast<unsigned char>(text[i]);
        if ((byte < 0x20 || byte == 0x7f) && !(lines && byte == '\n')) return false;
        if (byte == 0xc2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xa0) return false;  // C1
        if (text.compare(i, 2, "\xe2\x80") == 0 && i + 2 < text.size()) {
            const auto last = static_cast<unsigned char>(text[i + 2]);
            if ((last >= 0x8b && last <= 0x8f) || (last >= 0xa8 && last <= 0xae)) return false;
        }
        const std::size_t bytes = utf8_bytes(std::string_view(text).substr(i));
        if (bytes == 0) return false;
        i += bytes;
    }
    return true;
}

}  // namespace

TEST_CASE("letters of any script stay, what steers a terminal does not") {
    CHECK(printable_line("K\u00fcche \u6771\u4eac \U0001F600 \u00b15 %") ==
          "K\u00fcche \u6771\u4eac \U0001F600 \u00b15 %");
    CHECK(printable_line("a\x1b[31mred\x07\x7f\0z"s) == "a?[31mred???z");
    CHECK(printable_line("two\r\nlines\tand a tab") == "two  lines and a tab");
    CHECK(printable_line("\u202eevil\u200b \u2066x \u009b31m \ufeff") == "?evil? ?x ?31m ?");
    CHECK(printable_line("\xff\xc3 \xed\xa0\x80 \xc0\xaf \xf4\x90\x80\x80 \xe2\x82") == "?? ??? ?? ???? ??");
    CHECK(printable_text("a\nb\r\x1b") == "a\nb ?");
    CHECK(printable_line("").empty());
}

TEST_CASE("JSON keeps its values when it is made printable") {
    const nlohmann::json value = {{"name", "\u202e\x7f\u009b \U000e0041 \u00fc"}, {"rows", {1, 2}}};
    const std::string text = printable_json(value.dump(2));
    CHECK(is_harmless(text, true));
    CHECK(nlohmann::json::parse(text) == value);
    CHECK(nlohmann::json::parse(printable_json("[\"\xff\"]")) == nlohmann::json::array({"\ufffd"}));
}

TEST_CASE("no bytes whatever get through") {
    std::mt19937 random(1);
    static constexpr const char* pieces[] = {"\xe2\x80\xae", "\xc2\x9b", "\x1b[",       "\n",
                                             "\xf0\x9f",     "a",        "\xed\xbf\xbf"};
    for (int i = 0; i < 20000; ++i) {
        std::string text;
        for (std::size_t n = random() % 8; n-- > 0;)
            text +=
                random() % 2 == 0 ? std::string(1, static_cast<char>(random())) : pieces[random() % std::size(pieces)];
        REQUIRE(is_harmless(printable_line(text), false));
        REQUIRE(is_harmless(printable_text(text), true));
    }
}
