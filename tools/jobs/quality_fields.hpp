// The keys of the results of quality and samples jobs.
#pragma once

#include "tools/jobs/result_fields.hpp"

namespace raycache::tools {

template <>
struct EnumNames<tracer::ThreadMap> {
    static constexpr std::array all{
        std::pair{tracer::ThreadMap::tile, "tile"}, std::pair{tracer::ThreadMap::samples, "samples"},
        std::pair{tracer::ThreadMap::rows, "rows"}, std::pair{tracer::ThreadMap::classes, "classes"}};
};

template <>
struct EnumNames<tracer::Execution> {
    static constexpr std::array all{std::pair{tracer::Execution::megakernel, "megakernel"},
                                    std::pair{tracer::Execution::wavefront, "wavefront"}};
};

template <>
struct EnumNames<tracer::LightSampling> {
    static constexpr std::array all{
        std::pair{tracer::LightSampling::automatic, "auto"}, std::pair{tracer::LightSampling::bsdf, "bsdf"},
        std::pair{tracer::LightSampling::nee, "nee"}, std::pair{tracer::LightSampling::mis, "mis"}};
};

/// {"k": "2.5", …}
template <>
struct Codec<tracer::Parameters> {
    static Json write(const tracer::Parameters& parameters) {
        Json object = Json::object();
        for (const auto& [name, value] : parameters.given()) object[name] = value;
        return object;
    }
    static void read(const Reader& reader, const Json& json, const std::string& place, tracer::Parameters& out) {
        if (!json.is_object()) reader.wrong(place, "an object {…}", json);
        for (const auto& [name, value] : json.items()) {
            std::string text;
            reader.read(value, join_places(place, name), text);
            out.set(name, text);
        }
    }
};

template <>
struct Fields<tracer::PathSettings> {
    using S = tracer::PathSettings;
    static constexpr std::tuple all{Field{"bounces", &S::bounces},
                                    Field{"russian_roulette", &S::russian_roulette},
                                    Field{"bounces_diffuse", &S::bounces_diffuse},
                                    Field{"bounces_transmission", &S::bounces_transmission},
                                    Field{"lights", &S::lights},
                                    Field{"integrator", &S::integrator},
                                    Field{"parameters", &S::parameters}};
};

template <>
struct Fields<tracer::SampleSet> {
    using S = tracer::SampleSet;
    static constexpr std::tuple all{Field{"spp", &S::spp}, Field{"seed", &S::seed}, Field{"dimensions", &S::dimensions},
                                    Field{"width", &S::width}};
};

template <>
struct Fields<tracer::StrategySettings> {
    using S = tracer::StrategySettings;
    static constexpr std::tuple all{Field{"sequence", &S::sequence}, Field{"decorrelation", &S::decorrelation},
                                    Field{"samples", &S::samples}, Field{"parameters", &S::parameters},
                                    Field{"independent_pair", &S::independent_pair}};
};

template <>
struct Fields<tracer::ExecutionSettings> {
    using S = tracer::ExecutionSettings;
    static constexpr std::tuple all{Field{"execution", &S::execution}, Field{"order", &S::order}};
};

template <>
struct Fields<tracer::CaptureSettings> {
    using S = tracer::CaptureSettings;
    static constexpr std::tuple all{Field{"width", &S::width},
                                    Field{"height", &S::height},
                                    Field{"paths", &S::paths},
                                    Field{"strategy", &S::strategy},
                                    Field{"trace_samples", &S::trace_samples},
                                    Field{"thread_map", &S::thread_map},
                                    Field{"execution", &S::execution},
                                    Field{"program", &S::program},
                                    Field{"command", &S::command}};
};

template <>
struct Fields<tracer::Measured> {
    using S = tracer::Measured;
    static constexpr std::tuple all{Field{"value", &S::value}, Field{"half_width", &S::half_width},
                                    Field{"below", &S::below}, Field{"above", &S::above},
                                    Field{"reference_share", &S::reference_share}};
};

template <>
struct Fields<tracer::FewPixels> {
    using S = tracer::FewPixels;
    static constexpr std::tuple all{Field{"count", &S::count}, Field{"share", &S::share},
                                    Field{"largest", &S::largest}};
};

template <>
struct Fields<tracer::ErrorSums::Blocks> {
    using S = tracer::ErrorSums::Blocks;
    static constexpr std::tuple all{Field{"columns", &S::columns}, Field{"rows", &S::rows}, Field{"mean", &S::mean}};
};

/// pixel_square is empty in a result.
template <>
struct Fields<tracer::ErrorSums> {
    using S = tracer::ErrorSums;
    static constexpr std::tuple all{Field{"seeds", &S::seeds}, Field{"reference", &S::reference},
                                    Field{"noise", &S::noise}, Field{"blocks", &S::blocks}};
};

template <>
struct Fields<tracer::ErrorMeasures> {
    using S = tracer::ErrorMeasures;
    static constexpr std::tuple all{Field{"rmse", &S::rmse},
                                    Field{"relative_rmse", &S::relative_rmse},
                                    Field{"robust_rmse", &S::robust_rmse},
                                    Field{"r8", &S::r8},
                                    Field{"block_rmse", &S::block_rmse},
                                    Field{"mean_error", &S::mean_error},
                                    Field{"reference_rmse", &S::reference_rmse},
                                    Field{"reference_luminance", &S::reference_luminance},
                                    Field{"structured_mse", &S::structured_mse},
                                    Field{"z_pixels", &S::z_pixels},
                                    Field{"z_seeds", &S::z_seeds},
                                    Field{"few_pixels", &S::few_pixels},
                                    Field{"sums", &S::sums}};
};

template <>
struct Fields<tracer::RmseRatio> {
    using S = tracer::RmseRatio;
    static constexpr std::tuple all{Field{"value", &S::value}, Field{"robust", &S::robust},
                                    Field{"decided_by_pixels", &S::decided_by_pixels},
                                    Field{"baseline_is_zero", &S::baseline_is_zero}};
};

template <>
struct Fields<PairEffect> {
    using S = PairEffect;
    static constexpr std::tuple all{Field{"pair", &S::pair}, Field{"share", &S::share}};
};

template <>
struct Fields<QualityRow::Timing> {
    using S = QualityRow::Timing;
    static constexpr std::tuple all{Field{"seconds", &S::seconds}, Field{"speed_up", &S::speed_up},
                                    Field{"windows", &S::windows}};
};

template <>
struct Fields<QualityRow::EqualTime> {
    using S = QualityRow::EqualTime;
    static constexpr std::tuple all{Field{"spp", &S::spp}, Field{"errors", &S::errors}};
};

template <>
struct Fields<EqualError> {
    using S = EqualError;
    static constexpr std::tuple all{Field{"baseline", &S::baseline}, Field{"speed_up", &S::speed_up},
                                    Field{"ratio", &S::ratio}, Field{"gain", &S::gain}};
};

template <>
struct Fields<QualityRow> {
    using S = QualityRow;
    static constexpr std::tuple all{Field{"settings", &S::settings},
                                    Field{"parameters", &S::parameters},
                                    Field{"errors", &S::errors},
                                    Field{"baseline", &S::baseline},
                                    Field{"ratio", &S::ratio},
                                    Field{"pairs", &S::pairs},
                                    Field{"timing", &S::timing},
                                    Field{"equal_time", &S::equal_time},
                                    Field{"equal_error", &S::equal_error},
                                    Field{"no_equal_error", &S::no_equal_error}};
};

template <>
struct Fields<QualityReport> {
    using S = QualityReport;
    static constexpr std::tuple all{Field{"scene", &S::scene},
                                    Field{"baseline", &S::baseline},
                                    Field{"gpu", &S::gpu},
                                    Field{"time_resolution", &S::time_resolution},
                                    Field{"reference_path", &S::reference_path},
                                    Field{"reference_spp", &S::reference_spp},
                                    Field{"repeats", &S::repeats},
                                    Field{"clamp", &S::clamp},
                                    Field{"width", &S::width},
                                    Field{"height", &S::height},
                                    Field{"rows", &S::rows},
                                    Field{"notes", &S::notes},
                                    Field{"subject", &S::subject}};
};

template <>
struct Codec<tracer::FixedPoint2> {
    static Json write(const tracer::FixedPoint2& point) { return {point.x, point.y}; }
    static void read(const Reader& reader, const Json& json, const std::string& place, tracer::FixedPoint2& point) {
        std::array<std::uint32_t, 2> both{};
        reader.read(json, place, both);
        point = {both[0], both[1]};
    }
};

template <>
struct Fields<tracer::UnionDensity::Level> {
    using S = tracer::UnionDensity::Level;
    static constexpr std::tuple all{Field{"covered_by", &S::covered_by}, Field{"density", &S::density},
                                    Field{"area", &S::area}};
};

template <>
struct Fields<tracer::UnionDensity> {
    using S = tracer::UnionDensity;
    static constexpr std::tuple all{Field{"min", &S::min}, Field{"max", &S::max}, Field{"mean_square", &S::mean_square},
                                    Field{"levels", &S::levels}};
};

template <>
struct Fields<SampleUnion> {
    using S = SampleUnion;
    static constexpr std::tuple all{Field{"strategy", &S::strategy},
                                    Field{"first_dimension", &S::first_dimension},
                                    Field{"second_dimension", &S::second_dimension},
                                    Field{"copies", &S::copies},
                                    Field{"parameters", &S::parameters},
                                    Field{"warnings", &S::warnings},
                                    Field{"base", &S::base},
                                    Field{"points", &S::points},
                                    Field{"mu", &S::mu},
                                    Field{"base_hole", &S::base_hole},
                                    Field{"union_hole", &S::union_hole},
                                    Field{"hole_free_k", &S::hole_free_k},
                                    Field{"discrepancy", &S::discrepancy},
                                    Field{"density", &S::density}};
};

template <>
struct Fields<SamplesResult> {
    using S = SamplesResult;
    static constexpr std::tuple all{Field{"samples", &S::samples}};
};

template <>
struct Fields<QualityResult> {
    using S = QualityResult;
    static constexpr std::tuple all{Field{"report", &S::report}};
};

}  // namespace raycache::tools
