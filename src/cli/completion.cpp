// mirrorball completion: a script for bash, written from the option tables.
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mirrorball/error.h>

#include "output.h"
#include "verbs.h"

namespace mirrorball::cli {
namespace {

std::string joined(const std::vector<std::string>& words) {
    return fmt::format("{}", fmt::join(words, " "));
}

std::vector<std::string> option_names(const Command& command) {
    std::vector<std::string> names = {"--help"};
    for (const Option& option : command.options) names.push_back(split(option.names, ',').back());
    return names;
}

// What may follow an option: `    convert:--to) words="..." ;;`
std::string value_case(const Command& command, const Option& option) {
    if (option.value_name.empty()) return "";
    std::vector<std::string> patterns;
    for (const std::string& name : split(option.names, ',')) {
        patterns.push_back(command.name + ":" + name);
    }
    return fmt::format("        {}) value=1 words=\"{}\" files={} ;;\n", fmt::join(patterns, "|"),
                       joined(option.choices.values), option.choices.files ? 1 : 0);
}

std::string argument_case(const Command& command) {
    std::vector<std::string> words;
    bool files = false;
    for (const Argument& argument : command.arguments) {
        // Arguments of one verb are alike (A and B of compare), so each is offered once.
        if (words.empty()) words = argument.choices.values;
        files = files || argument.choices.files;
    }
    return fmt::format("        {}) words=\"{}\" files={} options=\"{}\" ;;\n", command.name,
                       joined(words), files ? 1 : 0, joined(option_names(command)));
}

// bash splits words at colons unless told otherwise, so what stands before the last colon is cut
// from the answers (ggx:0.5, builtin:sunset).
constexpr const char* kScript = R"(# bash completion of mirrorball; load it with
#   source <(mirrorball completion bash)
_mirrorball() {{
    local line="${{COMP_LINE:0:COMP_POINT}}" verb="${{COMP_WORDS[1]}}"
    local current="${{line##* }}" before="${{line% *}}"
    local previous="${{before##* }}" words="" options="" files=0 value=0
    if [[ "$line" != *" "*" "* ]]; then
        COMPREPLY=($(compgen -W "{verbs} --help --version" -- "$current"))
        return
    fi
    case "$verb:$previous" in
{values}    esac
    if ((!value)); then
        case "$verb" in
{arguments}        esac
    fi
    if [[ "$current" == -* ]] && ((!value)); then
        COMPREPLY=($(compgen -W "$options" -- "$current"))
        return
    fi
    COMPREPLY=($(compgen -W "$words" -- "$current"))
    if ((files)); then
        COMPREPLY+=($(compgen -f -- "$current"))
        compopt -o filenames 2>/dev/null
    fi
    if [[ "$current" == *:* && "$COMP_WORDBREAKS" == *:* ]]; then
        local i prefix="${{current%"${{current##*:}}"}}"
        for i in "${{!COMPREPLY[@]}}"; do
            COMPREPLY[i]="${{COMPREPLY[i]#"$prefix"}}"
        done
    fi
}}
complete -F _mirrorball mirrorball
)";

std::string script(const std::vector<Command>& commands) {
    std::vector<std::string> verbs;
    std::string values, arguments;
    for (const Command& command : commands) {
        verbs.push_back(command.name);
        arguments += "    " + argument_case(command);
        for (const Option& option : command.options) values += value_case(command, option);
    }
    return fmt::format(kScript, fmt::arg("verbs", joined(verbs)), fmt::arg("values", values),
                       fmt::arg("arguments", arguments));
}

}  // namespace

Command completion_command(Shared& shared, const std::vector<Command>& commands) {
    auto shell = std::make_shared<std::string>();
    Command command{.name = "completion", .summary = "A script that completes command lines."};
    command.arguments = {{"SHELL", "bash", text(*shell), {{"bash"}, true}}};
    add_shared_options(command, shared);
    command.examples = {"source <(mirrorball completion bash)"};
    std::vector<Command> all = commands;
    all.push_back(command);
    command.run = [all, shell, &shared] {
        const std::string result = script(all);
        shared.json ? print_json(Json{{"shell", *shell}, {"script", result}}) : print(result);
        return 0;
    };
    return command;
}

}  // namespace mirrorball::cli
