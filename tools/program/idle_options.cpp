#include "tools/program/idle_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "tools/program/console.hpp"
#include "tools/program/options.hpp"
#include "tracer/sampling/pixel_place.hpp"

namespace raycache::tools {
namespace {

using Case = tracer::CaptureSettings;

struct Context {
    const Command& command;
    const CaseUse& use;

    bool given(const char* name) const {
        const Option* option = command.find_option(name);
        return option && option->given();
    }
    std::string value(const char* name) const {
        const Option* option = command.find_option(name);
        return option && option->given() ? option->words().back() : "";
    }
};

/// Why a case does not read the option; empty where it does.
using Rule = std::function<std::string(const Case&, const Context&)>;

/// "A, B do": of the decorrelations, or of the integrators.
template <class Entries, class Reads>
std::string readers_of(const Entries& entries, const Reads& reads) {
    std::string names;
    std::size_t count = 0;
    for (const auto& entry : entries) {
        if (!reads(entry)) continue;
        names += (names.empty() ? "" : ", ") + entry.name;
        ++count;
    }
    return fmt::format("{} do{}", names, count == 1 ? "es" : "");
}

/// The parameter beside which the decorrelation does not read that one: "--mu", "--cycles-noise-threshold off".
std::string shadowing_option(const tracer::DecorrelationEntry& entry, const std::string& name,
                             const tracer::Parameters& given) {
    for (const tracer::ParameterEntry& other : entry.parameters) {
        if (other.name == name || !given.has(other.name)) continue;
        tracer::Parameters without = given;
        without.unset(other.name);
        if (entry.reads_parameter(name, without))
            return fmt::format("--{}{}", other.name, given.is_word(other) ? fmt::format(" {}", other.word) : "");
    }
    return {};
}

std::string unread(const std::string& name, const Case& c) {
    const auto& entry = tracer::find_decorrelation(c.strategy.decorrelation);
    const auto& given = c.strategy.parameters;
    if (entry.reads_parameter(name, given)) return {};
    const std::string beside = shadowing_option(entry, name, given);
    if (!beside.empty()) return fmt::format("{} is given, which takes its place", beside);
    return fmt::format(
        "{} does not read it ({})", entry.name,
        readers_of(tracer::decorrelations(), [&](const auto& other) { return other.has_parameter(name); }));
}

Rule parameter_rule(const std::string& name) {
    return [name](const Case& c, const Context&) { return unread(name, c); };
}

std::string sequence_rule(const Case& c, const Context&) {
    const auto& entry = tracer::find_decorrelation(c.strategy.decorrelation);
    if (entry.reads_sequence) return {};
    return fmt::format("{} does not read it ({})", entry.name,
                       readers_of(tracer::decorrelations(), [](const auto& other) { return other.reads_sequence; }));
}

std::string seed_rule(const Case& c, const Context& context) {
    const auto& entry = tracer::find_decorrelation(c.strategy.decorrelation);
    if (entry.reads_seed) return {};
    const auto& all = tracer::sequences();
    const auto sequence =
        std::find_if(all.begin(), all.end(), [&](const auto& s) { return s.name == c.strategy.sequence; });
    if (sequence != all.end() && sequence->reads_seed) return {};
    if (context.use.launches && c.trace_samples < c.strategy.samples.spp) return {};
    return fmt::format("{} of {} does not depend on it", entry.name, c.strategy.sequence);
}

std::string launches_rule(const Case&, const Context& context) {
    return context.use.launches ? "" : context.use.without_launches;
}

std::string trace_samples_rule(const Case& c, const Context& context) {
    if (!context.use.launches) return context.use.without_launches;
    const std::uint64_t n = c.strategy.samples.spp;
    return c.trace_samples > n ? fmt::format("N is {}, so that all {} are traced", n, n) : "";
}

std::string interleave_rule(const Case& c, const Context& context) {
    if (context.use.launches && c.thread_map == tracer::ThreadMap::classes) return {};
    return unread("interleave", c);
}

std::string thread_map_rule(const Case& c, const Context& context) {
    if (!context.use.launches) return context.use.without_launches;
    return context.value("--thread-map") == tracer::to_string(c.thread_map) ? ""
                                                                            : "the strategy's own @MAP takes its place";
}

std::string limit_rule(std::uint32_t limit, const Case& c) {
    return limit > c.paths.bounces ? fmt::format("a path has {} bounces at most", c.paths.bounces) : "";
}

/// "ao does not read it (path does)": of the integrators.
template <class Reads>
std::string unread_by_integrator(const Case& c, const Reads& reads) {
    const tracer::IntegratorEntry& own = tracer::integrator_entry(c.paths.integrator);
    if (reads(own)) return {};
    return fmt::format("integrator {} does not read it ({})", own.name, readers_of(tracer::integrators(), reads));
}

std::string light_rule(const Case& c, const Context&) {
    return unread_by_integrator(c, [](const tracer::IntegratorEntry& entry) { return entry.follows_light; });
}

std::string bvh_rule(const Case& c, const Context& context) {
    const std::string reason = launches_rule(c, context);
    if (!reason.empty() || tracer::integrator_entry(c.paths.integrator).walks_bvh) return reason;
    return fmt::format("integrator {} walks no BVH", c.paths.integrator);
}

Rule integrator_rule(const std::string& name) {
    return [name](const Case& c, const Context&) {
        return unread_by_integrator(c, [&](const tracer::IntegratorEntry& entry) { return entry.has_parameter(name); });
    };
}

/// `rule`, of a path with bounces; others do not get so far.
Rule with_light(const Rule& rule) {
    return [rule](const Case& c, const Context& context) {
        const std::string reason = light_rule(c, context);
        return reason.empty() ? rule(c, context) : reason;
    };
}

struct OptionRule {
    const char* option;
    Rule why_unread;
};

const std::vector<OptionRule>& rules() {
    static const std::vector<OptionRule> all{
        {"--sequence", sequence_rule},
        {"--k", parameter_rule("k")},
        {"--s", parameter_rule("s")},
        {"--mu", parameter_rule("mu")},
        {"--cycles-multiplier", parameter_rule("cycles-multiplier")},
        {"--cycles-min-samples", parameter_rule("cycles-min-samples")},
        {"--cycles-noise-threshold", parameter_rule("cycles-noise-threshold")},
        {"--interleave", interleave_rule},
        {"--share", parameter_rule("share")},
        {"--share-bits", parameter_rule("share-bits")},
        {"--seed", seed_rule},
        {"--trace-samples", trace_samples_rule},
        {"--thread-map", thread_map_rule},
        {"--spatial-splits", bvh_rule},
        {"--layout", bvh_rule},
        {"--bvh-cache", bvh_rule},
        {"--set", launches_rule},
        {"--warps-per-sm", launches_rule},
        {"--bounces", light_rule},
        {"--lights", light_rule},
        {"--bounces-diffuse",
         with_light([](const Case& c, const Context&) { return limit_rule(c.paths.bounces_diffuse, c); })},
        {"--bounces-transmission",
         with_light([](const Case& c, const Context&) { return limit_rule(c.paths.bounces_transmission, c); })},
        {"--russian-roulette", with_light([](const Case& c, const Context&) {
             return c.paths.bounces < 2 ? std::string("it begins at the second bounce") : std::string();
         })},
        {"--order",
         [](const Case& c, const Context& context) {
             return context.value("--order") == c.execution.order
                        ? std::string()
                        : std::string("the strategy's own +ORDER takes its place");
         }},
        {"--execution",
         [](const Case& c, const Context& context) {
             return context.value("--execution") == tracer::to_string(c.execution.execution)
                        ? std::string()
                        : std::string("the strategy's own +ORDER takes its place");
         }},
        {"--camera",
         [](const Case&, const Context& context) {
             return context.given("--eye") && context.given("--fov")
                        ? std::string("--eye, --look-at and --fov take its place")
                        : std::string();
         }},
    };
    return all;
}

}  // namespace

std::vector<std::string> idle_options(const Command& command, std::span<const tracer::CaptureSettings> cases,
                                      const CaseUse& use) {
    const Context context{command, use};
    std::vector<std::string> lines;
    const auto add = [&](const std::string& option, const Rule& why_unread) {
        std::vector<std::string> reasons;
        for (const Case& c : cases) {
            const std::string reason = why_unread(c, context);
            if (reason.empty()) return;
            if (std::find(reasons.begin(), reasons.end(), reason) == reasons.end()) reasons.push_back(reason);
        }
        lines.push_back(fmt::format("{} has no effect: {}", option, fmt::join(reasons, "; ")));
    };
    if (cases.empty()) return lines;
    for (const OptionRule& rule : rules())
        if (context.given(rule.option)) add(rule.option, rule.why_unread);
    for (const tracer::ParameterEntry& p : tracer::integrator_parameters()) {
        const std::string option = fmt::format("--{}", p.name);
        if (context.given(option.c_str())) add(option, integrator_rule(p.name));
    }
    if (const Option* given = command.find_option("--param"))
        for (const std::string& word : given->words()) {
            const std::string name = word.substr(0, word.find('='));
            const std::string option = "--" + name, parameter = "--param " + word;
            if (context.given(option.c_str())) {
                // One value rules over an option of one value; a list of cases rules over both.
                const std::string value = word.substr(std::min(word.size(), name.size() + 1));
                const bool rules = std::all_of(cases.begin(), cases.end(), [&](const Case& c) {
                    return c.strategy.parameters.text(name) == value;
                });
                lines.push_back(fmt::format("{} has no effect: {} takes its place", rules ? option : parameter,
                                            rules ? parameter : option));
            }
            add("--param " + name,
                name == tracer::interleave_parameter.name ? Rule(interleave_rule) : parameter_rule(name));
        }
    return lines;
}

std::vector<std::string> idle_besides(const Command& command, const std::vector<std::string>& read,
                                      const std::string& reason) {
    std::vector<std::string> lines;
    for (const auto& option : command.options()) {
        const bool is_read = std::find(read.begin(), read.end(), option->name()) != read.end();
        if (!option->given() || option->is_positional() || is_read) continue;
        lines.push_back(fmt::format("{} has no effect: {}", option->name(), reason));
    }
    return lines;
}

std::vector<std::string> idle_of_format(const Command& command) {
    const auto given = [&](const char* name) {
        const Option* option = command.find_option(name);
        return option && option->given();
    };
    if (!given("--wide") || given("--save")) return {};
    for (const char* format : {"--json", "--csv"})
        if (given(format)) return {fmt::format("--wide has no effect: {} has no columns to fit", format)};
    return {};
}

std::vector<std::string> idle_on_traces(const Command& command) {
    std::vector<std::string> lines;
    for (const auto& option : command.options())
        if (option->given() && option->is_about_scene())
            lines.push_back(fmt::format(
                "{} has no effect: {}", option->name(),
                option->name() == "--bvh-cache" ? "a replay of trace files builds no BVH" : "the trace files say it"));
    return lines;
}

void warn_of_idle(const Command& command, std::span<const tracer::CaptureSettings> cases, const CaseUse& use) {
    for (const std::string& line : idle_options(command, cases, use)) warn(line);
}

}  // namespace raycache::tools
