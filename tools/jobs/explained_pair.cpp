#include "tools/jobs/explained_pair.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "cachesim/report/origin.hpp"
#include "traces/error.hpp"
#include "traces/printable.hpp"

namespace raycache::tools {
namespace {

using traces::Header;
using traces::Provenance;

std::string list(const std::vector<std::uint32_t>& samples) {
    constexpr std::size_t most = 8;
    const std::vector<std::uint32_t> shown(
        samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(std::min(most, samples.size())));
    return fmt::format("{}{}", fmt::join(shown, ", "), samples.size() > most ? ", …" : "");
}

/// Ratios per ray mean something only between traces of the same rays but for the strategy.
void check_comparable(const ExplainedPair& pair) {
    const Header &base = *pair[0].header, &other = *pair[1].header;
    const Provenance &a = base.provenance, &b = other.provenance;
    const auto same = [&](const char* what, const auto& expected, const auto& found) {
        if (expected == found) return;
        throw Error(fmt::format("{}: expected the {} of {}, {}, found {}; capture both alike but for the strategy",
                                pair[1].name, what, pair[0].name, expected, found));
    };
    same("scene", a.scene, b.scene);
    same("content of the scene", fmt::format("{:#018x}", a.scene_hash), fmt::format("{:#018x}", b.scene_hash));
    same("camera", a.camera, b.camera);
    same("resolution", fmt::format("{}x{}", a.width, a.height), fmt::format("{}x{}", b.width, b.height));
    same("number of bounces", a.bounces, b.bounces);
    if (cachesim::indices_per_launch(a.thread_map) != cachesim::indices_per_launch(b.thread_map))
        same("thread map", a.thread_map, b.thread_map);
    if (base.launches == other.launches) return;
    const bool common = std::any_of(base.launches.begin(), base.launches.end(), [&](std::uint32_t sample) {
        return std::find(other.launches.begin(), other.launches.end(), sample) != other.launches.end();
    });
    throw Error(fmt::format(
        "{}: expected the sample indices of {}, {}, found {}{}; capture both with the same --spp, "
        "--seed and --trace-samples",
        pair[1].name, pair[0].name, list(base.launches), common ? "" : "none of them but ", list(other.launches)));
}

/// What tells each trace from the other: its strategy, and whatever else they were not given alike.
std::array<std::string, 2> names_of(const ExplainedPair& pair) {
    const Provenance &a = pair[0].header->provenance, &b = pair[1].header->provenance;
    std::array<std::string, 2> names;
    const auto add = [&](const std::string& first, const std::string& second) {
        if (first == second) return;
        for (std::size_t i = 0; i < 2; ++i) names[i] += (names[i].empty() ? "" : " ") + (i == 0 ? first : second);
    };
    add(to_string(pair[0].strategy), to_string(pair[1].strategy));
    if (a.decorrelation == b.decorrelation) add(a.parameters, b.parameters);
    add(a.sequence, b.sequence);
    add(fmt::format("N={}", a.spp), fmt::format("N={}", b.spp));
    if (names[0].empty() || names[1].empty()) return {"base", "other"};
    return {printable_line(names[0]), printable_line(names[1])};
}

}  // namespace

cachesim::Explanation begin_explanation(const ExplainedPair& pair, const cachesim::Gpu& gpu, cachesim::GroupBy by) {
    check_comparable(pair);
    const Provenance& first = pair[0].header->provenance;
    cachesim::Explanation explanation;
    explanation.scene = printable_line(first.scene);
    explanation.gpu = gpu.name;
    explanation.spp = first.spp;
    explanation.sector_bytes = gpu.l1().sector_bytes;
    explanation.by = by;
    const auto names = names_of(pair);
    explanation.base.name = names[0];
    explanation.other.name = names[1];
    return explanation;
}

void predict_speed_ups(cachesim::Explanation& explanation, const cachesim::Gpu& gpu, std::size_t launches) {
    explanation.no_time = cachesim::no_time_note(gpu);
    if (!explanation.no_time.empty()) return;
    explanation.traversal = cachesim::traversal_name(gpu);
    const std::vector<double> none(launches);
    for (const cachesim::NamedIdeal& ideal : cachesim::idealised_replays())
        explanation.speed_ups.push_back({ideal, {}, {}, none, none});
}

}  // namespace raycache::tools
