// Jobs and their results as text (JSON): settings in, a result out, and both read back.
//
//   const AnyJob job = parse_job(R"({"job": "replay", "launches": {"traces": ["mj.rct"]}, "gpu": {"names":
//   ["h100"]}})", "cell 7"); Observer silent; const std::string text = result_text(run(job, silent));
//
// The text of a job has every key, so that equal texts are equal jobs. A result does not depend on the number of
// threads and holds no time of day: equal jobs of equal files, equal texts (but for where the reference of quality is
// kept).
#pragma once

#include <string>
#include <variant>

#include "tools/jobs/capture_job.hpp"
#include "tools/jobs/explain_job.hpp"
#include "tools/jobs/quality_job.hpp"
#include "tools/jobs/render_job.hpp"
#include "tools/jobs/replay_job.hpp"
#include "tools/jobs/samples_job.hpp"

namespace raycache::tools {

using AnyJob = std::variant<CaptureJob, RenderJob, ReplayJob, ExplainJob, QualityJob, SamplesJob>;
/// Of the job of the same index.
using AnyResult = std::variant<CaptureResult, RenderResult, ReplayResult, ExplainResult, QualityResult, SamplesResult>;

/// "capture", "render", …: what the key "job" of its text says.
std::string job_name(const AnyJob&);

/// `source`: what the text is called in messages, such as its file's name. Throws Error "SOURCE: …" for what is no
/// JSON, for a key that the job does not have (with the one that was probably meant), one given twice and a value of
/// the wrong type. What is missing has its default. Values out of range are refused by run().
AnyJob parse_job(const std::string& text, const std::string& source);
std::string job_text(const AnyJob&);

/// As the run() of that job. What could not be delivered, such as a reference to its file, is an Error, too.
AnyResult run(const AnyJob&, Observer&);

/// Pictures are not in it: those of quality and heat maps are written to files (quality_pictures.hpp, heat_map.hpp).
std::string result_text(const AnyResult&);
/// Throws Error "SOURCE: …" for what result_text() does not write.
AnyResult parse_result(const std::string& text, const std::string& source);

}  // namespace raycache::tools
