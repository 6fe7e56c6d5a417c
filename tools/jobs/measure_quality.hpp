// From strategies to findings about their pictures: errors against a reference, and the time a GPU is predicted to
// take.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cachesim/gpus/gpu.hpp"
#include "cachesim/report/report.hpp"
#include "tools/jobs/equal_error.hpp"
#include "tools/jobs/observer.hpp"
#include "tools/jobs/outputs.hpp"
#include "tools/jobs/windows/estimate.hpp"
#include "tracer/capture.hpp"
#include "tracer/prepared_scene.hpp"
#include "tracer/quality/error_measures.hpp"
#include "tracer/quality/reference.hpp"

namespace raycache::tools {

struct QualityRequest {
    std::vector<tracer::CaptureSettings>
        cases;                  ///< all of one size and of equal paths; strategy, sequence, N, mu differ
    std::string baseline;       ///< strategy that ratios refer to; empty: none
    std::uint64_t repeats = 1;  ///< pictures of each case, with seeds one after the other
    bool pairs = false;         ///< also find the worst pair of dimensions: one more picture per pair
    bool equal_time = false;    ///< also render at the N that takes as long as the baseline; needs a GPU
    std::optional<cachesim::Gpu> gpu;
    EstimateSettings estimate;                      ///< of the times
    std::uint32_t time_width = 0, time_height = 0;  ///< of the picture that times are of; 0: that of the cases
    std::optional<float> clamp;                     ///< of each sample's radiance, as RenderSettings::clamp
};

/// What remains of the structured error (ErrorMeasures::structured_mse) when dimensions 2 pair and 2 pair + 1 are left
/// to independent random numbers.
struct PairEffect {
    std::uint32_t pair = 0;
    double share =
        0;  ///< by how much it falls, of the strategy's own: 1 = this pair alone carries it; NaN if there is none
};

struct QualityRow {
    tracer::CaptureSettings settings;
    std::string parameters;
    tracer::ErrorMeasures errors;            ///< without sums.pixel_square, as all that is kept
    std::optional<std::size_t> baseline;     ///< row of the same N, and of the same sequence where there is one
    std::optional<tracer::RmseRatio> ratio;  ///< to the baseline; absent without one
    std::vector<PairEffect> pairs;           ///< by pair; empty unless asked for

    struct Timing {
        double seconds = 0;                             ///< predicted for all N samples; NaN: no_time_note()
        std::optional<cachesim::Estimate> speed_up;     ///< over the baseline at equal N; absent without one
        std::optional<cachesim::WindowSample> windows;  ///< none: whole launches
    };
    std::optional<Timing> timing;
    struct EqualTime {
        std::uint64_t spp = 0;
        tracer::ErrorMeasures errors;
    };
    std::optional<EqualTime> equal_time;
    std::vector<EqualError>
        equal_error;             ///< against each of equal_error_baselines() and `baseline`; of a GPU with times
    std::string no_equal_error;  ///< no_equal_error() of its errors

    const tracer::StrategySettings& strategy() const { return settings.strategy; }
    std::uint64_t spp() const { return settings.strategy.samples.spp; }
    /// The pair with the largest share, if any has one.
    std::optional<PairEffect> worst_pair() const;
};

/// What was rendered, for who wants to see it.
struct QualityPictures {
    tracer::Image reference;
    std::vector<tracer::Image> rows;           ///< of each row's first seed
    std::vector<tracer::Image> at_equal_time;  ///< by row, at equal predicted time; empty unless asked for
};

/// Throws UsageError for settings out of range, before anything is rendered: call it before the scene is loaded.
void check(const QualityRequest&);

/// `pictures` gets those of rows and at_equal_time.
std::vector<QualityRow> measure_quality(const tracer::PreparedScene&, const tracer::Reference&, const QualityRequest&,
                                        Observer&, QualityPictures& pictures);

/// Tells `observer` what find_reference() and measure_quality() will take; `reference`: seconds for a new one.
void expect_stages(Observer&, const QualityRequest&, double reference);

/// From `file` if it is given and exists, else from the cache, else rendered and kept in that place. A damaged or
/// different file in the cache is replaced, with a warning; one that the user named is refused (Error). `path`: where
/// it lies now, empty if nowhere. A `file` that cannot be written is a failed delivery.
tracer::Reference find_reference(const tracer::PreparedScene&, const tracer::ReferenceSettings&,
                                 const std::string& file, std::string& path, Deliveries&, Observer&);

}  // namespace raycache::tools
