#include <charconv>
#include <exception>
#include <optional>
#include <ostream>
#include <string_view>

#include <fmt/format.h>

#include "tools/gpu/replay/replay.hpp"
#include "traces/error.hpp"
#include "traces/printable.hpp"

namespace raycache::gpu {
namespace {

constexpr std::string_view help =
    R"(Walks the rays of a replay package, checks every hit, and prints what was read and how long it took, as JSON.
Packages: raycache capture SCENE --gpu-package DIR (docs/gpu_package.md).

Usage: {} DIR [OPTION]...
  --repeats N       timed walks of each kind (10)
  --launches N      only the first N launches of the package
  --kernel KIND     only wavefront, a launch for each bounce and kind of ray, or megakernel, one for all
  --flush-l2        an L2 without the package before each timed walk; else it is as the walk before left it
  --block-warps N   warps of a CTA, 1 to 32 (8)
  --device N        number of the GPU (0)
  --profile         each walk once, nothing checked or timed: for a profiler
  --help            this

Example: {} /tmp/sponza --repeats 20 >sponza.json
)";

std::uint32_t number(std::string_view option, std::string_view word, std::uint32_t least, std::uint32_t most) {
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || value < least || value > most)
        throw UsageError(fmt::format("{}: expected a number from {} to {}, found '{}'", option, least, most, word));
    return value;
}

/// Nothing: --help was asked for.
std::optional<ReplayOptions> parse(int count, const char* const* words) {
    ReplayOptions options;
    for (int i = 1; i < count; ++i) {
        const std::string_view word = words[i];
        const auto value = [&](std::uint32_t least, std::uint32_t most) {
            if (i + 1 == count) throw UsageError(fmt::format("{}: expected a number, found none", word));
            return number(word, words[++i], least, most);
        };
        if (word == "--help") return std::nullopt;
        if (word == "--repeats")
            options.repeats = value(1, 1000);
        else if (word == "--launches")
            options.launches = value(1, 1000000);
        else if (word == "--block-warps")
            options.backend.block_warps = value(1, 32);
        else if (word == "--device")
            options.backend.device = value(0, 1000);
        else if (word == "--kernel") {
            const std::string_view kind = i + 1 == count ? "none" : words[++i];
            if (kind != "wavefront" && kind != "megakernel")
                throw UsageError(fmt::format("--kernel: expected wavefront or megakernel, found {}", kind));
            (kind == "wavefront" ? options.megakernel : options.wavefront) = false;
        } else if (word == "--flush-l2")
            options.flush_l2 = true;
        else if (word == "--profile")
            options.profile = true;
        else if (word.starts_with("-"))
            throw UsageError(fmt::format("unknown option '{}'; see {} --help", word, program_name()));
        else if (!options.folder.empty())
            throw UsageError(fmt::format("expected one package, found two: {} and {}", options.folder, word));
        else
            options.folder = word;
    }
    if (options.folder.empty())
        throw UsageError(fmt::format("expected the folder of a package, found none; see {} --help", program_name()));
    return options;
}

}  // namespace

int replay_main(int count, const char* const* words, std::ostream& out, std::ostream& errors) {
    const auto fail = [&](const char* what, int code) {
        errors << program_name() << ": error: " << printable_line(what) << '\n';
        return code;
    };
    try {
        const auto options = parse(count, words);
        if (!options) {
            out << fmt::format(fmt::runtime(help), program_name(), program_name());
            return 0;
        }
        const auto backend = make_backend(options->backend);
        const ReplayResult result = replay(*options, *backend);
        out << result.json << std::endl;
        if (!out) return fail("stdout: expected to write the result, found it closed or full", 1);
        if (result.wrong == 0) return 0;
        return fail(
            fmt::format("{} of {} rays ended elsewhere than in the tracer's own walk", result.wrong, result.rays)
                .c_str(),
            1);
    } catch (const UsageError& e) {
        return fail(e.what(), 2);
    } catch (const std::exception& e) {
        return fail(e.what(), 1);
    }
}

}  // namespace raycache::gpu
