#include "tools/jobs/gpu_variants.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cachesim/gpus/gpu_keys.hpp"
#include "tools/jobs/numbers.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

/// The values of a list: split at the commas that stand outside of brackets, braces and quotes.
std::vector<std::string> split_values(const std::string& text) {
    std::vector<std::string> values(1);
    int depth = 0;
    char quote = 0;
    for (const char c : text) {
        if (quote == 0 && (c == '"' || c == '\''))
            quote = c;
        else if (c == quote)
            quote = 0;
        else if (quote == 0 && (c == '[' || c == '{'))
            ++depth;
        else if (quote == 0 && (c == ']' || c == '}'))
            --depth;
        if (c == ',' && depth <= 0 && quote == 0)
            values.emplace_back();
        else
            values.back() += c;
    }
    return values;
}

bool is_size_key(const std::string& key) { return key.ends_with(".size") || cachesim::counts_bytes(key); }

/// A number as TOML has it, which knows neither "064" nor units. Words, lists and fractions stay as they are.
std::string plain_value(const std::string& key, const std::string& value) {
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    const std::size_t sign = !value.empty() && (value[0] == '+' || value[0] == '-');
    if (value.size() <= sign || !is_digit(value[sign])) return value;
    if (is_size_key(key)) return fmt::format("{}", read_size(value, "--set " + key));
    const bool other_base = value.size() > sign + 1 && value[sign] == '0' && std::isalpha(value[sign + 1]) &&
                            value[sign + 1] != 'e' && value[sign + 1] != 'E';
    if (sign != 0 || other_base || value.find('_') != std::string::npos)
        throw UsageError(fmt::format("--set {} '{}': expected a decimal number without sign", key, value));
    if (!std::all_of(value.begin(), value.end(), is_digit)) return value;
    return value.substr(std::min(value.find_first_not_of('0'), value.size() - 1));
}

/// "l1" of "l1.size=65536", and the bytes; no level: another change.
struct SizeChange {
    std::size_t level = 0;
    std::string key;
    std::uint64_t bytes = 0;
};

SizeChange size_change(const std::string& change) {
    const std::size_t equals = change.find('=');
    const std::string key = change.substr(0, equals);
    if (key.size() != 7 || key[0] != 'l' || !key.ends_with(".size")) return {};
    if (key[1] < '1' || key[1] > '3') return {};
    return {static_cast<std::size_t>(key[1] - '0'), key.substr(0, 2),
            read_size(change.substr(equals + 1), "--set " + key)};
}

bool changes_key(const std::vector<std::string>& changes, const std::string& key) {
    return std::any_of(changes.begin(), changes.end(), [&](const auto& c) { return c.starts_with(key + '='); });
}

std::string short_size(std::uint64_t bytes) {
    if (bytes % (1 << 20) == 0) return fmt::format("{} MiB", bytes >> 20);
    return bytes % 1024 == 0 ? fmt::format("{} KiB", bytes >> 10) : fmt::format("{} B", bytes);
}

/// The change of ways or sets that makes a cache of this size.
std::string resized(const cachesim::Gpu& gpu, const SizeChange& size, const std::vector<std::string>& others) {
    if (size.level > gpu.levels.size())
        throw UsageError(
            fmt::format("--set {}.size: expected a level of {}, which has {}", size.key, gpu.name, gpu.levels.size()));
    const cachesim::CacheGeometry& cache = gpu.levels[size.level - 1];
    const std::uint64_t line = std::uint64_t{cache.slices} * cache.line_bytes;
    const bool own_ways = changes_key(others, size.key + ".ways"), own_sets = changes_key(others, size.key + ".sets");
    const std::uint64_t way = line * cache.sets, set = line * cache.ways;
    if (!own_ways && size.bytes % way == 0) return fmt::format("{}.ways={}", size.key, size.bytes / way);
    if (!own_sets && size.bytes % set == 0) return fmt::format("{}.sets={}", size.key, size.bytes / set);
    const std::uint64_t step = own_ways ? set : own_sets ? way : std::min(way, set);
    const std::uint64_t below = std::max<std::uint64_t>(1, size.bytes / step) * step;
    throw UsageError(
        fmt::format("{} of {} for {}: expected a whole number of ways of {} or of sets of {}; the nearest "
                    "are {} and {}",
                    size.key, short_size(size.bytes), gpu.name, short_size(way), short_size(set), short_size(below),
                    short_size(below + step)));
}

cachesim::Gpu load_variant(const std::string& name, const std::vector<std::string>& changes) {
    std::vector<std::string> others;
    std::vector<SizeChange> sizes;
    for (const std::string& change : changes) {
        const SizeChange size = size_change(change);
        if (size.level == 0)
            others.push_back(change);
        else
            sizes.push_back(size);
    }
    const cachesim::Gpu given = cachesim::load_gpu(name, others);
    if (sizes.empty()) return given;
    std::string label = given.name;  // "rtx-3070", or with changes "rtx-3070 (sms=16)"
    std::vector<std::string> all = others;
    for (const SizeChange& size : sizes) {
        all.push_back(resized(given, size, others));
        if (given.levels[size.level - 1].carve_out_bytes != 0) all.push_back(size.key + ".carve_out_bytes=0");
        const std::string text = fmt::format("{}={}", size.key, short_size(size.bytes));
        if (label.ends_with(')'))
            label.replace(label.size() - 1, 1, ", " + text + ')');
        else
            label += " (" + text + ')';
    }
    cachesim::Gpu gpu = cachesim::load_gpu(name, all);
    gpu.name = label;
    return gpu;
}

}  // namespace

std::vector<std::string> listed_changes(const std::string& assignment) {
    const std::size_t equals = assignment.find('=');
    if (equals == std::string::npos) return {assignment};  // load_gpu() says what is wrong
    const std::string key = assignment.substr(0, equals);
    std::vector<std::string> changes;
    for (const std::string& value : split_values(assignment.substr(equals + 1))) {
        const std::string change = key + '=' + plain_value(key, value);
        if (std::find(changes.begin(), changes.end(), change) != changes.end())
            throw UsageError(fmt::format("--set {}: expected each value once, found {} twice", assignment, value));
        changes.push_back(change);
    }
    return changes;
}

std::vector<cachesim::Gpu> load_gpu_variants(const std::string& name,
                                             const std::vector<std::vector<std::string>>& lists) {
    std::size_t count = 1;
    for (const auto& list : lists) {
        count *= list.size();
        if (count > max_gpu_variants)
            throw UsageError(
                fmt::format("--set: expected at most {} combinations of the listed values, found more; "
                            "list fewer",
                            max_gpu_variants));
    }
    std::vector<cachesim::Gpu> gpus;
    for (std::size_t i = 0; i < count; ++i) {
        std::vector<std::string> changes(lists.size());
        std::size_t rest = i;
        for (std::size_t l = lists.size(); l-- > 0; rest /= lists[l].size())
            changes[l] = lists[l][rest % lists[l].size()];
        gpus.push_back(load_variant(name, changes));
    }
    return gpus;
}

}  // namespace raycache::tools
