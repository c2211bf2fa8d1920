// A verb of the program as data: its name, its options and what it does.
//
// One table of options parses the command line (parse.cpp), prints the help (help.cpp) and fills
// the shell completion (completion.cpp), so that the three cannot drift apart.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "core/nearest.h"

namespace mirrorball::cli {

/// Takes an option's value as it was typed. Throws Error(Errc::usage) that says what was expected;
/// the parser puts the option's name in front.
using SetValue = std::function<void(const std::string& text)>;

/// What may stand for a value, for completion; `closed` when there is nothing else.
struct Choices {
    std::vector<std::string> values;
    bool closed = false;
    bool files = false;  ///< any file name too
};

struct Option {
    std::string names;       ///< "-o,--output"
    std::string value_name;  ///< "FILE"; empty for a switch
    std::string help;        ///< one line; the default in brackets at its end
    SetValue set;
    Choices choices = {};
    bool required = false;
};

/// A value that has no name but a place: IN, FILE, ...
struct Argument {
    std::string name, help;
    SetValue set;
    Choices choices = {};
    bool required = true;
    bool repeated = false;  ///< takes all words that are left, one after the other; the last only
};

struct Command {
    std::string name, summary;
    std::vector<Argument> arguments = {};
    std::vector<Option> options = {};
    std::vector<std::string> notes = {};     ///< paragraphs after the options
    std::vector<std::string> examples = {};  ///< whole command lines
    std::function<int()> run = {};           ///< the exit code
};

/// Fills the command's values. \throws Error(Errc::usage), with the nearest spelling where one is
/// near
enum class Parsed { run, help };
[[nodiscard]] Parsed parse(const Command& command, const std::vector<std::string>& arguments);

[[nodiscard]] std::string help_text(const Command& command);
[[nodiscard]] std::string help_text(const std::vector<Command>& commands);

// Where values go. The variable has to outlive the parsing.
[[nodiscard]] SetValue text(std::string& value);
[[nodiscard]] SetValue flag(bool& value);
[[nodiscard]] SetValue whole_number(int& value, int least, int most);
[[nodiscard]] SetValue real_number(double& value, double least, double most);

/// Any type that the library can parse by `parse(text)`.
template <class T, class Parse>
[[nodiscard]] SetValue parsed(T& value, Parse parse) {
    return [&value, parse](const std::string& text) { value = parse(text); };
}

/// "256" -> 256. \throws Error(Errc::usage) naming the range
[[nodiscard]] int parse_whole_number(const std::string& text, int least, int most);
[[nodiscard]] double parse_real_number(const std::string& text, double least, double most);
/// "1,2,3" -> {"1", "2", "3"}
[[nodiscard]] std::vector<std::string> split(std::string_view text, char separator);

using detail::nearest;
/// `"spher" is not a projection; did you mean "sphere"? There are: ...`
[[nodiscard]] std::string unknown(std::string_view kind, std::string_view word,
                                  const std::vector<std::string>& candidates);

}  // namespace mirrorball::cli
