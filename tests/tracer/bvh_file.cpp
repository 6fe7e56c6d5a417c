// Built trees on disk.
#include "tracer/bvh/bvh_file.hpp"

#include <xxhash.h>
#include <zstd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <set>

#include "tests/traces/files.hpp"
#include "traces/bytes.hpp"
#include "traces/error.hpp"
#include "trees.hpp"

using namespace raycache;
using namespace raycache::tracer;
using namespace raycache::tracer::test;
using Catch::Matchers::Contains;
using traces::Bytes;

namespace {

constexpr std::size_t magic_bytes = 8, checksum_bytes = 8;

struct Kept {
    Scene scene;
    BvhSettings settings;
    TemporaryFolder folder{};
    std::string path = folder / "kept.bvh", key = bvh_key(scene, settings);
    Bvh built = build_bvh(scene, settings);

    Bytes write() const {
        write_bvh(path, built, scene, key);
        return read_file(path);
    }
    Bvh read() const { return read_bvh(path, scene, settings, key); }
    Bvh read(const Bytes& bytes) const {
        write_file(path, bytes);
        return read();
    }
    std::string refusal_of(const Bytes& bytes) const {
        return refusal([&] { read(bytes); });
    }
    std::size_t head_bytes() const { return magic_bytes + 4 + key.size() + 17; }
};

/// 0 and -0 differ.
bool same_bits(const Bvh& a, const Bvh& b) {
    return a.nodes.size() == b.nodes.size() && a.triangles == b.triangles && a.depth == b.depth &&
           std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(Bvh::Node)) == 0;
}

void reseal(Bytes& bytes) {
    const std::size_t body = bytes.size() - checksum_bytes;
    traces::store(&bytes[body], std::uint64_t{XXH3_64bits(bytes.data(), body)});
}

/// The content of the frame replaced, the checksum correct.
Bytes with_content(const Kept& kept, const Bytes& file, const Bytes& content) {
    Bytes out(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(kept.head_bytes()));
    const std::size_t head = out.size();
    out.resize(head + ZSTD_compressBound(content.size()));
    out.resize(head + ZSTD_compress(&out[head], out.size() - head, content.data(), content.size(), 1) + checksum_bytes);
    reseal(out);
    return out;
}

Bytes content_of(const Kept& kept, const Bytes& file) {
    const std::uint8_t* frame = file.data() + kept.head_bytes();
    const std::size_t stored = file.size() - kept.head_bytes() - checksum_bytes;
    Bytes content(ZSTD_getFrameContentSize(frame, stored));
    REQUIRE(ZSTD_decompress(content.data(), content.size(), frame, stored) == content.size());
    return content;
}

bool one_line(const std::string& message) {
    return message.find("kept.bvh") != std::string::npos && message.find("expected ") != std::string::npos &&
           message.find("found ") != std::string::npos && message.find('\n') == std::string::npos;
}

}  // namespace

TEST_CASE("bvh file: a tree is read as it was built, bit by bit") {
    Scene zeros = moved(icosphere(2), 1, {0, 0, 0});
    for (std::size_t i = 0; i < zeros.positions.size(); i += 2) zeros.positions[i] = zeros.positions[i] * -0.0F;
    for (const Scene& scene :
         {soup(5000, 0.2F, 1), icosphere(3), sticks(), zeros, mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2})})
        for (const BvhSettings settings : {BvhSettings{1, false}, {4, false}, {7, false}, {4, true}}) {
            const Kept kept{scene, settings};
            kept.write();
            CHECK(same_bits(kept.read(), kept.built));
        }
}

TEST_CASE("bvh file: without spatial splits it is a tenth of the tree in memory or less") {
    const Kept kept{soup(20000, 0.1F, 6), {}};
    const std::size_t in_memory = kept.built.nodes.size() * sizeof(Bvh::Node) + kept.built.triangles.size() * 4;
    CHECK(kept.write().size() * 10 < in_memory + 10 * kept.head_bytes());
}

TEST_CASE("bvh file: a flipped byte anywhere, a cut at any length and bytes added are refused") {
    for (const bool splits : {false, true}) {
        const Kept kept{soup(60, 1.0F, 4), {4, splits}};
        const Bytes good = kept.write();
        REQUIRE(kept.refusal_of(good).empty());
        std::size_t refused = 0;
        for (std::size_t i = 0; i < good.size(); ++i) {
            Bytes bad = good;
            bad[i] ^= static_cast<std::uint8_t>(1U << (i % 8));
            refused += one_line(kept.refusal_of(bad));
            refused += one_line(kept.refusal_of({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(i)}));
        }
        CHECK(refused == 2 * good.size());
        Bytes longer = good;
        longer.push_back(0);
        CHECK_THAT(kept.refusal_of(longer), Contains("damaged"));
    }
}

TEST_CASE("bvh file: behind a correct checksum, changes are refused or leave a tree over all triangles") {
    for (const bool splits : {false, true}) {
        const Kept kept{soup(60, 1.0F, 4), {4, splits}};
        const Bytes good = kept.write(), content = content_of(kept, good);
        Random random(5);
        std::size_t refused = 0, accepted = 0;
        for (int round = 0; round < 3000; ++round) {
            const bool inside = round % 2 == 0;
            Bytes bad = inside ? content : good;
            for (std::uint32_t n = 1 + random.below(3); n > 0; --n) {
                // Of the head, the numbers behind the key; a frame of random bytes is not worth the time.
                const std::size_t at = inside ? random.below(static_cast<std::uint32_t>(bad.size()))
                                              : kept.head_bytes() - 1 - random.below(17 + 4);
                bad[at] = random.below(2) == 0 ? static_cast<std::uint8_t>(random.bits())
                                               : bad[random.below(static_cast<std::uint32_t>(bad.size()))];
            }
            if (inside)
                bad = with_content(kept, good, bad);
            else
                reseal(bad);
            write_file(kept.path, bad);
            try {
                const Bvh bvh = kept.read();
                ++accepted;
                const std::set<std::uint32_t> found(bvh.triangles.begin(), bvh.triangles.end());
                REQUIRE(found.size() == 60);
                REQUIRE(*found.rbegin() == 59);
                if (!splits) check_shape(bvh, 4);
            } catch (const Error& e) {
                ++refused;
                if (!one_line(e.what())) FAIL(e.what());
            }
        }
        CHECK(refused > 1000);
        CHECK(accepted > 10);
    }
}

TEST_CASE("bvh file: sizes that no tree of the scene has are refused before memory is taken") {
    const Kept kept{soup(60, 1.0F, 4), {}};
    const Bytes good = kept.write();
    const std::size_t sizes = kept.head_bytes() - 17;
    for (const auto& [nodes, entries] : {std::pair<std::uint64_t, std::uint64_t>{std::uint64_t{1} << 62, 60},
                                         {0, 60},
                                         {120, 60},
                                         {119, std::uint64_t{1} << 61},
                                         {119, 59}}) {
        Bytes bad = good;
        traces::store(&bad[sizes], nodes);
        traces::store(&bad[sizes + 8], entries);
        reseal(bad);
        CHECK_THAT(kept.refusal_of(bad), Contains("1 to 119 nodes, 60 to 60 leaf entries"));
    }
    Bytes huge = good;
    huge.resize(1 << 20);
    CHECK_THAT(kept.refusal_of(huge), Contains("expected at most"));
}

TEST_CASE("bvh file: what is missing, foreign or of another key is refused by name") {
    const Kept kept{soup(60, 1.0F, 4), {}};
    CHECK_THAT(refusal([&] { kept.read(); }), Contains("kept.bvh") && Contains("found none"));
    CHECK_THAT(kept.refusal_of({'g', 'l', 'T', 'F'}), Contains("expected a BVH that raycache wrote"));
    CHECK_THAT(kept.refusal_of({}), Contains("expected a BVH that raycache wrote"));
    const Kept other{soup(60, 1.0F, 5), {}};
    CHECK_THAT(kept.refusal_of(other.write()), Contains(kept.key) && Contains(other.key));
    const Kept shorter{mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2}), {}}, longer{soup(60, 1.0F, 4), {4, true}};
    CHECK_THAT(kept.refusal_of(shorter.write()), Contains(kept.key) && Contains(shorter.key));
    CHECK_THAT(kept.refusal_of(longer.write()), Contains(kept.key) && Contains(longer.key));
    const std::string path = kept.folder / "none/kept.bvh";
    CHECK_THAT(refusal([&] { write_bvh(path, kept.built, kept.scene, kept.key); }), Contains("none"));
}

TEST_CASE("bvh file: the key tells triangles and settings apart, and nothing else") {
    const Scene scene = soup(60, 1.0F, 4);
    Scene vertex = scene, order = scene, lit = scene;
    vertex.positions[7].x = std::nextafter(vertex.positions[7].x, 2.0F);
    std::swap(order.indices[0], order.indices[1]);
    lit.name = "another";
    lit.hash = 7;
    lit.sky = {1, 1, 1};
    lit.cameras.resize(3);
    const std::set<std::string> keys{bvh_key(scene, {}), bvh_key(scene, {4, true}), bvh_key(scene, {3, false}),
                                     bvh_key(vertex, {}), bvh_key(order, {})};
    CHECK(keys.size() == 5);
    std::set<std::string> names;
    for (const std::string& key : keys) names.insert(bvh_file_name(key));
    CHECK(names.size() == 5);
    CHECK(bvh_key(lit, {}) == bvh_key(scene, {}));
}
