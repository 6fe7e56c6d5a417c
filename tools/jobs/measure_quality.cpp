#include "tools/jobs/measure_quality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <limits>

#include "tools/jobs/costs.hpp"
#include "tools/jobs/predict_times.hpp"
#include "tracer/quality/reference_file.hpp"
#include "tracer/render.hpp"
#include "traces/error.hpp"
#include "traces/memory_budget.hpp"

namespace raycache::tools {
namespace {

std::uint32_t dimensions_of(const tracer::CaptureSettings& s) { return tracer::sample_dimensions(s.paths); }

tracer::RenderSettings render_settings(const tracer::CaptureSettings& s, std::optional<float> clamp) {
    return {s.width, s.height, s.paths, s.strategy, clamp};
}

std::uint64_t paths_of(const tracer::CaptureSettings& s) {
    return std::uint64_t{s.width} * s.height * s.strategy.samples.spp;
}

/// Of all pictures of the strategies.
std::uint64_t paths_of(const QualityRequest& request) {
    std::uint64_t paths = 0;
    for (const auto& c : request.cases)
        paths += request.repeats * paths_of(c) * (1 + (request.pairs ? (dimensions_of(c) + 1) / 2 : 0));
    return paths;
}

/// The case with another N; a strategy that takes only powers of two gets the next lower one.
tracer::CaptureSettings with_spp(tracer::CaptureSettings settings, std::uint64_t spp) {
    settings.strategy.samples.spp = spp;
    try {
        const tracer::SamplingStrategy check(settings.strategy, dimensions_of(settings));
    } catch (const UsageError&) {
        settings.strategy.samples.spp = std::bit_floor(spp);
    }
    return settings;
}

class Renderer {
public:
    Renderer(const tracer::PreparedScene& scene, const tracer::Reference& reference, const QualityRequest& request,
             const Stage& stage)
        : scene_(scene), reference_(reference), repeats_(request.repeats), clamp_(request.clamp), stage_(stage) {}

    tracer::ErrorMeasures measure(const tracer::CaptureSettings& settings, tracer::Image* first = nullptr) {
        std::vector<tracer::Image> seeds;
        for (std::uint64_t r = 0; r < repeats_; ++r) {
            tracer::RenderSettings one = render_settings(settings, clamp_);
            one.strategy.samples.seed += r;
            seeds.push_back(tracer::render(scene_, one, [&](std::uint64_t done) { stage_.add(done, done); }));
        }
        const auto errors = tracer::measure_errors(seeds, reference_);
        if (first) *first = std::move(seeds.front());
        return errors;
    }

private:
    const tracer::PreparedScene& scene_;
    const tracer::Reference& reference_;
    std::uint64_t repeats_;
    std::optional<float> clamp_;
    const Stage& stage_;
};

void render_cases(const tracer::PreparedScene& scene, const tracer::Reference& reference, const QualityRequest& request,
                  std::vector<QualityRow>& rows, Observer& observer, QualityPictures& pictures) {
    const Stage stage(observer, "strategies", paths_of(request), "paths");
    Renderer renderer(scene, reference, request, stage);
    for (QualityRow& row : rows) {
        row.errors = renderer.measure(row.settings, &pictures.rows.emplace_back());
        if (!request.pairs) continue;
        const bool resolved = row.errors.rmse.resolved() && row.errors.r8.resolved();
        const double all = resolved ? row.errors.structured_mse : 0;
        for (std::uint32_t pair = 0; 2 * pair < dimensions_of(row.settings); ++pair) {
            tracer::CaptureSettings without = row.settings;
            without.strategy.independent_pair = pair;
            const double rest = renderer.measure(without).structured_mse;
            row.pairs.push_back({pair, all > 0 ? 1 - rest / all : std::numeric_limits<double>::quiet_NaN()});
        }
    }
}

void find_baselines(const std::string& baseline, std::vector<QualityRow>& rows) {
    for (QualityRow& row : rows)
        for (std::size_t b = 0; b < rows.size(); ++b) {
            const QualityRow& other = rows[b];
            if (other.strategy().decorrelation != baseline || other.spp() != row.spp()) continue;
            if (!row.baseline || other.strategy().sequence == row.strategy().sequence) row.baseline = b;
        }
}

/// Which rows each is held against at equal error: the first of a baseline's with its N, and its sequence if possible.
void find_equal_error_baselines(const std::string& baseline, std::vector<QualityRow>& rows) {
    std::vector<std::string> names = equal_error_baselines();
    if (!baseline.empty() && std::find(names.begin(), names.end(), baseline) == names.end()) names.push_back(baseline);
    for (std::size_t r = 0; r < rows.size(); ++r)
        for (const std::string& name : names) {
            std::optional<std::size_t> found;
            for (std::size_t b = rows.size(); b-- > 0;) {
                const bool same_sequence = rows[b].strategy().sequence == rows[r].strategy().sequence;
                if (rows[b].strategy().decorrelation != name || rows[b].spp() != rows[r].spp()) continue;
                if (!found || same_sequence) found = b;
            }
            if (found && *found != r) rows[r].equal_error.push_back({*found, {}, {}, {}});
        }
}

/// From speed-ups and errors; before the errors lose their pixels.
void find_equal_errors(std::vector<QualityRow>& rows) {
    for (QualityRow& row : rows) {
        row.no_equal_error =
            no_equal_error(row.errors, tracer::find_decorrelation(row.strategy().decorrelation).independent_pixels);
        for (EqualError& against : row.equal_error) {
            against.ratio = tracer::rmse_ratio(row.errors, rows[against.baseline].errors);
            against.gain = gain_at_equal_error(against.speed_up, against.ratio);
        }
    }
}

void render_at_equal_time(const tracer::PreparedScene& scene, const tracer::Reference& reference,
                          const QualityRequest& request, std::vector<QualityRow>& rows, Observer& observer,
                          QualityPictures& pictures) {
    std::vector<tracer::CaptureSettings> cases;
    std::uint64_t paths = 0;
    for (const QualityRow& row : rows) {
        const double seconds = row.baseline ? rows[*row.baseline].timing->seconds : row.timing->seconds;
        const double spp = std::round(static_cast<double>(row.spp()) * seconds / row.timing->seconds);
        cases.push_back(with_spp(row.settings, static_cast<std::uint64_t>(std::clamp(spp, 1.0, 0x1p32))));
        if (cases.back().strategy.samples.spp != row.spp()) paths += request.repeats * paths_of(cases.back());
    }
    const Stage stage(observer, "equal time", paths, "paths");
    Renderer renderer(scene, reference, request, stage);
    for (std::size_t r = 0; r < rows.size(); ++r) {
        QualityRow::EqualTime& same = rows[r].equal_time.emplace(QualityRow::EqualTime{});
        same.spp = cases[r].strategy.samples.spp;
        if (same.spp == rows[r].spp()) {
            same.errors = rows[r].errors;
            pictures.at_equal_time.push_back(pictures.rows[r]);
        } else {
            same.errors = renderer.measure(cases[r], &pictures.at_equal_time.emplace_back());
        }
    }
}

std::uint64_t paths_of(const tracer::ReferenceSettings& s) {
    return std::uint64_t{s.width} * s.height * ((s.spp + 1) / 2 * 2);
}

void advise_kept(const std::string& path, Observer& observer) {
    observer.resumable(fmt::format("the reference {} is kept: the same command starts from it", path));
}

tracer::Reference render_new(const tracer::PreparedScene& scene, const tracer::ReferenceSettings& settings,
                             Observer& observer) {
    const Stage stage(observer, "reference", paths_of(settings), "paths");
    return tracer::render_reference(scene, settings, [&](std::uint64_t done) { stage.add(done, done); });
}

}  // namespace

std::optional<PairEffect> QualityRow::worst_pair() const {
    std::optional<PairEffect> worst;
    for (const PairEffect& p : pairs)
        if (!std::isnan(p.share) && (!worst || p.share > worst->share)) worst = p;
    return worst;
}

void check(const QualityRequest& request) {
    if (request.repeats < 1 || request.repeats > 1024)
        throw UsageError(fmt::format("--repeats {}; expected 1 to 1024", request.repeats));
    if (request.cases.empty()) throw UsageError("no strategy; expected at least one --strategy");
    for (const auto& c : request.cases) {
        const tracer::SamplingStrategy strategy(c.strategy, dimensions_of(c));
        tracer::check_seeds(c.strategy.samples.seed, request.repeats);
    }
    const auto is_baseline = [&](const auto& c) { return c.strategy.decorrelation == request.baseline; };
    if (!request.baseline.empty() && std::none_of(request.cases.begin(), request.cases.end(), is_baseline))
        throw UsageError(fmt::format("--baseline {}; expected one of the strategies compared", request.baseline));
}

std::vector<QualityRow> measure_quality(const tracer::PreparedScene& scene, const tracer::Reference& reference,
                                        const QualityRequest& request, Observer& observer, QualityPictures& pictures) {
    // A picture of each seed, one of each case, perhaps another at equal time.
    const std::uint64_t count = request.repeats + (request.equal_time ? 2 : 1) * request.cases.size();
    const auto& mean = reference.mean;
    MemoryBudget().check(count * mean.pixels.size() * sizeof(tracer::Vec3),
                         fmt::format("{} x {} pixels", mean.width, mean.height), fmt::format("{} pictures", count));
    std::vector<QualityRow> rows;
    for (const auto& c : request.cases) {
        QualityRow& row = rows.emplace_back();
        row.settings = c;
        row.parameters = tracer::SamplingStrategy(c.strategy, dimensions_of(c)).parameters();
    }
    find_baselines(request.baseline, rows);
    render_cases(scene, reference, request, rows, observer, pictures);
    for (QualityRow& row : rows)
        if (row.baseline) row.ratio = tracer::rmse_ratio(row.errors, rows[*row.baseline].errors);
    if (request.gpu) {
        if (cachesim::no_time_note(*request.gpu).empty()) find_equal_error_baselines(request.baseline, rows);
        predict_times(scene, request, rows, observer);
        find_equal_errors(rows);
        if (request.equal_time && cachesim::no_time_note(*request.gpu).empty())
            render_at_equal_time(scene, reference, request, rows, observer, pictures);
    }
    for (QualityRow& row : rows) {  // working memory of the figures, as large as the pictures
        row.errors.sums.pixel_square.clear();
        if (row.equal_time) row.equal_time->errors.sums.pixel_square.clear();
    }
    return rows;
}

void expect_stages(Observer& observer, const QualityRequest& request, double reference) {
    const double pictures = render_cost(paths_of(request), request.cases.front().paths.bounces);
    observer.expect("reference", Work::render, reference);
    observer.expect("strategies", Work::render, pictures);
    double times = 0;
    for (const auto& c : request.cases) times += trace_cost(c) + replay_cost(c, true);
    if (request.gpu && !request.estimate.windows) observer.expect("replay", Work::timed_replay, times);
    if (request.gpu && request.equal_time) observer.expect("equal time", Work::render, pictures);
}

tracer::Reference find_reference(const tracer::PreparedScene& scene, const tracer::ReferenceSettings& settings,
                                 const std::string& file, std::string& path, Deliveries& deliveries,
                                 Observer& observer) {
    const std::string key = tracer::reference_key(scene, settings);
    path = file.empty() ? tracer::cached_reference_path(key) : file;
    std::error_code error;
    if (file.empty() && !path.empty()) warn_of_unfinished(path, observer.warning());
    if (!path.empty() && std::filesystem::exists(path, error)) {
        const auto read = [&] {
            tracer::Reference reference = tracer::read_reference(path, key, {settings.width, settings.height});
            observer.expect("reference", Work::render, 0);
            advise_kept(path, observer);
            return reference;
        };
        if (!file.empty()) return read();
        try {
            return read();
        } catch (const Error& e) {
            observer.warn(fmt::format("cached reference rendered again: {}", e.what()));
        }
    }
    tracer::Reference reference = render_new(scene, settings, observer);
    if (path.empty()) {
        observer.warn("the reference is not kept: neither XDG_CACHE_HOME nor HOME is set");
        return reference;
    }
    if (file.empty()) std::filesystem::create_directories(std::filesystem::path(path).parent_path(), error);
    bool kept = false;
    const auto keep = [&] {
        tracer::write_reference(path, reference);
        kept = true;
    };
    if (!file.empty()) {
        deliveries.attempt(keep);
    } else {
        try {
            keep();
        } catch (const Error& e) {
            observer.warn(fmt::format("the reference is not kept: {}", e.what()));
        }
    }
    if (kept)
        advise_kept(path, observer);
    else
        path.clear();
    return reference;
}

}  // namespace raycache::tools
