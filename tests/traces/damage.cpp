#include <catch2/catch.hpp>

#include "files.hpp"
#include "samples.hpp"
#include "traces/compression.hpp"
#include "traces/format.hpp"
#include "traces/reader.hpp"
#include "traces/verify.hpp"

using namespace raycache::traces;
using Catch::Matchers::Contains;

namespace {

const TemporaryFolder folder;

std::string verify_bytes(const Bytes& bytes) {
    const std::string path = folder / "damaged.rct";
    write_file(path, bytes);
    return refusal([&] { verify(path); });
}

Bytes file_of(const Sample& sample, std::size_t per_block = 2) {
    const std::string path = folder / "whole.rct";
    write_sample(sample, path, per_block);
    return read_file(path);
}

bool one_line_with_offset(const std::string& message) {
    return message.find("offset ") != std::string::npos && message.find("expected ") != std::string::npos &&
           message.find("found ") != std::string::npos && message.find('\n') == std::string::npos;
}

/// Corrects every checksum, so that what lies behind them is tested.
void reseal(Bytes& bytes) {
    const auto fix = [&](std::size_t from, std::size_t size) {
        if (size < 8 || from + size > bytes.size()) return;
        store(bytes.data() + from + size - 8, checksum(std::span(bytes).subspan(from, size - 8)));
    };
    if (bytes.size() < 100) return;
    const auto head = load<std::uint64_t>(bytes.data() + 16);
    if (head < 56 || head > bytes.size()) return;
    fix(0, head);
    const auto index = load<std::uint64_t>(bytes.data() + bytes.size() - 24);
    if (index < 40 || index > bytes.size()) return;
    fix(bytes.size() - index, index - 8);
    for (std::size_t at = bytes.size() - index + 16; at + 48 + 24 <= bytes.size(); at += 48) {
        const auto offset = load<std::uint64_t>(bytes.data() + at);
        if (offset < bytes.size()) fix(offset, load<std::uint32_t>(bytes.data() + at + 8));
    }
}

}  // namespace

TEST_CASE("a flipped byte anywhere is refused with its offset") {
    const Bytes good = file_of(bvh_walks({1, 2, 12, 2, 2}), 1);
    REQUIRE(verify_bytes(good).empty());
    std::size_t refused = 0;
    for (std::size_t i = 0; i < good.size(); ++i) {
        Bytes bad = good;
        bad[i] ^= static_cast<std::uint8_t>(1u << (i % 8));
        refused += one_line_with_offset(verify_bytes(bad));
    }
    CHECK(refused == good.size());
}

TEST_CASE("a file cut at any length, or with bytes added, is refused") {
    const Bytes good = file_of(bvh_walks({1, 2, 12, 1, 2}), 1);
    std::size_t refused = 0;
    for (std::size_t size = 0; size < good.size(); ++size)
        refused += one_line_with_offset(verify_bytes({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)}));
    CHECK(refused == good.size());
    Bytes longer = good;
    longer.push_back(0);
    CHECK_THAT(verify_bytes(longer), Contains("verify --recover"));
    for (int i = 0; i < 100; ++i) longer.push_back(0);
    CHECK_THAT(verify_bytes(longer), Contains("verify --recover"));
}

TEST_CASE("mutations behind correct checksums are refused or give valid records, and never crash") {
    std::size_t refused = 0, accepted = 0;
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        const Bytes good = file_of(seed % 2 ? bvh_walks({seed, 2, 12, 1, 2}) : noise({seed, 2, 0, 1, 2}), 1);
        Random random(seed);
        for (int round = 0; round < 4000; ++round) {
            Bytes bad = good;
            for (std::uint32_t n = 1 + random.below(3); n > 0; --n) {
                const auto at = random.below(static_cast<std::uint32_t>(bad.size()));
                switch (random.below(4)) {
                    case 0:
                        bad[at] ^= static_cast<std::uint8_t>(1u << random.below(8));
                        break;
                    case 1:
                        bad[at] = static_cast<std::uint8_t>(random.bits());
                        break;
                    case 2:
                        bad[at] = random.chance(50) ? 0xff : 0;
                        break;
                    default:
                        bad[at] = bad[random.below(static_cast<std::uint32_t>(bad.size()))];
                        break;
                }
            }
            if (!random.chance(10)) reseal(bad);
            const std::string message = verify_bytes(bad);
            if (message.empty()) {
                ++accepted;
            } else {
                ++refused;
                if (!one_line_with_offset(message)) FAIL(message);
            }
        }
    }
    CHECK(refused > 5000);
    INFO(accepted);
}

TEST_CASE("mutated symbols in a block stay inside the trace") {
    // Streams are compressed, so a flipped stored byte rarely reaches the symbols: build blocks from mutated streams.
    const Sample sample = bvh_walks({9, 2, 30, 1, 1});
    const Bytes good = file_of(sample, 1);
    const std::size_t at = load<std::uint64_t>(good.data() + 16);
    const std::size_t end = good.size() - load<std::uint64_t>(good.data() + good.size() - 24);
    std::vector<Bytes> raw;
    std::size_t from = at + format::block_head_bytes;
    for (unsigned s = 0; s < format::streams; ++s) {
        const std::size_t size = load<std::uint32_t>(good.data() + at + 48 + 8 * s);
        const std::size_t stored = load<std::uint32_t>(good.data() + at + 52 + 8 * s);
        decompress(std::span(good).subspan(from, stored), size, {"test"}, raw.emplace_back());
        from += stored;
    }
    Random random(5);
    std::size_t refused = 0;
    for (int round = 0; round < 6000; ++round) {
        auto streams = raw;
        for (std::uint32_t n = 1 + random.below(2); n > 0; --n) {
            Bytes& stream = streams[random.below(3)];
            stream[random.below(static_cast<std::uint32_t>(stream.size()))] =
                static_cast<std::uint8_t>(random.chance(50) ? random.below(6) : random.bits());
        }
        Bytes block(good.begin() + static_cast<std::ptrdiff_t>(at),
                    good.begin() + static_cast<std::ptrdiff_t>(at + format::block_head_bytes));
        for (unsigned s = 0; s < format::streams; ++s) {
            store(block.data() + 48 + 8 * s, static_cast<std::uint32_t>(streams[s].size()));
            const auto stored = static_cast<std::uint32_t>(compress(streams[s], Effort::fast, block));
            store(block.data() + 52 + 8 * s, stored);
        }
        store(block.data() + 8, static_cast<std::uint32_t>(block.size() + 8));
        seal(block);
        Bytes file(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(at));
        append(file, std::span<const std::uint8_t>(block));
        append(file, std::span(good).subspan(end));
        store(file.data() + file.size() - 24 - 48 + 8, static_cast<std::uint32_t>(block.size()));
        reseal(file);
        const std::string message = verify_bytes(file);
        refused += !message.empty();
        if (message.empty()) {
            for (const WarpTrace& warp : read_all(folder / "damaged.rct")) {
                std::size_t element = 0;
                for (const Record& record : warp.records)
                    for (unsigned n = record.is_access() ? record.lanes() : 0; n > 0; --n)
                        REQUIRE(warp.elements.at(element++) < sample.header.regions.at(record.region).count);
            }
        } else {
            REQUIRE(one_line_with_offset(message));
        }
    }
    CHECK(refused > 3000);
}

TEST_CASE("what is no ordinary file is refused") {
    CHECK_THAT(refusal([] { verify("/nowhere/t.rct"); }), Contains("No such file"));
    CHECK_THAT(refusal([] { verify("/dev/zero"); }), Contains("a device or pipe"));
    CHECK_THAT(refusal([] { verify("/tmp"); }), Contains("a folder"));
}
