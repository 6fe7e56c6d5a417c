#include <fmt/format.h>

#include "cachesim/report/explanation.hpp"
#include "cachesim/report/groups.hpp"
#include "cachesim/report/json_key.hpp"
#include "cachesim/report/json_parts.hpp"
#include "cachesim/report/speed_up_text.hpp"

namespace raycache::cachesim {

namespace {

Json counts(const MissCounts& c) {
    return {{"lookups", c.lookups},   {"misses", c.misses()},   {"compulsory", c.compulsory},
            {"capacity", c.capacity}, {"conflict", c.conflict}, {"lucky_hits", c.lucky_hits}};
}

/// Counts that are no quotient of others.
Json counters(const Counters& c, const CacheUnits& caches) {
    constexpr TrafficKey keys[] = {
        "total_rays", "steps",         "warp_accesses", "l1_requests",  "l1_hits",
        "sectors",    "l1_visit_hits", "l2_sectors",    "dram_sectors", "dram_first_sectors"};
    Json json = Json::object();
    const auto add = [&](TrafficKey key) {
        const TrafficFigure& figure = traffic_figures[key.index];
        json[figure.name] = figure.total(c, caches);
    };
    for (const TrafficKey key : keys) add(key);
    if (caches.levels == 3) add("l3_sectors");
    return json;
}

Json level(const LevelFindings& found) {
    constexpr const char* rays[] = {"camera", "bounce", "shadow"};
    Json json{{"all", counts(found.all())}};
    Json& by_object = json["by_object"] = Json::object();
    for (const traces::ObjectKindRole& role : traces::object_kind_roles) {
        const MissCounts of_kind = found.by_kind(role.kind);
        if (of_kind.lookups) by_object[snake_case(role.name)] = counts(of_kind);
    }
    Json& by_ray = json["by_ray"] = Json::array();
    for (std::size_t i = 0; i < LevelFindings::rays; ++i) {
        const MissCounts of_ray = found.by_ray(i);
        if (!of_ray.lookups) continue;
        Json row{{"ray", rays[i / LevelFindings::bounces]}, {"bounce", i % LevelFindings::bounces}};
        row.update(counts(of_ray));
        by_ray.push_back(row);
    }
    Json& by_depth = json["by_depth"] = Json::array();
    for (std::size_t depth = 0; depth < found.by_depth.size(); ++depth) {
        if (!found.by_depth[depth].lookups) continue;
        Json row{{"depth", depth}};
        row.update(counts(found.by_depth[depth]));
        by_depth.push_back(row);
    }
    return json;
}

Json trace(const Explanation& e, const ExplainedTrace& t) {
    const CacheUnits caches = e.caches();
    const Counters all = t.totals();
    Json json{{"name", t.name}, {"totals", counters(all, caches)}};
    for (const TrafficKey key :
         {TrafficKey("l1_hit_rate"), TrafficKey("l1_visit_hit_rate"), TrafficKey("dram_compulsory_share")}) {
        const TrafficFigure& figure = traffic_figures[key.index];
        json[figure.name] = figure.of_cold_launch && e.windows ? Json(nullptr) : json_of(figure.value(all, caches));
    }
    Json& levels = json["levels"] = Json::object();
    for (std::size_t i = 0; i < t.findings.levels.size(); ++i)
        levels[fmt::format("l{}", i + 1)] = level(t.findings.levels[i]);
    const Sharing& s = t.findings.sharing;
    json["l1_hits_by_fetcher"] = {{"same_warp", s.same_warp}, {"same_cta", s.same_cta}, {"other_cta", s.other_cta}};
    return json;
}

Counters sum_of(const std::vector<Counters>& by_launch) {
    Counters all;
    for (const Counters& c : by_launch) all += c;
    return all;
}

/// Both by sample index.
Json factors(const Explanation& e, const std::vector<Counters>& base, const std::vector<Counters>& other) {
    const CacheUnits caches = e.caches();
    const Counters base_sum = sum_of(base), other_sum = sum_of(other);
    const auto ratios = e.factors_of(base, other);
    Json json = Json::object();
    for (std::size_t i = 0; const IdentityTerm& term : identity_terms(caches.levels)) {
        json[term.key] = {{"base", json_of(term.value(base_sum, caches))},
                          {"other", json_of(term.value(other_sum, caches))},
                          {"factor", ratios ? json_of(ratios->terms[i]) : Json(nullptr)}};
        ++i;
    }
    return json;
}

Json groups(const Explanation& e) {
    const auto bases = split(e.base.launches, e.by), others = split(e.other.launches, e.by);
    Json json = Json::array();
    for (const LaunchGroup& base : bases)
        for (const LaunchGroup& other : others)
            if (base.name == other.name)
                json.push_back({{"group", base.name},
                                {"base", counters(sum_of(base.by_launch), e.caches())},
                                {"other", counters(sum_of(other.by_launch), e.caches())},
                                {"factors", factors(e, base.by_launch, other.by_launch)}});
    return json;
}

}  // namespace

std::string to_json(const Explanation& e) {
    Json json{{"scene", e.scene}, {"gpu", e.gpu}, {"spp", e.spp}, {"sector_bytes", e.sector_bytes}};
    Json& samples = json["samples"] = Json::array();
    for (const LaunchStatistics& launch : e.base.launches) samples.push_back(launch.sample);
    if (e.windows) json["windows"] = json_of(*e.windows);
    json["dram_bytes_ratio"] = json_of(ratio(e, "dram_bytes_ratio"));
    json["l2_bytes_ratio"] = json_of(ratio(e, "l2_bytes_ratio"));
    json["factors"] = factors(e, e.base.by_launch(), e.other.by_launch());
    if (const auto all = e.factors()) {
        json["equal_miss_rates"] = json_of(all->equal_miss_rates);
        json["cache_locality"] = json_of(all->cache_locality());
    }
    json["groups"] = groups(e);
    json["base"] = trace(e, e.base);
    json["other"] = trace(e, e.other);
    if (!e.no_time.empty()) json["timed"] = nullptr;
    if (!e.speed_ups.empty()) json["traversal"] = e.traversal;
    for (const SpeedUp& s : e.speed_ups)
        json["timed"].push_back({{"replay", s.replay.name},
                                 {"base_cycles", s.base.cycles},
                                 {"other_cycles", s.other.cycles},
                                 {"base_gain", json_of(s.base_gain(e.speed_ups.front()))},
                                 {"other_gain", json_of(s.other_gain(e.speed_ups.front()))},
                                 {"speed_up", json_of(s.value())}});
    if (!e.speed_ups.empty())
        json["speed_up_split"] = {{"with_perfect_caches", json_of(e.speed_ups.at(1).value())},
                                  {"locality", json_of(locality_part(e.speed_ups))}};
    json["verdict"] = json_of(verdict(difference_of(e)));
    json["sentence"] = sentence(e);
    if (!e.speed_ups.empty()) json["time_sentence"] = sentence(e.speed_ups);
    if (!e.no_time.empty()) json["time_sentence"] = e.no_time + '.';
    if (!e.cache_equivalents.empty()) json["cache_equivalents"] = e.cache_equivalents;
    return dump(json);
}

}  // namespace raycache::cachesim
