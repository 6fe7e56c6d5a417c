// GPU files from anywhere: whatever the text, an answer in one line and nothing else.
#include "cachesim/gpus/toml_guard.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "cachesim/gpus/gpu_file.hpp"
#include "cachesim/gpus/presets.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::cachesim;

namespace {

/// What parse_gpu() says: the empty string where it takes the text.
std::string answer(const std::string& text, const std::vector<std::string>& changes = {}) {
    try {
        parse_gpu(text, "f.toml", changes);
    } catch (const Error& e) {
        return e.what();
    }
    return {};
}

bool is_one_line(const std::string& message) {
    return std::none_of(message.begin(), message.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; });
}

std::string repeated(const std::string& piece, std::size_t times) {
    std::string text;
    while (times-- > 0) text += piece;
    return text;
}

/// Texts around which toml++ 3.3 asserts, descends without end or reads beyond a table of its own, and their relatives.
std::vector<std::string> hostile_texts() {
    std::vector<std::string> texts{"[.a]",
                                   "[a.]",
                                   "[a..b]",
                                   "[]",
                                   "[[]]",
                                   "[[.a]]",
                                   "[a",
                                   "[[a]",
                                   "[ [a]]",
                                   ".a=1",
                                   "a.=1",
                                   "a..b=1",
                                   "=1",
                                   "a=",
                                   "a",
                                   "a=1 b=2",
                                   "a=\"",
                                   "a='",
                                   "a=\"\"\"x",
                                   "a='''x",
                                   "a=\"\\",
                                   "a=[",
                                   "a=[1",
                                   "a=[,]",
                                   "a={",
                                   "a={b=1,}",
                                   "a={,}",
                                   "a={b}",
                                   "a=1\rb=2",
                                   "a=\"\x01\"",
                                   "# \x7f",
                                   std::string("a=1\0b=2", 7),
                                   "\"\"\"a\"\"\"=1",
                                   "\xce\xa0 = 1",
                                   "a\xc2\xaa=1",
                                   "a=\xe2\x88\x9e",
                                   "\xff",
                                   "# \xc3",
                                   "a=\"\xed\xa0\x80\"",
                                   "a=\"\xf4\x90\x80\x80\"",
                                   "\xef\xbb\xbf\xef\xbb\xbf a=1",
                                   "a=1979-05-27T07:32:00Z"};
    for (const char* open : {"[", "{a=", "[[", "{"}) texts.push_back("a=" + repeated(open, 100000));
    texts.push_back(repeated("a.", 100000) + "a=1");
    texts.push_back(std::string("[").append(repeated("a.", 100000)).append("a]"));  // "[" + … warns with GCC 12
    for (unsigned c = 0x80; c < 0x3000; ++c) {                                      // letters of many scripts as keys
        const char two[] = {static_cast<char>(0xc0 | c >> 6), static_cast<char>(0x80 | (c & 63)), 0};
        const char three[] = {static_cast<char>(0xe0 | c >> 12), static_cast<char>(0x80 | (c >> 6 & 63)),
                              static_cast<char>(0x80 | (c & 63)), 0};
        if (c % 7 == 0) texts.push_back(std::string(c < 0x800 ? two : three) + "=1");
    }
    return texts;
}

}  // namespace

TEST_CASE("texts that toml++ cannot bear are refused with their line", "[gpu]") {
    for (const std::string& text : hostile_texts()) {
        INFO(text.substr(0, 100));
        REQUIRE(find_toml_problem(text));
        for (const std::size_t lines : {0, 1, 5}) {
            const std::string message = answer(repeated("a1=1\n", 0) + repeated("# é\n", lines) + text);
            INFO(message);
            REQUIRE(message.starts_with("f.toml:"));
            REQUIRE(is_one_line(message));
        }
    }
    CHECK(answer("a=1\n\n[.a]") ==
          "f.toml:3: expected a key of letters A to Z, digits, '_' and '-', or one in quotes, "
          "found '.'; correct the line");
    CHECK(answer("a=1\n\xce\xa0=1").starts_with("f.toml:2: "));
}

TEST_CASE("what TOML allows in a GPU file passes", "[gpu]") {
    for (const char* text : {"",
                             "\n",
                             "\r\n",
                             "# only a comment, é",
                             "\xef\xbb\xbf"
                             "a=1",
                             "a = 1 # x\r\nb=\"é \\\" \\\\\" \n",
                             "a.b.c=1",
                             "\"quoted key\" . 'other' = -1_000.5e+3",
                             "[a]\n[a . \"b\"] # x\n[[c]]\n",
                             "a=[1,\n # x\n 2,\n]",
                             "a = { value = [1, 2], source = \"x\" }",
                             "a={}",
                             "a=[]",
                             "a=\"\"\"\nx\n\"quotes\"\n\"\"\"\"\"",
                             "a='''x''' # y",
                             "a=true",
                             "a=0xff",
                             "a=inf",
                             "a=''",
                             "a=\"tab\tinside\""}) {
        const auto problem = find_toml_problem(text);
        INFO(text << " -> " << (problem ? problem->message : ""));
        CHECK_FALSE(problem);
    }
    for (const PresetText& preset : preset_texts()) CHECK_FALSE(find_toml_problem(preset.toml));
}

TEST_CASE("a change given with --set that toml++ cannot bear is a usage error", "[gpu]") {
    const std::string& toml = preset_texts().front().toml;
    for (const std::string& text : hostile_texts()) {
        if (text.size() > 1000) continue;
        INFO(text);
        try {
            parse_gpu(toml, "f.toml", {text});
        } catch (const Error& e) {
            CHECK(is_one_line(e.what()));
        }
    }
    CHECK_THROWS_AS(parse_gpu(toml, "f.toml", {"\xce\xa0=1"}), UsageError);
    CHECK_THROWS_AS(parse_gpu(toml, "f.toml", {"[.a]"}), UsageError);
}

TEST_CASE("changed GPU files are taken or refused in one line, whatever the change", "[gpu]") {
    static const char* const pieces[] = {"[",
                                         "]",
                                         "[[",
                                         "]]",
                                         "{",
                                         "}",
                                         "=",
                                         ".",
                                         ",",
                                         "\"",
                                         "'",
                                         "\"\"\"",
                                         "'''",
                                         "\n",
                                         "\r\n",
                                         "\r",
                                         "#",
                                         " ",
                                         "\t",
                                         "\\",
                                         "\\u00e9",
                                         "\\U0001F600",
                                         "é",
                                         "Π",
                                         "\xff",
                                         "\x01",
                                         "a",
                                         "_",
                                         "-",
                                         "+",
                                         "0",
                                         "9",
                                         "1e999",
                                         "nan",
                                         "-inf",
                                         "0x",
                                         "0b",
                                         "0o9",
                                         "1979-05-27",
                                         "07:32:00",
                                         "true",
                                         "fals",
                                         "9223372036854775808",
                                         "-1",
                                         "1__0",
                                         "l1",
                                         "value",
                                         "source",
                                         "[l1]",
                                         "[.a]",
                                         "name = 1",
                                         "sets = { value = 4 }"};
    std::mt19937 random(1);
    const auto below = [&](std::size_t n) { return random() % n; };
    const auto& presets = preset_texts();
    std::size_t taken = 0, refused = 0;
    for (int i = 0; i < 4000; ++i) {
        std::string text = presets[below(presets.size())].toml;
        if (below(2) == 0) text.erase(0, below(text.size()));
        if (below(4) == 0) text.resize(below(text.size() + 1));
        for (std::size_t changes = 1 + below(4); changes-- > 0;) {
            const std::size_t at = below(text.size() + 1);
            switch (below(3)) {
                case 0:
                    text.insert(at, pieces[below(std::size(pieces))]);
                    break;
                case 1:
                    text.erase(at, below(12));
                    break;
                default:
                    text.insert(at, 1, static_cast<char>(random()));
            }
        }
        const std::string message = answer(text);
        (message.empty() ? taken : refused) += 1;
        if (message.empty()) continue;
        INFO(message);
        REQUIRE(message.starts_with("f.toml:"));
        REQUIRE(is_one_line(message));
    }
    CHECK(taken > 20);
    CHECK(refused > 2000);
}
