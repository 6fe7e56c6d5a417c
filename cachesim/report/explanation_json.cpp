#include <fmt/format.h>

#include "cachesim/analysis/factor_terms.hpp"
#include "cachesim/report/explanation.hpp"
#include "cachesim/report/groups.hpp"
#include "cachesim/report/json_parts.hpp"

namespace raycache::cachesim {

namespace {

Json counts(const MissCounts& c) {
    return {{"lookups", c.lookups},   {"misses", c.misses()},   {"compulsory", c.compulsory},
            {"capacity", c.capacity}, {"conflict", c.conflict}, {"lucky_hits", c.lucky_hits}};
}

/// The members of Counters that are no quotient of others.
Json counters(const Counters& c, std::size_t levels) {
    Json json{{"rays", c.rays},       {"steps", c.steps},           {"warp_accesses", c.warp_accesses},
              {"sectors", c.sectors}, {"l2_sectors", c.l2_sectors}, {"dram_sectors", c.dram_sectors}};
    if (levels == 3) json["l3_sectors"] = c.l3_sectors;
    return json;
}

Json level(const LevelFindings& found) {
    constexpr const char* kinds[] = {"node", "triangle", "texel"};
    constexpr const char* rays[] = {"camera", "bounce", "shadow"};
    Json json{{"all", counts(found.all())}};
    Json& by_object = json["by_object"] = Json::object();
    for (unsigned kind = 0; kind < traces::object_kinds_of_version_1; ++kind)
        if (found.by_kind[kind].lookups) by_object[kinds[kind]] = counts(found.by_kind[kind]);
    Json& by_ray = json["by_ray"] = Json::array();
    for (std::size_t i = 0; i < found.by_ray.size(); ++i) {
        if (!found.by_ray[i].lookups) continue;
        Json row{{"ray", rays[i / LevelFindings::bounces]}, {"bounce", i % LevelFindings::bounces}};
        row.update(counts(found.by_ray[i]));
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

Json trace(const ExplainedTrace& t) {
    Json json{{"name", t.name}, {"totals", counters(t.totals(), t.findings.levels.size())}};
    Json& levels = json["levels"] = Json::object();
    for (std::size_t i = 0; i < t.findings.levels.size(); ++i)
        levels[fmt::format("l{}", i + 1)] = level(t.findings.levels[i]);
    const Sharing& s = t.findings.sharing;
    json["l1_hits_by_fetcher"] = {{"same_warp", s.same_warp}, {"same_cta", s.same_cta}, {"other_cta", s.other_cta}};
    return json;
}

Json factors(const Counters& base, const Counters& other, std::size_t levels) {
    Json json = Json::object();
    for (const FactorTerm& term : factor_terms(levels))
        json[term.key] = {{"base", json_of(term.value(base))},
                          {"other", json_of(term.value(other))},
                          {"factor", json_of(term.value(other) / term.value(base))}};
    return json;
}

Json groups(const Explanation& e) {
    const auto bases = split(e.base.launches, e.by), others = split(e.other.launches, e.by);
    const auto sum = [](const LaunchGroup& group) {
        Counters all;
        for (const Counters& c : group.by_launch) all += c;
        return all;
    };
    Json json = Json::array();
    for (const LaunchGroup& base : bases)
        for (const LaunchGroup& other : others)
            if (base.name == other.name)
                json.push_back({{"group", base.name},
                                {"base", counters(sum(base), e.levels())},
                                {"other", counters(sum(other), e.levels())},
                                {"factors", factors(sum(base), sum(other), e.levels())}});
    return json;
}

}  // namespace

std::string to_json(const Explanation& e) {
    Json json{{"scene", e.scene}, {"gpu", e.gpu}, {"spp", e.spp}, {"sector_bytes", e.sector_bytes}};
    Json& samples = json["samples"] = Json::array();
    for (const LaunchStatistics& launch : e.base.launches) samples.push_back(launch.sample);
    json["dram_bytes_ratio"] = json_of(dram_bytes_ratio(e));
    json["l2_bytes_ratio"] = json_of(l2_bytes_ratio(e));
    json["factors"] = factors(e.base.totals(), e.other.totals(), e.levels());
    json["groups"] = groups(e);
    json["base"] = trace(e.base);
    json["other"] = trace(e.other);
    if (!e.no_time.empty()) json["timed"] = nullptr;
    for (const SpeedUp& s : e.speed_ups)
        json["timed"].push_back({{"replay", s.replay.name},
                                 {"base_cycles", s.base.cycles},
                                 {"other_cycles", s.other.cycles},
                                 {"speed_up", json_of(s.value())}});
    json["sentence"] = sentence(e);
    if (!e.speed_ups.empty()) json["time_sentence"] = sentence(e.speed_ups);
    if (!e.no_time.empty()) json["time_sentence"] = e.no_time + '.';
    return dump(json);
}

}  // namespace raycache::cachesim
