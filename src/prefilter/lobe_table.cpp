// Measured lobes from text files.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <sstream>

#include <fmt/format.h>
#include <mirrorball/error.h>
#include <mirrorball/lobe.h>
#include <mirrorball/vector.h>

#include "io/file.h"

namespace mirrorball {
namespace {

// What 4096 points need, with many digits and comments.
constexpr std::uint64_t kLargestFile = 1 << 20;

constexpr const char* kBlanks = " \t\r";

std::string read_text(detail::InputFile& file) {
    if (file.size() > kLargestFile)
        file.fail(
            fmt::format("{} bytes; a table of a lobe has at most {}", file.size(), kLargestFile));
    std::string text(file.size(), '\0');
    file.read(std::as_writable_bytes(std::span(text)));
    return text;
}

struct Point {
    double degrees, weight;
};

// The number at the start of `rest`, which moves past it.
bool take_number(const char*& rest, double& number) {
    char* end = nullptr;
    number = std::strtod(rest, &end);
    const bool found = end != rest && (*end == '\0' || *end == ' ' || *end == '\t' || *end == '\r');
    rest = end;
    return found;
}

Point parse_point(const detail::InputFile& file, int line_number, const std::string& line) {
    const char* rest = line.c_str();
    Point point{};
    const bool found = take_number(rest, point.degrees) && take_number(rest, point.weight);
    if (!found || rest + std::strspn(rest, kBlanks) != line.c_str() + line.size())
        file.fail(
            fmt::format("line {}: found \"{:.40}\", expected an angle in degrees and a weight",
                        line_number, line));
    return point;
}

}  // namespace

Lobe read_lobe_table(const std::filesystem::path& path) {
    detail::InputFile file(path);
    std::istringstream lines(read_text(file));
    std::vector<double> angles, weights;
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
        line.resize(std::min(line.find('#'), line.size()));
        if (line.find_first_not_of(kBlanks) == std::string::npos) continue;
        const Point point = parse_point(file, number, line);
        angles.push_back(point.degrees * kPi / 180);
        weights.push_back(point.weight);
    }
    try {
        return tabulated_lobe(path.filename().string(), std::move(angles), std::move(weights));
    } catch (const Error& e) {
        throw Error(Errc::cannot_read, fmt::format("{}: {}", file.name(), e.what()));
    }
}

}  // namespace mirrorball
