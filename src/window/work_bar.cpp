#include "work_bar.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "gl/framebuffer_guard.h"
#include "gl/gl.h"

namespace mirrorball::window {
namespace {

// Work that takes less is not shown, and no two pictures of it come nearer one another.
constexpr std::chrono::milliseconds kPatience{150}, kBetween{50};
constexpr double kHeight = 4;  // of pixels at scale 1

void fill(int left, int width, int height, float red, float green, float blue) {
    glScissor(left, 0, width, height);
    glClearColor(red, green, blue, 1);
    glClear(GL_COLOR_BUFFER_BIT);
}

}  // namespace

WorkBar::WorkBar(Desktop& desktop, std::function<bool()> stop)
    : desktop_(desktop),
      stop_(std::move(stop)) {}

Progress WorkBar::progress(std::string what) {
    return [this, what = std::move(what)](double share) { return tell(what, share); };
}

bool WorkBar::tell(const std::string& what, double share) {
    if (stop_ && stop_()) return false;
    if (std::this_thread::get_id() != owner_) return true;
    const Clock::time_point now = Clock::now();
    if (what != what_ || share < share_) began_ = now;
    what_ = what, share_ = share;
    if (now - began_ < kPatience || now - drawn_ < kBetween) return true;
    desktop_.wait(0);
    if (desktop_.is_closed()) return false;
    const double seconds = std::chrono::duration<double>(now - began_).count();
    desktop_.set_title(fmt::format("{}: {:.0f} %, {:.0f} s left", what, 100 * share,
                                   seconds * (1 - share) / std::max(share, 0.01)));
    draw(share);
    drawn_ = Clock::now();
    return true;
}

// Along the lower edge; around it stays what was there.
void WorkBar::draw(double share) {
    const gl::FramebufferGuard guard;
    const auto [width, height] = desktop_.pixels();
    const int thick = std::max(1, static_cast<int>(kHeight * desktop_.scale()));
    const int done = static_cast<int>(std::clamp(share, 0.0, 1.0) * width);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glEnable(GL_SCISSOR_TEST);
    if (is_blank_) fill(0, width, height, 0.055f, 0.063f, 0.078f);
    fill(0, width, thick, 0.2f, 0.22f, 0.25f);
    fill(0, done, thick, 1, 0.69f, 0.28f);
    glDisable(GL_SCISSOR_TEST);
    desktop_.swap();
    is_shown_ = true;
}

void WorkBar::end() {
    is_blank_ = false;
    share_ = 1;
    if (std::exchange(is_shown_, false)) desktop_.set_title("");
}

}  // namespace mirrorball::window
