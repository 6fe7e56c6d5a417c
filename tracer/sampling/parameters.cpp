#include "tracer/sampling/parameters.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>

#include "traces/error.hpp"

namespace raycache::tracer {
namespace {

template <class Number>
std::optional<Number> read(const std::string& text) {
    Number value{};
    const char* const end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc{} || stop != end) return std::nullopt;
    return value;
}

std::string range_text(const ParameterEntry& entry) {
    if (entry.has_choices()) return fmt::format("one of: {}", fmt::join(entry.choice_names(), ", "));
    std::string text = std::isfinite(entry.most) ? fmt::format("{:.10g} to {:.10g}", entry.least, entry.most)
                       : entry.whole             ? fmt::format("{:.10g} or more", entry.least)
                                                 : fmt::format("a number of {:.10g} or more", entry.least);
    return *entry.word ? fmt::format("{}, or '{}'", text, entry.word) : text;
}

[[noreturn]] void refuse(const ParameterEntry& entry, const std::string& found) {
    throw UsageError(fmt::format("{}: {} must be {}, found {}: {}", entry.topic, entry.label, range_text(entry),
                                 found.empty() ? "nothing" : found, entry.remedy));
}

template <class Number>
Number read_in_range(const ParameterEntry& entry, const std::string& text) {
    const std::optional<Number> value = read<Number>(text);
    const double compared = value ? static_cast<double>(*value) : std::nan("");
    if (!std::isfinite(compared) || compared < entry.least || compared > entry.most) refuse(entry, text);
    return *value;
}

}  // namespace

std::vector<std::string> ParameterEntry::choice_names() const {
    std::vector<std::string> names;
    for (const char* choice : choices)
        if (choice != nullptr) names.emplace_back(choice);
    return names;
}

void Parameters::set_real(const std::string& name, double value) { given_[name] = fmt::format("{}", value); }

std::string Parameters::text(const std::string& name) const {
    const auto found = given_.find(name);
    return found == given_.end() ? std::string() : found->second;
}

std::string Parameters::text(const ParameterEntry& entry) const {
    const auto found = given_.find(entry.name);
    return found == given_.end() ? entry.fallback : found->second;
}

std::optional<double> Parameters::number(const std::string& name) const { return read<double>(text(name)); }

double Parameters::real(const ParameterEntry& entry) const { return read_in_range<double>(entry, text(entry)); }

std::uint64_t Parameters::whole(const ParameterEntry& entry) const {
    return read_in_range<std::uint64_t>(entry, text(entry));
}

std::string Parameters::word(const ParameterEntry& entry) const {
    check_parameter(entry, text(entry));
    return text(entry);
}

bool Parameters::is_word(const ParameterEntry& entry) const { return *entry.word && text(entry) == entry.word; }

void check_parameter(const ParameterEntry& entry, const std::string& value) {
    if (entry.check) return entry.check(value);
    if (entry.has_choices()) {
        for (const std::string& name : entry.choice_names())
            if (value == name) return;
        refuse(entry, value);
    }
    if (*entry.word && value == entry.word) return;
    if (entry.whole)
        read_in_range<std::uint64_t>(entry, value);
    else
        read_in_range<double>(entry, value);
}

}  // namespace raycache::tracer
