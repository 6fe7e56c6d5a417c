#include "cachesim/gpus/gpu_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <map>
#include <sstream>

#include "cachesim/gpus/limits.hpp"
#include "traces/error.hpp"

#define TOML_HEADER_ONLY 1
#include <toml++/toml.h>

namespace raycache::cachesim {

namespace {

constexpr const char* root_keys[] = {"name",          "description", "sms", "warps_per_sm",
                                     "warps_per_cta", "l1_per_sm",   "l1",  "l2"};
constexpr const char* cache_keys[] = {"sets", "ways", "line_bytes", "sector_bytes", "index", "policy"};

std::string one_line(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
    return text;
}

std::string type_name(const toml::node& node) {
    std::ostringstream name;
    name << node.type();
    return name.str();
}

/// One file: knows lines and keys, so that every error names them.
class GpuFile {
public:
    GpuFile(const std::string& toml, const std::string& file) : file_(file) {
        try {
            root_ = toml::parse(toml, file);
        } catch (const toml::parse_error& e) {
            throw Error(fmt::format("{}:{}: expected TOML, found an error: {}; correct the line", file_,
                                    e.source().begin.line, one_line(std::string(e.description()))));
        }
    }

    Gpu read() {
        only_keys(root_, "", root_keys);
        Gpu gpu;
        gpu.name = text(root_, "", "name");
        gpu.description = text(root_, "", "description");
        gpu.sms = number<std::uint32_t>(root_, "", "sms");
        gpu.warps_per_sm = number<std::uint32_t>(root_, "", "warps_per_sm");
        gpu.warps_per_cta = number<std::uint32_t>(root_, "", "warps_per_cta");
        gpu.l1_per_sm = number<std::uint32_t>(root_, "", "l1_per_sm");
        gpu.l1 = cache("l1");
        gpu.l2 = cache("l2");
        if (const auto problem = find_problem(gpu)) fail(lines_[problem->key], problem->key, problem->message);
        return gpu;
    }

    /// In the order in which read() met them; it must have passed.
    const std::vector<GpuValue>& values() const { return values_; }

private:
    [[noreturn]] void fail(std::size_t line, const std::string& key, const std::string& message) const {
        throw Error(fmt::format("{}:{}: {}: {}", file_, line, key, message));
    }

    static std::size_t line_of(const toml::node& node) { return node.source().begin.line; }

    template <class Keys>
    void only_keys(const toml::table& table, const std::string& prefix, const Keys& known) const {
        for (const auto& [key, node] : table) {
            const std::string name(key.str());
            if (std::find(std::begin(known), std::end(known), name) == std::end(known))
                fail(key.source().begin.line, one_line(prefix + name),
                     fmt::format("expected one of the keys {}, found an unknown one; correct or remove it",
                                 fmt::join(known, ", ")));
        }
    }

    CacheGeometry cache(const std::string& level) {
        const toml::node& node = find(root_, "", level);
        const toml::table* table = node.as_table();
        if (!table)
            fail(line_of(node), level,
                 fmt::format("expected a table, found {}; write [{}] and its keys below", type_name(node), level));
        only_keys(*table, level + ".", cache_keys);
        CacheGeometry cache;
        cache.sets = number<std::uint64_t>(*table, level + ".", "sets");
        cache.ways = number<std::uint64_t>(*table, level + ".", "ways");
        cache.line_bytes = number<std::uint32_t>(*table, level + ".", "line_bytes");
        cache.sector_bytes = number<std::uint32_t>(*table, level + ".", "sector_bytes");
        const std::string index = text(*table, level + ".", "index");
        if (index != "modulo" && index != "xor_fold")
            fail(lines_[level + ".index"], level + ".index",
                 fmt::format("expected \"modulo\" or \"xor_fold\", found \"{}\"", one_line(index)));
        cache.index = index == "modulo" ? SetIndex::modulo : SetIndex::xor_fold;
        cache.policy = one_line(text(*table, level + ".", "policy"));
        return cache;
    }

    const toml::node& find(const toml::table& table, const std::string& prefix, const std::string& key) const {
        if (const toml::node* node = table.get(key)) return *node;
        fail(std::max<std::size_t>(1, line_of(table)), prefix + key, "expected this key, found none; add it");
    }

    /// The value itself, out of { value = …, source = "…" } if need be.
    const toml::node& value(const toml::table& table, const std::string& prefix, const std::string& key) {
        const toml::node& node = find(table, prefix, key);
        const std::string name = prefix + key;
        lines_[name] = line_of(node);
        const toml::table* pair = node.as_table();
        if (!pair) {
            values_.push_back({name, "", ""});
            return node;
        }
        static constexpr const char* pair_keys[] = {"value", "source"};
        only_keys(*pair, name + ".", pair_keys);
        const toml::node& source = find(*pair, name + ".", "source");
        if (!source.is_string())
            fail(line_of(source), name + ".source", fmt::format("expected a string, found {}", type_name(source)));
        values_.push_back({name, "", one_line(source.value_or(std::string()))});
        return find(*pair, name + ".", "value");
    }

    template <class Integer>
    Integer number(const toml::table& table, const std::string& prefix, const std::string& key) {
        const toml::node& node = value(table, prefix, key);
        const auto expected = fmt::format("expected a positive whole number below {}",
                                          std::min<std::uint64_t>(std::numeric_limits<Integer>::max(), 1ull << 41));
        const auto integer = node.as_integer();
        if (!integer) fail(line_of(node), prefix + key, fmt::format("{}, found {}", expected, type_name(node)));
        const std::int64_t found = integer->get();
        if (found <= 0 || static_cast<std::uint64_t>(found) > std::numeric_limits<Integer>::max())
            fail(line_of(node), prefix + key, fmt::format("{}, found {}", expected, found));
        values_.back().value = fmt::format("{}", found);
        return static_cast<Integer>(found);
    }

    std::string text(const toml::table& table, const std::string& prefix, const std::string& key) {
        const toml::node& node = prefix.empty() ? find(table, prefix, key) : value(table, prefix, key);
        const auto string = node.as_string();
        if (!string || string->get().empty())
            fail(line_of(node), prefix + key,
                 fmt::format("expected a text, found {}", string ? "an empty one" : type_name(node)));
        if (!prefix.empty()) values_.back().value = one_line(string->get());
        return one_line(string->get());
    }

    std::string file_;
    toml::table root_;
    std::map<std::string, std::size_t> lines_;  ///< of the values read so far
    std::vector<GpuValue> values_;
};

}  // namespace

Gpu parse_gpu(const std::string& toml, const std::string& file) { return GpuFile(toml, file).read(); }

std::vector<GpuValue> parse_gpu_values(const std::string& toml, const std::string& file) {
    GpuFile gpu(toml, file);
    gpu.read();
    return gpu.values();
}

}  // namespace raycache::cachesim
