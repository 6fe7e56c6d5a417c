#include "tools/jobs/result_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "traces/error.hpp"

namespace raycache::tools {
namespace {

class Checker {
public:
    explicit Checker(std::string source) : source_(std::move(source)) {}

    void operator()(const CaptureResult&) const {}
    void operator()(const RenderResult&) const {}

    void operator()(const ReplayResult& r) const {
        for (const cachesim::Series& s : r.series) {
            expect(s.caches.levels == 2 || s.caches.levels == 3, "series of 2 or 3 cache levels");
            expect(!s.launches.empty(), "launches in every series");
        }
        expect(r.times.empty() || r.times.size() == r.series.size(), "as many timed series as counted ones");
        for (const cachesim::TimedSeries& t : r.times) expect(!t.launches.empty(), "launches in every series");
        expect(r.cold.empty() || r.cold.size() == r.series.size(), "cold launches of every series, or none");
        for (const cachesim::ColdLaunches& c : r.cold)
            expect(!c.launches.empty() && (c.stages.empty() || c.stages.size() == c.launches.size()),
                   "stages of every cold launch, or none");
    }

    void operator()(const ExplainResult& r) const {
        const cachesim::Explanation& e = r.explanation;
        const std::size_t launches = e.base.launches.size();
        expect(launches > 0 && e.other.launches.size() == launches, "the same launches of both traces");
        const std::size_t levels = e.base.findings.levels.size();
        expect(levels == 2 || levels == 3, "findings of 2 or 3 cache levels");
        for (const auto* trace : {&e.base, &e.other}) {
            expect(trace->findings.levels.size() == levels, "findings of as many levels for both traces");
            const cachesim::LevelFindings usual;
            for (const auto& level : trace->findings.levels)
                expect(level.by_group.size() == usual.by_group.size() && level.by_depth.size() == usual.by_depth.size(),
                       "findings by ray and by depth");
        }
        const auto ideal = cachesim::idealised_replays();
        expect(e.speed_ups.empty() || e.speed_ups.size() == ideal.size(), "all idealised replays, or none");
        for (std::size_t i = 0; i < e.speed_ups.size(); ++i) {
            const cachesim::SpeedUp& s = e.speed_ups[i];
            expect(std::strcmp(s.replay.name, ideal[i].name) == 0, "the idealised replays in their order");
            expect(s.base_cycles.size() == launches && s.other_cycles.size() == launches, "cycles of every launch");
        }
        expect(r.maps.empty() || r.maps.size() == 2, "heat maps of both traces, or none");
        for (const HeatMap& map : r.maps) {
            const std::size_t pixels = std::size_t{map.width} * map.height;
            expect(map.dram_bytes.size() == pixels && map.l1_miss_rate.size() == pixels &&
                       map.active_lanes.size() == pixels,
                   "a number of each kind for every pixel of a heat map");
            expect(map.width == r.maps[0].width && map.height == r.maps[0].height, "heat maps of one size");
        }
    }

    void operator()(const QualityResult& r) const {
        expect(!r.report.rows.empty(), "at least one row");
        expect(r.report.width > 0 && r.report.height > 0, "a picture of at least one pixel");
        for (const QualityRow& row : r.report.rows) {
            expect(!row.baseline || *row.baseline < r.report.rows.size(), "a baseline among the rows");
            for (const EqualError& against : row.equal_error)
                expect(against.baseline < r.report.rows.size(), "a baseline at equal error among the rows");
            expect(row.settings.width == r.report.width, "rows of the picture's width");
            check(row.errors);
            if (row.equal_time) check(row.equal_time->errors);
        }
    }

    void operator()(const SamplesResult& r) const {
        const SampleUnion& s = r.samples;
        expect(!s.base.empty(), "at least one point");
        expect(s.points.size() == s.base.size() * s.copies, "as many points as copies of the base points");
        expect(!s.density || !s.density->levels.empty(), "levels of the density");
    }

private:
    void expect(bool holds, const char* what) const {
        if (!holds) throw Error(fmt::format("{}: expected {}, found something else; run the job again", source_, what));
    }
    void check(const tracer::ErrorMeasures& errors) const {
        const auto& blocks = errors.sums.blocks;
        expect(blocks.mean.size() == std::size_t{blocks.columns} * blocks.rows, "a mean error of every block");
    }

    std::string source_;
};

}  // namespace

void check_result(const AnyResult& result, const std::string& source) { std::visit(Checker(source), result); }

}  // namespace raycache::tools
