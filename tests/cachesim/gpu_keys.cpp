// The table of keys, against the documentation, the presets and what the reader takes.
#include "cachesim/gpus/gpu_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

#include "cachesim/gpus/gpu.hpp"
#include "tests/folders.hpp"
#include "traces/error.hpp"

using namespace raycache;
using namespace raycache::cachesim;

namespace {

std::string table_of(const std::string& section) {
    std::string table = "| key | default | values | unit | meaning |\n|---|---|---|---|---|\n";
    for (const GpuKey& key : gpu_keys())
        if (key.section == section)
            table += fmt::format("| `{}` | {} | {} | {} | {} |\n", key.name,
                                 key.needed ? "*needed*" : key.default_value, key.values, key.unit, key.meaning);
    return table;
}

/// The page with the table of each section put behind its mark, in place of the one that is there.
std::string with_tables(std::string page) {
    for (const char* section : {"", "registers", "front_end", "l1", "timing", "rt_unit"}) {
        const std::string mark =
            *section ? fmt::format("<!-- keys of [{}] -->\n\n", section) : std::string("<!-- keys of the chip -->\n\n");
        const auto at = page.find(mark);
        REQUIRE(at != std::string::npos);
        const auto begin = at + mark.size();
        auto end = begin;
        while (page.compare(end, 1, "|") == 0) end = page.find('\n', end) + 1;
        const std::string gap = page.compare(end, 1, "\n") == 0 ? "" : "\n";
        page.replace(begin, end - begin, table_of(section) + gap);
    }
    return page;
}

}  // namespace

TEST_CASE("docs/gpus.md has every key with its default, values, unit and meaning") {
    const std::string path = raycache::test::source_folder() + "docs/gpus.md";
    std::ostringstream page;
    page << std::ifstream(path).rdbuf();
    const std::string wanted = with_tables(page.str());
    if (std::getenv("RAYCACHE_WRITE_DOCS")) std::ofstream(path) << wanted;
    INFO("RAYCACHE_WRITE_DOCS=1 cachesim_tests \"docs/gpus.md*\" writes the tables");
    CHECK((page.str() == wanted || std::getenv("RAYCACHE_WRITE_DOCS")));
}

TEST_CASE("a key has one row, and what it means is said") {
    std::set<std::string> names;
    for (const GpuKey& key : gpu_keys()) {
        CAPTURE(key.section, key.name);
        CHECK(names.insert(key.section + '.' + key.name).second);
        CHECK(key.meaning.size() > 3);
        CHECK_FALSE(key.values.empty());
        CHECK(key.needed == key.default_value.empty());
    }
}

TEST_CASE("presets have no value but those of keys, and --set takes every one of them") {
    const auto names = gpu_key_names();
    for (const GpuPreset& preset : gpu_presets())
        for (const GpuValue& value : gpu_values(preset.name)) {
            CAPTURE(preset.name, value.key);
            CHECK(std::find(names.begin(), names.end(), value.key) != names.end());
        }
    CHECK(counts_bytes("l2.line_bytes"));
    CHECK(counts_bytes("front_end.load_bytes"));
    CHECK_FALSE(counts_bytes("timing.l2_bytes_per_cycle"));
    CHECK_FALSE(counts_bytes("l1.ways"));
    CHECK_FALSE(counts_bytes("l4.line_bytes"));
}

TEST_CASE("a value beyond the ends of its row is refused, and the ends are not refused as such") {
    // A change that breaks a rule of several keys is refused with those; here it is the row that speaks.
    const auto message = [](const std::string& change) -> std::string {
        try {
            load_gpu("rtx-3070", {"warps_per_sm=12", change});  // else resident warps follow from other keys
        } catch (const Error& e) {
            return e.what();
        }
        return "";
    };
    unsigned checked = 0;
    for (const GpuKey& key : gpu_keys()) {
        const auto to = key.values.find(" to ");
        if (to == std::string::npos || key.values.find_first_not_of("0123456789") != to) continue;
        const std::string name = (key.section.empty() ? "" : key.section + '.') + key.name;
        const std::uint64_t low = std::stoull(key.values), high = std::stoull(key.values.substr(to + 4));
        CAPTURE(name, key.values);
        CHECK_THAT(message(fmt::format("{}={}", name, high + 1)), Catch::Contains(fmt::format("found {}", high + 1)));
        const std::string range = fmt::format("expected {} to {}, found", low, high);
        for (const std::uint64_t end : {low, high})
            CHECK_THAT(message(fmt::format("{}={}", name, end)), !Catch::Contains(range));
        ++checked;
    }
    CHECK(checked > 30);
}
