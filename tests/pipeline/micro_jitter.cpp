// The claim that started the project, as tests: micro-jitter against Cranley–Patterson at equal N and equal sample
// indices.
#include <boost/math/distributions/students_t.hpp>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>

#include "measure.hpp"

namespace {

using namespace raycache;
using namespace raycache::test;

struct MeanAndError {
    double mean = 0, standard_error = 0;
};

MeanAndError summarise(const std::vector<double>& values) {
    const auto n = static_cast<double>(values.size());
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    double squares = 0;
    for (const double v : values) squares += (v - mean) * (v - mean);
    return {mean, std::sqrt(squares / (n - 1) / n)};
}

/// One-sided quantile of Student's t.
double t_quantile(double confidence, std::size_t samples) {
    return boost::math::quantile(boost::math::students_t(static_cast<double>(samples - 1)), confidence);
}

/// True if a < b with 99 % confidence, paired by index.
bool lower(const std::vector<Traffic>& a, const std::vector<Traffic>& b, double Traffic::*what) {
    std::vector<double> difference;
    for (std::size_t i = 0; i < a.size(); ++i) difference.push_back(a[i].*what - b[i].*what);
    const MeanAndError d = summarise(difference);
    INFO("mean difference " << d.mean << " +- " << d.standard_error);
    return d.mean < -t_quantile(0.99, a.size()) * d.standard_error;
}

double mean(const std::vector<Traffic>& traffic, double Traffic::*what) {
    double sum = 0;
    for (const Traffic& t : traffic) sum += t.*what;
    return sum / static_cast<double>(traffic.size());
}

/// In L1 and in L2, for two sequences, each at an N of its own.
void micro_jitter_misses_less(const std::string& name, std::uint64_t trace_samples) {
    const tracer::PreparedScene* scene = find_scene(name);
    if (scene == nullptr) return;
    struct Set {
        const char* sequence;
        std::uint64_t spp;
    };
    for (const Set& set : {Set{"sobol", 64}, Set{"halton", 1024}}) {
        INFO(name << ", " << set.sequence << ", N = " << set.spp);
        const auto traffic = [&](const char* strategy) {
            return measure(*scene, capture_settings(strategy, set.sequence, set.spp, trace_samples));
        };
        const auto rotated = traffic("cranley-patterson"), jittered = traffic("micro-jitter");
        CHECK(lower(jittered, rotated, &Traffic::l2_bytes));
        CHECK(lower(jittered, rotated, &Traffic::dram_bytes));
    }
}

}  // namespace

TEST_CASE("micro-jitter misses less than cranley-patterson in L1 and in L2, with 99 per cent confidence", "[slow]") {
    // All leaves and slats: sample indices differ most.
    micro_jitter_misses_less("courtyard", 20);
}

TEST_CASE("micro-jitter misses less than cranley-patterson in real scenes, with 99 per cent confidence",
          "[slow][data]") {
    micro_jitter_misses_less(GENERATE("sponza.glb", "bistro_interior.glb"), 6);
}

TEST_CASE("with one sample and K = 1 micro-jitter saves nothing", "[slow]") {
    const tracer::PreparedScene& scene = *find_scene("courtyard");
    constexpr std::uint64_t seeds = 4;
    std::vector<Traffic> rotated(seeds), jittered(seeds);
    tbb::parallel_for(std::uint64_t{0}, seeds, [&](std::uint64_t i) {
        auto settings = capture_settings("cranley-patterson", "sobol", 1, 1);
        settings.strategy.samples.seed = i + 1;
        rotated[i] = measure(scene, settings).front();
        settings.strategy.decorrelation = "micro-jitter";
        jittered[i] = measure(scene, settings).front();
    });
    CHECK(mean(jittered, &Traffic::l2_bytes) == Approx(mean(rotated, &Traffic::l2_bytes)).epsilon(0.01));
    CHECK(mean(jittered, &Traffic::dram_bytes) == Approx(mean(rotated, &Traffic::dram_bytes)).epsilon(0.01));
}

TEST_CASE("at N = 16384 micro-jitter lies nearer to coherent than to cranley-patterson", "[slow]") {
    const tracer::PreparedScene& scene = *find_scene("courtyard");
    const auto traffic = [&](const char* strategy) {
        return measure(scene, capture_settings(strategy, "sobol", 16384, 6));
    };
    const auto coherent = traffic("coherent"), rotated = traffic("cranley-patterson"),
               jittered = traffic("micro-jitter");
    for (const auto what : {&Traffic::l2_bytes, &Traffic::dram_bytes}) {
        CHECK(std::abs(mean(jittered, what) - mean(coherent, what)) < mean(rotated, what) - mean(jittered, what));
    }
}

TEST_CASE("miss traffic falls as mu falls from 1 to 0", "[slow]") {
    const tracer::PreparedScene& scene = *find_scene("courtyard");
    std::vector<std::vector<Traffic>> sweep;
    for (const double mu : {1.0, 0.5, 0.25, 0.125, 0.03125, 0.0}) {
        auto settings = capture_settings("micro-jitter", "sobol", 1024, 6);
        settings.strategy.parameters.set("mu", mu);
        sweep.push_back(measure(scene, settings));
    }
    for (const auto what : {&Traffic::l2_bytes, &Traffic::dram_bytes}) {
        for (std::size_t i = 1; i < sweep.size(); ++i) {
            INFO("step " << i << ": " << mean(sweep[i - 1], what) << " -> " << mean(sweep[i], what) << " B/ray");
            CHECK_FALSE(lower(sweep[i - 1], sweep[i], what));  // never up, within error
        }
        CHECK(lower(sweep.back(), sweep.front(), what));
    }
}
