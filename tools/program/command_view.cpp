#include "tools/program/command_view.hpp"

#include <algorithm>

#include "tools/program/program.hpp"

namespace raycache::tools {
namespace {

OptionView view_of(const Option& option) {
    OptionView view;
    for (const std::string& name : option.names())
        if (name.starts_with('-')) view.names.insert(view.names.begin(), name);  // the long one first
    view.title = option.name().substr(std::min(option.name().find_first_not_of('-'), option.name().size()));
    view.help = option.help();
    view.is_flag = option.kind() == Option::Kind::flag;
    if (!view.is_flag) view.value = option.type();
    view.has_commas = option.has_commas();
    view.is_list = !view.is_flag && option.is_list();
    view.is_given = option.given();
    view.words = option.words();
    view.choices = option.choice_names();
    const std::string& standard = option.default_value();
    if (!view.words.empty() || standard.empty()) return view;
    view.words = view.is_list ? split(standard, ',') : std::vector<std::string>{standard};
    return view;
}

}  // namespace

CommandView view_of(const Command& command) {
    CommandView view{command.name(), command.description(), {}};
    for (const auto& option : command.options()) {
        OptionView own = view_of(*option);
        if (option->is_positional()) {
            if (!own.names.empty()) {  // SCENE, --scene: two ways to say the same
                OptionView named = own;
                named.title = named.names.front().substr(2);
                named.words.clear();
                named.is_given = false;
                view.options.push_back(std::move(named));
            }
            own.names.clear();
        }
        view.options.push_back(std::move(own));
    }
    return view;
}

std::vector<CommandView> views_of_commands(const Program& program) {
    std::vector<CommandView> views;
    for (const auto& command : program.commands())
        if (!command->is_hidden()) views.push_back(view_of(*command));
    return views;
}

}  // namespace raycache::tools
