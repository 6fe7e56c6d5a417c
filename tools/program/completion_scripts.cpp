// The scripts themselves.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tools/program/completion.hpp"

namespace raycache::tools {
namespace {

/// In single quotes, as both shells read it back.
std::string shell_quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return out + "'";
}

std::string bash_values(const OptionView& option) {
    const Candidates c = candidates_of(option);
    std::string text;
    if (!c.values.empty()) text += fmt::format(" values={}", shell_quoted(fmt::format("{}", fmt::join(c.values, " "))));
    if (!c.extensions.empty())
        text += fmt::format(" files={}", shell_quoted(fmt::format("{}", fmt::join(c.extensions, " "))));
    if (option.has_commas) text += " list=1";
    return text;
}

/// The branch of one subcommand: its options, then what each of them takes, then its positional arguments.
std::string bash_branch(const CommandView& command) {
    std::vector<std::string> options;
    std::string takes, positional;
    for (const OptionView& option : command.options) {
        options.insert(options.end(), option.names.begin(), option.names.end());
        if (option.names.empty())
            positional += bash_values(option);
        else if (!option.is_flag)
            takes += fmt::format("        {}) value=1{} ;;\n", fmt::join(option.names, " | "), bash_values(option));
    }
    std::string text = fmt::format("    {})\n        options={}\n", command.name,
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

/// A blank before the function: without it _arguments puts options of its own before the arguments.
std::string zsh_action(const OptionView& option) {
    const Candidates c = candidates_of(option);
    std::string patterns;
    for (const std::string& extension : c.extensions)
        patterns += fmt::format("{}{}", patterns.empty() ? "" : "|", extension == "*" ? "*" : "*." + extension);
    if (patterns.find('|') != std::string::npos) patterns = "(" + patterns + ")";
    if (c.values.empty()) return patterns.empty() ? " " : fmt::format("_files -g \"{}\"", patterns);
    return fmt::format(" _raycache_values {} \"{}\" {}", option.has_commas ? "list" : "one", patterns,
                       zsh_escaped(fmt::format("{}", fmt::join(c.values, " "))));
}

std::string zsh_branch(const CommandView& command) {
    std::string text = fmt::format("    {})\n        _arguments -s -S", command.name);
    const auto add = [&](const std::string& specification) {
        text += " \\\n            " + shell_quoted(specification);
    };
    for (const OptionView& option : command.options) {
        const std::string help = zsh_escaped(option.help);
        if (option.names.empty())
            add(fmt::format("{}:{}:{}", option.is_list ? "*" : "", zsh_escaped(option.title), zsh_action(option)));
        for (const std::string& name : option.names)
            add(option.is_flag ? fmt::format("{}[{}]", name, help)
                               : fmt::format("*{}{}[{}]:{}:{}", name, name.starts_with("--") ? "=" : "+", help,
                                             zsh_escaped(option.title), zsh_action(option)));
    }
    return text + "\n        ;;\n";
}

}  // namespace

std::string bash_completion(const std::vector<CommandView>& commands) {
    std::string names, branches;
    for (const CommandView& command : commands) {
        names += (names.empty() ? "" : " ") + command.name;
        branches += bash_branch(command);
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

std::string zsh_completion(const std::vector<CommandView>& commands) {
    std::string names, branches;
    for (const CommandView& command : commands) {
        names += fmt::format("        {}\n", shell_quoted(command.name + ":" + zsh_escaped(command.description)));
        branches += zsh_branch(command);
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
