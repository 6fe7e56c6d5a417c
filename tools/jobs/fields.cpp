#include "tools/jobs/fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "traces/did_you_mean.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

constexpr int most_levels = 32;

/// As it stands in the text, but not the whole of a long one.
std::string shown(const Json& json) {
    std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    constexpr std::size_t most = 60;
    if (text.size() > most) text = text.substr(0, most) + "…";
    return text;
}

/// nlohmann's words without its "[json.exception.parse_error.101] ".
std::string reason(const std::exception& e) {
    const std::string text = e.what();
    const std::size_t bracket = text.find("] ");
    return bracket == std::string::npos ? text : text.substr(bracket + 2);
}

}  // namespace

std::string join_places(const std::string& outer, const std::string& key) {
    return outer.empty() ? key : outer + '.' + key;
}

Json Reader::parse(const std::string& text) const {
    std::vector<std::set<std::string>> keys;  // of the objects that are open
    std::string twice;
    const auto watch = [&](int depth, Json::parse_event_t event, Json& parsed) {
        if (depth > most_levels)
            throw Error(fmt::format("{}: expected at most {} levels of brackets, found more", source_, most_levels));
        if (event == Json::parse_event_t::object_start) keys.emplace_back();
        if (event == Json::parse_event_t::object_end) keys.pop_back();
        if (event == Json::parse_event_t::key && !keys.back().insert(parsed.get<std::string>()).second && twice.empty())
            twice = parsed.get<std::string>();
        return true;
    };
    Json json;
    try {
        json = Json::parse(text, watch);
    } catch (const Json::exception& e) {
        throw Error(fmt::format("{}: expected JSON, found something else: {}", source_, reason(e)));
    }
    if (!twice.empty()) throw Error(fmt::format("{}: expected each key once, found \"{}\" twice", source_, twice));
    if (!json.is_object()) throw Error(fmt::format("{}: expected an object {{…}}, found {}", source_, shown(json)));
    return json;
}

void Reader::wrong(const std::string& place, const std::string& expected, const Json& found) const {
    throw Error(fmt::format("{}: key \"{}\": expected {}, found {}", source_, place, expected, shown(found)));
}

void Reader::missing(const std::string& place) const {
    throw Error(fmt::format("{}: key \"{}\" is missing", source_, place));
}

void Reader::check_keys(const Json& json, const std::string& place, const std::vector<std::string>& keys) const {
    for (const auto& [key, value] : json.items()) {
        if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
        throw Error(fmt::format("{}: unknown key \"{}\"; expected one of: {}{}", source_, join_places(place, key),
                                fmt::join(keys, ", "), did_you_mean(key, keys)));
    }
}

std::string Reader::read_text(const Json& json, const std::string& place) const {
    if (kind_ == Kind::settings && json.is_number()) return json.dump();
    if (!json.is_string()) wrong(place, "a text \"…\"", json);
    return json.get<std::string>();
}

double Reader::read_number(const Json& json, const std::string& place, double most) const {
    if (json.is_number() && std::fabs(json.get<double>()) <= most) return json.get<double>();
    if (kind_ == Kind::result && json.is_string()) {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        const std::string word = json.get<std::string>();
        if (word == "nan") return std::numeric_limits<double>::quiet_NaN();
        if (word == "inf") return infinity;
        if (word == "-inf") return -infinity;
    }
    wrong(place, "a number", json);
}

std::uint64_t Reader::read_whole(const Json& json, const std::string& place, std::uint64_t most) const {
    if (!json.is_number_unsigned() || json.get<std::uint64_t>() > most)
        wrong(place, fmt::format("a whole number from 0 to {}", most), json);
    return json.get<std::uint64_t>();
}

}  // namespace raycache::tools
