#include "tools/samples_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cachesim/report/table.hpp"
#include "traces/error.hpp"

namespace raycache::tools {

namespace {

using tracer::FixedPoint2;

/// Side of the window around a base point in which all its copies lie; nothing for other strategies.
std::optional<double> window(const tracer::StrategySettings& s, const tracer::SamplingStrategy& strategy) {
    if (s.decorrelation == "coherent") return 0;
    if (s.decorrelation == "cranley-patterson") return 1;
    tracer::DecorrelationSettings p = strategy.settings().parameters;
    if (s.decorrelation == "micro-jitter")
        return tracer::effective_mu(tracer::resolve_k_and_s(p, *tracer::make_sequence(s.sequence, p.seed)));
    if (s.decorrelation == "scrambling-distance") {
        p.cycles_mu = !p.mu;
        return tracer::effective_mu(p);
    }
    return std::nullopt;
}

std::string fixed(double value, int digits) { return fmt::format("{:.{}f}", value, digits); }

/// Up to eight groups of equal width between the least and the greatest density.
struct DensityBin {
    double from, to, share;
};
std::vector<DensityBin> histogram(const SamplesReport& r) {
    const tracer::Coverage& c = *r.coverage;
    const std::uint64_t n = r.strategy.parameters.spp;
    constexpr std::size_t bins = 8;
    const std::size_t per_bin = (c.share.size() + bins - 1) / bins;
    std::vector<DensityBin> all;
    for (std::size_t k = 0; k < c.share.size(); k += per_bin) {
        const std::size_t last = std::min(k + per_bin, c.share.size()) - 1;
        DensityBin bin{c.density(k, n, *r.mu), c.density(last, n, *r.mu), 0};
        for (std::size_t i = k; i <= last; ++i) bin.share += c.share[i];
        all.push_back(bin);
    }
    return all;
}

}  // namespace

double SamplesReport::discrepancy_k() const {
    return std::sqrt(static_cast<double>(strategy.parameters.spp) * star_discrepancy);
}

SamplesReport sample(const SamplesRequest& request) {
    const std::uint64_t n = request.strategy.parameters.spp;
    if (request.copies == 0) throw UsageError("--copies 0; expected 1 or more pixels whose samples are shown");
    if (request.first == request.second)
        throw UsageError(fmt::format("--dimensions {0},{0}; expected two different dimensions", request.first));
    if (n > tracer::max_star_discrepancy_points || n * request.copies > max_shown_samples)
        throw UsageError(
            fmt::format("--spp {} with --copies {}; expected at most {} samples, and {} together; "
                        "give smaller numbers",
                        n, request.copies, tracer::max_star_discrepancy_points, max_shown_samples));
    // The pixels of a square picture, row by row.
    tracer::StrategySettings settings = request.strategy;
    settings.parameters.width = static_cast<std::uint32_t>(std::ceil(std::sqrt(request.copies)));
    const tracer::SamplingStrategy strategy(settings, std::max(request.first, request.second) + 1);
    SamplesReport r;
    r.strategy = request.strategy;
    r.copies = request.copies;
    r.first = request.first;
    r.second = request.second;
    r.parameters = strategy.parameters();
    r.warning = strategy.warning();
    for (std::uint32_t i = 0; i < n; ++i) {
        const auto base = strategy.base_point(i);
        r.panel.base.push_back({base[request.first], base[request.second]});
        for (std::uint32_t copy = 0; copy < request.copies; ++copy) {
            r.panel.points.push_back({strategy.value(base[request.first], copy, i, request.first),
                                      strategy.value(base[request.second], copy, i, request.second)});
            r.panel.index.push_back(i);
        }
    }
    r.star_discrepancy = tracer::star_discrepancy(r.panel.base);
    r.base_hole = tracer::largest_empty_square(r.panel.base);
    r.copies_hole = tracer::largest_empty_square(r.panel.points);
    r.mu = window(request.strategy, strategy);
    if (r.mu && *r.mu >= 0x1p-32 && n <= tracer::max_coverage_points)
        r.coverage = tracer::coverage(r.panel.base, *r.mu);
    r.panel.mu = r.mu.value_or(1);
    if (request.strategy.decorrelation == "scrambling-distance" || request.strategy.parameters.cycles_mu) {
        const auto half = static_cast<std::uint32_t>(r.panel.mu * 0x1p31);  // one-sided: the base point is a corner
        for (FixedPoint2& p : r.panel.base) p = {p.x + half, p.y + half};
    }
    r.panel.title = fmt::format("{} {}", request.strategy.decorrelation, r.mu ? fmt::format("mu={:.4g}", *r.mu) : "");
    r.panel.subtitle = r.coverage ? fmt::format("{:.1f} % of the square never sampled", 100 * r.coverage->holes())
                                  : fmt::format("largest hole {:.4f}", r.copies_hole);
    return r;
}

std::string to_text(const SamplesReport& r) {
    const auto& p = r.strategy.parameters;
    std::string out = fmt::format("{} samples of {} pixels, {} with {}{}{}, dimensions {} and {}\n\n", p.spp, r.copies,
                                  r.strategy.sequence, r.strategy.decorrelation, r.parameters.empty() ? "" : " ",
                                  r.parameters, r.first, r.second);
    const auto add = [&](const char* what, const std::string& value, const char* note) {
        out += fmt::format("{:<44}{:>9}{}{}\n", what, value, *note ? "  " : "", note);
    };
    add("star discrepancy of the base points", fixed(r.star_discrepancy, 5), "");
    add("K = sqrt(N * star discrepancy)", fixed(r.discrepancy_k(), 3), "the paper's eq. 2 with s = 2");
    add("largest empty square between base points", fixed(r.base_hole, 5), "side, modulo 1");
    add("least K without a hole", fixed(r.hole_free_k(), 3), "mu = K / sqrt(N)");
    add("largest empty square between all samples", fixed(r.copies_hole, 5), "");
    if (r.mu) add("mu in use", fmt::format("{:.6g}", *r.mu), "");
    if (!r.coverage) return out;
    const tracer::Coverage& c = *r.coverage;
    add("never sampled by any pixel", fmt::format("{:.2f} %", 100 * c.holes()), "of the square");
    add("density, least", fixed(c.least(p.spp, *r.mu), 3), "relative to an even one");
    add("density, greatest", fixed(c.most(p.spp, *r.mu), 3), "");
    add("density, mean of (density - 1)^2", fixed(c.uneven(p.spp, *r.mu), 4), "");
    cachesim::TextTable table;
    table.column("density", cachesim::TextTable::Align::left);
    table.column("% of the square", cachesim::TextTable::Align::right);
    table.column("", cachesim::TextTable::Align::left);
    for (const DensityBin& bin : histogram(r)) {
        std::string bar;
        for (int i = 0; i < static_cast<int>(std::lround(40 * bin.share)); ++i) bar += "█";
        table.row({bin.from == bin.to ? fixed(bin.from, 2) : fixed(bin.from, 2) + " to " + fixed(bin.to, 2),
                   fixed(100 * bin.share, 2), bar});
    }
    return out + "\n" + table.text();
}

std::string to_json(const SamplesReport& r) {
    const auto& p = r.strategy.parameters;
    nlohmann::ordered_json json{{"sequence", r.strategy.sequence},
                                {"strategy", r.strategy.decorrelation},
                                {"parameters", r.parameters},
                                {"spp", p.spp},
                                {"copies", r.copies},
                                {"dimensions", {r.first, r.second}},
                                {"star_discrepancy", r.star_discrepancy},
                                {"discrepancy_k", r.discrepancy_k()},
                                {"base_hole", r.base_hole},
                                {"hole_free_k", r.hole_free_k()},
                                {"copies_hole", r.copies_hole},
                                {"mu", r.mu ? nlohmann::ordered_json(*r.mu) : nlohmann::ordered_json(nullptr)}};
    if (r.coverage) {
        const tracer::Coverage& c = *r.coverage;
        json["never_sampled"] = c.holes();
        json["density_least"] = c.least(p.spp, *r.mu);
        json["density_greatest"] = c.most(p.spp, *r.mu);
        json["density_unevenness"] = c.uneven(p.spp, *r.mu);
        for (std::size_t k = 0; k < c.share.size(); ++k)
            json["density_histogram"].push_back({{"density", c.density(k, p.spp, *r.mu)}, {"share", c.share[k]}});
    }
    return json.dump(2) + "\n";
}

std::string to_csv(const SamplesReport& r) {
    std::string out = "copy,index,x,y\n";
    for (std::size_t i = 0; i < r.panel.points.size(); ++i)
        out += fmt::format("{},{},{:.10f},{:.10f}\n", i % r.copies, r.panel.index[i],
                           static_cast<double>(r.panel.points[i].x) * 0x1p-32,
                           static_cast<double>(r.panel.points[i].y) * 0x1p-32);
    return out;
}

}  // namespace raycache::tools
