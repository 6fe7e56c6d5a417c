// The keys of jobs' results: every member of the plain values in them.
#pragma once

#include <algorithm>
#include <string_view>

#include "tools/jobs/settings_fields.hpp"

namespace raycache::tools {

template <>
struct Fields<Subject> {
    using S = Subject;
    static constexpr std::tuple all{Field{"gpus", &S::gpus}, Field{"traces", &S::traces}};
};

template <>
struct Fields<CaptureResult> {
    using S = CaptureResult;
    static constexpr std::tuple all{Field{"trace", &S::trace}, Field{"warps", &S::warps}, Field{"rays", &S::rays}};
};

template <>
struct Fields<RenderResult> {
    using S = RenderResult;
    static constexpr std::tuple all{Field{"width", &S::width}, Field{"height", &S::height},
                                    Field{"exposure", &S::exposure}};
};

// Counts of a functional replay.

template <>
struct Fields<cachesim::LevelCounts> {
    using S = cachesim::LevelCounts;
    static constexpr std::tuple all{Field{"sectors", &S::sectors}, Field{"hits", &S::hits}};
};

template <>
struct Fields<cachesim::Counters> {
    using S = cachesim::Counters;
    static constexpr std::tuple all{Field{"rays", &S::rays},
                                    Field{"steps", &S::steps},
                                    Field{"lane_accesses", &S::lane_accesses},
                                    Field{"warp_accesses", &S::warp_accesses},
                                    Field{"loads", &S::loads},
                                    Field{"requests", &S::requests},
                                    Field{"levels", &S::levels},
                                    Field{"dram_sectors", &S::dram_sectors},
                                    Field{"written_sectors", &S::written_sectors},
                                    Field{"sort_sectors", &S::sort_sectors},
                                    Field{"dram_first_sectors", &S::dram_first_sectors}};
};

template <>
struct EnumNames<traces::RayType> {
    static constexpr std::array all{std::pair{traces::RayType::camera, "camera"},
                                    std::pair{traces::RayType::bounce, "bounce"},
                                    std::pair{traces::RayType::shadow, "shadow"}};
};

template <>
struct Fields<cachesim::RayGroup> {
    using S = cachesim::RayGroup;
    static constexpr std::tuple all{Field{"ray", &S::ray}, Field{"bounce", &S::bounce}, Field{"by_kind", &S::by_kind},
                                    Field{"rays", &S::rays}};
};

template <>
struct Fields<cachesim::LaunchStatistics> {
    using S = cachesim::LaunchStatistics;
    static constexpr std::tuple all{Field{"sample", &S::sample}, Field{"groups", &S::groups}};
};

template <>
struct Fields<cachesim::CacheUnits> {
    using S = cachesim::CacheUnits;
    static constexpr std::tuple all{Field{"levels", &S::levels}, Field{"sector_bytes", &S::sector_bytes}};
};

template <>
struct Fields<cachesim::WindowSample> {
    using S = cachesim::WindowSample;
    static constexpr std::tuple all{Field{"blocks", &S::blocks},
                                    Field{"indices", &S::indices},
                                    Field{"windows", &S::windows},
                                    Field{"timed_windows", &S::timed_windows},
                                    Field{"widening", &S::widening},
                                    Field{"unfilled_share", &S::unfilled_share},
                                    Field{"last_cache_full", &S::last_cache_full},
                                    Field{"all_indices", &S::all_indices}};
};

template <>
struct Fields<cachesim::Origin> {
    using S = cachesim::Origin;
    static constexpr std::tuple all{Field{"scene", &S::scene},
                                    Field{"strategy", &S::strategy},
                                    Field{"sequence", &S::sequence},
                                    Field{"parameters", &S::parameters},
                                    Field{"thread_map", &S::thread_map},
                                    Field{"gpu", &S::gpu},
                                    Field{"spp", &S::spp},
                                    Field{"caches", &S::caches},
                                    Field{"windows", &S::windows},
                                    Field{"indices", &S::indices}};
};

template <>
struct Fields<cachesim::Series> {
    static constexpr std::tuple all =
        std::tuple_cat(Fields<cachesim::Origin>::all, std::tuple{Field{"launches", &cachesim::Series::launches}});
};

// A replay in time.

template <>
struct Fields<cachesim::LevelAnswers> {
    using S = cachesim::LevelAnswers;
    static constexpr std::tuple all{Field{"hits", &S::hits}, Field{"merges", &S::merges},
                                    Field{"line_misses", &S::line_misses}, Field{"sector_misses", &S::sector_misses}};
};

template <>
struct Fields<cachesim::TimedStatistics::Resource> {
    using S = cachesim::TimedStatistics::Resource;
    static constexpr std::tuple all{Field{"busy", &S::busy}, Field{"copies", &S::copies}};
};

template <>
struct Fields<cachesim::TimedStatistics> {
    using S = cachesim::TimedStatistics;
    static constexpr std::tuple all{Field{"sample", &S::sample},
                                    Field{"cycles", &S::cycles},
                                    Field{"seconds", &S::seconds},
                                    Field{"rays", &S::rays},
                                    Field{"warp_accesses", &S::warp_accesses},
                                    Field{"lane_accesses", &S::lane_accesses},
                                    Field{"instructions", &S::instructions},
                                    Field{"loads", &S::loads},
                                    Element{"l1", &S::levels, 0},
                                    Element{"l2", &S::levels, 1},
                                    Element{"l3", &S::levels, 2},
                                    Field{"dram_sectors", &S::dram_sectors},
                                    Field{"issue", &S::issue},
                                    Field{"l1_port", &S::l1_port},
                                    Field{"crossbar", &S::crossbar},
                                    Field{"l2_slices", &S::l2_slices},
                                    Field{"dram", &S::dram},
                                    Field{"l1_tags", &S::l1_tags},
                                    Field{"l1_data", &S::l1_data},
                                    Field{"l1_mshrs", &S::l1_mshrs},
                                    Field{"l2_mshrs", &S::l2_mshrs},
                                    Field{"rt_loads", &S::rt_loads},
                                    Field{"rt_box_tests", &S::rt_box_tests},
                                    Field{"rt_triangle_tests", &S::rt_triangle_tests},
                                    Field{"rt_warps", &S::rt_warps},
                                    Field{"visit_cycles", &S::visit_cycles},
                                    Field{"warps", &S::warps},
                                    Field{"warp_cycles", &S::warp_cycles},
                                    Field{"warp_slots", &S::warp_slots},
                                    Field{"peak_l2_gb_s", &S::peak_l2_gb_s},
                                    Field{"peak_dram_gb_s", &S::peak_dram_gb_s}};
};

template <>
struct Fields<cachesim::Estimate> {
    using S = cachesim::Estimate;
    static constexpr std::tuple all{Field{"mean", &S::mean}, Field{"half_width", &S::half_width}};
};

template <>
struct Fields<cachesim::TimedSeries> {
    using S = cachesim::TimedSeries;
    static constexpr std::tuple all = std::tuple_cat(
        Fields<cachesim::Origin>::all, std::tuple{Field{"no_time", &S::no_time}, Field{"traversal", &S::traversal},
                                                  Field{"launches", &S::launches}, Field{"speed_up", &S::speed_up}});
};

template <>
struct Fields<cachesim::LaunchStages::Stage> {
    using S = cachesim::LaunchStages::Stage;
    static constexpr std::tuple all{Field{"cycles", &S::cycles}, Field{"warp_accesses", &S::warp_accesses}};
};

template <>
struct Fields<cachesim::LaunchStages> {
    using S = cachesim::LaunchStages;
    static constexpr std::tuple all{Field{"sample", &S::sample}, Field{"filling", &S::filling}, Field{"full", &S::full},
                                    Field{"draining", &S::draining}};
};

template <>
struct Fields<cachesim::ColdLaunches> {
    using S = cachesim::ColdLaunches;
    static constexpr std::tuple all{Field{"launches", &S::launches}, Field{"stages", &S::stages}};
};

template <>
struct Fields<cachesim::FidelityChoice::Level> {
    using S = cachesim::FidelityChoice::Level;
    static constexpr std::tuple all{Field{"name", &S::name}, Field{"timed_blocks", &S::timed_blocks},
                                    Field{"blocks", &S::blocks}, Field{"seconds", &S::seconds},
                                    Field{"suffices", &S::suffices}};
};

template <>
struct Fields<cachesim::FidelityChoice::Pilot> {
    using S = cachesim::FidelityChoice::Pilot;
    static constexpr std::tuple all{Field{"strategy", &S::strategy}, Field{"gpu", &S::gpu},
                                    Field{"spp", &S::spp},           Field{"by_work", &S::by_work},
                                    Field{"by_time", &S::by_time},   Field{"difference", &S::difference}};
};

template <>
struct Fields<cachesim::FidelityChoice> {
    using S = cachesim::FidelityChoice;
    static constexpr std::tuple all{Field{"picked", &S::picked},
                                    Field{"reason", &S::reason},
                                    Field{"target", &S::target},
                                    Field{"pilot_blocks", &S::pilot_blocks},
                                    Field{"pilot_seconds", &S::pilot_seconds},
                                    Field{"levels", &S::levels},
                                    Field{"pilots", &S::pilots}};
};

template <>
struct Fields<ReplayResult> {
    using S = ReplayResult;
    static constexpr std::tuple all{Field{"subject", &S::subject}, Field{"series", &S::series},
                                    Field{"times", &S::times}, Field{"cold", &S::cold},
                                    Field{"fidelity", &S::fidelity}};
};

// An explanation.

template <>
struct Fields<cachesim::MissCounts> {
    using S = cachesim::MissCounts;
    static constexpr std::tuple all{Field{"lookups", &S::lookups}, Field{"compulsory", &S::compulsory},
                                    Field{"capacity", &S::capacity}, Field{"conflict", &S::conflict},
                                    Field{"lucky_hits", &S::lucky_hits}};
};

/// By their index; most of them are nothing and left out.
template <>
struct Codec<std::vector<cachesim::MissCounts>> {
    using List = std::vector<cachesim::MissCounts>;
    static Json write(const List& list) {
        Json counts = Json::object();
        for (std::size_t i = 0; i < list.size(); ++i)
            if (list[i] != cachesim::MissCounts{}) counts[std::to_string(i)] = write_value(list[i]);
        return {{"size", list.size()}, {"counts", counts}};
    }
    static void read(const Reader& reader, const Json& json, const std::string& place, List& list) {
        constexpr std::size_t most = 1 << 16;  // far above any: a damaged file must not take all memory
        const bool whole = json.is_object() && json.contains("counts") && json["counts"].is_object() &&
                           json.contains("size") && json["size"].is_number_unsigned() && json["size"] <= most;
        if (!whole) reader.wrong(place, "{\"size\": N, \"counts\": {…}}", json);
        list.assign(json["size"].get<std::size_t>(), {});
        for (const auto& [key, value] : json["counts"].items()) {
            const bool digits = key.find_first_not_of("0123456789") == std::string::npos && !key.empty();
            const std::size_t index = digits && key.size() < 6 ? std::stoul(key) : most;
            if (index >= list.size()) reader.wrong(place + ".counts", "an index below the size", key);
            reader.read(value, place + ".counts." + key, list[index]);
        }
    }
};

template <>
struct Fields<cachesim::LevelFindings> {
    using S = cachesim::LevelFindings;
    static constexpr std::tuple all{Field{"by_group", &S::by_group}, Field{"by_depth", &S::by_depth}};
};

template <>
struct Fields<cachesim::Sharing> {
    using S = cachesim::Sharing;
    static constexpr std::tuple all{Field{"same_warp", &S::same_warp}, Field{"same_cta", &S::same_cta},
                                    Field{"other_cta", &S::other_cta}};
};

template <>
struct Fields<cachesim::Findings> {
    using S = cachesim::Findings;
    static constexpr std::tuple all{Field{"levels", &S::levels}, Field{"sharing", &S::sharing}};
};

template <>
struct Fields<cachesim::ExplainedTrace> {
    using S = cachesim::ExplainedTrace;
    static constexpr std::tuple all{Field{"name", &S::name}, Field{"launches", &S::launches},
                                    Field{"findings", &S::findings}};
};

/// By its name.
template <>
struct Codec<cachesim::NamedIdeal> {
    static Json write(const cachesim::NamedIdeal& ideal) { return ideal.name; }
    static void read(const Reader& reader, const Json& json, const std::string& place, cachesim::NamedIdeal& ideal) {
        const auto known = cachesim::idealised_replays();
        const auto at = std::find_if(known.begin(), known.end(), [&](const cachesim::NamedIdeal& one) {
            return json.is_string() && json.get<std::string>() == one.name;
        });
        if (at == known.end()) reader.wrong(place, "the name of an idealised replay", json);
        ideal = *at;
    }
};

template <>
struct Fields<cachesim::SpeedUp> {
    using S = cachesim::SpeedUp;
    static constexpr std::tuple all{Field{"replay", &S::replay},
                                    Field{"base", &S::base},
                                    Field{"other", &S::other},
                                    Field{"base_cycles", &S::base_cycles},
                                    Field{"other_cycles", &S::other_cycles},
                                    Field{"widening", &S::widening}};
};

template <>
struct Fields<cachesim::Explanation> {
    using S = cachesim::Explanation;
    static constexpr std::tuple all{Field{"scene", &S::scene},     Field{"gpu", &S::gpu},
                                    Field{"spp", &S::spp},         Field{"sector_bytes", &S::sector_bytes},
                                    Field{"by", &S::by},           Field{"base", &S::base},
                                    Field{"other", &S::other},     Field{"speed_ups", &S::speed_ups},
                                    Field{"no_time", &S::no_time}, Field{"traversal", &S::traversal},
                                    Field{"windows", &S::windows}};
};

template <>
struct Fields<HeatMap> {
    using S = HeatMap;
    static constexpr std::tuple all{Field{"name", &S::name},
                                    Field{"lanes", &S::lanes},
                                    Field{"width", &S::width},
                                    Field{"height", &S::height},
                                    Field{"dram_bytes", &S::dram_bytes},
                                    Field{"l1_miss_rate", &S::l1_miss_rate},
                                    Field{"active_lanes", &S::active_lanes}};
};

template <>
struct Fields<ExplainResult> {
    using S = ExplainResult;
    static constexpr std::tuple all{Field{"subject", &S::subject}, Field{"explanation", &S::explanation},
                                    Field{"maps", &S::maps}};
};

}  // namespace raycache::tools
