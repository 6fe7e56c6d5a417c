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

/// Cuts what follows the first `mark` from there on off the text; nothing where there is none.
std::optional<std::string> cut_after(std::string& text, char mark, std::size_t from = 0) {
    const std::size_t at = text.find(mark, from);
    if (at == std::string::npos) return std::nullopt;
    std::string rest = text.substr(at + 1);
    text.resize(at);
    return rest;
}

/// What follows each ':'.
std::vector<std::string> cut_parameters(std::string& text) {
    std::vector<std::string> all;
    std::optional<std::string> rest = cut_after(text, ':');
    while (rest) {
        std::optional<std::string> more = cut_after(*rest, ':');
        all.push_back(*rest);
        rest = std::move(more);
    }
    return all;
}

std::vector<std::string> order_names() {
    std::vector<std::string> orders;
    for (const auto& entry : ray_orders()) orders.push_back(entry.name);
    orders.emplace_back(unsorted);
    return orders;
}

bool is_order(const std::string& text) {
    const std::vector<std::string> all = order_names();
    return std::find(all.begin(), all.end(), text) != all.end();
}

void check_part(const StrategyName& name, const char* what, const std::string& found,
                const std::vector<std::string>& valid) {
    if (std::find(valid.begin(), valid.end(), found) != valid.end()) return;
    throw UsageError(fmt::format("strategy '{}': unknown {} '{}'; expected one of: {}{}", to_string(name), what, found,
                                 fmt::join(valid, ", "), did_you_mean(found, valid)));
}

void check_name_parameters(const StrategyName& name) {
    const DecorrelationEntry& entry = find_decorrelation(name.decorrelation);
    std::vector<std::string> valid, seen;
    for (const ParameterEntry& parameter : entry.parameters) valid.emplace_back(parameter.name);
    for (const std::string& one : name.parameters) {
        const std::size_t sign = one.find('=');
        const std::string parameter = one.substr(0, sign);
        if (sign == std::string::npos)
            throw UsageError(fmt::format("strategy '{}': ':{}'; expected :PARAMETER=VALUE such as micro-jitter:k=1",
                                         to_string(name), one));
        if (valid.empty())
            throw UsageError(
                fmt::format("strategy '{}': {} has no parameters, found '{}'", to_string(name), entry.name, parameter));
        check_part(name, "parameter", parameter, valid);
        if (std::find(seen.begin(), seen.end(), parameter) != seen.end())
            throw UsageError(
                fmt::format("strategy '{}': {} is given twice; expected once", to_string(name), parameter));
        seen.push_back(parameter);
        for (const ParameterEntry& p : entry.parameters)
            if (parameter == p.name) check_parameter(p, one.substr(sign + 1));
    }
}

}  // namespace

StrategyName parse_strategy_name(const std::string& text, StrategyParts parts) {
    StrategyName name{text};
    if (parts.layout) name.layout = cut_after(name.decorrelation, '/');
    if (parts.thread_map) name.thread_map = cut_after(name.decorrelation, '@');
    if (parts.parameters) name.parameters = cut_parameters(name.decorrelation);
    // A value may have a '+' of its own ("share=camera+light0"): of what follows one, only an order is an order.
    std::string& last = name.parameters.empty() ? name.decorrelation : name.parameters.back();
    const std::size_t plus = last.rfind('+');
    if (parts.order && plus != std::string::npos && (name.parameters.empty() || is_order(last.substr(plus + 1))))
        name.order = cut_after(last, '+', name.parameters.empty() ? 0 : plus);
    return name;
}

std::string to_string(const StrategyName& name) {
    std::string text = name.decorrelation;
    for (const std::string& parameter : name.parameters) text += ':' + parameter;
    if (name.order) text += '+' + *name.order;
    if (name.thread_map) text += '@' + *name.thread_map;
    if (name.layout) text += '/' + *name.layout;
    return text;
}

void check_strategy_name(const StrategyName& name) {
    find_decorrelation(name.decorrelation);
    check_name_parameters(name);
    if (name.order) check_part(name, "ray order", *name.order, order_names());
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
