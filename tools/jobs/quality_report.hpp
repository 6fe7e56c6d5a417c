// What was found about pictures, as a table for people, JSON and CSV.
#pragma once

#include <string>
#include <vector>

#include "tools/jobs/measure_quality.hpp"
#include "tools/jobs/subject.hpp"
#include "tracer/quality/sweep_rule.hpp"

namespace raycache::tools {

struct QualityReport {
    std::string scene, baseline, gpu;  ///< gpu: empty where no time was predicted
    std::string time_resolution;       ///< of the picture that times are of; empty: that of the pictures
    std::string reference_path;        ///< empty where it is not kept
    std::uint64_t reference_spp = 0, repeats = 1;
    std::optional<float> clamp;
    std::uint32_t width = 0, height = 0;
    std::vector<QualityRow> rows;
    std::vector<std::string> notes;
    Subject subject;
};

/// Which mu a sweep advises, and what it accepted.
struct Recommendation {
    std::string text;  ///< one line
    tracer::SweepAdvice advice;
    tracer::SweepLimits limits;
};

/// What to call a row among all: the strategy, with sequence, N and mu where rows differ in them.
std::string label(const QualityRow&, const std::vector<QualityRow>& all);

/// Adds a note for each row whose error the reference hides or a few pixels decide, and for Blender's defaults.
void add_notes(QualityReport&);

std::string to_text(const QualityReport&, std::size_t width);
/// `recommendation`: of a sweep; may be left out.
std::string to_json(const QualityReport&, const Recommendation* recommendation = nullptr);
std::string to_csv(const QualityReport&);

}  // namespace raycache::tools
