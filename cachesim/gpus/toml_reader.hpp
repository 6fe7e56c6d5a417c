// A TOML file whose values may stand beside their source. Every error is one line "FILE:LINE: KEY: expected …, found
// …".
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "cachesim/gpus/gpu.hpp"
#include "cachesim/gpus/toml_guard.hpp"
#include "traces/did_you_mean.hpp"
#include "traces/error.hpp"
#include "traces/printable.hpp"

#define TOML_HEADER_ONLY 1
#include <toml++/toml.h>

namespace raycache::cachesim {

/// What a file may say a key's value could be instead.
enum class OtherValues { none, listed, between };

class TomlReader {
public:
    TomlReader(const std::string& toml, const std::string& file) : file_(file) {
        if (const auto problem = find_toml_problem(toml))
            throw Error(fmt::format("{}:{}: {}; correct the line", file_, problem->line, problem->message));
        try {
            root_ = toml::parse(toml, file);
        } catch (const toml::parse_error& e) {
            throw Error(fmt::format("{}:{}: expected TOML, found an error: {}; correct the line", file_,
                                    e.source().begin.line, printable_line(std::string(e.description()))));
        }
    }

    /// "KEY=VALUE": from now on the key has this value; KEY may be in a table of the file, "l1.ways". VALUE is TOML,
    /// but a word needs no quotes. Returns the key. Throws UsageError if it is neither.
    std::string change(const std::string& assignment) {
        toml::table given;
        const auto parse = [&](const std::string& text) {
            if (find_toml_problem(text)) return;
            try {
                given = toml::parse(text);
            } catch (const toml::parse_error&) {
            }
        };
        parse(assignment);
        const auto equals = assignment.find('=');
        if (given.empty() && equals != std::string::npos &&
            assignment.find_first_of("\"'\n", equals) == std::string::npos)
            parse(fmt::format("{}=\"{}\"", assignment.substr(0, equals), assignment.substr(equals + 1)));
        if (given.size() != 1)
            throw UsageError(fmt::format("expected KEY=VALUE such as l1.ways=64 or l1.policy=fifo, found \"{}\"",
                                         printable_line(assignment)));
        const std::string key(given.begin()->first.str());
        const toml::node& value = given.begin()->second;
        const toml::table* inner = value.as_table();
        if (!inner) {
            root_.insert_or_assign(key, value);
            return key;
        }
        toml::table* own = root_[key].as_table();
        if (!own || inner->size() != 1) {
            std::vector<std::string> tables;
            for (const auto& [name, node] : root_)
                if (node.is_table() && !node.as_table()->contains("value")) tables.emplace_back(name.str());
            throw UsageError(fmt::format("{} with --set: expected a key of one of its tables {}, found \"{}\"", file_,
                                         fmt::join(tables, ", "), printable_line(assignment)));
        }
        const std::string inner_key(inner->begin()->first.str());
        own->insert_or_assign(inner_key, inner->begin()->second);
        return key + '.' + inner_key;
    }

    /// A table of the file: the root, or one below it. Keys that are absent from `known` are errors.
    class Section {
    public:
        bool has(const std::string& key) const { return table_->contains(key); }

        /// Not negative; 0 only if `zero` says so.
        template <class Integer>
        Integer number(const std::string& key, bool zero = false) {
            return reader_->integer<Integer>(reader_->value(*table_, prefix_, key), prefix_ + key, zero);
        }
        double positive(const std::string& key) {
            return reader_->positive(reader_->value(*table_, prefix_, key), prefix_ + key);
        }

        template <class Integer>
        std::vector<Integer> numbers(const std::string& key) {
            std::vector<Integer> all;
            const toml::node& node = reader_->value(*table_, prefix_, key);
            const toml::array* array = node.as_array();
            if (!array)
                reader_->fail(line_of(node), prefix_ + key,
                              fmt::format("expected a list of numbers, found {}", type_name(node)));
            for (const toml::node& element : *array)
                all.push_back(reader_->integer<Integer>(element, prefix_ + key, true));
            reader_->values_.back().value = fmt::format("{}", fmt::join(all, " "));
            return all;
        }

        /// A text; one in a section below the root may have a source.
        std::string text(const std::string& key) {
            const bool plain = prefix_.empty() && (key == "name" || key == "description");
            const toml::node& node =
                plain ? reader_->find(*table_, prefix_, key) : reader_->value(*table_, prefix_, key);
            const auto string = node.as_string();
            if (!string || string->get().empty())
                reader_->fail(line_of(node), prefix_ + key,
                              fmt::format("expected a text, found {}", string ? "an empty one" : type_name(node)));
            if (!plain) reader_->values_.back().value = printable_line(string->get());
            return printable_line(string->get());
        }

        /// A text that may be empty.
        std::string text_or_empty(const std::string& key) {
            const toml::node& node = reader_->value(*table_, prefix_, key);
            const auto string = node.as_string();
            if (!string)
                reader_->fail(line_of(node), prefix_ + key, fmt::format("expected a text, found {}", type_name(node)));
            return reader_->values_.back().value = printable_line(string->get());
        }

        /// The place of the text among the names.
        std::size_t choice(const std::string& key, const std::vector<std::string>& names) {
            const std::string found = text(key);
            std::string list;
            for (std::size_t i = 0; i < names.size(); ++i) {
                if (found == names[i]) return i;
                list += fmt::format("{}\"{}\"", i == 0 ? "" : i + 1 == names.size() ? " or " : ", ", names[i]);
            }
            reader_->fail(reader_->lines_[prefix_ + key], prefix_ + key,
                          fmt::format("expected {}, found \"{}\"{}", list, found, did_you_mean(found, names)));
        }

        Section section(const std::string& key, const std::vector<std::string>& known) const {
            const toml::node& node = reader_->find(*table_, prefix_, key);
            const toml::table* table = node.as_table();
            if (!table)
                reader_->fail(
                    line_of(node), prefix_ + key,
                    fmt::format("expected a table, found {}; write [{}] and its keys below", type_name(node), key));
            reader_->only_keys(*table, prefix_ + key + ".", known);
            return Section(*reader_, *table, prefix_ + key + ".");
        }

        /// Goes through the other values that the file says the key may have, if it does: the ends of `range = [low,
        /// high]`, or `choices = […]`. read() is called for each, and what it reads of the key is that one. Errors name
        /// the list. The values stand in GpuValue::range.
        template <class Read>
        void read_others(const std::string& key, OtherValues may, const Read& read) const {
            reader_->read_others(*table_, prefix_ + key, key, may, read);
        }

    private:
        friend class TomlReader;
        Section(TomlReader& reader, const toml::table& table, std::string prefix)
            : reader_(&reader), table_(&table), prefix_(std::move(prefix)) {}

        TomlReader* reader_;
        const toml::table* table_;
        std::string prefix_;
    };

    Section root(const std::vector<std::string>& known) {
        only_keys(root_, "", known);
        return Section(*this, root_, "");
    }

    /// Names the line of a value that was read.
    [[noreturn]] void fail_at(const std::string& key, const std::string& message) const {
        const auto line = lines_.find(key);
        fail(line == lines_.end() ? 1 : line->second, key, message);
    }

    /// A value that follows from others of the file.
    void note(const std::string& key, const std::string& value, const std::string& source) {
        values_.push_back({key, value, source, {}});
    }

    /// In the order in which they were read.
    const std::vector<GpuValue>& values() const { return values_; }

private:
    [[noreturn]] void fail(std::size_t line, const std::string& of, const std::string& message) const {
        const std::string key = other_ ? fmt::format("{}.{}", of, list_of_others_) : of;
        if (line == 0) throw UsageError(fmt::format("{} with --set: {}: {}", file_, key, message));  // from change()
        throw Error(fmt::format("{}:{}: {}: {}", file_, line, key, message));
    }

    static std::size_t line_of(const toml::node& node) { return node.source().begin.line; }

    static std::string type_name(const toml::node& node) {
        std::ostringstream name;
        name << node.type();
        return name.str();
    }

    /// What stands where a number should: the word itself, of what is no word its type.
    static std::string found_instead(const toml::node& node) {
        if (const auto* word = node.as_string())
            return word->get().empty() ? "nothing" : fmt::format("\"{}\"", printable_line(word->get()));
        if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
        return type_name(node);
    }

    void only_keys(const toml::table& table, const std::string& prefix, const std::vector<std::string>& known) const {
        for (const auto& [key, node] : table) {
            const std::string name(key.str());
            if (std::find(known.begin(), known.end(), name) == known.end())
                fail(key.source().begin.line, printable_line(prefix + name),
                     fmt::format("expected one of the keys {}, found an unknown one; correct or remove it{}",
                                 fmt::join(known, ", "), did_you_mean(name, known)));
        }
    }

    const toml::node& find(const toml::table& table, const std::string& prefix, const std::string& key) const {
        if (const toml::node* node = table.get(key)) return *node;
        fail(std::max<std::size_t>(1, line_of(table)), prefix + key, "expected this key, found none; add it");
    }

    /// The value itself, out of { value = …, source = "…" } if need be, or another that is to be read in its place.
    const toml::node& value(const toml::table& table, const std::string& prefix, const std::string& key) {
        const toml::node& node = find(table, prefix, key);
        const std::string name = prefix + key;
        if (other_) return *other_;
        lines_[name] = line_of(node);
        const toml::table* pair = node.as_table();
        if (!pair) {
            values_.push_back({name, "", "", {}});
            return node;
        }
        only_keys(*pair, name + ".", {"value", "source", "range", "choices", "range_source"});
        const toml::node& source = find(*pair, name + ".", "source");
        if (!source.is_string())
            fail(line_of(source), name + ".source", fmt::format("expected a string, found {}", type_name(source)));
        values_.push_back({name, "", printable_line(source.value_or(std::string())), {}});
        return find(*pair, name + ".", "value");
    }

    /// The list of a key that was read just now; null where the file gives none.
    const toml::array* others_of(const toml::table& pair, const std::string& name, OtherValues may) const {
        const toml::node *range = pair.get("range"), *choices = pair.get("choices");
        if (range && choices)
            fail(line_of(*choices), name + ".choices", "expected a range or choices, found both; remove one");
        const toml::node* list = range ? range : choices;
        if (!list) {
            if (const toml::node* why = pair.get("range_source"))
                fail(line_of(*why), name + ".range_source", "expected it beside a range or choices, found neither");
            return nullptr;
        }
        const std::string full = name + (range ? ".range" : ".choices");
        if (may == OtherValues::none)
            fail(line_of(*list), full, "expected no other values of this key, found some; remove them");
        if (range && may != OtherValues::between)
            fail(line_of(*range), full,
                 "expected choices, since not all between two of its values are values; list them");
        const toml::array* array = list->as_array();
        if (!array) fail(line_of(*list), full, fmt::format("expected a list of values, found {}", type_name(*list)));
        if (range && array->size() != 2)
            fail(line_of(*range), full, fmt::format("expected two numbers, [low, high], found {}", array->size()));
        if (array->empty()) fail(line_of(*list), full, "expected at least the value itself, found an empty list");
        return array;
    }

    template <class Read>
    void read_others(const toml::table& table, const std::string& name, const std::string& key, OtherValues may,
                     const Read& read) {
        const toml::table* pair = table.get(key)->as_table();
        const toml::array* array = pair ? others_of(*pair, name, may) : nullptr;
        if (!array) return;
        GpuRange range;
        range.listed = pair->contains("choices");
        list_of_others_ = range.listed ? "choices" : "range";
        if (const toml::node* why = pair->get("range_source")) {
            if (!why->is_string())
                fail(line_of(*why), name + ".range_source",
                     fmt::format("expected a string, found {}", type_name(*why)));
            range.source = printable_line(why->value_or(std::string()));
        }
        const std::string own = values_.back().value;
        const std::size_t line = lines_[name];
        for (const toml::node& other : *array) {
            other_ = &other;
            lines_[name] = line_of(other);
            values_.push_back({name, "", "", {}});
            read();
            range.values.push_back(values_.back().value);
            values_.pop_back();
        }
        check_others(range, name, own);
        other_ = nullptr;
        lines_[name] = line;
        values_.back().range = std::move(range);
    }

    void check_others(const GpuRange& range, const std::string& name, const std::string& own) const {
        const auto& values = range.values;
        const auto refuse = [&](const std::string& message) { fail(line_of(*other_), name, message); };
        if (range.listed) {
            for (const std::string& value : values)
                if (std::count(values.begin(), values.end(), value) > 1)
                    refuse(fmt::format("expected each choice once, found {} twice", value));
            if (std::find(values.begin(), values.end(), own) == values.end())
                refuse(fmt::format("expected the value itself, {}, among the choices, found {}", own,
                                   fmt::join(values, ", ")));
            return;
        }
        const auto number = [](const std::string& text) { return std::strtod(text.c_str(), nullptr); };
        const double low = number(values[0]), high = number(values[1]), value = number(own);
        if (low > high)
            refuse(fmt::format("expected the lower end first, found {} and {}; swap them", values[0], values[1]));
        if (value < low || value > high)
            refuse(fmt::format("expected ends around the value, {}, found {} and {}", own, values[0], values[1]));
    }

    template <class Integer>
    Integer integer(const toml::node& node, const std::string& name, bool zero) {
        constexpr std::uint64_t most = std::min<std::uint64_t>(std::numeric_limits<Integer>::max(), 1ull << 41);
        const auto expected = fmt::format("expected a {}whole number below {}", zero ? "" : "positive ", most);
        const auto integer = node.as_integer();
        if (!integer) fail(line_of(node), name, fmt::format("{}, found {}", expected, found_instead(node)));
        const std::int64_t found = integer->get();
        if (found < (zero ? 0 : 1) || static_cast<std::uint64_t>(found) > std::numeric_limits<Integer>::max())
            fail(line_of(node), name, fmt::format("{}, found {}", expected, found));
        values_.back().value = fmt::format("{}", found);
        return static_cast<Integer>(found);
    }

    double positive(const toml::node& node, const std::string& name) {
        const auto number = node.value<double>();
        const bool is_number = node.is_integer() || node.is_floating_point();
        if (!is_number || !number)
            fail(line_of(node), name, fmt::format("expected a positive number, found {}", found_instead(node)));
        if (!(*number > 0) || !(*number < 1e12))
            fail(line_of(node), name, fmt::format("expected a positive number below 1e12, found {}", *number));
        values_.back().value = fmt::format("{}", *number);
        return *number;
    }

    std::string file_;
    toml::table root_;
    std::map<std::string, std::size_t> lines_;  ///< of the values read so far
    std::vector<GpuValue> values_;
    const toml::node* other_ = nullptr;  ///< to be read in place of the key's own value
    std::string list_of_others_;         ///< that it is in: "range"
};

}  // namespace raycache::cachesim
