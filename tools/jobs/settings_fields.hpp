// The keys of jobs' settings. docs/jobs.md describes them for readers.
#pragma once

#include <map>
#include <string>

#include "tools/jobs/fields.hpp"
#include "tools/jobs/job_text.hpp"

namespace raycache::tools {

template <>
struct Fields<SceneSettings> {
    using S = SceneSettings;
    static constexpr std::tuple all{Field{"source", &S::source},   Field{"detail", &S::detail},
                                    Field{"camera", &S::camera},   Field{"eye", &S::eye},
                                    Field{"look_at", &S::look_at}, Field{"fov", &S::fov},
                                    Field{"sky", &S::sky},         Field{"spatial_splits", &S::spatial_splits},
                                    Field{"layout", &S::layout},   Field{"bvh_cache", &S::bvh_cache}};
};

/// Texts by name: {"radius": "0.5", …}
template <>
struct Codec<std::map<std::string, std::string>> {
    static Json write(const std::map<std::string, std::string>& texts) {
        Json object = Json::object();
        for (const auto& [name, text] : texts)
            if (!text.empty()) object[name] = text;
        return object;
    }
    static void read(const Reader& reader, const Json& json, const std::string& place,
                     std::map<std::string, std::string>& out) {
        if (!json.is_object()) reader.wrong(place, "an object {…}", json);
        for (const auto& [name, value] : json.items()) reader.read(value, join_places(place, name), out[name]);
    }
};

template <>
struct Fields<SamplingSettings> {
    using S = SamplingSettings;
    static constexpr std::tuple all{Field{"resolution", &S::resolution},
                                    Field{"bounces", &S::bounces},
                                    Field{"bounces_diffuse", &S::bounces_diffuse},
                                    Field{"bounces_transmission", &S::bounces_transmission},
                                    Field{"lights", &S::lights},
                                    Field{"russian_roulette", &S::russian_roulette},
                                    Field{"integrator", &S::integrator},
                                    Field{"integrator_parameters", &S::integrator_parameters},
                                    Field{"k", &S::k},
                                    Field{"s", &S::s},
                                    Field{"mu", &S::mu},
                                    Field{"cycles_multiplier", &S::cycles_multiplier},
                                    Field{"cycles_min_samples", &S::cycles_min_samples},
                                    Field{"cycles_noise_threshold", &S::cycles_noise_threshold},
                                    Field{"interleave", &S::interleave},
                                    Field{"share", &S::share},
                                    Field{"share_bits", &S::share_bits},
                                    Field{"parameters", &S::parameters},
                                    Field{"seed", &S::seed},
                                    Field{"trace_samples", &S::trace_samples},
                                    Field{"thread_map", &S::thread_map},
                                    Field{"execution", &S::execution},
                                    Field{"order", &S::order}};
};

/// A text. What no registry has is refused when the job is run.
template <>
struct Codec<tracer::StrategyName> {
    static Json write(const tracer::StrategyName& name) { return to_string(name); }
    static void read(const Reader& reader, const Json& json, const std::string& place, tracer::StrategyName& out) {
        std::string text;
        reader.read(json, place, text);
        out = tracer::parse_strategy_name(text);
    }
};

template <>
struct Fields<CaseSettings> {
    using S = CaseSettings;
    static constexpr std::tuple all{Field{"strategy", &S::strategy}, Field{"sequence", &S::sequence},
                                    Field{"spp", &S::spp}, Field{"k", &S::k}, Field{"mu", &S::mu}};
};

template <>
struct Fields<GpuSettings> {
    using S = GpuSettings;
    static constexpr std::tuple all{Field{"names", &S::names}, Field{"changes", &S::changes},
                                    Field{"l1_kib", &S::l1_kib}, Field{"l2_kib", &S::l2_kib},
                                    Field{"warps_per_sm", &S::warps_per_sm}};
};

template <>
struct Fields<LaunchSettings> {
    using S = LaunchSettings;
    static constexpr std::tuple all{Field{"traces", &S::traces}, Field{"scene", &S::scene},
                                    Field{"sampling", &S::sampling}, Field{"cases", &S::cases}};
};

template <>
struct EnumNames<cachesim::GroupBy> {
    static constexpr std::array all{
        std::pair{cachesim::GroupBy::none, "none"}, std::pair{cachesim::GroupBy::bounce, "bounce"},
        std::pair{cachesim::GroupBy::ray, "ray"}, std::pair{cachesim::GroupBy::object, "object"}};
};

template <>
struct Fields<CaptureJob> {
    using S = CaptureJob;
    static constexpr std::tuple all{Field{"scene", &S::scene}, Field{"sampling", &S::sampling},
                                    Field{"case", &S::strategy}, Field{"output", &S::output},
                                    Field{"gpu_package", &S::gpu_package}};
};

template <>
struct Fields<RenderJob> {
    using S = RenderJob;
    static constexpr std::tuple all{Field{"scene", &S::scene},   Field{"sampling", &S::sampling},
                                    Field{"case", &S::strategy}, Field{"exposure", &S::exposure},
                                    Field{"clamp", &S::clamp},   Field{"output", &S::output}};
};

template <>
struct Fields<SamplesJob> {
    using S = SamplesJob;
    static constexpr std::tuple all{Field{"sampling", &S::sampling}, Field{"case", &S::strategy},
                                    Field{"dimensions", &S::dimensions}, Field{"copies", &S::copies}};
};

template <>
struct EnumNames<Fidelity> {
    static constexpr std::array all{std::pair{Fidelity::windows, "windows"}, std::pair{Fidelity::automatic, "auto"},
                                    std::pair{Fidelity::exact, "exact"}};
};

template <>
struct Fields<EstimateSettings> {
    using S = EstimateSettings;
    static constexpr std::tuple all{Field{"windows", &S::windows},
                                    Field{"target_error", &S::target_error},
                                    Field{"time_budget", &S::time_budget},
                                    Field{"window_count", &S::window_count},
                                    Field{"baseline", &S::baseline},
                                    Field{"across_gpus", &S::across_gpus},
                                    Field{"cold_launches", &S::cold_launches},
                                    Field{"fidelity", &S::fidelity}};
};

template <>
struct Fields<ReplayJob> {
    using S = ReplayJob;
    static constexpr std::tuple all{Field{"launches", &S::launches}, Field{"gpu", &S::gpu}, Field{"timed", &S::timed},
                                    Field{"estimate", &S::estimate}};
};

template <>
struct Fields<ExplainJob> {
    using S = ExplainJob;
    static constexpr std::tuple all{
        Field{"launches", &S::launches}, Field{"gpu", &S::gpu},       Field{"by", &S::by},
        Field{"timed", &S::timed},       Field{"pixels", &S::pixels}, Field{"estimate", &S::estimate}};
};

template <>
struct Fields<QualityJob> {
    using S = QualityJob;
    static constexpr std::tuple all{Field{"scene", &S::scene},
                                    Field{"sampling", &S::sampling},
                                    Field{"cases", &S::cases},
                                    Field{"gpu", &S::gpu},
                                    Field{"baseline", &S::baseline},
                                    Field{"reference_spp", &S::reference_spp},
                                    Field{"reference_strategy", &S::reference_strategy},
                                    Field{"reference_file", &S::reference_file},
                                    Field{"repeats", &S::repeats},
                                    Field{"clamp", &S::clamp},
                                    Field{"pairs", &S::pairs},
                                    Field{"equal_time", &S::equal_time},
                                    Field{"estimate", &S::estimate},
                                    Field{"time_resolution", &S::time_resolution}};
};

}  // namespace raycache::tools
