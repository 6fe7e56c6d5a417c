#include "tracer/sampling/decorrelation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "traces/error.hpp"

namespace raycache::tracer {

namespace {

constexpr std::uint64_t max_spp = std::uint64_t{1} << 32;

void check_nonnegative(const char* name, double value, const char* example) {
    if (!std::isfinite(value) || value < 0) {
        throw UsageError(fmt::format("sampling: {} must be a number of 0 or more, found {}: give {} such as {}", name,
                                     value, name, example));
    }
}

}  // namespace

void check_spp(std::uint64_t spp) {
    if (spp >= 1 && spp <= max_spp) return;
    throw UsageError(
        fmt::format("sampling: the number of samples per pixel N must be 1 to {}, found {}: give an N in that range",
                    max_spp, spp));
}

void check_settings(const DecorrelationSettings& settings) {
    check_spp(settings.spp);
    check_nonnegative("K", settings.k, "2.5");
    if (settings.s == 0) {
        throw UsageError(
            "sampling: the dimension s of mu = K * N^(-1/s) must be 1 or more, found 0: give s = 2, the default");
    }
    if (settings.mu) {
        check_nonnegative("mu", *settings.mu, "0.1");
        if (settings.cycles_mu) {
            throw UsageError(
                fmt::format("sampling: mu must be given once, found {} and cycles: give a number or cycles, not both",
                            *settings.mu));
        }
    }
}

double requested_mu(const DecorrelationSettings& settings) {
    if (settings.mu) return *settings.mu;
    const auto n = static_cast<double>(settings.spp);
    if (settings.cycles_mu) return 4.0 / std::sqrt(n);
    // The two common cases need no pow(), whose last digit depends on the C library and processor.
    if (settings.s == 1) return settings.k / n;
    if (settings.s == 2) return settings.k / std::sqrt(n);
    return settings.k / std::pow(n, 1.0 / settings.s);
}

double effective_mu(const DecorrelationSettings& settings) { return std::min(1.0, requested_mu(settings)); }

std::unique_ptr<Decorrelation> make_decorrelation(const std::string& name, const DecorrelationSettings& settings) {
    const auto& all = decorrelations();
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& entry) { return entry.name == name; });
    if (found == all.end()) {
        std::string names;
        for (const auto& entry : all) names += (names.empty() ? "" : ", ") + entry.name;
        throw UsageError(
            fmt::format("sampling: unknown decorrelation '{}', expected one of {}: choose one of them", name, names));
    }
    check_settings(settings);
    return found->make(settings);
}

}  // namespace raycache::tracer
