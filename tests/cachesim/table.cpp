// Text tables: what all rows share, and how a table that is too wide becomes narrower.
#include "cachesim/report/table.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <sstream>

using namespace raycache::cachesim;
using Align = TextTable::Align;

namespace {

std::size_t widest(const std::string& text) {
    std::size_t most = 0;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) most = std::max(most, columns_of(line));
    return most;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Two strategies on GPUs of these names, with many figures.
TextTable table_of(const std::vector<std::string>& gpus, int figures) {
    TextTable table;
    table.column("strategy", Align::left);
    table.subject("N", Align::right);
    table.subject("GPU", Align::left);
    for (int i = 0; i < figures; ++i)
        table.column("figure no. " + std::to_string(i), Align::right, static_cast<unsigned>(i));
    for (const std::string& gpu : gpus)
        for (const char* strategy : {"coherent", "cranley-patterson"}) {
            std::vector<std::string> cells{strategy, "64", gpu};
            for (int i = 0; i < figures; ++i) cells.push_back("0." + std::to_string(100 + i));
            table.row(cells);
        }
    return table;
}

}  // namespace

TEST_CASE("what all rows of a table share stands above it, once") {
    const std::string text = table_of({"h100"}, 1).text();
    CHECK(text ==
          "all rows: N 64, GPU h100\n\n"
          "strategy           figure no. 0\n"
          "-----------------  ------------\n"
          "coherent                  0.100\n"
          "cranley-patterson         0.100\n");
    const std::string two = table_of({"h100", "v100"}, 1).text();
    CHECK(has(two, "all rows: N 64\n"));
    CHECK(has(two, "strategy           GPU   figure"));
}

TEST_CASE("the first column of a table stays even where all rows share it") {
    TextTable table;
    table.subject("strategy", Align::left);
    table.subject("N", Align::right);
    table.row({"coherent", "64"});
    CHECK(table.text() == "all rows: N 64\n\nstrategy\n--------\ncoherent\n");
}

TEST_CASE("a table that is too wide breaks its titles before anything else") {
    const TextTable table = table_of({"h100"}, 8);
    CHECK(widest(table.text(any_width)) > 100);
    const std::string text = table.text(100);
    CHECK(widest(text) <= 100);
    CHECK(has(text, "figure  figure"));
    CHECK_FALSE(has(text, "left out"));
    CHECK(has(text, "0.107"));
}

TEST_CASE("long names become letters with a key, and stay apart") {
    const std::string first = "gtx-980-ti (l1.ways=64, sms=16, warps_per_sm=24)", second = "gtx-980-ti (l1.ways=32)";
    const std::string text = table_of({first, second}, 8).text(100);
    CHECK(widest(text) <= 100);
    CHECK(has(text, "GPU A: " + first + "\n"));
    CHECK(has(text, "GPU B: " + second + "\n"));
    CHECK_FALSE(has(text, "..."));
    CHECK(has(table_of({first, second}, 8).text(any_width), first + "  "));
}

TEST_CASE("columns of the highest rank go first, and are named") {
    const std::string text = table_of({"h100", "v100"}, 14).text(100);
    CHECK(widest(text) <= 100);
    CHECK(has(text, "0.100"));
    CHECK_FALSE(has(text, "0.113"));
    CHECK(has(text, "figure no. 13"));
    CHECK(has(text, "left out for want of room: "));
    CHECK(has(text, "(--wide)"));
    CHECK_FALSE(has(table_of({"h100", "v100"}, 14).text(any_width), "left out"));
}

TEST_CASE("a row without a name goes on with the row above") {
    TextTable table;
    table.column("strategy", Align::left);
    table.subject("GPU", Align::left);
    table.column("work", Align::right);
    table.row({"coherent", "h100", "0.9"});
    table.row({"", "", "±0.1"});
    CHECK(table.text() ==
          "all rows: GPU h100\n\n"
          "strategy  work\n"
          "--------  ----\n"
          "coherent   0.9\n"
          "          ±0.1\n");
}

TEST_CASE("columns of rank 0 stay however wide the table") {
    TextTable table;
    for (int i = 0; i < 20; ++i) table.column("title" + std::to_string(i), Align::right);
    table.row(std::vector<std::string>(20, "1"));
    CHECK(has(table.text(100), "title19"));
}

TEST_CASE("words wrap at spaces, keep the breaks they have, and indent what follows") {
    CHECK(break_lines("one two three", 7) == "one two\nthree");
    CHECK(break_lines("one two three", 7, 2) == "one two\n  three");
    CHECK(break_lines("one\ntwo three\n", 9) == "one\ntwo three\n");
    CHECK(break_lines("unbreakable", 4) == "unbreakable");
    CHECK(break_lines("a unbreakable b", 4) == "a\nunbreakable\nb");
    CHECK(break_lines("  key  ±1 ±2 ±3", 10, 7) == "  key  ±1\n       ±2\n       ±3");
    CHECK(break_lines("one two three", any_width) == "one two three");
}
