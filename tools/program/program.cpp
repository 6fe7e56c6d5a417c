#include "tools/program/program.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>

#include "tools/jobs/version.hpp"
#include "tools/program/commands.hpp"
#include "tools/program/console.hpp"
#include "tools/program/help.hpp"
#include "tools/program/idle_options.hpp"
#include "tools/program/memory_limit.hpp"
#include "traces/did_you_mean.hpp"
#include "traces/error.hpp"

namespace raycache::tools {
namespace {

/// The words of each option, as typed.
using Typed = std::map<const Option*, std::vector<std::string>>;

/// CLI11 tells commands, options and their words apart; it converts nothing and requires nothing, so that what is
/// unknown is found before what is missing.
void declare(CLI::App& app, const Command& command, Typed& typed) {
    app.allow_extras();
    for (const auto& owned : command.options()) {
        const Option* option = owned.get();
        const std::string names = fmt::format("{}", fmt::join(option->names(), ","));
        const auto keep = [&typed, option](const CLI::results_t& words) {
            typed[option] = words;
            return true;
        };
        if (option->kind() == Option::Kind::flag) {
            app.add_flag_callback(names, [&typed, option] { typed[option] = {""}; });
            continue;
        }
        CLI::Option* declared = app.add_option(names, keep);
        declared->type_size(1)->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
        declared->allow_extra_args(option->is_positional() && option->is_list());
    }
}

std::vector<std::string> option_names(const Command& command) {
    std::vector<std::string> names{"--help"};
    for (const auto& option : command.options())
        for (const std::string& name : option->names())
            if (name.starts_with('-')) names.push_back(name);
    return names;
}

std::string argument_names(const Command& command) {
    std::string names;
    for (const auto& option : command.options())
        if (option->is_positional()) names += (names.empty() ? "" : " ") + option->name();
    return names.empty() ? "none" : names;
}

/// Words that belong to nothing. An option comes first: words after a mistyped one may have been its value.
void refuse_extras(const std::vector<std::string>& extras, const Command& command) {
    if (extras.empty()) return;
    const auto is_option = [](const std::string& word) { return word.size() > 1 && word[0] == '-'; };
    const auto option = std::find_if(extras.begin(), extras.end(), is_option);
    if (option == extras.end())
        throw UsageError(fmt::format("unexpected argument '{}'; 'raycache {}' takes {}", extras.front(), command.name(),
                                     argument_names(command)));
    const std::string name = option->substr(0, option->find('='));
    const std::string meant = did_you_mean(name, option_names(command));
    throw UsageError(fmt::format("unknown option '{}' of 'raycache {}'{}", name, command.name(),
                                 meant.empty() ? fmt::format("; see 'raycache {} --help'", command.name()) : meant));
}

/// "--gpu --json": the second is no value of the first.
void refuse_options_as_values(const Typed& typed, const Command& command) {
    for (const auto& [option, words] : typed)
        for (const std::string& word : words)
            if (word.starts_with("--") && command.find_option(word.substr(0, word.find('='))))
                throw UsageError(fmt::format("{}: expected {}, found the option {}; give {} a value", option->name(),
                                             option->type(), word, option->name()));
}

void check_together(const Command& command) {
    for (const auto& option : command.options()) {
        if (!option->given()) continue;
        for (const std::string& name : option->excluded()) {
            const Option* other = command.find_option(name);
            if (other && other->given())
                throw UsageError(fmt::format("{} and {} together; expected one of them", option->name(), name));
        }
    }
    std::string missing;
    for (const auto& option : command.options())
        if (option->is_required() && !option->given()) missing += (missing.empty() ? "" : " and ") + option->name();
    if (!missing.empty())
        throw UsageError(fmt::format("{} missing; see 'raycache {} --help'",
                                     missing + (missing.find(" and ") == std::string::npos ? " is" : " are"),
                                     command.name()));
}

/// "--name=" as "--name" and an empty value, which CLI11 would take from the next word.
std::vector<std::string> with_empty_values(const std::vector<std::string>& words) {
    std::vector<std::string> all;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string& word = words[i];
        if (word == "--") {
            all.insert(all.end(), words.begin() + static_cast<std::ptrdiff_t>(i), words.end());
            break;
        }
        if (word.size() > 3 && word.starts_with("--") && word.find('=') == word.size() - 1) {
            all.push_back(word.substr(0, word.size() - 1));
            all.emplace_back();
        } else {
            all.push_back(word);
        }
    }
    return all;
}

std::vector<std::string> names_of(const std::vector<std::unique_ptr<Command>>& commands) {
    std::vector<std::string> names;
    for (const auto& command : commands)
        if (!command->is_hidden()) names.push_back(command->name());
    return names;
}

/// Of a word where a command is expected.
UsageError unknown_word(const std::string& word, const std::vector<std::string>& commands) {
    if (word.starts_with('-')) {
        const std::string meant = did_you_mean(word, {"--help", "--version"});
        return UsageError(fmt::format("unknown option '{}'; expected a command, --help or --version{}", word, meant));
    }
    std::string meant = did_you_mean(word, commands);
    if (word == "help" || word == "version") meant = fmt::format("; did you mean '--{}'?", word);
    return UsageError(
        fmt::format("unknown command '{}'; expected one of: {}{}", word, fmt::join(commands, ", "), meant));
}

}  // namespace

Program::Program() {
    add_render(*this);
    add_capture(*this);
    add_info(*this);
    add_verify(*this);
    add_replay(*this);
    add_compare(*this);
    add_counters(*this);
    add_explain(*this);
    add_curve(*this);
    add_measure(*this);
    add_quality(*this);
    add_sweep(*this);
    add_sensitivity(*this);
    add_export(*this);
    add_import(*this);
    add_samples(*this);
    add_list(*this);
    add_completion(*this);
    add_memory_limit(*this);
}

Command* Program::add_subcommand(const std::string& name, const std::string& description) {
    commands_.push_back(std::make_unique<Command>(name, description));
    return commands_.back().get();
}

std::string Program::help() const { return help_text(commands_); }
std::string Program::help(const Command& command) const { return help_text(command); }

Action Program::parse(const std::vector<std::string>& words) {
    CLI::App app;
    app.allow_extras();
    app.set_version_flag("--version", program_name);
    Typed typed;
    std::map<const Command*, CLI::App*> declared;
    for (const auto& command : commands_) {
        declared[command.get()] = app.add_subcommand(command->name());
        declare(*declared[command.get()], *command, typed);
    }
    const Command* chosen = nullptr;
    const auto find_chosen = [&] {
        for (const auto& command : commands_)
            if (declared[command.get()]->parsed()) chosen = command.get();
    };
    try {
        std::vector<std::string> reversed = with_empty_values(words);
        std::reverse(reversed.begin(), reversed.end());  // as CLI11 wants them
        app.parse(std::move(reversed));
    } catch (const CLI::CallForHelp&) {
        find_chosen();
        if (!chosen && !words.front().starts_with('-')) throw unknown_word(words.front(), names_of(commands_));
        return [text = chosen ? help(*chosen) : help()] { print(text); };
    } catch (const CLI::CallForVersion&) {
        return [] { print(std::string(program_name) + "\n"); };
    } catch (const CLI::ArgumentMismatch& e) {
        const std::string text = e.what();  // "NAME: 1 required …"
        throw UsageError(text.substr(0, text.find(':')) + ": expected a value, found nothing");
    } catch (const CLI::ParseError& e) {
        throw UsageError(e.what());
    }
    find_chosen();
    const std::vector<std::string> extras = app.remaining();
    const std::vector<std::string> names = names_of(commands_);
    if (!extras.empty()) throw unknown_word(extras.front(), names);
    if (!chosen)
        throw UsageError(fmt::format("no command; expected one of: {}; see 'raycache --help'", fmt::join(names, ", ")));
    refuse_extras(declared[chosen]->remaining(), *chosen);
    refuse_options_as_values(typed, *chosen);
    // Files last: a name that nobody knows is said before a file that is not there.
    for (const bool positional : {false, true})
        for (const auto& option : chosen->options())
            if (const auto found = typed.find(option.get());
                found != typed.end() && option->is_positional() == positional)
                option->read(found->second);
    check_together(*chosen);
    Action action = chosen->make_action();
    return [action = std::move(action), chosen] {
        for (const std::string& line : idle_of_format(*chosen)) warn(line);
        action();
    };
}

}  // namespace raycache::tools
