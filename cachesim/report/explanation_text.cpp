#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "cachesim/report/explanation.hpp"
#include "cachesim/report/format.hpp"
#include "cachesim/report/groups.hpp"
#include "cachesim/report/speed_up_text.hpp"
#include "cachesim/report/table.hpp"
#include "cachesim/report/traversal_note.hpp"
#include "cachesim/report/waterfall.hpp"
#include "cachesim/report/window_notes.hpp"

namespace raycache::cachesim {

namespace {

using Align = TextTable::Align;

std::string four_digits(double value) { return cachesim::figure(value, 4); }
double quotient(std::uint64_t a, std::uint64_t b) { return static_cast<double>(a) / static_cast<double>(b); }
std::string percent(std::uint64_t part, std::uint64_t whole) { return decimals(100 * quotient(part, whole), 1); }

Counters sum_of(const LaunchGroup& group) {
    Counters sum;
    for (const Counters& c : group.by_launch) sum += c;
    return sum;
}

/// Counts of both traces, over all rays of each, as cells.
class Pair {
public:
    explicit Pair(const Explanation& e) : base_rays_(e.base.totals().rays), other_rays_(e.other.totals().rays) {}

    std::string base(std::uint64_t count) const { return four_digits(quotient(count, base_rays_)); }
    std::string other(std::uint64_t count) const { return four_digits(quotient(count, other_rays_)); }
    std::string ratio(std::uint64_t base_count, std::uint64_t other_count) const {
        return decimals(quotient(other_count, other_rays_) / quotient(base_count, base_rays_), 3);
    }

private:
    std::uint64_t base_rays_, other_rays_;
};

std::string identity_table(const Explanation& e, std::size_t width) {
    const Counters base = e.base.totals(), other = e.other.totals();
    TextTable table;
    table.column("factor", Align::left);
    table.column("", Align::left);
    for (const std::string& title : {e.base.name, e.other.name, std::string("ratio")})
        table.column(title, Align::right);
    const CacheUnits caches = e.caches();
    const auto factors = e.factors();
    for (std::size_t i = 0; const IdentityTerm& term : identity_terms(caches.levels)) {
        table.row({term.name, term.quantity, four_digits(term.value(base, caches)),
                   four_digits(term.value(other, caches)),
                   with_interval(factors ? std::optional(factors->terms[i]) : std::nullopt, 3)});
        ++i;
    }
    const auto product = [&](TrafficKey mean, TrafficKey key, const char* name) {
        const TrafficFigure& f = traffic_figures[mean.index];
        table.row({"product", name, four_digits(f.value(base, caches)), four_digits(f.value(other, caches)),
                   with_interval(ratio(e, key), 3)});
    };
    if (factors) {
        const TrafficFigure& f = traffic_figures[TrafficKey("cache_locality").index];
        table.row({f.title, "all miss rates", four_digits(f.value(base, caches)), four_digits(f.value(other, caches)),
                   with_interval(factors->cache_locality(), 3)});
    }
    product("l2_bytes_per_ray", "l2_bytes_ratio", "L2-to-L1 bytes/ray");
    product("dram_bytes_per_ray", "dram_bytes_ratio", "DRAM bytes/ray");
    const auto hits = [](const Counters& c) { return percent(c.request_hits(), c.requests); };
    return table.text(width) + '\n' +
           paragraph(
               fmt::format("L1 visit miss rate: of the distinct sectors of each warp access. L1 %, hits of load "
                           "requests as Nsight Compute counts (l1tex__t_sector_hit_rate): {} and {}. cache locality: "
                           "the miss rates multiplied, DRAM sectors per sector asked for. ±: half width of the 95 % "
                           "confidence interval over {}, paired.",
                           hits(base), hits(other), units_name(e.windows.has_value())));
}

std::string bars(const Explanation& e) {
    const auto factors = e.factors();
    if (!factors || !(factors->product() > 0)) return {};
    std::vector<WaterfallStep> steps;
    for (std::size_t i = 0; i < factors->terms.size(); ++i) {
        steps.push_back({traffic_identity[i].name, factors->terms[i].mean});
        if (i == terms_before_caches) steps.push_back({"= L2-to-L1 bytes", 1, true});
    }
    steps.push_back({"= DRAM bytes", 1, true});
    return "\nBytes per ray, factor by factor; logarithmic scale, to the left is less traffic\n\n" +
           waterfall(steps, text_width);
}

/// The identity of each group, and what it contributes to the change of the whole.
std::string group_table(const Explanation& e, std::size_t width) {
    const auto groups = split(e.base.launches, e.by), others = split(e.other.launches, e.by);
    const Counters base_all = e.base.totals(), other_all = e.other.totals();
    const auto per_all = [&](const Counters& base, const Counters& other) {
        return quotient(other.dram_sectors, other_all.rays) - quotient(base.dram_sectors, base_all.rays);
    };
    TextTable table;
    table.column("group", Align::left);
    for (const char* title : {"base", "other", "ratio"}) table.column(title, Align::right);
    for (const IdentityTerm& term : identity_terms(e.caches().levels)) table.column(term.name, Align::right);
    table.column("change %", Align::right);
    for (const LaunchGroup& group : groups) {
        const auto match =
            std::find_if(others.begin(), others.end(), [&](const LaunchGroup& g) { return g.name == group.name; });
        const Counters base = sum_of(group), other = match == others.end() ? Counters{} : sum_of(*match);
        const double before = e.sector_bytes * quotient(base.dram_sectors, base.rays);
        const double after = e.sector_bytes * quotient(other.dram_sectors, other.rays);
        const std::vector<Counters> none(group.by_launch.size());
        const auto& by_launch = match == others.end() ? none : match->by_launch;
        const Estimate ratio = e.ratio_of("dram_bytes_ratio", group.by_launch, by_launch);
        const auto factors = e.factors_of(group.by_launch, by_launch);
        std::vector<std::string> cells{group.name, four_digits(before), four_digits(after), decimals(ratio.mean, 3)};
        std::vector<std::string> widths{"", "", "", half_width_cell(ratio, 3)};
        for (std::size_t i = 0; const IdentityTerm& term : identity_terms(e.caches().levels)) {
            cells.push_back(decimals(term.value(other, e.caches()) / term.value(base, e.caches()), 3));
            widths.push_back(factors ? half_width_cell(factors->terms[i], 3) : "");
            ++i;
        }
        cells.push_back(decimals(100 * per_all(base, other) / per_all(base_all, other_all), 1));
        widths.emplace_back();
        table.row(std::move(cells));
        if (factors && ratio.half_width) table.row(std::move(widths));
    }
    return '\n' +
           paragraph(
               fmt::format("The same for each group: DRAM bytes per ray of the group ({} and {}), the factors of their "
                           "ratio, and the group's share of the change in DRAM bytes per ray of the whole",
                           e.base.name, e.other.name)) +
           '\n' + table.text(width);
}

std::string class_table(const Explanation& e, std::size_t width) {
    const Pair per_ray(e);
    TextTable table;
    table.column("sectors/ray", Align::left);
    for (const std::string& name : {e.base.name, e.other.name}) {
        table.column(name, Align::right);
        table.column("%", Align::right);
    }
    table.column("ratio", Align::right);
    for (std::size_t level = 0; level < e.base.findings.levels.size(); ++level) {
        const MissCounts base = e.base.findings.levels[level].all(), other = e.other.findings.levels[level].all();
        const auto row = [&](const std::string& name, std::uint64_t b, std::uint64_t o, bool of_misses) {
            table.row({fmt::format("L{} {}", level + 1, name), per_ray.base(b),
                       of_misses ? percent(b, base.misses()) : percent(b, base.lookups), per_ray.other(o),
                       of_misses ? percent(o, other.misses()) : percent(o, other.lookups), per_ray.ratio(b, o)});
        };
        row("look-ups", base.lookups, other.lookups, false);
        row("misses", base.misses(), other.misses(), false);
        row("  compulsory", base.compulsory, other.compulsory, true);
        row("  capacity", base.capacity, other.capacity, true);
        row("  conflict", base.conflict, other.conflict, true);
        row("lucky hits", base.lucky_hits, other.lucky_hits, false);
    }
    return "\nMisses by class\n\n" + table.text(width) + '\n' +
           paragraph(
               "compulsory: the cache had never held the sector; capacity: a fully associative LRU cache of as "
               "many lines lacks it too; conflict: that cache would have had it; lucky: a hit where that cache "
               "would have missed. Classes in % of the misses, the rest in % of the look-ups, of which L1 has one for "
               "each distinct sector of a warp access." +
               std::string(e.windows ? " In the steady state a full cache has held everything once: what it had not "
                                       "held since the windows began counts as capacity."
                                     : ""));
}

/// Where the misses are, one group of rows after the other.
std::string place_table(const Explanation& e, std::size_t width) {
    const Pair per_ray(e);
    const LevelFindings &base1 = e.base.findings.levels.front(), &other1 = e.other.findings.levels.front();
    const LevelFindings &base2 = e.base.findings.levels.back(), &other2 = e.other.findings.levels.back();
    TextTable table;
    table.column("", Align::left);
    for (const char* title : {"L1 misses: base", "other", "ratio", "L1 visit miss %: base", "other",
                              "DRAM sectors: base", "other", "ratio"})
        table.column(title, Align::right);
    const auto row = [&](const std::string& name, const std::function<MissCounts(const LevelFindings&)>& of) {
        const MissCounts b1 = of(base1), o1 = of(other1), b2 = of(base2), o2 = of(other2);
        if (b1.lookups + o1.lookups == 0) return;
        table.row({name, per_ray.base(b1.misses()), per_ray.other(o1.misses()), per_ray.ratio(b1.misses(), o1.misses()),
                   percent(b1.misses(), b1.lookups), percent(o1.misses(), o1.lookups), per_ray.base(b2.misses()),
                   per_ray.other(o2.misses()), per_ray.ratio(b2.misses(), o2.misses())});
    };
    row("all", &LevelFindings::all);
    for (const traces::ObjectKindRole& role : traces::object_kind_roles)
        row(role.plural, [&](const LevelFindings& f) { return f.by_kind(role.kind); });
    constexpr const char* rays[] = {"camera", "bounce", "shadow"};
    for (unsigned ray = 0; ray < traces::ray_types; ++ray)
        for (unsigned bounce = 0; bounce < LevelFindings::bounces; ++bounce)
            row(ray == 0 && bounce == 0 ? "camera" : fmt::format("{} {}", rays[ray], bounce),
                [=](const LevelFindings& f) {
                    return f.by_ray(LevelFindings::place(static_cast<traces::RayType>(ray), bounce));
                });
    bool depth = false;
    for (unsigned first = 0; first < LevelFindings::depths; first += 4) {
        row(fmt::format("depth {}-{}", first, first + 3), [&](const LevelFindings& f) {
            MissCounts sum;
            for (unsigned d = first; d < std::min(first + 4, LevelFindings::depths); ++d) sum += f.by_depth[d];
            depth |= sum.lookups != 0;
            return sum;
        });
    }
    return "\nMisses by kind of object, ray and BVH depth: sectors per ray, over all rays\n\n" + table.text(width) +
           (depth ? "\ndepth: links from the root of the BVH; the triangles of a leaf are as deep as the leaf.\n"
                  : "\nno depth in this trace: its nodes have no links.\n");
}

std::string sharing_table(const Explanation& e, std::size_t width) {
    const Pair per_ray(e);
    const Sharing &base = e.base.findings.sharing, &other = e.other.findings.sharing;
    TextTable table;
    table.column("L1 hits on a sector fetched by", Align::left);
    for (const std::string& name : {e.base.name, e.other.name}) {
        table.column(name, Align::right);
        table.column("% of hits", Align::right);
    }
    table.column("ratio", Align::right);
    const auto row = [&](const char* name, std::uint64_t b, std::uint64_t o) {
        table.row({name, per_ray.base(b), percent(b, base.hits()), per_ray.other(o), percent(o, other.hits()),
                   per_ray.ratio(b, o)});
    };
    row("the same warp", base.same_warp, other.same_warp);
    row("another warp of the CTA", base.same_cta, other.same_cta);
    row("another CTA", base.other_cta, other.other_cta);
    return "\nSharing: to whom L1 hits are owed, sectors per ray\n\n" + table.text(width);
}

/// "sample indices 3, 17", or how many blocks of them windows are of.
std::string samples_of(const Explanation& e) {
    if (e.windows)
        return fmt::format("steady state, from {} block{} of {} sample indices", e.windows->blocks,
                           e.windows->blocks == 1 ? "" : "s", e.windows->indices);
    std::string samples;
    for (const LaunchStatistics& launch : e.base.launches)
        samples += fmt::format("{}{}", samples.empty() ? "sample indices " : ", ", launch.sample);
    return samples;
}

std::string note_of_traversal(const Explanation& e) {
    return e.traversal == "software" ? traversal_note({}, true) : traversal_note({e.gpu}, false);
}

}  // namespace

std::string to_text(const Explanation& e, std::size_t width) {
    std::string text = paragraph(fmt::format("{} against {}: {}, N {}, {}, GPU {}", e.other.name, e.base.name, e.scene,
                                             e.spp, samples_of(e), e.gpu));
    text +=
        fmt::format("\nTraffic: {} B x the product of these factors\n\n", e.sector_bytes) + identity_table(e, width);
    text += bars(e);
    if (e.by != GroupBy::none) text += group_table(e, width);
    text += class_table(e, width) + place_table(e, width) + sharing_table(e, width);
    if (!e.speed_ups.empty())
        text += fmt::format(
                    "\nPredicted time, and what is left of the speed-up when one cost is taken away\n"
                    "(gain: how much faster than as modelled{})\n\n",
                    e.windows ? fmt::format("; cycles: of {} samples of the picture", e.windows->blocks) : "") +
                to_text(e.speed_ups, e.base.name, e.other.name, width);
    text += '\n';
    if (!e.no_time.empty())
        text += paragraph(e.no_time + '.');
    else if (!e.speed_ups.empty())
        text += paragraph(sentence(e.speed_ups)) + paragraph(note_of_traversal(e) + '.');
    text += paragraph(sentence(e));
    if (difference_of(e).dram_compulsory_share >= mostly_compulsory)
        text += paragraph("note: " + compulsory_note(e.gpu) + '.', 2);
    if (e.windows) text += paragraph("note: " + window_note(*e.windows) + '.', 2);
    if (e.windows && !e.windows->last_cache_full) text += paragraph("note: " + unfilled_note(e.gpu) + '.', 2);
    for (const std::string& found : e.cache_equivalents) text += paragraph(found + '.', 2);
    return text;
}

}  // namespace raycache::cachesim
