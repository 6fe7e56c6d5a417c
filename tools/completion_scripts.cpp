// The scripts themselves.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>

#include "tools/completion.hpp"

namespace raycache::tools {
namespace {

/// In single quotes, as both shells read it back.
std::string shell_quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

bool is_flag(const CLI::Option& option) { return option.get_items_expected_max() == 0; }

/// "--output", "-o"; none for a positional argument.
std::vector<std::string> spellings(const CLI::Option& option) {
    std::vector<std::string> names;
    for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option.get_snames()) names.push_back("-" + name);
    return names;
}

std::string bash_values(const Candidates& c) {
    std::string text;
    if (!c.values.empty()) text += fmt::format(" values={}", shell_quoted(fmt::format("{}", fmt::join(c.values, " "))));
    if (!c.extensions.empty())
        text += fmt::format(" files={}", shell_quoted(fmt::format("{}", fmt::join(c.extensions, " "))));
    if (c.is_list) text += " list=1";
    return text;
}

/// The branch of one subcommand: its options, then what each of them takes, then its positional arguments.
std::string bash_branch(const CLI::App& command) {
    std::vector<std::string> options;
    std::string takes, positional;
    for (const CLI::Option* option : command.get_options()) {
        const auto names = spellings(*option);
        options.insert(options.end(), names.begin(), names.end());
        const Candidates candidates = candidates_of(*option);
        if (names.empty())
            positional += bash_values(candidates);
        else if (!is_flag(*option))
            takes += fmt::format("        {}) value=1{} ;;\n", fmt::join(names, " | "), bash_values(candidates));
    }
    std::string text = fmt::format("    {})\n        options={}\n", command.get_name(),
                                   shell_quoted(fmt::format("{}", fmt::join(options, " "))));
    text += fmt::format("        case $previous in\n{}        *){} ;;\n        esac\n        ;;\n", takes, positional);
    return text;
}

/// For the text of a zsh _arguments specification.
std::string zsh_escaped(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
        out += c;
    }
    return out;
}

std::string zsh_action(const Candidates& c) {
    std::string patterns;
    for (const std::string& extension : c.extensions)
        patterns += fmt::format("{}{}", patterns.empty() ? "" : "|", extension == "*" ? "*" : "*." + extension);
    if (patterns.find('|') != std::string::npos) patterns = "(" + patterns + ")";
    if (c.values.empty()) return patterns.empty() ? " " : fmt::format("_files -g \"{}\"", patterns);
    return fmt::format("_raycache_values {} \"{}\" {}", c.is_list ? "list" : "one", patterns,
                       zsh_escaped(fmt::format("{}", fmt::join(c.values, " "))));
}

std::string zsh_branch(const CLI::App& command) {
    std::string text = fmt::format("    {})\n        _arguments -s -S", command.get_name());
    for (const CLI::Option* option : command.get_options()) {
        const std::string help = zsh_escaped(option->get_description());
        const bool many = option->get_items_expected_max() > 1 || option->get_delimiter() != '\0';
        const Candidates candidates = candidates_of(*option);
        if (spellings(*option).empty())
            text += fmt::format(" \\\n            {}",
                                shell_quoted(fmt::format("{}:{}:{}", many ? "*" : "",
                                                         zsh_escaped(option->get_name(true)), zsh_action(candidates))));
        for (const std::string& name : spellings(*option)) {
            const std::string spec = is_flag(*option)
                                         ? fmt::format("{}[{}]", name, help)
                                         : fmt::format("*{}{}[{}]:{}:{}", name, name.starts_with("--") ? "=" : "+",
                                                       help, zsh_escaped(option->get_name()), zsh_action(candidates));
            text += " \\\n            " + shell_quoted(spec);
        }
    }
    return text + "\n        ;;\n";
}

}  // namespace

std::string bash_completion(const CLI::App& app) {
    std::string names, branches;
    for (const CLI::App* command : commands_of(app)) {
        names += (names.empty() ? "" : " ") + command->get_name();
        branches += bash_branch(*command);
    }
    return "# bash completion for raycache, made by: raycache completion bash\n"
           "_raycache() {\n"
           "    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}\n"
           "    local command='' options='' values='' files='' list='' value='' head='' i extension\n"
           "    # --gpu=h100 comes as three words.\n"
           "    [[ $current == '=' ]] && current=''\n"
           "    [[ $previous == '=' ]] && previous=${COMP_WORDS[COMP_CWORD - 2]}\n"
           "    for ((i = 1; i < COMP_CWORD; ++i)); do\n"
           "        if [[ ${COMP_WORDS[i]} != -* ]]; then\n"
           "            command=${COMP_WORDS[i]}\n"
           "            break\n"
           "        fi\n"
           "    done\n"
           "    COMPREPLY=()\n"
           "    case $command in\n"
           "    '') values=" +
           shell_quoted(names) +
           " options='--help --version' ;;\n"
           "    # Each sets value=1 after an option that takes one.\n" +
           branches +
           "    esac\n"
           "    if [[ -z $value && $current == -* ]]; then\n"
           "        mapfile -t COMPREPLY < <(compgen -W \"$options\" -- \"$current\")\n"
           "        return\n"
           "    fi\n"
           "    if [[ -n $list && $current == *,* ]]; then\n"
           "        head=${current%,*},\n"
           "        current=${current##*,}\n"
           "    fi\n"
           "    mapfile -t COMPREPLY < <(compgen -P \"$head\" -W \"$values\" -- \"$current\")\n"
           "    if [[ -n $files && -z $head ]]; then\n"
           "        compopt -o filenames 2>/dev/null\n"
           "        for extension in ${files//\\*/ANY}; do\n"
           "            if [[ $extension == ANY ]]; then\n"
           "                mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -f -- \"$current\")\n"
           "            else\n"
           "                mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -f -X \"!*.$extension\" -- "
           "\"$current\")\n"
           "            fi\n"
           "        done\n"
           "        [[ $files == '*' ]] || mapfile -t -O ${#COMPREPLY[@]} COMPREPLY < <(compgen -d -- \"$current\")\n"
           "    fi\n"
           "    [[ ${#COMPREPLY[@]} -ne 1 || ${COMPREPLY[0]} != *= ]] || compopt -o nospace 2>/dev/null\n"
           "}\n"
           "complete -F _raycache raycache\n";
}

std::string zsh_completion(const CLI::App& app) {
    std::string names, branches;
    for (const CLI::App* command : commands_of(app)) {
        names += fmt::format("        {}\n",
                             shell_quoted(command->get_name() + ":" + zsh_escaped(command->get_description())));
        branches += zsh_branch(*command);
    }
    return "#compdef raycache\n"
           "# zsh completion for raycache, made by: raycache completion zsh\n"
           "_raycache_values() {\n"
           "    local many=$1 files=$2\n"
           "    shift 2\n"
           "    if [[ $many == list ]]; then\n"
           "        compset -P '*,'\n"
           "        compadd -q -S '' -- \"$@\"\n"
           "    elif [[ $1 == *= ]]; then\n"
           "        compadd -S '' -- \"$@\"\n"
           "    else\n"
           "        compadd -- \"$@\"\n"
           "    fi\n"
           "    [[ -z $files ]] || _files -g \"$files\"\n"
           "}\n"
           "_raycache() {\n"
           "    local -a commands=(\n" +
           names +
           "    )\n"
           "    if ((CURRENT == 2)); then\n"
           "        _describe command commands\n"
           "        return\n"
           "    fi\n"
           "    local command=$words[2]\n"
           "    shift words\n"
           "    ((CURRENT--))\n"
           "    case $command in\n" +
           branches +
           "    esac\n"
           "}\n"
           "if [[ $funcstack[1] == _raycache ]]; then\n"
           "    _raycache \"$@\"\n"
           "else\n"
           "    compdef _raycache raycache\n"
           "fi\n";
}

}  // namespace raycache::tools
