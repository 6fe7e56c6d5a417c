#include <catch2/catch.hpp>
#include <thread>

#include "files.hpp"
#include "samples.hpp"
#include "traces/bytes.hpp"
#include "traces/reader.hpp"
#include "traces/verify.hpp"
#include "traces/writer.hpp"

using namespace raycache::traces;
using Catch::Matchers::Contains;

namespace {

void check_round_trip(const Sample& sample, std::size_t per_block) {
    const TemporaryFolder folder;
    const std::string path = folder / "sample.rct";
    write_sample(sample, path, per_block);
    CHECK(Reader(path).header() == sample.header);
    CHECK(read_all(path) == sample.warps);

    VerifyResult expected;
    for (const WarpTrace& warp : sample.warps) {
        ++expected.warps;
        expected.records += warp.records.size();
        expected.lane_accesses += warp.elements.size();
        for (const Record& record : warp.records) expected.rays += record.is_access() ? 0 : record.lanes();
    }
    const VerifyResult found = verify(path);
    CHECK(found.warps == expected.warps);
    CHECK(found.records == expected.records);
    CHECK(found.lane_accesses == expected.lane_accesses);
    CHECK(found.rays == expected.rays);
    CHECK(found.blocks == Reader(path).blocks().size());
}

}  // namespace

TEST_CASE("walks through trees of every degree come back exactly") {
    for (const unsigned degree : {2u, 3u, 4u, 8u, 16u})
        for (const bool breadth_first : {false, true})
            for (std::uint64_t seed = 1; seed <= 6; ++seed)
                check_round_trip(bvh_walks({seed, degree, 60, 2, 5, breadth_first}), seed);
}

TEST_CASE("records without any sense come back exactly") {
    for (std::uint64_t seed = 1; seed <= 150; ++seed) check_round_trip(noise({seed, 2, 0, 2, 3}), 1 + seed % 3);
}

TEST_CASE("the kernels and buffers of a wavefront come back exactly") {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) check_round_trip(wavefront_buffers({seed, 0, 0, 2, 4}), 3);
}

TEST_CASE("only a trace that needs version 2 is one") {
    const TemporaryFolder folder;
    const auto version = [&](const Sample& sample) {
        write_sample(sample, folder / "sample.rct");
        return load<std::uint32_t>(read_file(folder / "sample.rct").data() + 8);
    };
    Sample sample = texel_reads({});
    CHECK(version(sample) == 1);
    sample.header.regions[0].kind = ObjectKind::hit;
    CHECK(version(sample) == 2);
    sample = texel_reads({1, 0, 0, 1, 4});
    sample.header.kernels_per_launch = 2;
    CHECK(version(sample) == 2);
    CHECK(version(wavefront_buffers({})) == 2);
}

TEST_CASE("depths and normals are of version 5, and come back exactly") {
    Sample sample = texel_reads({2, 0, 0, 2, 4});
    sample.header.regions[0].kind = ObjectKind::depth;
    check_round_trip(sample, 3);
    sample.header.regions[0].kind = ObjectKind::normal;
    check_round_trip(sample, 2);
}

TEST_CASE("a region of pages is of version 3, and says where its elements lie") {
    const TemporaryFolder folder;
    Sample sample = texel_reads({1, 0, 0, 1, 1});
    Region& region = sample.header.regions[0];
    const auto write = [&](Region changed) {
        sample.header.regions[0] = changed;
        write_sample(sample, folder / "sample.rct");
        return load<std::uint32_t>(read_file(folder / "sample.rct").data() + 8);
    };
    Region paged = region;
    paged.base = 0;
    paged.stride = 4;
    std::vector<std::uint64_t> numbers((std::uint64_t{paged.count} * paged.stride + 4095) / 4096);
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = 7 + i * 0x100000001;
    paged.pages = PageTable(numbers);
    CHECK(write(paged) == 3);
    CHECK(Reader(folder / "sample.rct").header() == sample.header);
    CHECK(paged.address(1025) == (numbers[1] << 12) + 4);
    const auto refused = [&](auto change) {
        Region changed = paged;
        change(changed);
        return refusal([&] { write(changed); });
    };
    CHECK_THAT(refused([](Region& r) { r.base = 2u << 20; }), Contains("base address"));
    CHECK_THAT(refused([](Region& r) { r.stride = 12; }), Contains("a power of two"));
    CHECK_THAT(refused([](Region& r) { r.pages = PageTable({1}); }), Contains("pages of region 0"));
    CHECK_THAT(refused([&](Region& r) {
                   std::swap(numbers[0], numbers[1]);
                   r.pages = PageTable(numbers);
               }),
               Contains("page 1 of region 0"));
}

TEST_CASE("texel reads come back exactly") { check_round_trip(texel_reads({}), 2); }

TEST_CASE("a deep tree, a single node and a region without elements come back exactly") {
    check_round_trip(bvh_walks({3, 2, 4000, 1, 3}), 3);
    check_round_trip(bvh_walks({3, 2, 2, 1, 1}), 1);
    Sample sample = bvh_walks({});
    sample.header.regions.push_back({ObjectKind::texel, 0, 4, 4, 0, 0, {}});
    check_round_trip(sample, 2);
}

TEST_CASE("a chain of links deeper than the lane's stack comes back exactly") {
    Sample sample = noise({1, 2, 0, 1, 1});
    Region chain{ObjectKind::node, 0, 64, 64, 1000, 2, {}};
    for (std::uint32_t i = 0; i < 1000; ++i) {
        chain.links.push_back(i + 1 < 1000 ? i + 1 : no_link);
        chain.links.push_back(999 - i);
    }
    sample.header.regions = {chain};
    WarpTrace& warp = sample.warps[0];
    warp.clear();
    for (std::uint32_t i = 0; i < 500; ++i) {
        warp.records.push_back({1, 0, RayType::camera, 0, 0});
        warp.elements.push_back(i);
    }
    for (std::uint32_t i = 500; i < 999; ++i) {  // the links not taken, latest first
        warp.records.push_back({1, 0, RayType::camera, 0, 0});
        warp.elements.push_back(i);
    }
    check_round_trip(sample, 1);
}

TEST_CASE("a warp without records is kept") {
    Sample sample = bvh_walks({});
    for (const std::size_t i : {0u, 4u, 9u}) sample.warps[i].clear();
    check_round_trip(sample, 3);
}

TEST_CASE("a block decodes alone, in any order, on any thread") {
    const TemporaryFolder folder;
    const std::string path = folder / "sample.rct";
    const Sample sample = bvh_walks({5, 2, 100, 3, 8});
    write_sample(sample, path, 3);
    const Reader reader(path);
    std::vector<std::thread> threads;
    std::vector<int> good(4);
    for (std::size_t t = 0; t < good.size(); ++t)
        threads.emplace_back([&, t] {
            std::vector<WarpTrace> warps;
            bool equal = true;
            for (std::size_t n = reader.blocks().size(); n-- > 0;) {
                const std::size_t i = (n + t) % reader.blocks().size();
                reader.read_block(i, warps);
                const BlockInfo& info = reader.blocks()[i];
                for (std::size_t w = 0; w < warps.size(); ++w)
                    equal = equal && warps[w] == sample.warps[info.launch * 8 + info.first_warp + w];
            }
            good[t] = equal;
        });
    for (auto& thread : threads) thread.join();
    CHECK(good == std::vector<int>(4, 1));
}

TEST_CASE("equal input gives equal bytes, whatever was encoded before") {
    const Sample one = bvh_walks({7}), other = noise({8});
    const Block first = encode_block(one.header, std::span(one.warps).first(3));
    encode_block(other.header, std::span(other.warps).first(2));
    CHECK(encode_block(one.header, std::span(one.warps).first(3)).bytes == first.bytes);
    Block elsewhere;
    std::thread([&] { elsewhere = encode_block(one.header, std::span(one.warps).first(3)); }).join();
    CHECK(elsewhere.bytes == first.bytes);
}

TEST_CASE("a lane access through a tree costs well under a byte") {
    const Sample sample = bvh_walks({1, 2, 20000, 1, 64});
    std::size_t accesses = 0;
    for (const auto& warp : sample.warps) accesses += warp.elements.size();
    const Block block = encode_block(sample.header, sample.warps);
    CHECK(double(block.bytes.size()) < 0.6 * double(accesses));
}
