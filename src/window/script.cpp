#include "script.h"

#include <sstream>

#include <fmt/format.h>

#include <mirrorball/error.h>
#include <mirrorball/lobe.h>

namespace mirrorball::window {
namespace {

constexpr int kLargest = 16384, kMostFrames = 100000;

class LineReader {
  public:
    LineReader(const std::string& line, std::string where)
        : words_(line),
          where_(std::move(where)) {}

    std::string word(const char* what) {
        std::string word;
        if (!(words_ >> word)) fail(fmt::format("{} is missing", what));
        return word;
    }
    int whole(const char* what, int least, int most) {
        const double value = number(what);
        if (value < least || value > most || value != static_cast<int>(value))
            fail(fmt::format("{} is a whole number from {} to {}", what, least, most));
        return static_cast<int>(value);
    }
    double number(const char* what) {
        double value = 0;
        if (!(words_ >> value)) fail(fmt::format("{} is missing, or no number", what));
        return value;
    }
    // File names may have blanks in them.
    std::string rest(const char* what) {
        std::string rest;
        std::getline(words_ >> std::ws, rest);
        if (rest.empty()) fail(fmt::format("{} is missing", what));
        return rest;
    }
    bool at_end() { return (words_ >> std::ws).eof(); }
    [[noreturn]] void fail(const std::string& what) const {
        throw Error(Errc::usage, fmt::format("{}: {}", where_, what));
    }

  private:
    std::istringstream words_;
    std::string where_;
};

Step parse_step(LineReader& line) {
    const std::string verb = line.word("a step");
    if (verb == "resize") {
        const int width = line.whole("the width", 1, kLargest);
        return ResizeStep{width, line.whole("the height", 1, kLargest)};
    }
    if (verb == "drop") return DropStep{line.rest("the file")};
    if (verb == "key") return KeyStep{line.word("the key")};
    if (verb == "drag") {
        const double dx = line.number("the way to the right"), dy = line.number("the way down");
        return DragStep{dx, dy, line.at_end() ? 1 : line.whole("the frames", 1, kMostFrames)};
    }
    if (verb == "lobe") {
        const std::string kind = line.word("the kind of lobe");
        const double from = line.number("the first number"), to = line.number("the last number");
        for (const double number : {from, to}) {
            try {
                (void)parse_lobe(fmt::format("{}:{}", kind, number));
            } catch (const Error& error) {
                line.fail(error.what());
            }
        }
        return LobeStep{kind, from, to, line.whole("the frames", 1, kMostFrames)};
    }
    if (verb == "wait") return WaitStep{line.whole("the frames", 1, kMostFrames)};
    line.fail(
        fmt::format("\"{}\" is no step; there are: resize W H, drop FILE, key KEY, drag DX DY "
                    "[FRAMES], lobe KIND FROM TO FRAMES, wait FRAMES",
                    verb));
}

}  // namespace

std::vector<Step> parse_script(std::string_view text, std::string_view name) {
    std::vector<Step> steps;
    std::istringstream lines{std::string(text)};
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
        const std::size_t first = line.find_first_not_of(" \t\r");
        if (first == std::string::npos || line[first] == '#') continue;
        LineReader reader(line, fmt::format("{}:{}", name, number));
        steps.push_back(parse_step(reader));
        if (!reader.at_end()) reader.fail("there is more than the step takes");
    }
    return steps;
}

}  // namespace mirrorball::window
