#include "tools/command_view.hpp"

#include <CLI/CLI.hpp>

namespace raycache::tools {
namespace {

/// The names of a CLI::IsMember check, which says them in its description: "{a,b}".
std::vector<std::string> choices_of(const std::string& type) {
    const std::size_t open = type.find('{'), close = type.find('}');
    if (open == std::string::npos || close == std::string::npos || close < open) return {};
    return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
}

OptionView view_of(const CLI::Option& option) {
    OptionView view;
    for (const std::string& name : option.get_lnames()) view.names.push_back("--" + name);
    for (const std::string& name : option.get_snames()) view.names.push_back("-" + name);
    view.title = option.get_lnames().empty() ? option.get_name(true) : option.get_lnames().front();
    view.help = option.get_description();
    view.value = option.get_type_name();
    view.is_flag = option.get_items_expected_max() == 0;
    view.has_commas = option.get_delimiter() != '\0';
    view.is_list = view.has_commas || option.get_items_expected_max() > 1;
    view.is_given = option.count() != 0;
    view.words = option.results();
    view.choices = choices_of(view.value);
    const std::string& standard = option.get_default_str();
    if (!view.words.empty() || standard.empty()) return view;
    if (!view.is_list)
        view.words = {standard};
    else  // "[a,b]"
        view.words =
            CLI::detail::split(standard.front() == '[' ? standard.substr(1, standard.size() - 2) : standard, ',');
    return view;
}

}  // namespace

CommandView view_of(const CLI::App& command) {
    CommandView view{command.get_name(), command.get_description(), {}};
    for (const CLI::Option* option : command.get_options()) view.options.push_back(view_of(*option));
    return view;
}

std::vector<CommandView> views_of_commands(const CLI::App& program) {
    std::vector<CommandView> views;
    for (const CLI::App* command : program.get_subcommands([](const CLI::App* a) { return !a->get_group().empty(); }))
        views.push_back(view_of(*command));
    return views;
}

}  // namespace raycache::tools
