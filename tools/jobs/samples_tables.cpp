#include "tools/jobs/samples_tables.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "cachesim/report/json_key.hpp"
#include "tracer/sampling/hash.hpp"
#include "tracer/sampling/measures/jitter_variants.hpp"
#include "tracer/sampling/measures/largest_hole.hpp"
#include "tracer/sampling/measures/test_scenes.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

using namespace tracer;

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<std::uint32_t, 4> counts{16, 64, 256, 1024};

std::vector<FixedPoint2> plane(const Sequence& sequence, std::uint32_t n, std::uint32_t a, std::uint32_t b) {
    std::vector<FixedPoint2> points(n);
    for (std::uint32_t i = 0; i < n; ++i) points[i] = {sequence.sample(i, a), sequence.sample(i, b)};
    return points;
}

double k_of_line(const Sequence& sequence, std::uint32_t n, std::uint32_t dimension) {
    std::vector<std::uint32_t> points(n);
    for (std::uint32_t i = 0; i < n; ++i) points[i] = sequence.sample(i, dimension);
    return hole_free_k(largest_hole(points), n, 1);
}

double k_of_plane(const Sequence& sequence, std::uint32_t n, std::uint32_t a, std::uint32_t b) {
    return hole_free_k(largest_hole(plane(sequence, n, a, b)), n, 2);
}

/// The worst of the pairs (2j, 2j+1) of the first 64 dimensions: those that the decisions of a path use.
double k_of_worst_pair(const Sequence& sequence, std::uint32_t n) {
    double worst = 0;
    for (std::uint32_t d = 0; d < 64; d += 2) worst = std::max(worst, k_of_plane(sequence, n, d, d + 1));
    return worst;
}

SamplesTable holes() {
    SamplesTable table{
        "Hole-free K: micro-jitter of K or more leaves no hole; least and greatest over N = 2^4 ... 2^16",
        {"sequence", "dimensions", "s", "N=16", "256", "4096", "65536", "least", "greatest"},
        {}};
    const auto add = [&](const std::string& name, const std::string& dimensions, unsigned s, unsigned most,
                         const std::function<double(const Sequence&, std::uint32_t)>& k) {
        const auto sequence = make_sequence(name);
        std::vector<double> of_power(17, none);
        for (unsigned m = 4; m <= most; ++m) of_power[m] = k(*sequence, 1U << m);
        const auto [least, greatest] = std::minmax_element(of_power.begin() + 4, of_power.begin() + most + 1);
        table.rows.push_back({name, dimensions, fmt::format("{}", s), of_power[4], of_power[8], of_power[12],
                              of_power[16], *least, *greatest});
    };
    for (const char* name : {"sobol", "sobol-owen-02", "sobol-owen-4d", "pmj02", "halton", "r2"})
        add(name, "0,1", 2, 16, [](const Sequence& q, std::uint32_t n) { return k_of_plane(q, n, 0, 1); });
    for (const char* name : {"sobol", "sobol-owen-02", "halton", "halton-scrambled"})
        add(name, "worst pair of 64", 2, 14, k_of_worst_pair);
    add("halton", "30,31", 2, 16, [](const Sequence& q, std::uint32_t n) { return k_of_plane(q, n, 30, 31); });
    for (const char* name : {"sobol", "halton", "r2"})
        for (const std::uint32_t d : {0U, 1U})
            add(name, fmt::format("{}", d), 1, 16,
                [d](const Sequence& q, std::uint32_t n) { return k_of_line(q, n, d); });
    return table;
}

/// At one N: the paper's Figure 2, and what is said of a native high pair of Halton.
SamplesTable figure2_k() {
    SamplesTable table{"K from the star discrepancy, (N * D*)^(1/2), and hole-free K",
                       {"sequence", "dimensions", "N", "D*", "K from D*", "hole-free K"},
                       {}};
    const auto add = [&](const std::string& name, std::uint32_t n, std::uint32_t a, std::uint32_t b) {
        const auto points = plane(*make_sequence(name), n, a, b);
        const double discrepancy = star_discrepancy(points);
        table.rows.push_back({name, fmt::format("{},{}", a, b), double(n), discrepancy, std::sqrt(n * discrepancy),
                              hole_free_k(largest_hole(points), n, 2)});
    };
    add("halton", 128, 0, 1);
    add("halton", 1024, 30, 31);
    for (const char* name : {"sobol", "sobol-owen-02", "halton", "r2"})
        for (const std::uint32_t n : {64U, 1024U, 16384U}) add(name, n, 0, 1);
    return table;
}

struct Row {
    std::string label, sequence, decorrelation;
    double k = 2.5;
    unsigned s = 2;

    StrategySettings settings(std::uint32_t n) const {
        StrategySettings settings;
        settings.sequence = sequence;
        settings.decorrelation = decorrelation;
        settings.samples.spp = n;
        settings.samples.seed = 1;
        settings.parameters.set("k", k);
        settings.parameters.set("s", s);
        settings.parameters.set("share", "sets");  // integrands of 2 and 4 dimensions have no first bounce
        return settings;
    }
    FieldError measure(const TestScenes& scenes, std::uint32_t dimensions, std::uint32_t n) const {
        return summarise(measure_scenes(scenes, dimensions, n, StrategyPoints(settings(n), dimensions)));
    }
};

SamplesTable bias() {
    SamplesTable table{"Bias test: z over 12 two-dimensional scenes; 1 without bias, 1.4 or less passes",
                       {"strategy", "sequence", "N=16", "64", "256", "1024"},
                       {}};
    const std::vector<Row> rows{{"random", "random", "random"},
                                {"cranley-patterson", "sobol", "cranley-patterson"},
                                {"owen", "sobol", "owen"},
                                {"net-micro-jitter", "sobol-owen-4d", "net-micro-jitter"},
                                {"micro-jitter K=1", "sobol", "micro-jitter", 1},
                                {"micro-jitter K=2", "sobol", "micro-jitter", 2},
                                {"micro-jitter K=2.5", "sobol", "micro-jitter", 2.5},
                                {"micro-jitter K=4", "sobol", "micro-jitter", 4},
                                {"micro-jitter K=1", "halton", "micro-jitter", 1},
                                {"micro-jitter K=2", "halton", "micro-jitter", 2},
                                {"micro-jitter K=4", "halton", "micro-jitter", 4},
                                {"scrambling-distance", "sobol", "scrambling-distance"},
                                {"coherent", "sobol", "coherent"}};
    for (const Row& row : rows) {
        table.rows.push_back({row.label, row.sequence});
        for (const std::uint32_t n : counts) table.rows.back().emplace_back(row.measure(scenes_2d(), 2, n).z);
    }
    return table;
}

SamplesTable four_dimensions(const std::string& title, std::uint32_t n, const std::vector<Row>& rows) {
    SamplesTable table{title, {"strategy", "sequence", "s", "N", "rmse", "z", "R8", "shared"}, {}};
    for (const Row& row : rows) {
        const FieldError e = row.measure(edges_4d(), 4, n);
        const bool uses_s = row.decorrelation == "micro-jitter";
        table.rows.push_back({row.label, row.sequence, uses_s ? fmt::format("{}", row.s) : "", double(n),
                              std::sqrt(e.mse), e.z, e.r8, e.structured()});
    }
    return table;
}

SamplesTable structure() {
    return four_dimensions("Edges in four dimensions: share of the squared error that an 8x8 block has in common", 1024,
                           {{"cranley-patterson", "sobol", "cranley-patterson"},
                            {"micro-jitter K=1", "sobol", "micro-jitter", 1, 2},
                            {"micro-jitter K=2", "sobol", "micro-jitter", 2, 2},
                            {"micro-jitter K=4", "sobol", "micro-jitter", 4, 2},
                            {"micro-jitter K=1", "sobol", "micro-jitter", 1, 4},
                            {"micro-jitter K=2", "sobol", "micro-jitter", 2, 4},
                            {"coherent", "sobol", "coherent"}});
}

SamplesTable net() {
    return four_dimensions("Edges in four dimensions: net-micro-jitter against the others", 256,
                           {{"net-micro-jitter", "sobol-owen-4d", "net-micro-jitter"},
                            {"net-micro-jitter", "sobol", "net-micro-jitter"},
                            {"net-micro-jitter-fast", "sobol-owen-02", "net-micro-jitter-fast"},
                            {"micro-jitter K=4", "sobol-owen-02", "micro-jitter", 4, 2},
                            {"micro-jitter K=4", "sobol-owen-4d", "micro-jitter", 4, 2},
                            {"owen", "sobol", "owen"},
                            {"cranley-patterson", "sobol-owen-4d", "cranley-patterson"},
                            {"coherent", "sobol-owen-02", "coherent"},
                            {"coherent", "sobol-owen-4d", "coherent"}});
}

double mse_of(const char* scene, const std::vector<FieldError>& errors) {
    for (std::size_t i = 0; i < errors.size(); ++i)
        if (scenes_2d()[i]->name() == scene) return errors[i].mse;
    return none;
}

SamplesTable smooth() {
    SamplesTable table{"Smooth scenes in two dimensions, mean squared error",
                       {"strategy", "sequence", "N", "periodic", "lobe", "ramp"},
                       {}};
    for (const std::uint32_t n : {256U, 1024U})
        for (const Row& row : {Row{"net-micro-jitter", "sobol-owen-4d", "net-micro-jitter"},
                               Row{"owen", "sobol", "owen"}, Row{"micro-jitter K=2", "sobol", "micro-jitter", 2},
                               Row{"micro-jitter K=2", "sobol-owen-4d", "micro-jitter", 2},
                               Row{"cranley-patterson", "sobol", "cranley-patterson"}}) {
            const auto errors = measure_scenes(scenes_2d(), 2, n, StrategyPoints(row.settings(n), 2));
            table.rows.push_back({row.label, row.sequence, double(n), mse_of("periodic", errors),
                                  mse_of("lobe", errors), mse_of("ramp", errors)});
        }
    return table;
}

std::vector<FieldError> measure_variant(JitterVariant variant, std::uint32_t n, double k) {
    const double mu = std::min(1.0, k / std::sqrt(n));
    return measure_scenes(scenes_2d(), 2, n, JitterVariantPoints(variant, *make_sequence("sobol"), 2, n, mu, 1));
}

SamplesTable boundary() {
    SamplesTable table{"Jitter beyond the border, sobol, K = 2: mean squared error",
                       {"border", "N", "periodic", "lobe", "ramp", "all 12 scenes"},
                       {}};
    constexpr std::array<std::pair<const char*, JitterVariant>, 3> variants{
        {{"wrap", JitterVariant::wrap}, {"clamp", JitterVariant::clamp}, {"reflect", JitterVariant::reflect}}};
    for (const std::uint32_t n : {64U, 1024U})
        for (const auto& [name, variant] : variants) {
            const auto errors = measure_variant(variant, n, 2);
            table.rows.push_back({name, double(n), mse_of("periodic", errors), mse_of("lobe", errors),
                                  mse_of("ramp", errors), summarise(errors).mse});
        }
    return table;
}

SamplesTable jitter() {
    SamplesTable table{"A new xi for every sample: mean squared error over that of one xi per pixel, sobol, 2-D scenes",
                       {"K", "N", "all scenes", "least of a scene"},
                       {}};
    for (const double k : {1.0, 2.0, 4.0})
        for (const std::uint32_t n : counts) {
            const auto changing = measure_variant(JitterVariant::per_sample, n, k),
                       constant = measure_variant(JitterVariant::wrap, n, k);
            std::vector<double> ratios;
            for (std::size_t i = 0; i < changing.size(); ++i) ratios.push_back(changing[i].mse / constant[i].mse);
            const double least = *std::min_element(ratios.begin(), ratios.end());
            table.rows.push_back({k, double(n), summarise(changing).mse / summarise(constant).mse, least});
        }
    return table;
}

struct NamedTable {
    const char* name;
    SamplesTable (*make)();
};
constexpr std::array<NamedTable, 8> tables{{{"holes", holes},
                                            {"discrepancy", figure2_k},
                                            {"bias", bias},
                                            {"structure", structure},
                                            {"net", net},
                                            {"smooth", smooth},
                                            {"boundary", boundary},
                                            {"jitter", jitter}}};

std::string number_text(double value) {
    if (std::isnan(value)) return "-";
    const double size = std::fabs(value);
    if (value == std::floor(value) && size < 1e7) return fmt::format("{:.0f}", value);
    if (size < 1e-3) return fmt::format("{:.1e}", value);
    return size < 0.1 ? fmt::format("{:.4f}", value) : fmt::format("{:.2f}", value);
}

}  // namespace

std::string SamplesTable::text() const {
    std::vector<std::vector<std::string>> lines{columns};
    for (const auto& row : rows) {
        lines.emplace_back();
        for (const auto& cell : row) {
            const auto* words = std::get_if<std::string>(&cell);
            lines.back().push_back(words ? *words : number_text(std::get<double>(cell)));
        }
    }
    std::vector<std::size_t> widths(columns.size());
    for (const auto& line : lines)
        for (std::size_t c = 0; c < line.size(); ++c) widths[c] = std::max(widths[c], line[c].size());
    std::vector<std::string> rule;
    for (const std::size_t width : widths) rule.emplace_back(width, '-');
    lines.insert(lines.begin() + 1, rule);
    std::string text = title + "\n\n";
    for (const auto& line : lines) {
        for (std::size_t c = 0; c < line.size(); ++c) {
            const bool words = std::holds_alternative<std::string>(rows.front()[c]);
            text += fmt::format(fmt::runtime(words ? "{}{:<{}}" : "{}{:>{}}"), c == 0 ? "" : "  ", line[c], widths[c]);
        }
        text.erase(text.find_last_not_of(' ') + 1);
        text += '\n';
    }
    return text;
}

namespace {

/// A column of an N is titled by the number alone.
std::string key_of(const std::string& title) {
    return title.find_first_not_of("0123456789") == std::string::npos ? "n_" + title : cachesim::snake_case(title);
}

}  // namespace

std::string SamplesTable::json() const {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const auto& row : rows) {
        nlohmann::ordered_json object;
        for (std::size_t c = 0; c < columns.size(); ++c)
            std::visit([&](const auto& cell) { object[key_of(columns[c])] = cell; }, row[c]);
        list.push_back(std::move(object));
    }
    return nlohmann::ordered_json{{"title", title}, {"rows", list}}.dump(2) + "\n";
}

std::vector<std::string> samples_table_names() {
    std::vector<std::string> names;
    for (const NamedTable& table : tables) names.emplace_back(table.name);
    return names;
}

SamplesTable make_samples_table(const std::string& name) {
    for (const NamedTable& table : tables)
        if (name == table.name) return table.make();
    throw UsageError(fmt::format("--table '{}'; expected one of: {}", name, fmt::join(samples_table_names(), ", ")));
}

}  // namespace raycache::tools
