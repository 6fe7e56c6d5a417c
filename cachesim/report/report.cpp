#include "cachesim/report/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <tuple>

#include "cachesim/analysis/estimate.hpp"
#include "cachesim/analysis/factor_terms.hpp"
#include "cachesim/report/groups.hpp"
#include "cachesim/report/pairing.hpp"
#include "cachesim/report/verdict.hpp"
#include "traces/error.hpp"

namespace raycache::cachesim {

namespace {

/// A member of Counters, or a function of them.
using Figure = std::function<std::uint64_t(const Counters&)>;

/// A row with what its estimates are made of.
struct Draft {
    Row row;
    std::vector<Counters> by_launch;
    std::uint32_t sector_bytes = 32;

    /// Per sample index; no figure counts 1.
    Sums sums(const Figure& y, const Figure& x, double scale = 1) const {
        Sums s;
        for (const Counters& c : by_launch) {
            s.y.push_back(scale * static_cast<double>(y(c)));
            s.x.push_back(x ? static_cast<double>(x(c)) : 1.0);
        }
        return s;
    }
    Sums l2_bytes() const { return sums(&Counters::l2_sectors, &Counters::rays, sector_bytes); }
    Sums l3_bytes() const { return sums(&Counters::l3_sectors, &Counters::rays, sector_bytes); }
    Sums dram_bytes() const { return sums(&Counters::dram_sectors, &Counters::rays, sector_bytes); }

    bool comparable(const Draft& other) const {
        const auto key = [](const Row& r) { return std::tie(r.scene, r.sequence, r.spp, r.gpu, r.group); };
        return key(row) == key(other.row) && same_work_per_launch(row.thread_map, other.row.thread_map);
    }
};

Draft make_draft(const Series& series, const LaunchGroup& group) {
    Draft draft;
    Row& row = draft.row;
    row.scene = series.scene;
    row.strategy = series.strategy;
    row.sequence = series.sequence;
    row.parameters = series.parameters;
    row.thread_map = series.thread_map;
    row.gpu = series.gpu;
    row.group = group.name;
    row.spp = series.spp;
    for (const LaunchStatistics& launch : series.launches) row.samples.push_back(launch.sample);
    draft.by_launch = group.by_launch;
    draft.sector_bytes = row.sector_bytes = series.sector_bytes;
    row.levels = series.levels;
    for (const Counters& c : group.by_launch) row.totals += c;
    row.loads = group.loads;
    row.stores = group.stores;

    row.rays = ratio_of_totals(draft.sums(&Counters::rays, nullptr));
    row.steps_per_ray = ratio_of_totals(draft.sums(&Counters::steps, &Counters::rays));
    row.active_lanes = ratio_of_totals(draft.sums(&Counters::lane_accesses, &Counters::warp_accesses));
    row.sectors_per_access = ratio_of_totals(draft.sums(&Counters::sectors, &Counters::warp_accesses));
    row.l1_hit_rate = ratio_of_totals(draft.sums(&Counters::l1_request_hits, &Counters::l1_requests));
    row.l1_visit_hit_rate = ratio_of_totals(draft.sums(&Counters::l1_hits, &Counters::sectors));
    row.l2_hit_rate = ratio_of_totals(draft.sums(&Counters::l2_hits, &Counters::l2_sectors));
    row.l2_bytes_per_ray = ratio_of_totals(draft.l2_bytes());
    row.dram_bytes_per_ray = ratio_of_totals(draft.dram_bytes());
    row.dram_compulsory_share =
        ratio_of_totals(draft.sums(&Counters::dram_first_sectors, &Counters::dram_read_sectors));
    if (row.totals.written_sectors != 0 || row.totals.sort_sectors != 0) {
        const double bytes = series.sector_bytes;
        row.written_bytes_per_ray = ratio_of_totals(draft.sums(&Counters::written_sectors, &Counters::rays, bytes));
        row.sort_bytes_per_ray = ratio_of_totals(draft.sums(&Counters::sort_sectors, &Counters::rays, bytes));
    }
    if (row.levels < 3) return draft;
    row.l3_hit_rate = ratio_of_totals(draft.sums(&Counters::l3_hits, &Counters::l3_sectors));
    row.l3_bytes_per_ray = ratio_of_totals(draft.l3_bytes());
    return draft;
}

std::string name_of(const Row& row) {
    return fmt::format("scene {}, sequence {}, N {}, thread map {}, GPU {}", row.scene, row.sequence, row.spp,
                       row.thread_map, row.gpu);
}

/// Notes in order of first mention, each once.
class Notes {
public:
    explicit Notes(std::vector<std::string>& notes) : notes_(notes) {}
    void add(const std::string& note) {
        if (seen_.insert(note).second) notes_.push_back(note);
    }

private:
    std::vector<std::string>& notes_;
    std::set<std::string> seen_;
};

void compare(Draft& draft, const std::vector<Draft>& drafts, const std::string& baseline, Notes& notes) {
    Row& row = draft.row;
    const auto find_base = [&](bool same_map) {
        return std::find_if(drafts.begin(), drafts.end(), [&](const Draft& d) {
            return d.row.strategy == baseline && d.comparable(draft) &&
                   (!same_map || d.row.thread_map == row.thread_map);
        });
    };
    auto base = find_base(true);
    if (base == drafts.end()) base = find_base(false);
    if (base == drafts.end()) {
        notes.add(fmt::format("no ratio to the baseline {0} for {1}: the baseline has no such row{2}", baseline,
                              name_of(row), row.group == "all" ? "" : " in group " + row.group));
        return;
    }
    if (base->row.samples != row.samples) {
        notes.add(
            fmt::format("no ratio to the baseline {} for strategy {}, {}: their sample indices differ, so they "
                        "cannot be paired",
                        baseline, row.strategy, name_of(row)));
        return;
    }
    row.l2_bytes_ratio = ratio_to_baseline(draft.l2_bytes(), base->l2_bytes());
    if (row.levels == 3) row.l3_bytes_ratio = ratio_to_baseline(draft.l3_bytes(), base->l3_bytes());
    row.dram_bytes_ratio = ratio_to_baseline(draft.dram_bytes(), base->dram_bytes());
    row.factors = traffic_factors(base->by_launch, draft.by_launch, row.levels);
}

}  // namespace

namespace {

void note_compulsory(const Report& report, Notes& notes) {
    std::vector<std::string> gpus;
    for (const Row& row : report.rows)
        if (row.dram_compulsory_share.mean >= mostly_compulsory &&
            std::find(gpus.begin(), gpus.end(), row.gpu) == gpus.end())
            gpus.push_back(row.gpu);
    if (!gpus.empty()) notes.add(compulsory_note(fmt::format("{}", fmt::join(gpus, ", "))));
}

}  // namespace

bool Report::has_l3() const {
    return std::any_of(rows.begin(), rows.end(), [](const Row& row) { return row.levels == 3; });
}

bool Report::has_wavefront() const {
    return std::any_of(rows.begin(), rows.end(), [](const Row& row) { return row.written_bytes_per_ray.has_value(); });
}

std::string row_label(const Report& report, const Row& row) {
    std::string label = row.strategy;
    const auto differs = [&](std::string Row::*what) {
        return std::any_of(report.rows.begin(), report.rows.end(), [&](const Row& other) {
            return other.strategy == row.strategy && other.spp == row.spp && other.gpu == row.gpu &&
                   other.group == row.group && other.*what != row.*what;
        });
    };
    for (std::string Row::*what : {&Row::parameters, &Row::sequence, &Row::thread_map, &Row::scene})
        if (differs(what)) label += ", " + row.*what;
    return fmt::format("{}, N {}, {}{}", label, row.spp, row.gpu, report.by == GroupBy::none ? "" : ", " + row.group);
}

Report make_report(const std::vector<Series>& all_series, const std::string& baseline, GroupBy by) {
    Report report;
    report.baseline = baseline;
    report.by = by;
    if (!baseline.empty() &&
        std::none_of(all_series.begin(), all_series.end(), [&](const Series& s) { return s.strategy == baseline; })) {
        std::set<std::string> names;
        for (const Series& s : all_series) names.insert(s.strategy);
        std::string list;
        for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
        throw UsageError(fmt::format("baseline: expected one of the strategies {}, found \"{}\"", list, baseline));
    }

    std::vector<Draft> drafts;
    for (const Series& series : all_series)
        for (const LaunchGroup& group : split(series.launches, by)) drafts.push_back(make_draft(series, group));

    Notes notes(report.notes);
    for (Draft& draft : drafts) {
        if (!baseline.empty() && draft.row.strategy != baseline) compare(draft, drafts, baseline, notes);
        if (draft.row.samples.size() == 1) notes.add("one sample index: no confidence interval");
        report.rows.push_back(draft.row);
    }
    note_compulsory(report, notes);
    return report;
}

}  // namespace raycache::cachesim
