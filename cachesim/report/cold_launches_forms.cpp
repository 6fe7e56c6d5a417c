// Launches from cold caches as tables, JSON and CSV.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "cachesim/report/cold_launches.hpp"
#include "cachesim/report/format.hpp"
#include "cachesim/report/table.hpp"

namespace raycache::cachesim {
namespace {

using Align = TextTable::Align;

/// "l2_bytes" of "l2_bytes_per_ray".
std::string bytes_key(std::size_t levels, std::size_t level) {
    const std::string_view key = traffic_figures[bytes_figures(levels)[level].mean.index].key;
    return std::string(key.substr(0, key.find("_per_ray")));
}

const char* bytes_title(std::size_t levels, std::size_t level) {
    return traffic_figures[bytes_figures(levels)[level].mean.index].column;
}

/// A table whose first columns say what its rows are of.
class RowTable {
public:
    template <class OfRow>
    explicit RowTable(const std::vector<OfRow>& rows) {
        for (const auto& [title, what] :
             {std::pair{"parameters", &Origin::parameters}, std::pair{"sequence", &Origin::sequence},
              std::pair{"threads", &Origin::thread_map}})
            if (std::any_of(rows.begin(), rows.end(), [&, what = what](const Origin& a) {
                    return std::any_of(rows.begin(), rows.end(), [&](const Origin& b) {
                        return a.strategy == b.strategy && a.spp == b.spp && a.gpu == b.gpu && a.*what != b.*what;
                    });
                })) {
                titles_.push_back(title);
                more_.push_back(what);
            }
        table.subject("strategy", Align::left);
        for (const char* title : titles_) table.subject(title, Align::left);
        table.subject("N", Align::right);
        table.subject("GPU", Align::left);
    }
    void add(const Origin& o, std::vector<std::string> cells) {
        std::vector<std::string> all{o.strategy};
        for (const auto what : more_) all.push_back((o.*what).empty() ? "-" : o.*what);
        all.push_back(fmt::format("{}", o.spp));
        all.push_back(o.gpu);
        all.insert(all.end(), cells.begin(), cells.end());
        for (const std::string& cell : cells) has_undefined |= cell == undefined;
        table.row(std::move(all));
    }

    TextTable table;
    bool has_undefined = false;

private:
    std::vector<const char*> titles_;
    std::vector<std::string Origin::*> more_;
};

/// Of all rows: where their launches are of the same sample indices, those are named.
std::string title_of(const std::vector<ColdFigures>& all) {
    const std::vector<std::uint32_t>& samples = all.front().samples;
    const bool same = std::all_of(all.begin(), all.end(), [&](const ColdFigures& f) { return f.samples == samples; });
    const std::string which =
        same ? fmt::format(" (sample {} {})", samples.size() == 1 ? "index" : "indices", fmt::join(samples, ", "))
             : std::string();
    return fmt::format("\n{}{} from cold caches beside the steady state\n\n",
                       samples.size() == 1 ? "One launch" : fmt::format("{} launches, each", samples.size()), which);
}

constexpr const char* bytes_words =
    "B/ray: of the launches; x: bytes per warp access over those of the steady state, with its ±";
constexpr const char* undefined_words = "; -: not known, since a cache does not fill up or would be divided by nothing";

/// `figures` stand beside `rows`.
template <class OfRow>
std::string cold_bytes_table(const std::vector<OfRow>& rows, const std::vector<ColdFigures>& figures, std::size_t width,
                             bool& has_undefined) {
    std::size_t levels = 2;
    for (const ColdFigures& f : figures) levels = std::max(levels, f.bytes.size());
    RowTable all(rows);
    for (std::size_t level = 0; level < levels; ++level) {
        const std::string title = bytes_title(levels, level);
        all.table.column(title, Align::right);
        all.table.column(title.substr(0, title.find(' ')) + " x", Align::right);
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
        std::vector<std::string> cells;
        const std::vector<ColdFigures::Bytes>& own = figures[i].bytes;
        for (std::size_t level = 0; level < levels; ++level) {
            // Of two levels, DRAM is below the second, of three below the third.
            const std::size_t at = level + 1 == levels ? own.size() - 1 : level;
            const bool has = level + 1 == levels || level + 1 < own.size();
            cells.push_back(has ? with_interval(own[at].per_ray) : undefined);
            cells.push_back(has && own[at].over_steady ? with_interval(own[at].over_steady, 3) : undefined);
        }
        all.add(rows[i], cells);
    }
    has_undefined |= all.has_undefined;
    return all.table.text(width);
}

std::string factor_cell(double value) { return decimals(value, 3); }

std::string cold_time_table(const TimedReport& report, std::size_t width, bool& has_undefined) {
    RowTable all(report.rows);
    all.table.column("cycles", Align::right, 1);
    all.table.column("steady cycles", Align::right, 2);
    for (const char* title : {"launch/steady", "cold", "ramp", "tail", "full %"}) all.table.column(title, Align::right);
    if (!report.baseline.empty()) all.table.column("launch speed-up", Align::right);
    for (std::size_t i = 0; i < report.rows.size(); ++i) {
        const std::optional<ColdFigures::Time>& time = report.cold[i].time;
        std::vector<std::string> cells(7, undefined);
        if (time)
            cells = {fmt::format("{}", time->cycles),
                     with_interval(time->steady_cycles, 0),
                     with_interval(time->over_steady, 3),
                     with_interval(time->cold, 3),
                     factor_cell(time->ramp.mean),
                     factor_cell(time->tail.mean),
                     decimals(100 * time->full_share.mean, 1)};
        if (!report.baseline.empty())
            cells.push_back(report.baseline.is(report.rows[i]) ? "1"
                            : time                             ? with_interval(time->speed_up, 3)
                                                               : undefined);
        all.add(report.rows[i], cells);
    }
    has_undefined |= all.has_undefined;
    return all.table.text(width);
}

}  // namespace

std::string cold_tables(const Report& report, std::size_t width) {
    if (report.cold.empty()) return {};
    bool has_undefined = false;
    const std::string table = cold_bytes_table(report.rows, report.cold, width, has_undefined);
    return title_of(report.cold) + table + '\n' +
           paragraph(fmt::format("{}{}.", bytes_words, has_undefined ? undefined_words : ""));
}

std::string cold_tables(const TimedReport& report, std::size_t width) {
    if (report.cold.empty()) return {};
    bool has_undefined = false;
    const std::string times = cold_time_table(report, width, has_undefined);
    const std::string bytes = cold_bytes_table(report.rows, report.cold, width, has_undefined);
    return title_of(report.cold) + times + '\n' + bytes + '\n' +
           paragraph(fmt::format(
               "steady cycles: what the steady state takes for the accesses of these launches. launch/steady = cold x "
               "ramp x tail: cold: cycles per access while all slots for CTAs are taken, over the steady state's; "
               "ramp: "
               "what the time until then adds; tail: what the time from the last CTA that is dealt out adds. full %: "
               "of the accesses, those while all slots are taken. ± is that of the steady state, of launch speed-up "
               "that over launches. {}{}.",
               bytes_words, has_undefined ? undefined_words : ""));
}

Json cold_json(const ColdFigures& f) {
    Json json{{"samples", f.samples}};
    if (f.time) {
        const ColdFigures::Time& t = *f.time;
        json.update({{"cycles", t.cycles},
                     {"steady_cycles", json_of(t.steady_cycles)},
                     {"over_steady", json_of(t.over_steady)},
                     {"cold", json_of(t.cold)},
                     {"ramp", json_of(t.ramp.mean)},
                     {"tail", json_of(t.tail.mean)},
                     {"full_share", json_of(t.full_share.mean)},
                     {"speed_up", json_of(t.speed_up)}});
    }
    for (std::size_t level = 0; level < f.bytes.size(); ++level) {
        const std::string key = bytes_key(f.bytes.size(), level);
        json[key + "_per_ray"] = json_of(f.bytes[level].per_ray);
        json[key + "_over_steady"] = json_of(f.bytes[level].over_steady);
    }
    return json;
}

void add_cold_titles(CsvLine& line, std::size_t levels, bool timed) {
    const auto estimate = [&](const std::string& name) {
        line.text(name);
        line.text(name + "_ci95");
    };
    line.text("cold_samples");
    if (timed) {
        line.text("cold_cycles");
        for (const char* name : {"cold_steady_cycles", "cold_over_steady", "cold_factor"}) estimate(name);
        for (const char* name : {"ramp_factor", "tail_factor", "full_share"}) line.text(name);
        estimate("cold_speed_up");
    }
    for (std::size_t level = 0; level < levels; ++level) {
        estimate("cold_" + bytes_key(levels, level) + "_per_ray");
        estimate("cold_" + bytes_key(levels, level) + "_over_steady");
    }
}

void add_cold_fields(CsvLine& line, const ColdFigures& f, std::size_t levels, bool timed) {
    line.text(fmt::format("{}", fmt::join(f.samples, " ")));
    if (timed) {
        const ColdFigures::Time none{0,
                                     {std::nan(""), {}},
                                     {std::nan(""), {}},
                                     {std::nan(""), {}},
                                     {std::nan(""), {}},
                                     {std::nan(""), {}},
                                     {std::nan(""), {}},
                                     {}};
        const ColdFigures::Time& t = f.time ? *f.time : none;
        line.text(f.time ? fmt::format("{}", t.cycles) : "");
        for (const Estimate& e : {t.steady_cycles, t.over_steady, t.cold}) line.estimate(e);
        for (const Estimate& e : {t.ramp, t.tail, t.full_share}) line.number(e.mean);
        line.estimate(t.speed_up);
    }
    for (std::size_t level = 0; level < levels; ++level) {
        const std::size_t own = f.bytes.size();
        const bool has = level + 1 == levels || level + 1 < own;
        const std::size_t at = level + 1 == levels ? own - 1 : level;
        line.estimate(has ? std::optional(f.bytes[at].per_ray) : std::nullopt);
        line.estimate(has ? f.bytes[at].over_steady : std::nullopt);
    }
}

}  // namespace raycache::cachesim
