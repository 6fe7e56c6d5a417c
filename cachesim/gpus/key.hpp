// A key of a GPU file as one row of a table: its name, the member that it sets, what it may be and what it means.
// Reading, limits, `--set`, `raycache list gpus --keys` and docs/gpus.md follow from the row.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "cachesim/gpus/choice.hpp"

namespace raycache::cachesim {

/// What a whole number may be, both ends included.
struct WholeRange {
    static constexpr std::uint64_t no_limit = std::numeric_limits<std::uint64_t>::max();
    std::uint64_t low = 1, high = no_limit;
    bool power_of_two = false;
};

/// "1 to 4096", "1, 2, 4 or 8", "power of two, 16 to 4096"
std::string range_text(const WholeRange&);

template <class Struct, class Integer>
struct WholeValue {
    Integer Struct::*member;
    WholeRange range;
};
/// A positive number, whole or not.
template <class Struct>
struct RealValue {
    double Struct::*member;
    double low, high;  ///< both included; low 0: any positive number
};
template <class Struct>
struct TextValue {
    std::string Struct::*member;
    bool may_be_empty;
};
/// One of the names that the program knows, of policies say.
template <class Struct>
struct NameValue {
    std::string Struct::*member;
    std::vector<std::string> (*names)();
};
template <class Struct, class Integer>
struct ListValue {
    std::vector<Integer> Struct::*member;
    std::size_t most;  ///< numbers
    WholeRange each;
    const char* what;  ///< the numbers are: "address bits"
};
/// One of a list of Choice, whatever its enumeration.
template <class Struct>
struct ChoiceValue {
    std::vector<std::string> (*names)();
    void (*set)(Struct&, std::size_t choice);
    const char* (*name)(const Struct&);
};

template <class Struct>
using KeyValue = std::variant<WholeValue<Struct, std::uint32_t>, WholeValue<Struct, std::uint64_t>, RealValue<Struct>,
                              TextValue<Struct>, NameValue<Struct>, ListValue<Struct, std::uint32_t>,
                              ListValue<Struct, std::uint64_t>, ChoiceValue<Struct>>;

/// What holds where a file lacks the key.
template <class Struct>
struct Absent {
    bool refused;                     ///< the key must be there
    const char* text = nullptr;       ///< the default in words; none: it is the member's initial value
    void (*fill)(Struct&) = nullptr;  ///< the default that follows from members of the rows above
};

template <class Struct>
struct Key {
    const char* name;
    KeyValue<Struct> value;
    Absent<Struct> absent;
    const char* unit;     ///< "cycles"; empty: a number of what the name says, or no number
    const char* meaning;  ///< Markdown, one line; the range and the default are not repeated
};

/// Rows read {"sms", whole(&Gpu::sms, 1, 4096), needed, "", "streaming multiprocessors"}.
template <class Struct, class Integer>
constexpr KeyValue<Struct> whole(Integer Struct::*member, std::uint64_t low = 1,
                                 std::uint64_t high = WholeRange::no_limit) {
    return WholeValue<Struct, Integer>{member, {low, high, false}};
}
template <class Struct, class Integer>
constexpr KeyValue<Struct> power_of_two(Integer Struct::*member, std::uint64_t low = 1,
                                        std::uint64_t high = WholeRange::no_limit) {
    return WholeValue<Struct, Integer>{member, {low, high, true}};
}
template <class Struct>
constexpr KeyValue<Struct> real(double Struct::*member, double low = 0,
                                double high = std::numeric_limits<double>::infinity()) {
    return RealValue<Struct>{member, low, high};
}
template <class Struct>
constexpr KeyValue<Struct> text(std::string Struct::*member) {
    return TextValue<Struct>{member, false};
}
template <class Struct>
constexpr KeyValue<Struct> text_or_none(std::string Struct::*member) {
    return TextValue<Struct>{member, true};
}
template <class Struct>
constexpr KeyValue<Struct> name_out_of(std::string Struct::*member, std::vector<std::string> (*names)()) {
    return NameValue<Struct>{member, names};
}
template <class Struct, class Integer>
constexpr KeyValue<Struct> list(std::vector<Integer> Struct::*member, const char* what,
                                std::size_t most = WholeRange::no_limit, std::uint64_t highest = WholeRange::no_limit) {
    return ListValue<Struct, Integer>{member, most, {0, highest, false}, what};
}
template <auto member, const auto& choices, class Struct, class Enum>
constexpr KeyValue<Struct> choice_of(Enum Struct::*) {
    return ChoiceValue<Struct>{[] {
                                   std::vector<std::string> names;
                                   for (const Choice<Enum>& c : choices) names.emplace_back(c.name);
                                   return names;
                               },
                               [](Struct& into, std::size_t i) { into.*member = choices[i].value; },
                               [](const Struct& of) { return name_of<Enum>(choices, of.*member); }};
}
/// choice<&Gpu::scheduler, schedulers>()
template <auto member, const auto& choices>
constexpr auto choice() {
    return choice_of<member, choices>(member);
}

struct Needed {
    template <class Struct>
    constexpr operator Absent<Struct>() const {
        return {true};
    }
};
struct Initial {
    template <class Struct>
    constexpr operator Absent<Struct>() const {
        return {false};
    }
};
inline constexpr Needed needed;    ///< the file must have the key
inline constexpr Initial initial;  ///< else the member keeps its initial value

}  // namespace raycache::cachesim
