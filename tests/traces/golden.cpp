// The committed files of traces/golden: good ones that today's writer reproduces and today's reader reads, bad ones
// that it refuses. `traces_tests [.regenerate]` writes them anew after a change of the format's version.
#include <zstd.h>

#include <catch2/catch.hpp>
#include <functional>
#include <sstream>

#include "dump.hpp"
#include "files.hpp"
#include "samples.hpp"
#include "tests/folders.hpp"
#include "tests/skip.hpp"
#include "traces/compression.hpp"
#include "traces/reader.hpp"
#include "traces/verify.hpp"

using namespace raycache::traces;
using Catch::Matchers::Contains;

namespace {

const std::string folder = raycache::test::source_folder() + "traces/golden/";

/// The worked example of FORMAT.md: one lane visits the root, its second child's two triangles, its first child's one.
Sample example() {
    Sample sample;
    sample.header.provenance.program = "example";
    sample.header.launches = {5};
    sample.header.warps_per_launch = 1;
    sample.header.regions = {
        {ObjectKind::node, 0x7f5000000000u, 64, 64, 1, 2, {1u << 30 | 0, 1u << 30 | 1}},
        {ObjectKind::triangle, 0x7f6000000000u, 48, 48, 3, 0, {}},
    };
    WarpTrace warp{0, 0, {}, {0, 1, 2, 0}};
    warp.records.push_back({1, ray_start, RayType::camera, 0, 0});
    for (const std::uint8_t region : {0, 1, 1, 1}) warp.records.push_back({1, region, RayType::camera, 0, 0});
    sample.warps = {warp};
    return sample;
}

/// Lanes that read objects of one region of pages far apart: 4 bytes at multiples of 2, the last one across two pages.
Sample pages() {
    Sample sample;
    sample.header.provenance.program = "pages";
    sample.header.launches = {0};
    sample.header.warps_per_launch = 1;
    constexpr std::uint64_t last = ~std::uint64_t{0} >> PageTable::page_bits;
    Region region{ObjectKind::node, 0, 4, 2, 3 * 2048 - 1, 0, {}, PageTable({1, 0x7f5000000, last})};
    sample.header.regions = {region};
    WarpTrace warp{0, 0, {}, {0, 2048, 6142, 2047}};
    warp.records.push_back({15, ray_start, RayType::camera, 0, 0});
    warp.records.push_back({15, 0, RayType::camera, 0, 0});
    sample.warps = {warp};
    return sample;
}

/// Loads of which the second and the third wait for the first, and the warp's end for the third; and a warp without
/// any.
Sample issue() {
    Sample sample;
    sample.header.provenance.program = "issue";
    sample.header.launches = {0};
    sample.header.warps_per_launch = 2;
    sample.header.issue = true;
    sample.header.regions = {{ObjectKind::node, 0x7f5000000000u, 16, 16, 100, 0, {}}};
    WarpTrace warp{0, 0, {}, {0, 1, 50, 99, 7, 7}};
    warp.records.push_back({3, ray_start, RayType::camera, 0, 0});
    for (unsigned i = 0; i < 3; ++i) warp.records.push_back({3, 0, RayType::camera, 0, 0});
    warp.issue = {{0, 0, 3}, {1, 1, 300}, {3, 0, 1}, {3, 3, 70000}};
    sample.warps = {warp, {0, 1, {}, {}}};
    return sample;
}

/// Screen-space reads again, of a depth buffer, each pixel's normal first.
Sample depths() {
    Sample sample = texel_reads({4, 0, 0, 1, 2});
    sample.header.regions[0].kind = ObjectKind::depth;
    sample.header.regions.push_back({ObjectKind::normal, 0x7f7100000000u, 4, 4, sample.header.regions[0].count, 0, {}});
    for (WarpTrace& warp : sample.warps) {
        warp.records.insert(warp.records.begin() + 1, {0xffffffffu, 1, RayType::shadow, 0, 0});
        const std::vector<std::uint32_t> first(warp.elements.begin(), warp.elements.begin() + warp_lanes);
        warp.elements.insert(warp.elements.begin(), first.begin(), first.end());
    }
    return sample;
}

struct Good {
    std::string name;
    std::function<Sample()> make;
};

std::vector<Good> good_files() {
    return {
        {"example", example},
        {"bvh2-depth-first",
         [] {
             return bvh_walks({1, 2, 40, 2, 2});
         }},
        {"bvh8-breadth-first",
         [] {
             return bvh_walks({2, 8, 60, 1, 3, true});
         }},
        {"texels",
         [] {
             return texel_reads({3, 0, 0, 1, 2});
         }},
        {"noise",
         [] {
             return noise({30, 0, 0, 1, 3});
         }},
        {"wavefront",
         [] {
             return wavefront_buffers({5, 0, 0, 2, 2});
         }},
        {"pages", pages},
        {"issue", issue},
        {"depths", depths},
    };
}

std::size_t head_size(const Bytes& b) { return load<std::uint64_t>(b.data() + 16); }

void reseal_head(Bytes& b) { store(b.data() + head_size(b) - 8, checksum(std::span(b).first(head_size(b) - 8))); }

void reseal_index(Bytes& b) {
    const std::size_t at = b.size() - load<std::uint64_t>(b.data() + b.size() - 24);
    store(b.data() + b.size() - 16, checksum(std::span(b).subspan(at, b.size() - 16 - at)));
}

void reseal_block(Bytes& b) {
    const std::size_t at = head_size(b), size = load<std::uint32_t>(b.data() + at + 8);
    store(b.data() + at + size - 8, checksum(std::span(b).subspan(at, size - 8)));
}

/// Changes in a copy of good/example.rct, and what the refusal says.
struct Bad {
    std::string name;
    std::function<void(Bytes&)> change;
    std::string message;
};

std::vector<Bad> bad_files() {
    const auto head = [](std::size_t at, std::uint8_t value) {
        return [=](Bytes& b) { b[at] = value, reseal_head(b); };
    };
    constexpr std::size_t region0 = 52;  // its entry; the provenance follows at 132
    return {
        {"empty", [](Bytes& b) { b.clear(); }, "offset 0: magic: expected RCTRACE, found an empty file"},
        {"wrong-magic", [](Bytes& b) { b[0] = 'X'; },
         "offset 0: magic: expected RCTRACE, found other bytes; this is no raycache trace"},
        {"newer-version", [](Bytes& b) { b[8] = 6; },
         "offset 8: format version: expected at most 5, found 6; this raycache reads version 5: install a newer one to "
         "read version 6"},
        {"version-zero", head(8, 0), "offset 8: format version: expected 1 to 5, found 0"},
        {"issue-in-version-3", [](Bytes& b) { b[8] = 3, b[40] = 1, b[44] = 1, reseal_head(b); },
         "offset 44: reserved bits: expected 0, found 0x00000001"},
        {"reserved-bit", head(12, 1), "offset 12: reserved bits: expected 0, found 0x00000001"},
        {"region-reserved-bit", head(region0 + 3, 1), "offset 55: reserved bits: expected 0, found 0x01"},
        {"flipped-head", [](Bytes& b) { b[140] ^= 1; }, "offset 0: checksum of the head"},
        {"huge-head", [](Bytes& b) { store(b.data() + 16, ~std::uint64_t{0}); }, "offset 16: size of the head"},
        {"huge-launch-count", [](Bytes& b) { store(b.data() + 28, ~0u), reseal_head(b); }, "offset 28: launches"},
        {"huge-link-table", [](Bytes& b) { store(b.data() + region0 + 20, 0x3fffffffu), reseal_head(b); },
         "offset 72: links of region 0: expected 0 to 268435456, found 2147483646"},
        {"link-out-of-range", [](Bytes& b) { store(b.data() + region0 + 40 + 20, 1u), reseal_head(b); },
         "link 1 of element 0 of region 0: expected an element of the trace, found element 1 of region 1"},
        {"unknown-kind", head(region0, 3), "kind of region 0: expected 0 to 2, found 3"},
        {"kernels-in-version-1", head(40, 1), "offset 40: reserved bits: expected 0, found 0x0000000000000001"},
        {"no-kernel", head(8, 2), "offset 40: kernels per launch: expected 1 to 1024, found 0"},
        {"unequal-kernels", [](Bytes& b) { b[8] = 2, b[40] = 2, reseal_head(b); },
         "offset 40: kernels per launch: expected a divisor of 1 warps per launch, found 2"},
        {"order-missing", [](Bytes& b) { b[8] = 2, b[40] = 1, reseal_head(b); },
         "provenance: key \"execution\": expected a value, found none"},
        {"flipped-block", [](Bytes& b) { b[head_size(b) + 120] ^= 1; }, "checksum of the block"},
        {"huge-stream", [](Bytes& b) { store(b.data() + head_size(b) + 56, ~0u), reseal_block(b); },
         "raw stream size of the block: expected at most"},
        {"huge-block", [](Bytes& b) { store(b.data() + head_size(b) + 32, std::uint64_t{1} << 40), reseal_block(b); },
         "lane accesses of the block: expected at most 33554432"},
        {"warps-missing", [](Bytes& b) { store(b.data() + 32, 2u), reseal_head(b); },
         "expected every warp of every launch, found none for launch 0 warp 1"},
        {"index-elsewhere", [](Bytes& b) { b[b.size() - 24 - 48] ^= 1, reseal_index(b); }, "place of block 0"},
        {"no-index", [](Bytes& b) { b.erase(b.end() - 88, b.end()); }, "end of the file: expected the end mark RCEND"},
        {"cut-short", [](Bytes& b) { b.erase(b.end() - 5, b.end()); },
         "keep its whole launches with `raycache verify --recover`"},
        {"bytes-added", [](Bytes& b) { b.push_back(0); }, "end of the file: expected the end mark RCEND"},
    };
}

bool same_zstd() { return std::string(ZSTD_versionString()) == "1.5.4"; }

}  // namespace

TEST_CASE("the writer still makes the golden files, byte for byte") {
    if (!same_zstd())
        raycache::test::skip(std::string("zstd is ") + ZSTD_versionString() +
                                 ", not 1.5.4: compressed bytes may differ, so records alone are compared",
                             "run the tests on Debian 12");
    const TemporaryFolder temporary;
    for (const Good& good : good_files()) {
        INFO(good.name);
        const std::string path = folder + "good/" + good.name + ".rct";
        write_sample(good.make(), temporary / "new.rct", 2);
        if (same_zstd()) CHECK(read_file(temporary / "new.rct") == read_file(path));
        CHECK(dump_trace(temporary / "new.rct") == dump_trace(path));
    }
}

TEST_CASE("the reader still reads the golden files") {
    for (const Good& good : good_files()) {
        INFO(good.name);
        const std::string path = folder + "good/" + good.name + ".rct";
        const Sample sample = good.make();
        CHECK(Reader(path).header() == sample.header);
        CHECK(read_all(path) == sample.warps);
        CHECK_NOTHROW(verify(path));
    }
}

TEST_CASE("each bad golden file is refused for its own reason") {
    for (const Bad& bad : bad_files()) {
        INFO(bad.name);
        const std::string path = folder + "bad/" + bad.name + ".rct";
        CHECK(std::filesystem::exists(path));
        CHECK_THAT(refusal([&] { verify(path); }), Contains(bad.message) && Contains(path));
    }
}

TEST_CASE("every golden file is one that the tests know") {
    const auto files = [](const std::string& of) {
        return std::distance(std::filesystem::directory_iterator(folder + of), {});
    };
    CHECK(files("good") == std::ssize(good_files()));
    CHECK(files("bad") == std::ssize(bad_files()));
}

TEST_CASE("the hexadecimal example of FORMAT.md is the golden file") {
    std::ifstream in(raycache::test::source_folder() + "traces/FORMAT.md");
    Bytes bytes;
    for (std::string line; std::getline(in, line);) {
        if (!line.starts_with("    0x")) continue;  // 0xOFFSET: up to 16 bytes, two spaces, words
        std::istringstream words(line.substr(line.find(": ") + 2, 47));
        for (std::string word; words >> word && word.size() == 2;)
            bytes.push_back(static_cast<std::uint8_t>(std::stoul(word, nullptr, 16)));
    }
    CHECK(bytes == read_file(folder + "good/example.rct"));
}

TEST_CASE("write the golden files anew", "[.regenerate]") {
    for (const Good& good : good_files()) write_sample(good.make(), folder + "good/" + good.name + ".rct", 2);
    for (const Bad& bad : bad_files()) {
        Bytes bytes = read_file(folder + "good/example.rct");
        bad.change(bytes);
        write_file(folder + "bad/" + bad.name + ".rct", bytes);
    }
}
