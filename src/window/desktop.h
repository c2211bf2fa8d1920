// Desktop: the one place that knows about GLFW. A window with an OpenGL context, and what came in.
#pragma once

#include <functional>
#include <string>
#include <vector>

struct GLFWwindow;

namespace mirrorball::window {

/// What happened since the last look.
struct Events {
    std::vector<std::string> keys;  ///< as browsers name them
    std::vector<std::string> dropped;
};

class Desktop {
  public:
    /// \throws Error(Errc::unsupported) naming what was tried
    Desktop(int width, int height, bool vertical_sync);
    ~Desktop();
    Desktop(const Desktop&) = delete;
    Desktop& operator=(const Desktop&) = delete;

    /// Waits for something to happen, `seconds` at most.
    void wait(double seconds);
    [[nodiscard]] Events take_events();
    void swap();
    void resize(int width, int height);
    void close();
    /// In front of the program's name; none if empty.
    void set_title(const std::string& title);

    struct Size {
        int width, height;
        bool operator==(const Size&) const = default;
    };
    [[nodiscard]] Size pixels() const;
    [[nodiscard]] bool is_closed() const;
    /// Of text: pixels per point of a usual screen.
    [[nodiscard]] double scale() const;
    [[nodiscard]] GLFWwindow* handle() const { return window_; }

  private:
    GLFWwindow* window_ = nullptr;
    Events events_;
};

}  // namespace mirrorball::window
