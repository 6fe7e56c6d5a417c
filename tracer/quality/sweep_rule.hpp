// Which mu of a sweep has an acceptable picture: a rule that knows its intervals.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tracer/quality/error_measures.hpp"

namespace raycache::tracer {

struct SweepPoint {
    double mu = 0;
    Measured r8{};
    RmseRatio ratio;  ///< to Cranley-Patterson
};

struct SweepLimits {
    double r8 = 2, rmse_ratio = 1.1;  ///< at most
};

/// What was spent, and may be raised.
struct SweepEffort {
    std::uint64_t repeats = 1, reference_spp = 1024;
};

/// "raise OPTION from A to B": B by the law that half widths fall with the root of the number.
struct Raise {
    std::string option;  ///< "--repeats", "--reference-spp" or "--trace-samples"
    std::uint64_t from = 0, to = 0;
    std::string text() const;
};

/// How many, so that a half width seen with `from` becomes `wanted`, rounded up to two digits; at least
/// from + 1, at most about 2^40; twice as many where the half width is not known.
std::uint64_t raised(std::uint64_t from, double half_width, double wanted);

enum class Verdict { accepted, rejected, unclear };
struct Judgement {
    Verdict verdict = Verdict::accepted;
    std::string reason;  ///< of a rejection or a doubt, such as "R8 2.27 ±1.62, at most 2"; empty where accepted
    std::optional<Raise> raise;
};

/// Accepted where both intervals lie within the limits, rejected where one lies outside; in between it is not clear,
/// and more of something would tell. mu = 1 is Cranley-Patterson itself (but for a shift): without bias, without shared
/// error and with its RMSE whatever a test of finite length says, hence always accepted.
Judgement judge(const SweepPoint&, const SweepLimits&, const SweepEffort&);

struct SweepAdvice {
    std::optional<double> mu;          ///< the least that is accepted together with every larger one of the list
    std::optional<double> blocked_by;  ///< the next smaller one, which is not
    Judgement why;                     ///< of `blocked_by`
};
/// Precondition: at least one point; order does not matter.
SweepAdvice advise(std::vector<SweepPoint> points, const SweepLimits&, const SweepEffort&);

/// "1.02 ±0.03", "< 0.31", "> 2.4"; "-" where nothing is known. `significant`: digits of the value after the point, or
/// with `general` digits in all.
std::string measured_text(const Measured&, int digits, bool general = false);
/// The ratio, or why there is none: "decided by 3 pixels", "not defined: the baseline's error is 0", …
std::string ratio_text(const RmseRatio&);

}  // namespace raycache::tracer
