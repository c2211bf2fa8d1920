// A bar with the time left, on stderr while it is a terminal, for work that takes a while.
#pragma once

#include <chrono>
#include <mutex>
#include <string>

#include <mirrorball/progress.h>

namespace mirrorball::cli {

struct Shared;

/// Work in stages. Each stage has a share of the whole, so that the bar runs from 0 to 1 once.
/// Where there are several parts alike, the stages' shares are of each part.
class ProgressBar {
  public:
    explicit ProgressBar(const Shared& shared, int part_count = 1);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    /// The callback for the next stage, which takes `share` of the whole. It says stop after
    /// Ctrl-C.
    [[nodiscard]] Progress stage(const std::string& label, double share = 1);

    /// The stages of part `index` follow, however far the one before came.
    void begin_part(int index);
    /// Takes the bar off the terminal; before anything else is printed.
    void hide();

  private:
    using Clock = std::chrono::steady_clock;

    void show(double done);

    bool enabled_;
    bool shown_ = false;
    int part_count_, part_ = 0;
    std::mutex mutex_;
    std::string label_;
    double before_ = 0, share_ = 0;  // of this stage in the whole
    Clock::time_point start_ = Clock::now(), last_ = start_;
};

/// Throws Error(Errc::cancelled) after Ctrl-C; between steps that report no progress.
void stop_if_interrupted();

}  // namespace mirrorball::cli
