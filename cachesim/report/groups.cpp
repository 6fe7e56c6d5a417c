#include "cachesim/report/groups.hpp"

#include <fmt/format.h>

#include <map>

namespace raycache::cachesim {

namespace {

constexpr const char* ray_names[] = {"camera", "bounce", "shadow"};
static_assert(std::size(ray_names) == traces::ray_types);

/// Groups by an ordered key; every group gets one entry per launch.
class Groups {
public:
    explicit Groups(std::size_t launches) : launches_(launches) {}

    Counters& at(unsigned key, const std::string& name, std::size_t launch) {
        LaunchGroup& group = groups_[key];
        if (group.by_launch.empty()) group = {name, std::vector<Counters>(launches_)};
        return group.by_launch[launch];
    }

    std::vector<LaunchGroup> in_order() const {
        std::vector<LaunchGroup> all;
        for (const auto& [key, group] : groups_) all.push_back(group);
        return all;
    }

private:
    std::size_t launches_;
    std::map<unsigned, LaunchGroup> groups_;
};

std::string bounce_name(const RayGroup& group) {
    const char* ray = ray_names[static_cast<unsigned>(group.ray)];
    return group.ray == traces::RayType::camera ? ray : fmt::format("{} {}", ray, group.bounce);
}

void add_kinds(Groups& groups, const LaunchStatistics& launch, std::size_t i) {
    const std::uint64_t rays = launch.all().rays;
    for (const RayGroup& group : launch.groups)
        for (unsigned kind = 0; kind < traces::object_kinds; ++kind)
            if (group.by_kind[kind].warp_accesses) {
                Counters& sum = groups.at(kind, traces::name_of(static_cast<traces::ObjectKind>(kind)), i);
                sum += group.by_kind[kind];
                sum.rays = rays;
            }
}

}  // namespace

std::vector<LaunchGroup> split(const std::vector<LaunchStatistics>& launches, GroupBy by) {
    Groups groups(launches.size());
    for (std::size_t i = 0; i < launches.size(); ++i) {
        if (by == GroupBy::none) groups.at(0, "all", i) = launches[i].all();
        if (by == GroupBy::object) add_kinds(groups, launches[i], i);
        if (by != GroupBy::ray && by != GroupBy::bounce) continue;
        for (const RayGroup& group : launches[i].groups) {
            const auto ray = static_cast<unsigned>(group.ray);
            if (by == GroupBy::ray)
                groups.at(ray, ray_names[ray], i) += group.all();
            else
                groups.at(ray * 256 + group.bounce, bounce_name(group), i) += group.all();
        }
    }
    return groups.in_order();
}

}  // namespace raycache::cachesim
