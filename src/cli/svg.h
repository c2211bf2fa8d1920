// Drawings as SVG text: shapes in pixels from the top left, in one style.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mirrorball::cli {

struct Spot {
    double x, y;
};

/// How a line or shape looks. Colours as in CSS; none where empty.
struct Ink {
    std::string stroke, fill;
    double width = 1.5;
    double opacity = 1;
    bool dashed = false;
};

/// Colours that plots share: legible on white, and apart for those who see red and green alike.
namespace ink {
inline constexpr const char* kText = "#1d2126";
inline constexpr const char* kSoft = "#6b727b";
inline constexpr const char* kGrid = "#e3e5e8";
inline constexpr const char* kAxis = "#9aa1a9";
inline constexpr const char* kBlue = "#1f6fb2";
inline constexpr const char* kOrange = "#e08a1e";
inline constexpr const char* kChannels[] = {"#d1362f", "#2a9d4a", "#2563c9"};  // R, G and B
}  // namespace ink

enum class Anchor { start, middle, end };

class Svg {
  public:
    Svg(int width, int height);

    void line(Spot from, Spot to, const Ink& ink);
    void path(const std::vector<Spot>& spots, const Ink& ink, bool closed = false);
    void circle(Spot centre, double radius, const Ink& ink);
    void arrow(Spot from, Spot to, const Ink& ink);
    void text(Spot at, std::string_view words, double size, const char* colour = ink::kText,
              Anchor anchor = Anchor::start, bool bold = false);

    /// The whole file.
    [[nodiscard]] std::string str() const;

  private:
    int width_, height_;
    std::string body_;
};

/// A path without the points that no eye could tell from the line through their neighbours.
[[nodiscard]] std::vector<Spot> thinned(const std::vector<Spot>& spots, double tolerance = 0.05);

}  // namespace mirrorball::cli
