// Members of the objects of a glTF file: appendix A of the glTF 2.0 specification, and the extensions we read.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string_view>

namespace raycache::tracer::gltf_schema {

enum class Type {
    object,      ///< described by Rule::object
    objects,     ///< array of such
    numbers,     ///< array
    strings,     ///< array
    indices,     ///< array
    index_map,   ///< object whose members are all indices
    index_maps,  ///< array of such
    index,       ///< into Rule::section
    integer,
    number,
    string,
    boolean
};

struct Object;

struct Rule {
    std::string_view name;
    Type type;
    bool required = false;
    double least = -std::numeric_limits<double>::infinity();
    double most = std::numeric_limits<double>::infinity();
    std::size_t items = 0;       ///< of an array of numbers; 0: any number
    std::string_view section{};  ///< that indices point into,
    std::string_view kind{};     ///< and one of it, in words
    const Object* object = nullptr;
    std::span<const std::string_view> choices{};  ///< that a string has; none: any
};

struct Object {
    std::span<const Rule> rules;
};

constexpr Rule number(std::string_view name) { return {name, Type::number}; }
constexpr Rule not_negative(std::string_view name) { return {name, Type::number, false, 0}; }
constexpr Rule numbers(std::string_view name, std::size_t items) {
    Rule rule{name, Type::numbers};
    rule.items = items;
    return rule;
}
constexpr Rule integer(std::string_view name, double least = 0) { return {name, Type::integer, false, least}; }
constexpr Rule text(std::string_view name) { return {name, Type::string}; }
constexpr Rule choice(std::string_view name, std::span<const std::string_view> choices) {
    Rule rule{name, Type::string};
    rule.choices = choices;
    return rule;
}
constexpr Rule flag(std::string_view name) { return {name, Type::boolean}; }
constexpr Rule refers(std::string_view name, std::string_view section, std::string_view kind, Type type = Type::index) {
    Rule rule{name, type, false, 0};
    rule.section = section;
    rule.kind = kind;
    return rule;
}
constexpr Rule has(std::string_view name, const Object& object, Type type = Type::object) {
    Rule rule{name, type};
    rule.object = &object;
    return rule;
}
constexpr Rule required(Rule rule) {
    rule.required = true;
    return rule;
}

extern const Object document;

}  // namespace raycache::tracer::gltf_schema
