// A plain struct as JSON and back: its members and their keys are listed once.
//
// Whole numbers stay exact, other numbers too (the shortest decimal that reads back as the same); a number that is none
// or infinite is "nan", "inf" or "-inf". Null is an absent std::optional.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "tools/jobs/subject.hpp"

namespace raycache::tools {

template <class Struct, class Member>
struct Field {
    const char* key;
    Member Struct::*member;

    auto& of(auto& object) const { return object.*member; }
};
template <class Struct, class Member>
Field(const char*, Member Struct::*) -> Field<Struct, Member>;

/// One element of a member that is an array, under a key of its own.
template <class Struct, class Array>
struct Element {
    const char* key;
    Array Struct::*array;
    std::size_t index;

    auto& of(auto& object) const { return (object.*array)[index]; }
};
template <class Struct, class Array>
Element(const char*, Array Struct::*, int) -> Element<Struct, Array>;

/// To be specialised: `static constexpr std::tuple all{Field{"spp", &S::spp}, …};`, every member that is to be kept.
template <class Struct>
struct Fields {};
template <class T>
concept HasFields = requires {
    Fields<T>::all;
};

/// To be specialised: `static constexpr std::array all{std::pair{E::none, "none"}, …};`
template <class Enum>
struct EnumNames {};
template <class T>
concept HasNames = requires {
    EnumNames<T>::all;
};

/// To be specialised where neither fits: `static Json write(const T&)`, `static void read(const Reader&, const Json&,
/// const std::string& place, T&)`.
template <class T>
struct Codec {};
template <class T>
concept HasCodec = requires(const T& value) {
    Codec<T>::write(value);
};

template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;
template <class T>
concept Growing = requires(T& list) {
    list.resize(1);
};

template <class T>
Json write_value(const T& value) {
    if constexpr (HasCodec<T>) {
        return Codec<T>::write(value);
    } else if constexpr (std::same_as<T, std::string> || std::same_as<T, bool> || std::integral<T> ||
                         std::same_as<T, Json>) {
        return value;
    } else if constexpr (std::floating_point<T>) {
        if (std::isfinite(value)) return static_cast<double>(value);
        return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
    } else if constexpr (HasNames<T>) {
        for (const auto& [named, name] : EnumNames<T>::all)
            if (named == value) return name;
        return nullptr;
    } else if constexpr (is_optional<T>) {
        return value ? write_value(*value) : Json(nullptr);
    } else if constexpr (HasFields<T>) {
        Json object = Json::object();
        std::apply([&](const auto&... field) { ((object[field.key] = write_value(field.of(value))), ...); },
                   Fields<T>::all);
        return object;
    } else {  // a list
        Json list = Json::array();
        for (const auto& element : value) list.push_back(write_value(element));
        return list;
    }
}

/// JSON to values. What does not fit is an Error: "SOURCE: key "sampling.seed": expected …, found …".
class Reader {
public:
    enum class Kind {
        settings,  ///< what is missing keeps its default; numbers are finite; a text may be given as a number
        result     ///< every key is there
    };
    /// `source`: what the text is called in messages, such as its file's name.
    Reader(std::string source, Kind kind) : source_(std::move(source)), kind_(kind) {}

    /// A text as JSON: one object, each key once, not nested deeper than any that this program writes. Throws Error
    /// that says where it is not.
    Json parse(const std::string& text) const;

    /// `place`: the keys that lead to it, such as "launches[2].sample"; empty for the whole.
    template <class T>
    void read(const Json&, const std::string& place, T& out) const;

    [[noreturn]] void wrong(const std::string& place, const std::string& expected, const Json& found) const;

private:
    void check_keys(const Json&, const std::string& place, const std::vector<std::string>& keys) const;
    std::string read_text(const Json&, const std::string& place) const;
    double read_number(const Json&, const std::string& place, double most) const;
    std::uint64_t read_whole(const Json&, const std::string& place, std::uint64_t most) const;
    [[noreturn]] void missing(const std::string& place) const;

    std::string source_;
    Kind kind_;
};

/// "scene" and "fov": "scene.fov".
std::string join_places(const std::string& outer, const std::string& key);

template <class T>
void Reader::read(const Json& json, const std::string& place, T& out) const {
    if constexpr (HasCodec<T>) {
        Codec<T>::read(*this, json, place, out);
    } else if constexpr (std::same_as<T, Json>) {
        out = json;
    } else if constexpr (std::same_as<T, std::string>) {
        out = read_text(json, place);
    } else if constexpr (std::same_as<T, bool>) {
        if (!json.is_boolean()) wrong(place, "true or false", json);
        out = json.get<bool>();
    } else if constexpr (std::unsigned_integral<T>) {
        out = static_cast<T>(read_whole(json, place, std::numeric_limits<T>::max()));
    } else if constexpr (std::floating_point<T>) {
        out = static_cast<T>(read_number(json, place, double{std::numeric_limits<T>::max()}));
    } else if constexpr (HasNames<T>) {
        const std::string name = json.is_string() ? json.template get<std::string>() : std::string();
        std::string expected = "one of:";
        for (const auto& [named, own] : EnumNames<T>::all) {
            if (name == own) {
                out = named;
                return;
            }
            expected += std::string(expected.ends_with(':') ? " " : ", ") + own;
        }
        wrong(place, expected, json);
    } else if constexpr (is_optional<T>) {
        out.reset();
        if (json.is_null()) return;
        typename T::value_type value{};
        read(json, place, value);
        out = std::move(value);
    } else if constexpr (HasFields<T>) {
        if (!json.is_object()) wrong(place, "an object {…}", json);
        std::apply([&](const auto&... field) { check_keys(json, place, {field.key...}); }, Fields<T>::all);
        const auto read_member = [&](const auto& field) {
            if (const auto at = json.find(field.key); at != json.end())
                read(*at, join_places(place, field.key), field.of(out));
            else if (kind_ == Kind::result)
                missing(join_places(place, field.key));
        };
        std::apply([&](const auto&... field) { (read_member(field), ...); }, Fields<T>::all);
    } else {
        if (!json.is_array()) wrong(place, "a list […]", json);
        if constexpr (Growing<T>) {
            out.clear();
            out.resize(json.size());
        }
        if (json.size() != out.size()) wrong(place, "a list of " + std::to_string(out.size()), json.size());
        std::size_t i = 0;
        for (auto& element : out) {
            read(json[i], place + '[' + std::to_string(i) + ']', element);
            ++i;
        }
    }
}

}  // namespace raycache::tools
