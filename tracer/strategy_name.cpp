#include "tracer/strategy_name.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "tracer/bvh/layouts/layout.hpp"
#include "tracer/sampling/decorrelation.hpp"
#include "tracer/simt/orders/ray_order.hpp"
#include "traces/did_you_mean.hpp"
#include "traces/error.hpp"

namespace raycache::tracer {
namespace {

constexpr const char* unsorted = "wavefront";

/// Cuts what follows `mark` off the text; nothing where the mark is not in it.
std::optional<std::string> cut_after(std::string& text, char mark) {
    const std::size_t at = text.find(mark);
    if (at == std::string::npos) return std::nullopt;
    std::string rest = text.substr(at + 1);
    text.resize(at);
    return rest;
}

void check_part(const StrategyName& name, const char* what, const std::string& found,
                const std::vector<std::string>& valid) {
    if (std::find(valid.begin(), valid.end(), found) != valid.end()) return;
    throw UsageError(fmt::format("strategy '{}': unknown {} '{}'; expected one of: {}{}", to_string(name), what, found,
                                 fmt::join(valid, ", "), did_you_mean(found, valid)));
}

}  // namespace

StrategyName parse_strategy_name(const std::string& text, StrategyParts parts) {
    StrategyName name{text};
    if (parts.layout) name.layout = cut_after(name.decorrelation, '/');
    if (parts.thread_map) name.thread_map = cut_after(name.decorrelation, '@');
    if (parts.order) name.order = cut_after(name.decorrelation, '+');
    return name;
}

std::string to_string(const StrategyName& name) {
    std::string text = name.decorrelation;
    if (name.order) text += '+' + *name.order;
    if (name.thread_map) text += '@' + *name.thread_map;
    if (name.layout) text += '/' + *name.layout;
    return text;
}

void check_strategy_name(const StrategyName& name) {
    find_decorrelation(name.decorrelation);
    if (name.order) {
        std::vector<std::string> orders;
        for (const auto& entry : ray_orders()) orders.push_back(entry.name);
        orders.emplace_back(unsorted);
        check_part(name, "ray order", *name.order, orders);
    }
    if (name.thread_map) {
        std::vector<std::string> maps;
        for (const auto& entry : thread_maps()) maps.push_back(entry.name);
        check_part(name, "thread map", *name.thread_map, maps);
    }
    if (name.layout) {
        std::vector<std::string> layouts;
        for (const auto& entry : bvh_layouts()) layouts.push_back(entry.name);
        check_part(name, "layout", *name.layout, layouts);
    }
}

StrategyName strategy_name(const traces::Provenance& p) {
    StrategyName name{p.decorrelation};
    if (p.execution != traces::Provenance{}.execution) name.order = p.order == "none" ? p.execution : p.order;
    if (p.layout != default_layout) name.layout = p.layout;
    return name;
}

ExecutionSettings execution_of(const StrategyName& name, const ExecutionSettings& otherwise) {
    if (!name.order) return otherwise;
    return {Execution::wavefront, *name.order == unsorted ? "none" : *name.order};
}

ThreadMap thread_map_of(const StrategyName& name, const std::string& otherwise) {
    if (name.thread_map) return thread_map_from(*name.thread_map);
    if (!otherwise.empty()) return thread_map_from(otherwise);
    return find_decorrelation(name.decorrelation).has_classes ? ThreadMap::classes : ThreadMap::tile;
}

}  // namespace raycache::tracer
