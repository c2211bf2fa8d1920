// Help texts, from the same table that parses.
#include <algorithm>

#include <fmt/format.h>

#include "command.h"

namespace mirrorball::cli {
namespace {

constexpr std::size_t kWidth = 100, kColumn = 28;

// Words of `text` in lines of at most `width`, each after the first indented.
std::string wrapped(const std::string& text, std::size_t width, std::size_t indent) {
    std::string out;
    std::size_t column = 0;
    for (const std::string& word : split(text, ' ')) {
        if (column > 0 && column + 1 + word.size() > width) {
            out += "\n" + std::string(indent, ' ');
            column = 0;
        } else if (column > 0) {
            out += ' ';
            ++column;
        }
        out += word;
        column += word.size();
    }
    return out;
}

std::string row(const std::string& left, const std::string& right) {
    std::string line = "  " + left;
    line += line.size() < kColumn - 1 ? std::string(kColumn - line.size(), ' ')
                                      : "\n" + std::string(kColumn, ' ');
    return line + wrapped(right, kWidth - kColumn, kColumn) + "\n";
}

// "-o, --output FILE", long names under each other.
std::string option_names(const Option& option) {
    const auto names = split(option.names, ',');
    std::string left = names.size() > 1 ? fmt::format("{}, {}", names[0], names[1])
                                        : fmt::format("    {}", names[0]);
    if (!option.value_name.empty()) left += " " + option.value_name;
    return left;
}

std::string usage_line(const Command& command) {
    std::string line = "usage: mirrorball " + command.name;
    for (const Argument& argument : command.arguments) {
        const char* const brackets = argument.required ? "  " : "[]";
        line += fmt::format(" {}{}{}{}", brackets[0], argument.name, argument.repeated ? "..." : "",
                            brackets[1]);
    }
    for (const Option& option : command.options) {
        if (!option.required) continue;
        line += fmt::format(" {} {}", split(option.names, ',').front(), option.value_name);
    }
    return line + (command.options.empty() ? "\n" : " [options]\n");
}

std::string option_help(const Option& option) {
    if (!option.choices.closed) return option.help;
    return fmt::format("{} ({})", option.help, fmt::join(option.choices.values, " "));
}

}  // namespace

std::string help_text(const Command& command) {
    std::string text = command.summary + "\n\n" + usage_line(command);
    for (const Argument& argument : command.arguments) text += row(argument.name, argument.help);
    text += "\n";
    for (const Option& option : command.options)
        text += row(option_names(option), option_help(option));
    text += row("-h, --help", "this text");
    for (const std::string& note : command.notes) text += "\n" + wrapped(note, kWidth, 0) + "\n";
    text += command.examples.size() == 1 ? "\nexample:\n" : "\nexamples:\n";
    for (const std::string& example : command.examples) text += "  " + example + "\n";
    return text;
}

std::string help_text(const std::vector<Command>& commands) {
    std::string text =
        "Environment maps: read, convert, prefilter, show and prove them.\n\n"
        "usage: mirrorball VERB [options]\n\n";
    for (const Command& command : commands) {
        text += fmt::format("  {:<15}{}\n", command.name, command.summary);
    }
    return text +
           "\n  mirrorball VERB --help    options and examples of a verb\n"
           "  mirrorball --version      which version this is\n\n"
           "IN is a file, a pattern for six faces (faces/%s.hdr) or builtin:NAME.\n"
           "Exit codes: 0 done, 1 compared and different, 2 usage, 3 cannot read, 4 cannot write,\n"
           "5 not in this build, 130 interrupted.\n\n"
           "example:\n"
           "  mirrorball bake studio.hdr -o studio\n";
}

}  // namespace mirrorball::cli
