// Every number on every command line is decimal, finite, whole of word, and in its range.
#include "tools/jobs/numbers.hpp"

#include <catch2/catch.hpp>

#include "tests/tools/command_line.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

using Catch::Contains;
using test::refusal;
using test::shortest_line;

/// Refused for every number; `whole`: only where a whole number is wanted.
struct BadWord {
    const char* word;
    bool whole;
};
constexpr BadWord bad_words[] = {{"", false},    {" 1", false},       {"1 ", false},   {"\t1", false},
                                 {"+1", false},  {"0x10", false},     {"0b1", false},  {"1_000", false},
                                 {"inf", false}, {"nan", false},      {"-nan", false}, {"1e999", false},
                                 {"1x", false},  {"ten", false},      {"1e", false},   {"--1", false},
                                 {"1;2", false}, {"\xd9\xa1", false}, {".", false},    {"18446744073709551616", true},
                                 {"-1", true},   {"-0", true},        {"1.5", true},   {"1e1", true}};

std::vector<std::string> with(std::vector<std::string> line, const std::string& option, const std::string& word) {
    line.push_back(option);
    line.push_back(word);
    return line;
}

TEST_CASE("a number with leading zeros is decimal") {
    CHECK(read_whole("064", "--spp", {}) == 64);
    CHECK(read_whole("010", "--spp", {}) == 10);
    CHECK(read_whole("18446744073709551615", "--seed", {}) == 18446744073709551615u);
    CHECK(read_real("010", "--k", {}) == 10);
    CHECK(read_real("-1.5e3", "--exposure", {}) == -1500);
    CHECK(read_real(".5", "--mu", {}) == 0.5);
}

TEST_CASE("a number out of its range is answered with the range") {
    CHECK_THROWS_WITH(read_whole("65", "--bounces", {0, 64}), "--bounces '65': expected a whole number from 0 to 64");
    CHECK_THROWS_WITH(read_real("1.5", "--mu", {0, 1}), "--mu '1.5': expected a number from 0 to 1");
    CHECK_THROWS_WITH(read_real("inf", "--k", {}), Contains("--k 'inf': expected a finite number"));
}

TEST_CASE("every numeric option of every command refuses what is no decimal number in range") {
    std::size_t tried = 0;
    const Program program;
    for (const auto& command : program.commands())
        for (const auto& option : command->options()) {
            if (option->kind() != Option::Kind::whole && option->kind() != Option::Kind::real) continue;
            ++tried;
            for (const BadWord& bad : bad_words) {
                if (bad.whole && option->kind() == Option::Kind::real) continue;
                const auto refused = [&](const std::string& word) {
                    INFO(command->name() << ' ' << option->name() << " '" << word << "'");
                    CHECK_THAT(refusal(with(shortest_line(*command), option->name(), word)),
                               Contains(option->name()) && Contains("expected") && !Contains("\n"));
                };
                refused(bad.word);
                if (!option->is_list()) continue;
                refused(std::string("1,") + bad.word);
                refused(std::string(bad.word) + ",1");
            }
        }
    CHECK(tried > 60);
}

TEST_CASE("numbers within texts are as strict") {
    const auto refused = [](const std::string& option, const std::string& word) {
        INFO(option << ' ' << word);
        std::vector<std::string> line = with({"capture", "courtyard", "-o", "t.rct"}, option, word);
        CHECK_THAT(refusal(line), Contains(option) && Contains(word));
    };
    for (const char* word : {"0x40x48", "64x+48", " 64x48", "64x48 ", "-64x48", "64x", "infx48", "1e2x48", "64X48"})
        refused("--resolution", word);
    CHECK(refusal(with({"capture", "courtyard", "-o", "t.rct"}, "--resolution", "064x048")).empty());
}

}  // namespace
}  // namespace raycache::tools
