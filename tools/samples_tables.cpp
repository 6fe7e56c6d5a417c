#include "tools/samples_tables.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "cachesim/report/table.hpp"
#include "tracer/sampling/hash.hpp"
#include "tracer/sampling/measures/coverage.hpp"
#include "tracer/sampling/measures/error_statistics.hpp"
#include "traces/error.hpp"

namespace raycache::tools {

namespace {

using tracer::FixedPoint2;
using tracer::SamplingStrategy;
using tracer::StrategySettings;

SamplingStrategy coherent(const std::string& sequence, std::uint64_t n, std::uint32_t dimensions, std::uint64_t seed) {
    StrategySettings s;
    s.sequence = sequence;
    s.decorrelation = "coherent";
    s.parameters.spp = n;
    s.parameters.seed = seed;
    return {s, dimensions};
}

/// Least K without a hole, for dimensions (d, d + 1) jointly or d alone.
double hole_free(const std::string& sequence, std::uint64_t n, std::uint32_t d, unsigned s, std::uint64_t seed) {
    const SamplingStrategy strategy = coherent(sequence, n, d + s, seed);
    std::vector<FixedPoint2> points;
    std::vector<std::uint32_t> line;
    for (std::uint64_t i = 0; i < n; ++i) {
        const auto base = strategy.base_point(i);
        if (s == 1)
            line.push_back(base[d]);
        else
            points.push_back({base[d], base[d + 1]});
    }
    return tracer::hole_free_k(s == 1 ? tracer::largest_gap(line) : tracer::largest_empty_square(points), n, s);
}

constexpr std::uint64_t hole_counts[] = {16, 64, 256, 1024, 4096, 16384, 65536};

std::vector<SamplesTable> holes(const std::string&, std::uint64_t seed) {
    SamplesTable table{"Least K of mu = K * N^(-1/s) that leaves no hole",
                       "s=2: dimensions 0 and 1 jointly; s=1: each of dimensions 0 to 7 alone; pairs: dimensions (d, "
                       "d+1), even d, the greatest of them.",
                       {"sequence"},
                       {}};
    for (const std::uint64_t n : hole_counts) table.columns.push_back(fmt::format("s=2 N={}", n));
    for (const char* last : {"s=1, all N", "pairs to 15, N=1024", "pairs to 63, N=1024"})
        table.columns.emplace_back(last);
    for (const auto& entry : tracer::sequences()) table.rows.push_back({entry.name});
    constexpr std::size_t counts = std::size(hole_counts);
    tbb::parallel_for(std::size_t{0}, table.rows.size(), [&](std::size_t row) {
        std::vector<std::string>& cells = table.rows[row];
        const std::string name = cells[0];
        for (const std::uint64_t n : hole_counts)
            cells.push_back(fmt::format("{:.2f}", hole_free(name, n, 0, 2, seed)));
        double low = INFINITY, high = 0;
        for (std::size_t i = 0; i < counts; ++i) {
            for (std::uint32_t d = 0; d < 8; ++d) {
                const double k = hole_free(name, hole_counts[i], d, 1, seed);
                low = std::min(low, k);
                high = std::max(high, k);
            }
        }
        cells.push_back(fmt::format("{:.2f}-{:.2f}", low, high));
        double worst = 0;
        for (std::uint32_t d = 0; d < 64; d += 2) {
            worst = std::max(worst, hole_free(name, 1024, d, 2, seed));
            if (d == 14 || d == 62) cells.push_back(fmt::format("{:.2f}", worst));
        }
    });
    return {table};
}

/// A strategy with settings of its own, as a row.
struct Variant {
    std::string name;
    StrategySettings settings;
};

std::vector<Variant> variants(const std::string& sequence, std::uint64_t seed) {
    std::vector<Variant> all;
    const auto add = [&](const std::string& decorrelation, const std::string& label, double k, unsigned s) {
        StrategySettings settings;
        settings.sequence = sequence;
        settings.decorrelation = decorrelation;
        settings.parameters.seed = seed;
        settings.parameters.width = tracer::test_picture_side;
        settings.parameters.k = k;
        settings.parameters.s = s;
        all.push_back({label, settings});
    };
    for (const auto& entry : tracer::decorrelations()) {
        if (entry.name != "micro-jitter") {
            add(entry.name, entry.name, 2.5, 2);
            continue;
        }
        for (const double k : {1., 2., 2.5, 4.}) add(entry.name, fmt::format("micro-jitter K={} s=2", k), k, 2);
        for (const double k : {1., 2.}) add(entry.name, fmt::format("micro-jitter K={} s=4", k), k, 4);
    }
    return all;
}

constexpr std::uint64_t error_counts[] = {16, 64, 256, 1024};

/// Figures of all integrands with one N.
struct Errors {
    double z = 0;           ///< root mean square over the integrands
    double mse_smooth = 0;  ///< mean over the smooth ones
    double mse_edges = 0;   ///< over those with edges
    double r8 = 0;          ///< over those with edges in 4-D
    double common = 0;      ///< likewise
};

std::optional<Errors> errors(StrategySettings settings, std::uint64_t n) {
    settings.parameters.spp = n;
    Errors e;
    try {
        const SamplingStrategy strategy(settings, tracer::test_dimensions);
        double smooth = 0, edges = 0, deep = 0, all = 0;
        for (const tracer::TestIntegrand& integrand : tracer::test_integrands()) {
            const auto s = tracer::error_statistics(tracer::errors_of(strategy, integrand), tracer::test_picture_side);
            e.z += s.z() * s.z();
            all += 1;
            (integrand.edges ? e.mse_edges : e.mse_smooth) += s.mse;
            (integrand.edges ? edges : smooth) += 1;
            if (!integrand.edges || integrand.dimensions < 4) continue;
            deep += 1;
            e.r8 += s.r8;
            e.common += s.common();
        }
        e.z = std::sqrt(e.z / all);
        e.mse_smooth /= smooth;
        e.mse_edges /= edges;
        e.r8 /= deep;
        e.common /= deep;
    } catch (const UsageError&) {  // not defined for this sequence or N
        return std::nullopt;
    }
    return e;
}

std::vector<SamplesTable> errors_of_all(const std::string& sequence, std::uint64_t seed) {
    const std::vector<Variant> rows = variants(sequence, seed);
    constexpr std::size_t counts = std::size(error_counts);
    std::vector<std::optional<Errors>> found(rows.size() * counts);
    tbb::parallel_for(std::size_t{0}, found.size(),
                      [&](std::size_t i) { found[i] = errors(rows[i / counts].settings, error_counts[i % counts]); });
    const auto table = [&](const char* title, const char* note, auto&& cell) {
        SamplesTable t{fmt::format("{}, {}", title, sequence), note, {"strategy"}, {}};
        for (const std::uint64_t n : error_counts) t.columns.push_back(fmt::format("N={}", n));
        for (std::size_t row = 0; row < rows.size(); ++row) {
            t.rows.push_back({rows[row].name});
            for (std::size_t i = 0; i < counts; ++i) {
                const auto& e = found[row * counts + i];
                t.rows.back().push_back(e ? cell(*e) : "-");
            }
        }
        return t;
    };
    return {table("z of the bias test",
                  "mean error over 64x64 pixels / its standard error, root mean square over 12 integrands: 1 without "
                  "bias, above 1.4 biased. It means nothing for coherent, where all pixels err alike.",
                  [](const Errors& e) { return fmt::format("{:.1f}", e.z); }),
            table("Root mean square error: smooth integrands / edges", "over 64x64 pixels, then over the integrands.",
                  [](const Errors& e) {
                      return fmt::format("{:.1e} / {:.1e}", std::sqrt(e.mse_smooth), std::sqrt(e.mse_edges));
                  }),
            table("Structured noise on 4-D edges: R8 / share of the squared error common to all pixels",
                  "R8 = 64 * MSE of 8x8 block means / MSE: 1 independent pixels, 64 whole blocks err alike.",
                  [](const Errors& e) { return fmt::format("{:.1f} / {:.2f}", e.r8, e.common); })};
}

/// What becomes of a jittered sample that leaves [0, 1).
enum class Boundary { wrap, clamp, reflect };

double jittered(std::uint32_t x, double jitter, Boundary boundary) {
    const double y = static_cast<double>(x) * 0x1p-32 + jitter;
    if (boundary == Boundary::wrap) return y - std::floor(y);
    if (boundary == Boundary::clamp) return std::clamp(y, 0.0, 0x1.fffffffp-1);
    return y < 0 ? -y : y >= 1 ? std::nextafter(2 - y, 0.0) : y;
}

/// Mean squared error of micro-jitter's variants over the smooth integrands of two dimensions.
double variant_error(const std::string& sequence, std::uint64_t n, Boundary boundary, bool new_jitter_each_sample,
                     std::uint64_t seed) {
    const SamplingStrategy strategy = coherent(sequence, n, 2, seed);
    StrategySettings settings = strategy.settings();
    const double mu = tracer::effective_mu(settings.parameters);
    const tracer::HashKey key(seed, tracer::HashPurpose::pixel_offset);
    constexpr std::uint32_t side = tracer::test_picture_side;
    std::vector<std::vector<std::uint32_t>> base;
    for (std::uint64_t i = 0; i < n; ++i) base.push_back(strategy.base_point(i));
    double sum = 0, integrands = 0;
    for (const tracer::TestIntegrand& f : tracer::test_integrands()) {
        if (f.edges || f.dimensions != 2) continue;
        integrands += 1;
        for (std::uint32_t pixel = 0; pixel < side * side; ++pixel) {
            const double px = (pixel % side + 0.5) / side, py = (pixel / side + 0.5) / side;
            double mean = 0;
            for (std::uint32_t i = 0; i < n; ++i) {
                std::array<double, tracer::test_dimensions> u{};
                for (std::uint32_t d = 0; d < 2; ++d) {
                    const std::uint32_t who = new_jitter_each_sample ? pixel + side * side * (i + 1) : pixel;
                    const double xi = tracer::pixel_offset(key, who, d) * 0x1p-32 - 0.5;
                    u[d] = jittered(base[i][d], mu * xi, boundary);
                }
                mean += f.value(u, px, py) / static_cast<double>(n);
            }
            sum += std::pow(mean - f.mean(px, py), 2) / (side * side);
        }
    }
    return sum / integrands;
}

std::vector<SamplesTable> boundary(const std::string& sequence, std::uint64_t seed) {
    SamplesTable table{fmt::format("Mean squared error of variants of micro-jitter, K = 2.5, s = 2, {}", sequence),
                       "smooth integrands of two dimensions, 64x64 pixels. The strategy micro-jitter is the first row.",
                       {"variant"},
                       {}};
    struct Row {
        const char* name;
        Boundary boundary;
        bool each_sample;
    };
    constexpr Row rows[] = {{"wrap, one offset per pixel", Boundary::wrap, false},
                            {"clamp", Boundary::clamp, false},
                            {"reflect", Boundary::reflect, false},
                            {"wrap, a new offset for each sample", Boundary::wrap, true}};
    for (const std::uint64_t n : error_counts) table.columns.push_back(fmt::format("N={}", n));
    for (const Row& row : rows) {
        table.rows.push_back({row.name});
        for (const std::uint64_t n : error_counts)
            table.rows.back().push_back(
                fmt::format("{:.1e}", variant_error(sequence, n, row.boundary, row.each_sample, seed)));
    }
    return {table};
}

struct Named {
    std::string name;
    std::vector<SamplesTable> (*make)(const std::string&, std::uint64_t);
};
const std::vector<Named>& registry() {
    static const std::vector<Named> all{{"holes", holes}, {"errors", errors_of_all}, {"boundary", boundary}};
    return all;
}

}  // namespace

const std::vector<std::string>& samples_tables() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const Named& n : registry()) all.push_back(n.name);
        return all;
    }();
    return names;
}

std::vector<SamplesTable> make_samples_tables(const std::string& name, const std::string& sequence,
                                              std::uint64_t seed) {
    tracer::make_sequence(sequence, seed);  // a name that is unknown is refused once, not in every row
    for (const Named& n : registry())
        if (n.name == name) return n.make(sequence, seed);
    throw UsageError(fmt::format("--table '{}'; expected one of: {}", name, fmt::join(samples_tables(), ", ")));
}

std::string to_text(const std::vector<SamplesTable>& tables) {
    std::string out;
    for (const SamplesTable& table : tables) {
        cachesim::TextTable text;
        for (std::size_t i = 0; i < table.columns.size(); ++i)
            text.column(table.columns[i],
                        i == 0 ? cachesim::TextTable::Align::left : cachesim::TextTable::Align::right);
        for (const auto& row : table.rows) text.row(row);
        out += (out.empty() ? "" : "\n") + table.title + "\n\n" + text.text() + "\n" + table.note + "\n";
    }
    return out;
}

std::string to_json(const std::vector<SamplesTable>& tables) {
    nlohmann::ordered_json json;
    for (const SamplesTable& table : tables) {
        nlohmann::ordered_json one{{"title", table.title}, {"note", table.note}};
        for (const auto& row : table.rows) {
            nlohmann::ordered_json& out = one["rows"].emplace_back();
            for (std::size_t i = 0; i < row.size(); ++i) out[table.columns[i]] = row[i];
        }
        json["tables"].push_back(std::move(one));
    }
    return json.dump(2) + "\n";
}

}  // namespace raycache::tools
