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

    LaunchGroup& at(unsigned key, const std::string& name) {
        LaunchGroup& group = groups_[key];
        if (group.by_launch.empty()) group = {name, std::vector<Counters>(launches_), {}, {}};
        return group;
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

/// What a launch did with objects of one kind.
void add(LaunchGroup& group, std::size_t launch, traces::ObjectKind kind, const Counters& counters) {
    group.by_launch[launch] += counters;
    if (traces::is_write(kind))
        group.stores += counters;
    else if (!traces::is_stream(kind))
        group.loads += counters;
}

void add(LaunchGroup& group, std::size_t launch, const RayGroup& rays) {
    for (unsigned kind = 0; kind < traces::object_kinds; ++kind)
        add(group, launch, static_cast<traces::ObjectKind>(kind), rays.by_kind[kind]);
    group.by_launch[launch].rays += rays.rays;
}

std::string bounce_name(const RayGroup& group) {
    const char* ray = ray_names[static_cast<unsigned>(group.ray)];
    return group.ray == traces::RayType::camera ? ray : fmt::format("{} {}", ray, group.bounce);
}

void add_kinds(Groups& groups, const LaunchStatistics& launch, std::size_t i) {
    const std::uint64_t rays = launch.all().rays;
    for (const RayGroup& of_rays : launch.groups)
        for (unsigned k = 0; k < traces::object_kinds; ++k)
            if (of_rays.by_kind[k].warp_accesses) {
                const auto kind = static_cast<traces::ObjectKind>(k);
                LaunchGroup& group = groups.at(k, traces::name_of(kind));
                add(group, i, kind, of_rays.by_kind[k]);
                group.by_launch[i].rays = rays;
            }
}

}  // namespace

std::vector<LaunchGroup> split(const std::vector<LaunchStatistics>& launches, GroupBy by) {
    Groups groups(launches.size());
    for (std::size_t i = 0; i < launches.size(); ++i) {
        if (by == GroupBy::none) groups.at(0, "all");  // there even if the launch has no rays
        if (by == GroupBy::object) {
            add_kinds(groups, launches[i], i);
            continue;
        }
        for (const RayGroup& of_rays : launches[i].groups) {
            const auto ray = static_cast<unsigned>(of_rays.ray);
            if (by == GroupBy::none)
                add(groups.at(0, "all"), i, of_rays);
            else if (by == GroupBy::ray)
                add(groups.at(ray, ray_names[ray]), i, of_rays);
            else
                add(groups.at(ray * 256 + of_rays.bounce, bounce_name(of_rays)), i, of_rays);
        }
    }
    return groups.in_order();
}

}  // namespace raycache::cachesim
