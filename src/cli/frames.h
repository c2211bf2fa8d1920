// Frames of an animation: which ones, and the files that they become.
//
// A file's name comes from a pattern as of printf. Frames never share a name, and need not be
// checked for it: the pattern has the number exactly once and in full, with the same text around
// it, and a width pads it to the left with one character only.
#pragma once

#include <string>
#include <vector>

namespace mirrorball::cli {

inline constexpr int kLastFrame = 999999;

/// first, first + step, ... up to last.
struct FrameRange {
    int first = 0, last = 0, step = 1;
};
/// "0:119", or every fifth: "0:119:5". \throws Error(Errc::usage)
[[nodiscard]] FrameRange parse_frame_range(const std::string& text);
[[nodiscard]] std::vector<int> numbers(const FrameRange& range);

/// "water/%04d.png": %d is the frame's number, a width pads it with spaces, 0 before the width with
/// zeros; %% is a percent sign.
class FramePattern {
  public:
    /// \throws Error(Errc::usage) for anything else after a %, and unless there is one number, in
    /// the file's own name
    explicit FramePattern(const std::string& text);

    [[nodiscard]] std::string file_of(int frame) const;
    /// Of all files; empty: where the program runs.
    [[nodiscard]] std::string folder() const;

  private:
    std::string before_, after_;
    std::string number_;  // as fmt::format() takes it
};

/// Whether there is a number in it as FramePattern takes it.
[[nodiscard]] bool has_frame_number(const std::string& text);

}  // namespace mirrorball::cli
