// raycache list: every name that another subcommand takes.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cachesim/gpus/gpu.hpp"
#include "cachesim/report/figures/timed_figures.hpp"
#include "cachesim/report/figures/traffic_figures.hpp"
#include "cachesim/report/json_key.hpp"
#include "cachesim/report/json_parts.hpp"
#include "tools/program/commands.hpp"
#include "tools/program/console.hpp"
#include "tools/program/gpu_details.hpp"
#include "tools/program/gpu_key_list.hpp"
#include "tools/program/json_output.hpp"
#include "tools/program/program.hpp"
#include "tools/program/width_option.hpp"
#include "tracer/bvh/layouts/layout.hpp"
#include "tracer/paths/integrators/integrator.hpp"
#include "tracer/sampling/decorrelation.hpp"
#include "tracer/sampling/sequence.hpp"
#include "tracer/scene/scene.hpp"
#include "tracer/simt/orders/ray_order.hpp"
#include "tracer/simt/thread_map.hpp"
#include "tracer/strategy_groups.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

struct Entry {
    std::string name, description;
    nlohmann::ordered_json more{};  ///< beside these, in JSON
};
struct Topic {
    std::string name;
    std::vector<Entry> entries;
};

template <class List>
std::vector<Entry> entries_of(const List& list) {
    std::vector<Entry> entries;
    entries.reserve(list.size());
    for (const auto& item : list) entries.push_back({item.name, item.description});
    return entries;
}

/// "l1_hits / l1_requests", "…, over the baseline's"; nothing for a count.
template <class Figure>
std::string formula(const Figure& figure) {
    if (figure.of == cachesim::Of::total || !figure.denominator) return {};
    return fmt::format(" [{} / {}{}{}]", figure.numerator.name, figure.denominator->name,
                       figure.per ? fmt::format(" x {}", figure.per->name) : "",
                       figure.is_compared() ? ", over the baseline's" : "");
}

template <class List>
std::vector<Entry> figures_of(const List& list) {
    std::vector<Entry> entries;
    for (const auto& figure : list)
        entries.push_back({figure.key, figure.definition + formula(figure), cachesim::figure_json(figure, nullptr)});
    return entries;
}

std::vector<Entry> group_entries() {
    std::vector<Entry> entries;
    for (const tracer::StrategyGroup& group : tracer::strategy_groups())
        entries.push_back({group.name,
                           fmt::format("{} [{}]", group.description, fmt::join(group.members, ", ")),
                           {{"strategies", group.members}}});
    return entries;
}

std::vector<Topic> all_topics() {
    return {{"strategies", entries_of(tracer::decorrelations())},  {"groups", group_entries()},
            {"sequences", entries_of(tracer::sequences())},        {"gpus", entries_of(cachesim::gpu_presets())},
            {"layouts", entries_of(tracer::bvh_layouts())},        {"integrators", entries_of(tracer::integrators())},
            {"thread-maps", entries_of(tracer::thread_maps())},    {"orders", entries_of(tracer::ray_orders())},
            {"scenes", entries_of(tracer::builtin_scenes())},      {"figures", figures_of(cachesim::traffic_figures)},
            {"timed-figures", figures_of(cachesim::timed_figures)}};
}

/// Entries of a topic that `raycache list` shows without being asked for it; of more it says how many there are.
constexpr std::size_t most_of_all_topics = 30;

struct ListArguments {
    std::string topic;
    JsonOption json;
    WidthOption width;
    bool details = false, keys = false;
};

void run(const ListArguments& o) {
    if (o.keys) {
        if (o.topic != "gpus" || o.details)
            throw UsageError(fmt::format("--keys with {}; expected 'raycache list gpus --keys'",
                                         o.details ? "--details" : fmt::format("topic '{}'", o.topic)));
        print(o.json ? o.json.document(gpu_keys_json()) : gpu_keys_text(o.width.columns()));
        return;
    }
    if (o.details) {
        if (o.topic != "gpus")
            throw UsageError(
                fmt::format("--details with topic '{}'; expected 'raycache list gpus --details'", o.topic));
        print(o.json ? o.json.document(gpu_details_json()) : gpu_details_text(o.width.columns()));
        return;
    }
    std::vector<Topic> topics = all_topics();
    if (!o.topic.empty()) std::erase_if(topics, [&](const Topic& t) { return t.name != o.topic; });
    nlohmann::ordered_json json;
    std::string text;
    for (const Topic& topic : topics) {
        std::size_t width = 0;
        for (const Entry& e : topic.entries) width = std::max(width, e.name.size());
        text += (text.empty() ? "" : "\n") + topic.name + "\n";
        const bool is_shown = !o.topic.empty() || topic.entries.size() <= most_of_all_topics;
        if (!is_shown) text += fmt::format("  {} of them: raycache list {}\n", topic.entries.size(), topic.name);
        for (const Entry& e : topic.entries) {
            if (is_shown)
                text += cachesim::break_lines(fmt::format("  {:<{}}  {}\n", e.name, width, e.description),
                                              o.width.columns(), width + 4);
            nlohmann::ordered_json entry{{"name", e.name}, {"description", e.description}};
            if (!e.more.is_null()) entry.update(e.more);
            json["topics"][cachesim::snake_case(topic.name)].push_back(std::move(entry));
        }
    }
    print(o.json ? o.json.document(json_text(json)) : text);
}

}  // namespace

void add_list(Program& program) {
    auto o = std::make_shared<ListArguments>();
    Command* command = program.add_subcommand("list",
                                              "List strategies, groups of them, sequences, GPUs, layouts, integrators, "
                                              "thread maps, ray orders, built-in scenes, figures of reports");
    std::vector<std::string> topics;
    for (const Topic& topic : all_topics()) topics.push_back(topic.name);
    command
        ->add_option(
            "TOPIC", o->topic,
            "strategies, groups, sequences, gpus, layouts, integrators, thread-maps, orders, scenes, figures or "
            "timed-figures; default: all")
        ->choices("topic", topics);
    o->json.add(*command);
    o->width.add(*command);
    command->add_flag("--details", o->details, "with topic gpus: every value of every preset, and who says so");
    command->add_flag("--keys", o->keys, "with topic gpus: every key of a GPU file, what it may be and what it means");
    command->examples({"raycache list", "raycache list gpus --json", "raycache list gpus --details",
                       "raycache list gpus --details --json", "raycache list gpus --keys"});
    command->callback([o] { run(*o); });
}

}  // namespace raycache::tools
