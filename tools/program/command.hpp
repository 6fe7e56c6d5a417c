// A subcommand and its options: declared once, here, for the parser, the help text and the tests. What a person typed
// is checked while it is read: numbers are decimal and in range, names are known.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "tools/jobs/numbers.hpp"

namespace raycache::tools {

/// The parts of a text between these characters: "a,,b" has three.
std::vector<std::string> split(const std::string& text, char at);

/// What a command line asks for, checked and ready to run.
using Action = std::function<void()>;

class Option {
public:
    /// What its words are. Every number is read by numbers.hpp.
    enum class Kind { text, whole, real, flag };

    Option* required(bool value = true);
    Option* range(std::uint64_t least, std::uint64_t most);
    Option* range(double least, double most);
    /// A text that is a number; the same, or this word (none: "").
    Option* number();
    Option* number_or(const std::string& word);
    Option* whole_or(const std::string& word);
    /// Only these names; another is answered with the closest of them. `what`: "strategy".
    Option* choices(const std::string& what, std::vector<std::string> names);
    /// Called with every word; may replace it by its usual spelling. Throws UsageError.
    Option* check(std::function<void(std::string&)> check);
    /// How many words a list must have.
    Option* count(std::size_t words);
    /// The words of one value are not separated by commas: it may be repeated instead.
    Option* repeated();
    /// Options that it cannot stand beside: said in the help text, and checked.
    Option* excludes(std::vector<std::string> names);
    /// It asks how a scene is traced: no use beside traces.
    Option* about_scene(bool value = true);
    /// What the help text calls its value.
    Option* type_name(const std::string& name);
    /// What the help text says of its default, where the target does not show it; empty: nothing.
    Option* default_text(const std::string& text);

    bool given() const { return given_; }
    /// Each word as it was read; none if not given.
    const std::vector<std::string>& words() const { return words_; }
    bool has_commas() const { return commas_; }
    /// Of choices(); empty: any.
    const std::vector<std::string>& choice_names() const { return choices_; }
    Kind kind() const { return kind_; }
    bool is_list() const { return is_list_; }
    bool is_positional() const { return names_.front().front() != '-'; }
    bool is_required() const { return required_; }
    bool is_about_scene() const { return about_scene_; }
    /// "SCENE", or the long one: "--output".
    const std::string& name() const { return is_positional() ? names_.front() : names_.back(); }
    const std::vector<std::string>& names() const { return names_; }
    const std::string& help() const { return help_; }
    const std::string& group() const { return group_; }
    const std::string& type() const { return type_; }
    const std::string& default_value() const { return default_; }
    const std::vector<std::string>& excluded() const { return excludes_; }

    /// All its words, as typed. Throws UsageError.
    void read(const std::vector<std::string>& typed);

private:
    friend class Command;
    using Read = std::function<void(const Option&, const std::vector<std::string>& words)>;

    std::vector<std::string> names_;
    std::string help_, group_, type_, default_, number_word_;
    Kind kind_ = Kind::text;
    bool is_list_ = false, commas_ = false, required_ = false, given_ = false, about_scene_ = false;
    WholeRange whole_;
    RealRange real_;
    std::size_t count_ = 0;
    std::vector<std::function<void(std::string&)>> checks_;
    std::vector<std::string> excludes_, choices_, words_;
    Read read_;

    template <class T>
    T word_as(const std::string& word) const;
};

class Command {
public:
    Command(std::string name, std::string description);

    /// `names`: "--spp", "-o,--output", or "SCENE" for an argument without a name. T is a text, a number, an optional
    /// of one, or a vector of them: a list separated by commas, of arguments by blanks.
    template <class T>
    Option* add_option(const std::string& names, T& target, const std::string& help);
    Option* add_flag(const std::string& names, bool& target, const std::string& help);
    void remove_option(const std::string& name);
    /// Puts the options from that place on before all others, where --help lists them first.
    void move_to_front(std::size_t first);
    Option* find_option(const std::string& name) const;

    /// The heading of the options that are added next; empty: the command's own.
    /// `about_scene`: see Option::about_scene().
    void group(const std::string& heading, bool about_scene = false) {
        group_ = heading;
        about_scene_ = about_scene;
    }
    /// Not listed by --help.
    void hide() { hidden_ = true; }
    void examples(std::vector<std::string> lines) { examples_ = std::move(lines); }

    /// What the command line asks for, from the options read: everything is checked that needs no scene and no trace.
    void plan(std::function<Action()> make) { plan_ = std::move(make); }
    /// plan() for a command without settings to check.
    void callback(Action run);

    const std::string& name() const { return name_; }
    bool is_hidden() const { return hidden_; }
    const std::string& description() const { return description_; }
    const std::vector<std::unique_ptr<Option>>& options() const { return options_; }
    const std::vector<std::string>& example_lines() const { return examples_; }
    Action make_action() const { return plan_(); }

private:
    Option* add(const std::string& names, const std::string& help);

    std::string name_, description_, group_;
    bool about_scene_ = false, hidden_ = false;
    std::vector<std::unique_ptr<Option>> options_;
    std::vector<std::string> examples_;
    std::function<Action()> plan_;
};

// ---

namespace detail {

template <class T>
struct Target {  ///< a plain value
    using Value = T;
    static constexpr bool list = false;
};
template <class T>
struct Target<std::optional<T>> {
    using Value = T;
    static constexpr bool list = false;
};
template <class T>
struct Target<std::vector<T>> {
    using Value = T;
    static constexpr bool list = true;
};

std::string default_of(const std::string&);
std::string default_of(std::uint64_t);
inline std::string default_of(std::uint32_t value) { return default_of(std::uint64_t{value}); }
std::string default_of(double);
std::string default_of(float);
template <class T>
std::string default_of(const std::optional<T>& value) {
    return value ? default_of(*value) : std::string();
}
template <class T>
std::string default_of(const std::vector<T>& values) {
    std::string list;
    for (const T& value : values) list += (list.empty() ? "" : ",") + default_of(value);
    return list;
}

}  // namespace detail

template <class T>
T Option::word_as(const std::string& word) const {
    if constexpr (std::is_same_v<T, std::string>)
        return word;
    else if constexpr (std::is_floating_point_v<T>)
        return static_cast<T>(read_real(word, name(), real_));
    else
        return static_cast<T>(read_whole(word, name(), whole_));
}

template <class T>
Option* Command::add_option(const std::string& names, T& target, const std::string& help) {
    using Value = typename detail::Target<T>::Value;
    static_assert(std::is_same_v<Value, std::string> || std::is_floating_point_v<Value> ||
                  (std::is_unsigned_v<Value> && !std::is_same_v<Value, bool>));
    Option* option = add(names, help);
    option->is_list_ = detail::Target<T>::list;
    option->commas_ = option->is_list_ && !option->is_positional();
    option->default_ = detail::default_of(target);
    if constexpr (std::is_floating_point_v<Value>) {
        option->kind_ = Option::Kind::real;
        option->real_ = {std::numeric_limits<Value>::lowest(), std::numeric_limits<Value>::max()};
        option->type_ = option->is_list_ ? "X,X,..." : "X";
    } else if constexpr (!std::is_same_v<Value, std::string>) {
        option->kind_ = Option::Kind::whole;
        option->whole_.most = std::numeric_limits<Value>::max();
        option->type_ = option->is_list_ ? "N,N,..." : "N";
    } else {
        option->type_ = option->commas_ ? "NAME,..." : "NAME";
    }
    option->read_ = [&target](const Option& self, const std::vector<std::string>& words) {
        if constexpr (detail::Target<T>::list) {
            target.clear();
            for (const std::string& word : words) target.push_back(self.word_as<Value>(word));
        } else {
            target = self.word_as<Value>(words.front());
        }
    };
    return option;
}

}  // namespace raycache::tools
