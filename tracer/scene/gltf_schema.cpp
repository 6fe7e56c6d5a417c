#include "tracer/scene/gltf_schema.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "tracer/scene/gltf_schema_tables.hpp"

namespace raycache::tracer {

namespace {

using gltf_schema::Object;
using gltf_schema::Rule;
using gltf_schema::Type;
using nlohmann::json;

std::string text_of(const json& value) {
    constexpr std::size_t longest = 60;
    std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
    if (text.size() > longest) text = text.substr(0, longest) + "…";
    return text;
}

bool is_integer(const json& value) {
    if (value.is_number_integer()) return true;
    constexpr double exact = 9007199254740992.0;  // 2^53
    return value.is_number_float() && std::abs(value.get<double>()) <= exact &&
           std::floor(value.get<double>()) == value.get<double>();
}

class Checker {
public:
    Checker(const json& document, const GltfReport& report) : document_(document), report_(report) {}

    void object(json& value, const Object& shape, const std::string& where) {
        if (!value.is_object()) fail(where, "an object", value);
        for (const Rule& rule : shape.rules) {
            const auto found = value.find(rule.name);
            const std::string place = where.empty() ? std::string(rule.name) : fmt::format("{}.{}", where, rule.name);
            if (found == value.end()) {
                if (rule.required) report_.fail(place, expected(rule, 1), "none");
                continue;
            }
            member(*found, rule, place);
        }
    }

    /// Before references into them are counted.
    void sections(const json& document) const {
        for (const Rule& rule : gltf_schema::document.rules) {
            const auto found = document.find(rule.name);
            if (rule.type == Type::objects && found != document.end() && !found->is_array())
                fail(std::string(rule.name), expected(rule, 1), *found);
        }
    }

private:
    void member(json& value, const Rule& rule, const std::string& where) {
        switch (rule.type) {
            case Type::object:
                object(value, *rule.object, where);
                return;
            case Type::objects:
                each(value, "an array of objects", where,
                     [&](json& item, const std::string& at) { object(item, *rule.object, at); });
                return;
            case Type::numbers:
            case Type::indices:
            case Type::strings:
                if (!value.is_array() || (rule.items != 0 && value.size() != rule.items))
                    fail(where, expected(rule, rule.items), value);
                for (std::size_t i = 0; i < value.size(); ++i) {
                    if (rule.type == Type::numbers && !value[i].is_number())
                        fail(where, expected(rule, rule.items), value);
                    if (rule.type != Type::numbers) scalar(value[i], rule, fmt::format("{}[{}]", where, i));
                }
                return;
            case Type::index_map:
                index_map(value, rule, where);
                return;
            case Type::index_maps:
                each(value, "an array of objects", where,
                     [&](json& item, const std::string& at) { index_map(item, rule, at); });
                return;
            default:
                scalar(value, rule, where);
        }
    }

    template <class Body>
    void each(json& value, const char* wanted, const std::string& where, Body body) {
        if (!value.is_array()) fail(where, wanted, value);
        for (std::size_t i = 0; i < value.size(); ++i) body(value[i], fmt::format("{}[{}]", where, i));
    }

    void index_map(json& value, const Rule& rule, const std::string& where) {
        if (!value.is_object()) fail(where, "an object", value);
        for (const auto& [name, item] : value.items()) scalar(item, rule, fmt::format("{}.{}", where, name));
    }

    /// A value that is no container, or an item of one.
    void scalar(json& value, const Rule& rule, const std::string& where) {
        switch (rule.type) {
            case Type::boolean:
                if (!value.is_boolean()) fail(where, "true or false", value);
                return;
            case Type::strings:
                if (!value.is_string()) fail(where, "a string", value);
                return;
            case Type::string:
                if (!value.is_string() ||
                    (!rule.choices.empty() && std::find(rule.choices.begin(), rule.choices.end(),
                                                        value.get_ref<const std::string&>()) == rule.choices.end()))
                    fail(where, expected(rule, 1), value);
                return;
            case Type::number:
                if (!value.is_number() || !(value.get<double>() >= rule.least)) fail(where, expected(rule, 1), value);
                return;
            default:
                break;
        }
        const bool integer = is_integer(value);
        const double number = integer ? value.get<double>() : 0;
        const bool refers = !rule.section.empty();
        const double most = refers ? static_cast<double>(count(rule.section)) - 1 : rule.most;
        if (!integer || number < rule.least || number > most) fail(where, expected(rule, 1), value);
        if (value.is_number_float()) value = static_cast<std::int64_t>(number);
    }

    /// Objects in a section of the document.
    std::size_t count(std::string_view section) const {
        if (section == "lights") {
            const auto lights = json::json_pointer("/extensions/KHR_lights_punctual/lights");
            return document_.contains(lights) && document_.at(lights).is_array() ? document_.at(lights).size() : 0;
        }
        const auto found = document_.find(section);
        return found != document_.end() && found->is_array() ? found->size() : 0;
    }

    std::string expected(const Rule& rule, std::size_t items) const {
        switch (rule.type) {
            case Type::object:
            case Type::index_map:
                return "an object";
            case Type::objects:
            case Type::index_maps:
                return "an array of objects";
            case Type::numbers:
                return items == 0 ? "an array of numbers" : fmt::format("{} numbers", items);
            case Type::strings:
                return "an array of strings";
            case Type::string:
                return rule.choices.empty() ? "a string" : fmt::format("{}", fmt::join(rule.choices, ", "));
            case Type::boolean:
                return "true or false";
            case Type::number:
                return std::isinf(rule.least) ? "a number" : fmt::format("a number of {} or more", rule.least);
            case Type::integer:
            case Type::index:
            case Type::indices:
                break;
        }
        if (rule.type == Type::indices && items != 1) return fmt::format("an array of integers ({})", rule.section);
        if (!rule.section.empty()) return fmt::format("{} below {}", rule.kind, count(rule.section));
        return std::isinf(rule.most) ? fmt::format("an integer of {} or more", rule.least)
                                     : fmt::format("an integer from {} to {}", rule.least, rule.most);
    }

    [[noreturn]] void fail(const std::string& where, const std::string& wanted, const json& found) const {
        report_.fail(where, wanted, text_of(found));
    }

    const json& document_;
    const GltfReport& report_;
};

}  // namespace

void check_gltf_schema(json& document, const GltfReport& report) {
    Checker checker(document, report);
    checker.sections(document);
    checker.object(document, gltf_schema::document, "");
    // A camera has the member that its type names, and so has a spot light.
    const auto check_named = [&](const char* pointer, const std::string& place, bool spots) {
        const json::json_pointer where(pointer);
        if (!document.contains(where)) return;
        const json& list = document.at(where);
        for (std::size_t i = 0; i < list.size(); ++i) {
            const std::string type = list[i]["type"].get<std::string>();
            if ((!spots || type == "spot") && !list[i].contains(type))
                report.fail(fmt::format("{}[{}].{}", place, i, type), "an object", "none");
        }
    };
    check_named("/cameras", "cameras", false);
    check_named("/extensions/KHR_lights_punctual/lights", "extensions.KHR_lights_punctual.lights", true);
}

}  // namespace raycache::tracer
