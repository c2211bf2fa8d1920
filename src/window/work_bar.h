// WorkBar: long work shows in the window how far it is, and ends when the window is closed.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <thread>

#include <mirrorball/progress.h>

#include "desktop.h"

namespace mirrorball::window {

class WorkBar {
  public:
    /// `stop`, if not empty, is asked whether to end, too.
    WorkBar(Desktop& desktop, std::function<bool()> stop);

    /// What work called `what` is to call. The bar is drawn by the thread that made this; calls of
    /// others only say whether to go on.
    [[nodiscard]] Progress progress(std::string what);

    /// A frame has been shown: work that took its time is done.
    void end();

  private:
    using Clock = std::chrono::steady_clock;

    bool tell(const std::string& what, double share);
    void draw(double share);

    Desktop& desktop_;
    std::function<bool()> stop_;
    std::thread::id owner_ = std::this_thread::get_id();
    bool is_blank_ = true;  // nothing has been drawn in the window yet
    bool is_shown_ = false;
    std::string what_;
    double share_ = 1;
    Clock::time_point began_, drawn_;
};

}  // namespace mirrorball::window
