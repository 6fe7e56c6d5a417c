#include "tools/program/command.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "traces/did_you_mean.hpp"
#include "traces/error.hpp"

namespace raycache::tools {

std::vector<std::string> split(const std::string& text, char at) {
    std::vector<std::string> parts(1);
    for (const char c : text)
        if (c == at)
            parts.emplace_back();
        else
            parts.back() += c;
    return parts;
}

namespace detail {
std::string default_of(const std::string& value) { return value; }
std::string default_of(std::uint64_t value) { return fmt::format("{}", value); }
std::string default_of(double value) { return fmt::format("{:.4g}", value); }
std::string default_of(float value) { return default_of(double{value}); }
}  // namespace detail

Option* Option::required(bool value) {
    required_ = value;
    return this;
}

Option* Option::range(std::uint64_t least, std::uint64_t most) {
    whole_ = {least, most};
    return this;
}

Option* Option::range(double least, double most) {
    real_ = {least, most};
    return this;
}

Option* Option::number() {
    kind_ = Kind::real;
    type_ = "X";
    return check([this](std::string& found) { read_real(found, name(), real_); });
}

Option* Option::number_or(const std::string& word) {
    number_word_ = word;
    kind_ = Kind::real;
    type_ = (is_list_ ? "X|" + word + ",..." : "X|" + word);
    return check([this](std::string& found) {
        if (found != number_word_)
            read_real(found, name(), real_, fmt::format("{}, or '{}'", describe(real_), number_word_));
    });
}

Option* Option::whole_or(const std::string& word) {
    number_word_ = word;
    kind_ = Kind::whole;
    type_ = word.empty() ? "N" : "N|" + word;
    return check([this](std::string& found) {
        if (found != number_word_)
            read_whole(found, name(), whole_,
                       number_word_.empty() ? "" : fmt::format("{}, or '{}'", describe(whole_), number_word_));
    });
}

Option* Option::choices(const std::string& what, std::vector<std::string> names) {
    choices_ = names;
    return check([this, what, names = std::move(names)](std::string& found) {
        if (std::find(names.begin(), names.end(), found) != names.end()) return;
        throw UsageError(fmt::format("{}: unknown {} '{}'; expected one of: {}{}", name(), what, found,
                                     fmt::join(names, ", "), did_you_mean(found, names)));
    });
}

Option* Option::check(std::function<void(std::string&)> check) {
    checks_.push_back(std::move(check));
    return this;
}

Option* Option::count(std::size_t words) {
    count_ = words;
    if (words == 1) type_ = "NAME";
    return this;
}

Option* Option::repeated() {
    commas_ = false;
    return this;
}

Option* Option::excludes(std::vector<std::string> names) {
    excludes_ = std::move(names);
    return this;
}

Option* Option::about_scene(bool value) {
    about_scene_ = value;
    return this;
}

Option* Option::type_name(const std::string& name) {
    type_ = name;
    return this;
}

Option* Option::default_text(const std::string& text) {
    default_ = text;
    return this;
}

void Option::read(const std::vector<std::string>& typed) {
    std::vector<std::string> words;
    for (const std::string& word : typed)
        for (const std::string& part : commas_ ? split(word, ',') : std::vector<std::string>{word})
            words.push_back(part);
    if (!is_list_ && words.size() > 1)
        throw UsageError(
            fmt::format("{} is given {} times: {}; expected once", name(), words.size(), fmt::join(words, ", ")));
    if (count_ != 0 && words.size() != count_)
        throw UsageError(fmt::format("{} '{}': expected {}, found {} value{}", name(), fmt::join(words, ","),
                                     count_ == 1 ? "one value" : fmt::format("{} values {}", count_, type_),
                                     words.size(), words.size() == 1 ? "" : "s"));
    if (kind_ != Kind::flag && std::find(words.begin(), words.end(), "") != words.end())
        throw UsageError(fmt::format("{} '{}': expected {}, found nothing", name(), fmt::join(typed, " "), type_));
    for (std::string& word : words)
        for (const auto& check : checks_) check(word);
    read_(*this, words);
    words_ = std::move(words);
    given_ = true;
}

Command::Command(std::string name, std::string description)
    : name_(std::move(name)), description_(std::move(description)) {}

Option* Command::add(const std::string& names, const std::string& help) {
    auto option = std::make_unique<Option>();
    option->names_ = split(names, ',');
    option->help_ = help;
    option->group_ = group_;
    option->about_scene_ = about_scene_;
    options_.push_back(std::move(option));
    return options_.back().get();
}

Option* Command::add_flag(const std::string& names, bool& target, const std::string& help) {
    Option* option = add(names, help);
    option->kind_ = Option::Kind::flag;
    option->is_list_ = true;  // twice is as good as once
    option->read_ = [&target](const Option&, const std::vector<std::string>&) { target = true; };
    return option;
}

void Command::remove_option(const std::string& name) {
    std::erase_if(options_, [&](const auto& option) { return option->name() == name; });
}

void Command::move_to_front(std::size_t first) {
    std::rotate(options_.begin(), options_.begin() + static_cast<std::ptrdiff_t>(first), options_.end());
}

Option* Command::find_option(const std::string& name) const {
    for (const auto& option : options_)
        for (const std::string& own : option->names())
            if (own == name) return option.get();
    return nullptr;
}

void Command::callback(Action run) {
    plan_ = [run = std::move(run)] { return run; };
}

}  // namespace raycache::tools
