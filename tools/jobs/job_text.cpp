#include "tools/jobs/job_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <utility>

#include "tools/jobs/quality_fields.hpp"
#include "tools/jobs/result_checks.hpp"
#include "tools/jobs/version.hpp"
#include "traces/did_you_mean.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

/// In the order of AnyJob and AnyResult.
constexpr std::array<const char*, std::variant_size_v<AnyJob>> names{"capture", "render",  "replay",
                                                                     "explain", "quality", "samples"};
static_assert(std::variant_size_v<AnyResult> == names.size());

/// The alternative of that index, with its defaults.
template <class Variant, std::size_t... i>
Variant alternative(std::size_t index, std::index_sequence<i...>) {
    Variant made;
    ((index == i ? void(made.template emplace<i>()) : void()), ...);
    return made;
}

/// `json` without the keys in front, which say what it is of.
template <class Variant>
Variant parse(const Reader& reader, Json json, const std::string& source) {
    const auto key = json.find("job");
    if (key == json.end())
        throw Error(fmt::format("{}: key \"job\" is missing; expected one of: {}", source, fmt::join(names, ", ")));
    const std::string name = key->is_string() ? key->template get<std::string>() : "";
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) reader.wrong("job", fmt::format("one of: {}", fmt::join(names, ", ")), *key);
    json.erase("job");
    auto made = alternative<Variant>(static_cast<std::size_t>(at - names.begin()),
                                     std::make_index_sequence<std::variant_size_v<Variant>>());
    std::visit([&](auto& value) { reader.read(json, "", value); }, made);
    return made;
}

}  // namespace

std::string job_name(const AnyJob& job) { return names[job.index()]; }

AnyJob parse_job(const std::string& text, const std::string& source) {
    const Reader reader(source, Reader::Kind::settings);
    return parse<AnyJob>(reader, reader.parse(text), source);
}

std::string job_text(const AnyJob& job) {
    Json json{{"job", job_name(job)}};
    json.update(std::visit([](const auto& settings) { return write_value(settings); }, job));
    return json_text(json);
}

AnyResult run(const AnyJob& job, Observer& observer) {
    return std::visit(
        [&](const auto& settings) -> AnyResult {
            if constexpr (std::is_same_v<decltype(settings), const QualityJob&>) {
                Deliveries deliveries;
                QualityResult result = run(settings, observer, deliveries);
                deliveries.finish(observer.warning());
                return result;
            } else {
                return run(settings, observer);
            }
        },
        job);
}

std::string result_text(const AnyResult& result) {
    Json json{{"job", names[result.index()]}, {"program", program_name}};
    json.update(std::visit([](const auto& value) { return write_value(value); }, result));
    return json.dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
}

AnyResult parse_result(const std::string& text, const std::string& source) {
    const Reader reader(source, Reader::Kind::result);
    Json json = reader.parse(text);
    const std::string program = json.value("program", Json()).is_string() ? json["program"].get<std::string>() : "";
    if (program != program_name)
        throw Error(fmt::format("{}: expected a result of {}, found one of {}; run the job again", source, program_name,
                                program.empty() ? "an unknown program" : program));
    json.erase("program");
    AnyResult result = parse<AnyResult>(reader, std::move(json), source);
    check_result(result, source);
    return result;
}

}  // namespace raycache::tools
