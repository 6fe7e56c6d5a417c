// References: rendered, kept in files, and found again only where they are what was asked for.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <catch2/catch.hpp>
#include <limits>

#include "tests/traces/files.hpp"
#include "tracer/quality/error_measures.hpp"
#include "tracer/quality/reference_file.hpp"
#include "traces/error.hpp"

namespace raycache::tracer {
namespace {

const PreparedScene& courtyard() {
    static const PreparedScene scene(
        [] {
            SceneRequest request;
            request.source = "courtyard";
            request.detail = 50000;
            return load_scene(request, {});
        }(),
        {});
    return scene;
}

ReferenceSettings small() {
    ReferenceSettings settings;
    settings.width = 24;
    settings.height = 16;
    settings.spp = 6;
    return settings;
}

constexpr ImageSize size{24, 16};  // of small()

}  // namespace

TEST_CASE("a reference is the same whatever the number of threads", "[quality]") {
    const Reference all = render_reference(courtyard(), small(), {});
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const Reference single = render_reference(courtyard(), small(), {});
    CHECK(all.mean.pixels == single.mean.pixels);
    CHECK(all.half_difference.pixels == single.half_difference.pixels);
    CHECK(all.key == single.key);
}

TEST_CASE("the half difference is as large as the reference's error against a better one", "[quality][slow]") {
    ReferenceSettings settings = small(), better = small();
    settings.paths.bounces = better.paths.bounces = 1;
    settings.spp = 32;
    better.spp = 2048;
    const Reference rough = render_reference(courtyard(), settings, {});
    const Reference fine = render_reference(courtyard(), better, {});
    const ErrorMeasures m = measure_errors(std::span(&rough.mean, 1), fine);
    const ErrorMeasures own = measure_errors(std::span(&rough.mean, 1), rough);
    CHECK(own.reference_rmse == Approx(m.rmse.value).epsilon(0.2));
    CHECK(m.z_pixels < 1.6);
}

TEST_CASE("a clamp scales samples down to its value, keeps their colour and is refused unless above 0", "[quality]") {
    RenderSettings settings{24, 16, {}, {}, {}};
    settings.strategy.samples.spp = 1;
    const Image free = render(courtyard(), settings, {});
    settings.clamp = 0.25F;
    const Image clamped = render(courtyard(), settings, {});
    std::size_t scaled = 0;
    for (std::size_t p = 0; p < free.pixels.size(); ++p) {
        const Vec3 before = free.pixels[p], after = clamped.pixels[p];
        REQUIRE(max_component(after) <= 0.25F * 1.000001F);
        if (max_component(before) <= 0.25F) {
            REQUIRE(after == before);
        } else {
            ++scaled;
            REQUIRE(after.x * before.y == Approx(after.y * before.x).margin(1e-6));
        }
    }
    CHECK(scaled > 10);
    for (const float bad : {0.0F, -1.0F, std::numeric_limits<float>::infinity(), std::nanf("")})
        CHECK_THROWS_AS(check_clamp(bad), UsageError);
    CHECK_NOTHROW(check_clamp({}));
}

TEST_CASE("every setting that changes the picture changes the key and the cached file's name", "[quality]") {
    const std::string key = reference_key(courtyard(), small());
    std::vector<ReferenceSettings> others(8, small());
    others[0].width = 25;
    others[1].height = 17;
    others[2].spp = 8;
    others[3].paths.bounces = 4;
    others[4].paths.russian_roulette = true;
    others[5].clamp = 10;
    others[6].paths.integrator = "ao";
    others[7].paths.integrator = "ao";
    others[7].paths.parameters.set("radius", "0.5");
    CHECK(reference_key(courtyard(), others[6]) != reference_key(courtyard(), others[7]));
    for (const auto& other : others) {
        CHECK(reference_key(courtyard(), other) != key);
        CHECK(cached_reference_path(reference_key(courtyard(), other)) != cached_reference_path(key));
    }
    Scene moved = courtyard().scene();
    moved.cameras.front().eye.x += 0.5F;
    CHECK(reference_key(PreparedScene(moved, {}), small()) != key);
    Scene dark = courtyard().scene();
    dark.sky = {0, 0, 0};
    CHECK(reference_key(PreparedScene(dark, {}), small()) != key);
    CHECK(reference_key(courtyard(), small()) == key);
}

TEST_CASE("a reference read back from its file is the one written, bit by bit", "[quality]") {
    const TemporaryFolder folder;
    const Reference written = render_reference(courtyard(), small(), {});
    write_reference(folder / "a.exr", written);
    const Reference read = read_reference(folder / "a.exr", written.key, size);
    CHECK(read.mean.pixels == written.mean.pixels);
    CHECK(read.half_difference.pixels == written.half_difference.pixels);
    CHECK(read.mean.width == 24);
    CHECK(read.mean.height == 16);
    write_reference(folder / "b.exr", read);
    CHECK(read_file(folder / "a.exr") == read_file(folder / "b.exr"));
}

TEST_CASE("files that are not the wanted reference are refused", "[quality]") {
    const TemporaryFolder folder;
    const std::string path = folder / "a.exr";
    const Reference written = render_reference(courtyard(), small(), {});
    write_reference(path, written);
    const std::vector<std::uint8_t> whole = read_file(path);

    SECTION("another key") { CHECK_THROWS_AS(read_reference(path, written.key + "!", size), Error); }
    SECTION("missing") { CHECK_THROWS_AS(read_reference(folder / "none.exr", written.key, size), Error); }
    SECTION("an EXR of someone else's") {
        write_image(folder / "b.exr", written.mean);
        CHECK_THROWS_AS(read_reference(folder / "b.exr", written.key, size), Error);
    }
    SECTION("our mark, but other pixels") {
        std::vector<Channel> channels;
        for (const char* name : {"R", "G", "B", "half_difference.R", "half_difference.G", "half_difference.B"})
            channels.push_back({name, std::vector<float>(24 * 16, 1)});
        write_channels(folder / "b.exr", 24, 16, channels,
                       {{"raycache:reference", written.key}, {"raycache:checksum", "0000000000000000"}});
        CHECK_THROWS_AS(read_reference(folder / "b.exr", written.key, size), Error);
    }
    SECTION("text") {
        write_file(path, {'h', 'e', 'l', 'l', 'o'});
        CHECK_THROWS_AS(read_reference(path, written.key, size), Error);
    }
    SECTION("cut short anywhere, or one byte changed: never other pixels") {
        std::size_t wrong = 0, refused = 0, tried = 0;
        for (std::size_t at = 0; at < whole.size(); at += 97) {
            std::vector<std::uint8_t> damaged = whole;
            damaged[at] = static_cast<std::uint8_t>(damaged[at] ^ 0x55);
            for (const auto& bytes :
                 {damaged, std::vector<std::uint8_t>(whole.begin(), whole.begin() + static_cast<long>(at))}) {
                write_file(path, bytes);
                ++tried;
                try {
                    const Reference read = read_reference(path, written.key, size);
                    wrong += read.mean.pixels != written.mean.pixels ||
                             read.half_difference.pixels != written.half_difference.pixels;
                } catch (const Error&) {
                    ++refused;
                }
            }
        }
        CHECK(wrong == 0);
        CHECK(refused > tried / 2);
    }
}

TEST_CASE("a reference with the right key and checksum but pixels that no picture has is refused", "[quality]") {
    const TemporaryFolder folder;
    const std::string path = folder / "a.exr";
    const float infinity = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    const auto message_of = [&](Reference reference, ImageSize wanted) {
        write_reference(path, reference);
        return refusal([&] { read_reference(path, "key", wanted); });
    };
    Reference good{{8, 4, {}}, {8, 4, {}}, "key"};
    good.mean.pixels.assign(32, {1, 2, 0});
    good.half_difference.pixels.assign(32, {0.5F, -2, 0});
    CHECK(message_of(good, {8, 4}).empty());

    SECTION("another size: said before the pixels are looked at") {
        for (const ImageSize wanted : {ImageSize{4, 8}, ImageSize{8, 5}, ImageSize{16, 2}, ImageSize{3000, 3000}}) {
            const std::string message = message_of(good, wanted);
            CHECK(message.find(fmt::format("expected {} x {} pixels, found 8 x 4", wanted.width, wanted.height)) !=
                  std::string::npos);
        }
    }
    SECTION("no radiance") {
        for (const float bad : {nan, infinity, -infinity, -1e-20F}) {
            Reference reference = good;
            reference.mean.pixels[21].y = bad;
            const std::string message = message_of(reference, {8, 4});
            INFO(message);
            CHECK(message.find("channel G at pixel 5, 2") != std::string::npos);
        }
    }
    SECTION("a half picture that is none") {
        for (const float bad : {nan, infinity, -infinity, 1.01F, -1.01F}) {
            Reference reference = good;
            reference.half_difference.pixels[31].x = bad;
            const std::string message = message_of(reference, {8, 4});
            INFO(message);
            CHECK(message.find("channel half_difference.R at pixel 7, 3") != std::string::npos);
        }
    }
    SECTION("a folder, an empty file, a device without an end") {
        write_file(folder / "empty.exr", {});
        for (const std::string& bad : {folder / "", folder / "empty.exr", std::string("/dev/zero")})
            CHECK(refusal([&] { read_reference(bad, "key", {8, 4}); }).find("expected") != std::string::npos);
    }
}

TEST_CASE("less than two samples and seeds of the reference are refused", "[quality]") {
    ReferenceSettings settings = small();
    for (const std::uint64_t spp : {0, 1}) {
        settings.spp = spp;
        CHECK_THROWS_AS(render_reference(courtyard(), settings, {}), UsageError);
    }
    CHECK_NOTHROW(check_seeds(1, 1024));
    CHECK_NOTHROW(check_seeds(0, 1));
    CHECK_THROWS_AS(check_seeds(0x7265666572656e63, 1), UsageError);
    CHECK_THROWS_AS(check_seeds(0x7265666572656e63 - 3, 4), UsageError);
    CHECK_NOTHROW(check_seeds(0x7265666572656e63 - 3, 3));
}

TEST_CASE("an independent pair gets random's numbers, the others keep theirs", "[quality]") {
    StrategySettings settings;
    settings.decorrelation = "coherent";
    settings.samples.spp = 16;
    settings.samples.seed = 5;
    const SamplingStrategy plain(settings, 10);
    settings.independent_pair = 2;
    const SamplingStrategy with(settings, 10);
    settings.independent_pair.reset();
    settings.decorrelation = "random";
    const SamplingStrategy random(settings, 10);
    for (std::uint32_t d = 0; d < 10; ++d) {
        const SamplingStrategy& same = d / 2 == 2 ? random : plain;
        CHECK(with.value(77, 3, 4, d) == same.value(77, 3, 4, d));
    }
}

}  // namespace raycache::tracer
