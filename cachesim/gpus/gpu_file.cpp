#include "cachesim/gpus/gpu_file.hpp"

#include <algorithm>
#include <set>
#include <string_view>

#include "cachesim/gpus/key_tables.hpp"
#include "cachesim/gpus/limits.hpp"
#include "cachesim/gpus/toml_reader.hpp"
#include "cachesim/gpus/value_check.hpp"
#include "traces/record.hpp"

namespace raycache::cachesim {

namespace {

template <class Struct>
std::vector<std::string> names_of(std::span<const Key<Struct>> keys) {
    std::vector<std::string> names;
    for (const Key<Struct>& key : keys) names.emplace_back(key.name);
    return names;
}

/// Reads one value into its member.
template <class Struct>
struct Reading {
    TomlReader::Section& section;
    const std::string key;
    Struct& into;

    template <class Integer>
    void operator()(const WholeValue<Struct, Integer>& v) {
        into.*v.member = section.number<Integer>(key, v.range.low == 0);
    }
    void operator()(const RealValue<Struct>& v) { into.*v.member = section.positive(key); }
    void operator()(const TextValue<Struct>& v) {
        into.*v.member = v.may_be_empty ? section.text_or_empty(key) : section.text(key);
    }
    void operator()(const NameValue<Struct>& v) { into.*v.member = section.text(key); }
    template <class Integer>
    void operator()(const ListValue<Struct, Integer>& v) {
        into.*v.member = section.numbers<Integer>(key);
    }
    void operator()(const ChoiceValue<Struct>& v) { v.set(into, section.choice(key, v.names())); }
};

template <class Struct>
struct OthersOf {
    template <class Integer>
    OtherValues operator()(const WholeValue<Struct, Integer>& v) {
        return v.range.power_of_two ? OtherValues::listed : OtherValues::between;
    }
    OtherValues operator()(const RealValue<Struct>&) { return OtherValues::between; }
    OtherValues operator()(const TextValue<Struct>&) { return OtherValues::none; }
    OtherValues operator()(const NameValue<Struct>&) { return OtherValues::listed; }
    template <class Integer>
    OtherValues operator()(const ListValue<Struct, Integer>&) {
        return OtherValues::none;
    }
    OtherValues operator()(const ChoiceValue<Struct>&) { return OtherValues::listed; }
};

/// Reads the keys that are there, or must be; the others get their defaults. What the file says a key may be instead
/// must be as right as its value.
template <class Struct>
void read_keys(TomlReader& file, TomlReader::Section section, std::span<const Key<Struct>> keys, Struct& into,
               const std::string& prefix = "") {
    for (const Key<Struct>& key : keys) {
        if (section.has(key.name) || key.absent.refused) {
            std::visit(Reading<Struct>{section, key.name, into}, key.value);
            const bool is_text = key.name == std::string_view("name") || key.name == std::string_view("description");
            if (prefix.empty() && is_text) continue;
            section.read_others(key.name, std::visit(OthersOf<Struct>{}, key.value), [&] {
                Struct other = into;
                std::visit(Reading<Struct>{section, key.name, other}, key.value);
                if (const auto p = find_value_problem(key, other, prefix)) file.fail_at(p->key, p->message);
            });
        } else if (key.absent.fill) {
            key.absent.fill(into);
        }
    }
}
template <class Struct>
Struct read_section(TomlReader& file, TomlReader::Section& root, const std::string& name,
                    std::span<const Key<Struct>> keys) {
    Struct values;
    read_keys(file, root.section(name, names_of(keys)), keys, values, name + '.');
    return values;
}

CacheGeometry read_cache(TomlReader& file, TomlReader::Section& root, const std::string& level) {
    auto cache = read_section(file, root, level, level_keys());
    std::uint64_t way_bytes = std::uint64_t{cache.slices} * cache.line_bytes;
    if (cache.carve_out_bytes == 0 || __builtin_mul_overflow(way_bytes, cache.sets, &way_bytes)) return cache;
    const std::uint64_t taken = cache.carve_out_bytes / way_bytes + (cache.carve_out_bytes % way_bytes != 0);
    if (taken >= cache.ways)
        file.fail_at(
            level + ".carve_out_bytes",
            fmt::format("expected to leave at least one of {} ways of {} bytes, found {} bytes; carve out less",
                        cache.ways, way_bytes, cache.carve_out_bytes));
    cache.ways -= taken;
    return cache;
}

/// The warps of as many CTAs as the registers of an SM hold; 0 where the file does not give them.
std::uint32_t warps_by_registers(TomlReader& file, TomlReader::Section& root, const Gpu& gpu) {
    if (!root.has("registers")) return 0;
    const auto registers = read_section(file, root, "registers", register_keys());
    const std::uint64_t of_warp =
        (std::uint64_t{registers.per_thread} * traces::warp_lanes + registers.allocation - 1) / registers.allocation *
        registers.allocation;
    std::uint64_t warps = registers.per_sm / of_warp;
    if (gpu.max_warps_per_sm) warps = std::min<std::uint64_t>(warps, gpu.max_warps_per_sm);
    const auto resident = static_cast<std::uint32_t>(warps / gpu.warps_per_cta * gpu.warps_per_cta);
    if (resident == 0 && !root.has("warps_per_sm"))
        file.fail_at("registers.per_thread",
                     fmt::format("expected a CTA of {} warps to fit an SM, found registers for {}; use fewer "
                                 "registers or a smaller CTA",
                                 gpu.warps_per_cta, warps));
    return resident;
}

/// The keys that are in no section. Resident warps follow from the keys above them and from [registers], unless they
/// are given.
void read_chip(TomlReader& file, TomlReader::Section& root, Gpu& gpu) {
    const auto keys = chip_keys();
    const auto resident = std::find_if(
        keys.begin(), keys.end(), [](const Key<Gpu>& key) { return key.name == std::string_view("warps_per_sm"); });
    const auto place = static_cast<std::size_t>(resident - keys.begin());
    read_keys(file, root, keys.first(place), gpu);
    const std::uint32_t by_registers = warps_by_registers(file, root, gpu);
    if (by_registers && !root.has("warps_per_sm")) {
        gpu.warps_per_sm = by_registers;
        file.note("warps_per_sm", fmt::format("{}", by_registers),
                  "computed: the CTAs that the registers of an SM hold");
    } else {
        read_keys(file, root, keys.subspan(place, 1), gpu);
    }
    read_keys(file, root, keys.subspan(place + 1), gpu);
}

Gpu read(TomlReader& file) {
    std::vector<std::string> known = names_of(chip_keys());
    for (const char* section : {"registers", "front_end", "l1", "l2", "l3", "timing", "rt_unit"})
        known.emplace_back(section);
    TomlReader::Section root = file.root(known);
    Gpu gpu;
    read_chip(file, root, gpu);
    if (root.has("front_end")) gpu.front_end = read_section(file, root, "front_end", front_end_keys());
    gpu.levels.clear();
    const std::size_t levels = root.has("l3") ? 3 : 2;
    for (std::size_t level = 1; level <= levels; ++level)
        gpu.levels.push_back(read_cache(file, root, fmt::format("l{}", level)));
    if (root.has("timing")) gpu.timing = read_section(file, root, "timing", timing_keys());
    if (root.has("rt_unit")) gpu.rt_unit = read_section(file, root, "rt_unit", rt_unit_keys());
    if (const auto problem = find_problem(gpu)) file.fail_at(problem->key, problem->message);
    return gpu;
}

/// The values of these keys, as the GPU has them. What has no value of its own, a name, is passed over.
void note_changes(Gpu& gpu, const std::set<std::string>& keys, const std::vector<GpuValue>& values) {
    for (const std::string& key : keys)
        for (const GpuValue& v : values)
            if (v.key == key) gpu.changes.emplace_back(key, v.value);
    if (gpu.changes.empty()) return;
    std::string list;
    for (const auto& [key, value] : gpu.changes) list += fmt::format("{}{}={}", list.empty() ? "" : ", ", key, value);
    gpu.name += fmt::format(" ({})", list);
}

}  // namespace

Gpu parse_gpu(const std::string& toml, const std::string& file, const std::vector<std::string>& changes) {
    TomlReader reader(toml, file);
    std::set<std::string> changed;
    for (const std::string& change : changes) changed.insert(reader.change(change));
    Gpu gpu = read(reader);
    note_changes(gpu, changed, reader.values());
    return gpu;
}

std::vector<GpuValue> parse_gpu_values(const std::string& toml, const std::string& file,
                                       const std::vector<std::string>& changes) {
    TomlReader reader(toml, file);
    for (const std::string& change : changes) reader.change(change);
    read(reader);
    return reader.values();
}

}  // namespace raycache::cachesim
