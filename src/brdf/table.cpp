// Measured isotropic BRDFs from text: a grid of angles of light, view and azimuth.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <mirrorball/error.h>

#include "brdf/half_angle_sampler.h"
#include "brdf/model.h"
#include "io/file.h"

namespace mirrorball {
namespace detail {
namespace {

constexpr std::uint64_t kLargestFile = 64 << 20;
constexpr std::size_t kMostLines = 1'000'000;

struct Line {
    int number;                   // in the file, from 1
    double light, view, azimuth;  // degrees
    Vec3d value;

    [[nodiscard]] auto key() const { return std::tie(light, view, azimuth); }
};

// One side of the grid: its angles in degrees, increasing.
class Side {
  public:
    template <class Member>
    Side(const std::vector<Line>& lines, Member member) {
        for (const Line& line : lines) degrees_.push_back(line.*member);
        std::sort(degrees_.begin(), degrees_.end());
        degrees_.erase(std::unique(degrees_.begin(), degrees_.end()), degrees_.end());
    }

    [[nodiscard]] std::size_t size() const { return degrees_.size(); }
    [[nodiscard]] double operator[](std::size_t i) const { return degrees_[i]; }

    struct Between {
        std::size_t low, high;
        double share;  // of the higher
    };
    [[nodiscard]] Between find(double radians) const {
        const double angle = radians * 180 / kPi;
        const auto after = std::upper_bound(degrees_.begin(), degrees_.end(), angle);
        if (after == degrees_.begin()) return {0, 0, 0};
        const std::size_t low = after - degrees_.begin() - 1;
        if (after == degrees_.end()) return {low, low, 0};
        return {low, low + 1, (angle - degrees_[low]) / (*after - degrees_[low])};
    }

  private:
    std::vector<double> degrees_;
};

class TableModel : public BrdfModel {
  public:
    /// \pre  the lines are sorted and fill the grid
    TableModel(std::string path, const std::vector<Line>& lines)
        : path_(std::move(path)),
          light_(lines, &Line::light),
          view_(lines, &Line::view),
          azimuth_(lines, &Line::azimuth),
          values_(values_of(lines)),
          sampler_([this](const Vec3d& wi, const Vec3d& wo) {
              const Vec3d f = lookup(wi, wo);
              return f.x + f.y + f.z;
          }) {}

    Vec3d evaluate(const Vec3d& wi, const Vec3d& wo) const override { return lookup(wi, wo); }
    double density(const Vec3d& wi, const Vec3d& wo) const override {
        return sampler_.density(wi, wo);
    }
    Choice choose(const Vec3d& wo, const Vec3d& u) const override {
        return {sampler_.choose(wo, u)};
    }
    std::string text() const override { return "table:" + path_; }

  private:
    static std::vector<Vec3d> values_of(const std::vector<Line>& lines) {
        std::vector<Vec3d> values;
        values.reserve(lines.size());
        for (const Line& line : lines) values.push_back(line.value);
        return values;
    }
    static double angle_to_normal(const Vec3d& w) { return std::atan2(std::hypot(w.x, w.y), w.z); }

    [[nodiscard]] Vec3d lookup(const Vec3d& wi, const Vec3d& wo) const {
        // along the normal there is no azimuth, and atan2(0, 0) is 0
        const double across = wi.x * wo.y - wi.y * wo.x, along = wi.x * wo.x + wi.y * wo.y;
        const auto light = light_.find(angle_to_normal(wi)), view = view_.find(angle_to_normal(wo)),
                   azimuth = azimuth_.find(std::abs(std::atan2(across, along)));
        Vec3d sum(0);
        for (int corner = 0; corner < 8; ++corner) {
            const bool a = corner & 1, b = corner & 2, c = corner & 4;
            const double weight = (a ? light.share : 1 - light.share) *
                                  (b ? view.share : 1 - view.share) *
                                  (c ? azimuth.share : 1 - azimuth.share);
            const std::size_t row =
                (a ? light.high : light.low) * view_.size() + (b ? view.high : view.low);
            if (weight > 0)
                sum += values_[row * azimuth_.size() + (c ? azimuth.high : azimuth.low)] * weight;
        }
        return sum;
    }

    std::string path_;
    Side light_, view_, azimuth_;
    std::vector<Vec3d> values_;
    HalfAngleSampler sampler_;
};

std::string read_text(InputFile& file) {
    if (file.size() > kLargestFile)
        file.fail(
            fmt::format("{} bytes; a table of a BRDF has at most {}", file.size(), kLargestFile));
    std::string text(file.size(), '\0');
    file.read(std::as_writable_bytes(std::span(text)));
    return text;
}

// The numbers of a line; empty if there is something else in it.
std::vector<double> numbers_in(const std::string& line) {
    std::vector<double> numbers;
    const char* rest = line.c_str();
    while (true) {
        rest += std::strspn(rest, " \t\r");
        if (*rest == '\0') return numbers;
        char* end = nullptr;
        numbers.push_back(std::strtod(rest, &end));
        if (end == rest || std::strchr(" \t\r", *end) == nullptr || numbers.size() > 6) return {};
        rest = end;
    }
}

void check_number(const InputFile& file, int line, const char* what, double value, double most) {
    if (value >= 0 && value <= most) return;
    file.fail(fmt::format("line {}: the {} is {}; expected {}", line, what, value,
                          std::isinf(most) ? "a number from 0 up" : fmt::format("0 to {}", most)));
}

Line parse_line(const InputFile& file, int number, const std::string& text) {
    const std::vector<double> n = numbers_in(text);
    if (n.size() != 4 && n.size() != 6)
        file.fail(
            fmt::format("line {}: found \"{:.40}\", expected the angles of light, view and "
                        "azimuth in degrees, and one value or R G B",
                        number, text));
    check_number(file, number, "light's angle", n[0], 90);
    check_number(file, number, "view's angle", n[1], 90);
    check_number(file, number, "azimuth", n[2], 180);
    const Vec3d value = n.size() == 4 ? Vec3d(n[3]) : Vec3d(n[3], n[4], n[5]);
    for (int c = 0; c < 3; ++c) {
        // finite, and with room to be added up
        check_number(file, number, "value", value[c], 1e30);
    }
    return {number, n[0], n[1], n[2], value};
}

std::vector<Line> parse_lines(const InputFile& file, const std::string& text) {
    std::istringstream stream(text);
    std::vector<Line> lines;
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
        line.resize(std::min(line.find('#'), line.size()));
        if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
        if (lines.size() == kMostLines)
            file.fail(fmt::format("more than {} measurements", kMostLines));
        lines.push_back(parse_line(file, number, line));
    }
    if (lines.empty()) file.fail("no measurements in it");
    return lines;
}

// Sorted, every point of the grid must be there once.
void check_grid(const InputFile& file, const std::vector<Line>& lines) {
    const Side light(lines, &Line::light), view(lines, &Line::view), azimuth(lines, &Line::azimuth);
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const Line& line = lines[i];
        if (i > 0 && lines[i - 1].key() == line.key())
            file.fail(fmt::format("line {}: the same angles as line {}", line.number,
                                  lines[i - 1].number));
    }
    const std::size_t per_light = view.size() * azimuth.size();
    for (std::size_t i = 0; i < light.size() * per_light; ++i) {
        const double l = light[i / per_light], v = view[i % per_light / azimuth.size()],
                     a = azimuth[i % azimuth.size()];
        if (i < lines.size() && lines[i].key() == std::tie(l, v, a)) continue;
        file.fail(
            fmt::format("{} angles of light, {} of view and {} azimuths make a grid, but "
                        "there is no line for {} {} {}",
                        light.size(), view.size(), azimuth.size(), l, v, a));
    }
}

}  // namespace

ModelPointer read_table_model(InputFile& file) {
    std::vector<Line> lines = parse_lines(file, read_text(file));
    std::stable_sort(lines.begin(), lines.end(),
                     [](const Line& a, const Line& b) { return a.key() < b.key(); });
    check_grid(file, lines);
    return std::make_shared<TableModel>(file.name(), lines);
}

}  // namespace detail

Brdf read_brdf_table(const std::filesystem::path& path) {
    detail::InputFile file(path);
    return Brdf(detail::read_table_model(file));
}

}  // namespace mirrorball
