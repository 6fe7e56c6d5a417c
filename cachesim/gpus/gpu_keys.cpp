#include "cachesim/gpus/gpu_keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "cachesim/gpus/key_tables.hpp"

namespace raycache::cachesim {

std::string range_text(const WholeRange& range) {
    const bool open = range.high == WholeRange::no_limit;
    constexpr std::uint64_t few = 32;
    if (range.power_of_two && range.high <= few) {
        std::string list;
        for (std::uint64_t n = range.low; n <= range.high; n *= 2)
            list += fmt::format("{}{}", list.empty() ? "" : n * 2 > range.high ? " or " : ", ", n);
        return list;
    }
    const std::string limits =
        open ? fmt::format("{} or more", range.low) : fmt::format("{} to {}", range.low, range.high);
    return !range.power_of_two ? limits : open ? "power of two" : fmt::format("power of two, {}", limits);
}

namespace {

template <class Names>
std::string quoted(const Names& names) {
    return fmt::format("`{}`", fmt::join(names, "`, `"));
}

struct Values {
    template <class Struct, class Integer>
    std::string operator()(const WholeValue<Struct, Integer>& v) const {
        return range_text(v.range);
    }
    template <class Struct>
    std::string operator()(const RealValue<Struct>& v) const {
        if (v.low > 0) return fmt::format("{} to {}", v.low, v.high);
        return std::isfinite(v.high) ? fmt::format("above 0, up to {}", v.high) : "above 0";
    }
    template <class Struct>
    std::string operator()(const TextValue<Struct>&) const {
        return "text";
    }
    template <class Struct>
    std::string operator()(const NameValue<Struct>& v) const {
        return quoted(v.names());
    }
    template <class Struct, class Integer>
    std::string operator()(const ListValue<Struct, Integer>& v) const {
        std::string text = "list of ";
        if (v.most != WholeRange::no_limit) text += fmt::format("at most {} ", v.most);
        text += v.what;
        return v.each.high == WholeRange::no_limit ? text : text + fmt::format(", each {}", range_text(v.each));
    }
    template <class Struct>
    std::string operator()(const ChoiceValue<Struct>& v) const {
        return quoted(v.names());
    }
};

/// A member's initial value, as a file would have it.
template <class Struct>
struct InitialValue {
    const Struct of{};

    template <class Integer>
    std::string operator()(const WholeValue<Struct, Integer>& v) const {
        return fmt::format("{}", of.*v.member);
    }
    std::string operator()(const RealValue<Struct>& v) const { return fmt::format("{}", of.*v.member); }
    std::string operator()(const TextValue<Struct>& v) const { return text(of.*v.member); }
    std::string operator()(const NameValue<Struct>& v) const { return text(of.*v.member); }
    template <class Integer>
    std::string operator()(const ListValue<Struct, Integer>&) const {
        return "none";  // of no key a list that is not empty
    }
    std::string operator()(const ChoiceValue<Struct>& v) const { return text(v.name(of)); }

private:
    static std::string text(const std::string& value) { return value.empty() ? "none" : '`' + value + '`'; }
};

template <class Struct>
void append(std::vector<GpuKey>& all, const char* section, std::span<const Key<Struct>> keys) {
    for (const Key<Struct>& key : keys) {
        const Absent<Struct>& absent = key.absent;
        const std::string otherwise = absent.text      ? absent.text
                                      : absent.refused ? ""
                                                       : std::visit(InitialValue<Struct>{}, key.value);
        all.push_back({section, key.name, absent.refused && !absent.text, otherwise, std::visit(Values{}, key.value),
                       key.unit, key.meaning});
    }
}

}  // namespace

std::vector<GpuKey> gpu_keys() {
    std::vector<GpuKey> all;
    append(all, "", chip_keys());
    append(all, "registers", register_keys());
    append(all, "front_end", front_end_keys());
    append(all, "l1", level_keys());
    append(all, "timing", timing_keys());
    append(all, "rt_unit", rt_unit_keys());
    return all;
}

std::vector<std::string> gpu_key_names() {
    std::vector<std::string> names;
    for (const GpuKey& key : gpu_keys()) {
        if (key.section == "l1")
            for (const char* level : {"l1", "l2", "l3"}) names.push_back(fmt::format("{}.{}", level, key.name));
        else if (!key.section.empty())
            names.push_back(fmt::format("{}.{}", key.section, key.name));
        else if (key.name != "name" && key.name != "description")
            names.push_back(key.name);
    }
    return names;
}

bool counts_bytes(const std::string& key_name) {
    const auto dot = key_name.find('.');
    std::string section = dot == std::string::npos ? "" : key_name.substr(0, dot);
    if (section == "l2" || section == "l3") section = "l1";
    const std::string name = key_name.substr(dot + 1);
    const auto keys = gpu_keys();
    return std::any_of(keys.begin(), keys.end(), [&](const GpuKey& key) {
        return key.section == section && key.name == name && key.unit == "bytes";
    });
}

}  // namespace raycache::cachesim
