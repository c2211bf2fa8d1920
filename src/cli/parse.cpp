// The option table turned into a CLI11 parser. CLI11 splits the command line and knows what belongs
// to which option; every value is ours to judge, so that all messages have one form.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <mirrorball/error.h>

#include "command.h"

namespace mirrorball::cli {
namespace {

// The name that messages use: "--output" of "-o,--output".
std::string long_name(const Option& option) {
    return split(option.names, ',').back();
}

std::vector<std::string> all_names(const Command& command) {
    std::vector<std::string> names = {"--help"};
    for (const Option& option : command.options) {
        for (const std::string& name : split(option.names, ',')) names.push_back(name);
    }
    return names;
}

void check_choice(const Choices& choices, const std::string& value) {
    if (!choices.closed) return;
    for (const std::string& choice : choices.values) {
        if (choice == value) return;
    }
    throw Error(Errc::usage, unknown("known here", value, choices.values));
}

void set_value(const std::string& name, const SetValue& set, const Choices& choices,
               const std::string& value) {
    try {
        check_choice(choices, value);
        set(value);
    } catch (const Error& error) {
        throw Error(Errc::usage, fmt::format("{}: {}", name, error.what()));
    }
}

// What was found of one option: its values in the order given.
struct Found {
    std::vector<std::string> values;
    CLI::Option* parsed = nullptr;
};

void check_not_swallowed(const std::string& name, const std::string& value) {
    // "-o --quiet" is a forgotten value, not a file called "--quiet".
    if (value.size() > 2 && value.compare(0, 2, "--") == 0) {
        throw Error(Errc::usage, fmt::format("{} needs a value, found {}", name, value));
    }
}

[[noreturn]] void report_unknown_option(const Command& command, const std::string& word) {
    const std::string name = word.substr(0, word.find('='));
    const std::string near = nearest(name, all_names(command));
    throw Error(
        Errc::usage,
        fmt::format("unknown option {}{}; see mirrorball {} --help", name,
                    near.empty() ? "" : fmt::format(", did you mean {}?", near), command.name));
}

void declare(CLI::App& app, const Command& command, std::vector<Found>& options) {
    for (std::size_t i = 0; i < command.options.size(); ++i) {
        const Option& option = command.options[i];
        options[i].parsed = option.value_name.empty()
                                ? app.add_flag(option.names)
                                : app.add_option(option.names, options[i].values)
                                      ->expected(1)
                                      ->take_all()
                                      ->allow_extra_args(false);
    }
}

void deliver_option(const Command& command, const Option& option, const Found& found) {
    const std::string name = long_name(option);
    if (found.parsed->count() == 0) {
        if (!option.required) return;
        throw Error(Errc::usage, fmt::format("{} {} is missing; see mirrorball {} --help", name,
                                             option.value_name, command.name));
    }
    if (option.value_name.empty()) return option.set("");
    if (found.values.size() > 1) throw Error(Errc::usage, fmt::format("{} is given twice", name));
    check_not_swallowed(name, found.values.front());
    set_value(name, option.set, option.choices, found.values.front());
}

// What belongs to no option is an argument, in the order given.
void deliver_arguments(const Command& command, const std::vector<std::string>& words) {
    for (const std::string& word : words) {
        if (word.size() > 1 && word[0] == '-') report_unknown_option(command, word);
    }
    const bool any_number = !command.arguments.empty() && command.arguments.back().repeated;
    if (words.size() > command.arguments.size() && !any_number) {
        throw Error(Errc::usage, fmt::format("unexpected argument \"{}\"; see mirrorball {} --help",
                                             words[command.arguments.size()], command.name));
    }
    for (std::size_t i = 0; i < command.arguments.size(); ++i) {
        const Argument& argument = command.arguments[i];
        if (i < words.size()) {
            const std::size_t end = argument.repeated ? words.size() : i + 1;
            for (std::size_t word = i; word < end; ++word)
                set_value(argument.name, argument.set, argument.choices, words[word]);
        } else if (argument.required) {
            throw Error(Errc::usage, fmt::format("{} is missing; see mirrorball {} --help",
                                                 argument.name, command.name));
        }
    }
}

}  // namespace

Parsed parse(const Command& command, const std::vector<std::string>& arguments) {
    CLI::App app;
    app.set_help_flag();
    app.allow_extras();
    bool help = false;
    app.add_flag("-h,--help", help);
    std::vector<Found> options(command.options.size());
    declare(app, command, options);
    try {
        app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    } catch (const CLI::ParseError& error) {
        throw Error(Errc::usage,
                    fmt::format("{}; see mirrorball {} --help", error.what(), command.name));
    }
    if (help) return Parsed::help;
    deliver_arguments(command, app.remaining());
    for (std::size_t i = 0; i < options.size(); ++i) {
        deliver_option(command, command.options[i], options[i]);
    }
    return Parsed::run;
}

}  // namespace mirrorball::cli
