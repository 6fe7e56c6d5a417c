// The rule by which a sweep advises a mu, on made-up figures.
#include <catch2/catch.hpp>
#include <cmath>

#include "tracer/quality/sweep_rule.hpp"

namespace raycache::tracer {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Measured figure(double value, double half_width, double reference_share = 0) {
    return {value, half_width, {}, {}, reference_share};
}
SweepPoint point(double mu, Measured r8, Measured ratio) { return {mu, r8, {ratio, ratio, {}, false}}; }

const SweepLimits limits{2, 1.1};
const SweepEffort effort{4, 256};

}  // namespace

TEST_CASE("sweep: the least mu that is accepted together with all larger ones is advised", "[quality]") {
    const auto good = [](double mu) { return point(mu, figure(1.1, 0.2), figure(0.95, 0.05)); };
    const auto bad = [](double mu) { return point(mu, figure(9, 1), figure(0.95, 0.05)); };
    const SweepAdvice advice = advise({bad(0.1), good(0.5), good(1), good(0.25)}, limits, effort);
    CHECK(advice.mu == 0.25);
    CHECK(advice.blocked_by == 0.1);
    CHECK(advice.why.verdict == Verdict::rejected);
    CHECK_THAT(advice.why.reason, Catch::Contains("R8 9.00 ±1.00, at most 2"));
    // A lucky small one amid bad ones does not count.
    CHECK(advise({good(0.05), bad(0.1), good(0.5)}, limits, effort).mu == 0.5);
    CHECK_FALSE(advise({bad(0.5), good(0.1)}, limits, effort).mu);
    CHECK_FALSE(advise({good(0.5), good(0.1)}, limits, effort).blocked_by);
}

TEST_CASE("sweep: an interval across a limit is too noisy to say, and the root law says how many would tell",
          "[quality]") {
    const Judgement r8 = judge(point(0.5, figure(1.5, 1.0), figure(1, 0.01)), limits, effort);
    CHECK(r8.verdict == Verdict::unclear);
    REQUIRE(r8.raise);
    CHECK(r8.raise->text() == "raise --repeats from 4 to 16");  // half of 1.0 needs four times as many
    const Judgement ratio = judge(point(0.5, figure(1, 0.1), figure(1.0, 0.3)), limits, effort);
    CHECK(ratio.verdict == Verdict::unclear);
    CHECK(ratio.raise->to == 36);
    const Judgement reference = judge(point(0.5, figure(1.5, 1.0, 0.9), figure(1, 0.01)), limits, effort);
    CHECK(reference.raise->text() == "raise --reference-spp from 256 to 1100");
    // At the limit itself no number would do: a twentieth of it is enough.
    CHECK(judge(point(0.5, figure(2.0, 1.0), figure(1, 0.01)), limits, effort).raise->to == 400);
    CHECK(judge(point(0.5, figure(2.0, 100), figure(1, 0.01)), limits, effort).raise->to == 1024);
}

TEST_CASE("sweep: mu = 1 is Cranley-Patterson itself and never rejected by its own noise", "[quality]") {
    for (const Measured& r8 : {figure(9, 0.1), figure(1, 30), figure(nan, nan)})
        CHECK(judge(point(1, r8, figure(1.3, 0.01)), limits, effort).verdict == Verdict::accepted);
}

TEST_CASE("sweep: what the reference hides is accepted where its bound is, else asks for a better reference",
          "[quality]") {
    Measured hidden{nan, nan, 0.3, {}, 1};
    CHECK(judge(point(0.5, figure(nan, nan), hidden), limits, effort).verdict == Verdict::unclear);
    CHECK(judge(point(0.5, hidden, figure(1, 0.05)), limits, effort).verdict == Verdict::accepted);
    hidden.below = 3;
    const Judgement j = judge(point(0.5, hidden, figure(1, 0.05)), limits, effort);
    CHECK(j.verdict == Verdict::unclear);
    CHECK(j.raise->text() == "raise --reference-spp from 256 to 1024");
    CHECK(judge(point(0.5, figure(1, 0.1), {nan, nan, {}, 2.0, 0}), limits, effort).verdict == Verdict::rejected);
}

TEST_CASE("sweep: a baseline without error and a ranking by few pixels are named, not judged", "[quality]") {
    SweepPoint zero = point(0.5, figure(1, 0.1), figure(nan, nan));
    zero.ratio.baseline_is_zero = true;
    CHECK(judge(zero, limits, effort).reason == "not defined: the baseline's error is 0");
    SweepPoint few = point(0.5, figure(1, 0.1), figure(nan, nan));
    few.ratio.decided_by_pixels = 2;
    const Judgement j = judge(few, limits, effort);
    CHECK(j.verdict == Verdict::unclear);
    CHECK(j.reason == "RMSE decided by 2 pixels: use --clamp");
    CHECK_FALSE(j.raise);
}

TEST_CASE("figures in words never say nan or inf", "[quality]") {
    CHECK(measured_text(figure(1.234, 0.056), 2) == "1.23 ±0.06");
    CHECK(measured_text(figure(0.0089363, 0.00031), 4, true) == "0.008936 ±0.00031");
    CHECK(measured_text(figure(1.2, nan), 2) == "1.20");
    CHECK(measured_text({nan, nan, 0.0031, {}, 1}, 3) == "< 0.0031");
    CHECK(measured_text({nan, nan, {}, 2.41, 1}, 3) == "> 2.4");
    CHECK(measured_text(figure(nan, nan), 3) == "-");
    CHECK(raised(4, nan, 1) > 4);
    CHECK(raised(4, 1e300, 1e-300) > 4);
}

}  // namespace raycache::tracer
