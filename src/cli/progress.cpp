#include "progress.h"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <mirrorball/error.h>

#include "interrupt.h"
#include "options.h"

namespace mirrorball::cli {
namespace {

using namespace std::chrono_literals;

// Shorter work is over before anyone could read a bar.
constexpr auto kQuietStart = 500ms;
constexpr auto kRedraw = 100ms;
constexpr int kBarWidth = 24;

int terminal_width() {
    winsize size{};
    return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

std::string duration_text(double seconds) {
    const auto whole = static_cast<long>(seconds + 0.5);
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{}:{:02} min", whole / 60, whole % 60);
    return fmt::format("{}:{:02} h", whole / 3600, whole / 60 % 60);
}

std::string bar(double done) {
    const int filled = static_cast<int>(done * kBarWidth + 0.5);
    std::string text = "[";
    for (int i = 0; i < kBarWidth; ++i) text += i < filled ? '#' : '.';
    return text + "]";
}

}  // namespace

ProgressBar::ProgressBar(const Shared& shared, int part_count)
    : enabled_(!shared.quiet && isatty(STDERR_FILENO) == 1),
      part_count_(part_count) {}

ProgressBar::~ProgressBar() {
    hide();
}

void ProgressBar::hide() {
    if (shown_) fmt::print(stderr, "\r\x1b[K");
    shown_ = false;
}

void ProgressBar::begin_part(int index) {
    hide();
    part_ = index;
    before_ = static_cast<double>(index) / part_count_;
    share_ = 0;
}

Progress ProgressBar::stage(const std::string& label, double share) {
    stop_if_interrupted();
    before_ = std::min(1.0, before_ + share_);
    share_ = share / part_count_;
    label_ = part_count_ > 1 ? fmt::format("{}/{} {}", part_ + 1, part_count_, label) : label;
    return [this](double fraction) {
        if (enabled_) show(std::min(1.0, before_ + share_ * fraction));
        return !interrupted();
    };
}

void ProgressBar::show(double done) {
    const std::lock_guard lock(mutex_);
    const auto now = Clock::now();
    if (now - start_ < kQuietStart || now - last_ < kRedraw) return;
    last_ = now;
    shown_ = true;
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    std::string line = fmt::format("{} {} {:3.0f} %", label_, bar(done), done * 100);
    // The first hundredth says too little about the rest.
    if (done > 0.01) line += fmt::format("  {} left", duration_text(elapsed * (1 - done) / done));
    line.resize(std::min<std::size_t>(line.size(), static_cast<std::size_t>(terminal_width() - 1)));
    fmt::print(stderr, "\r{}\x1b[K", line);
    std::fflush(stderr);
}

void stop_if_interrupted() {
    if (interrupted()) throw Error(Errc::cancelled, "interrupted");
}

}  // namespace mirrorball::cli
