#include "desktop.h"

#include <cstdlib>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <mirrorball/error.h>

namespace mirrorball::window {
namespace {

std::string last_error() {
    const char* description = nullptr;
    glfwGetError(&description);
    return description != nullptr ? description : "no reason given";
}

std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr ? fmt::format("{}={}", name, value)
                            : fmt::format("{} is not set", name);
}

constexpr const char* kName = "mirrorball";
constexpr const char* kAdvice =
    "\"mirrorball render\" draws pictures without a window, and xvfb-run gives programs a screen "
    "that no one sees";

// Debian's ImGui speaks the desktop's OpenGL only.
GLFWwindow* open_window(int width, int height) {
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_DEPTH_BITS, 24);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    if (GLFWwindow* window = glfwCreateWindow(width, height, kName, nullptr, nullptr))
        return window;
    throw Error(Errc::unsupported,
                fmt::format("no window with OpenGL can be opened; tried: OpenGL 4.5, core profile "
                            "({}). {}",
                            last_error(), kAdvice));
}

// Keys that are no letters, as browsers name them.
const char* name_of(int key) {
    switch (key) {
        case GLFW_KEY_LEFT:
            return "ArrowLeft";
        case GLFW_KEY_RIGHT:
            return "ArrowRight";
        case GLFW_KEY_UP:
            return "ArrowUp";
        case GLFW_KEY_DOWN:
            return "ArrowDown";
        case GLFW_KEY_HOME:
            return "Home";
        case GLFW_KEY_TAB:
            return "Tab";
        case GLFW_KEY_ESCAPE:
            return "Escape";
        case GLFW_KEY_F1:
            return "F1";
        case GLFW_KEY_F11:
            return "F11";
        default:
            return nullptr;
    }
}

Events& events_of(GLFWwindow* window) {
    return *static_cast<Events*>(glfwGetWindowUserPointer(window));
}

void on_key(GLFWwindow* window, int key, int /*scancode*/, int action, int /*modifiers*/) {
    if (action == GLFW_RELEASE) return;
    if (const char* name = name_of(key)) events_of(window).keys.emplace_back(name);
}

// Letters as the keyboard's layout and Shift make them; those that keys are bound to are ASCII.
void on_character(GLFWwindow* window, unsigned int code) {
    if (code >= ' ' && code < 127) events_of(window).keys.emplace_back(1, static_cast<char>(code));
}

void on_drop(GLFWwindow* window, int count, const char** paths) {
    for (int i = 0; i < count; ++i) events_of(window).dropped.emplace_back(paths[i]);
}

}  // namespace

Desktop::Desktop(int width, int height, bool vertical_sync) {
    if (glfwInit() != GLFW_TRUE) {
        throw Error(Errc::unsupported,
                    fmt::format("there is no display to open a window on; tried: {} ({}; {}). {}",
                                "X11", last_error(), variable("DISPLAY"), kAdvice));
    }
    try {
        window_ = open_window(width, height);
    } catch (...) {
        glfwTerminate();
        throw;
    }
    glfwSetWindowUserPointer(window_, &events_);
    glfwSetKeyCallback(window_, on_key);
    glfwSetCharCallback(window_, on_character);
    glfwSetDropCallback(window_, on_drop);
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(vertical_sync ? 1 : 0);
}

Desktop::~Desktop() {
    glfwDestroyWindow(window_);
    glfwTerminate();
}

void Desktop::wait(double seconds) {
    if (seconds > 0) {
        glfwWaitEventsTimeout(seconds);
    } else {
        glfwPollEvents();
    }
}

Events Desktop::take_events() {
    return std::exchange(events_, {});
}

void Desktop::swap() {
    glfwSwapBuffers(window_);
}

void Desktop::resize(int width, int height) {
    glfwSetWindowSize(window_, width, height);
}

void Desktop::close() {
    glfwSetWindowShouldClose(window_, GLFW_TRUE);
}

void Desktop::set_title(const std::string& title) {
    const std::string whole = title.empty() ? kName : fmt::format("{} - {}", title, kName);
    glfwSetWindowTitle(window_, whole.c_str());
}

Desktop::Size Desktop::pixels() const {
    Size size{};
    glfwGetFramebufferSize(window_, &size.width, &size.height);
    return size;
}

bool Desktop::is_closed() const {
    return glfwWindowShouldClose(window_) == GLFW_TRUE;
}

double Desktop::scale() const {
    float x = 1, y = 1;
    glfwGetWindowContentScale(window_, &x, &y);
    return x > 0 ? x : 1;
}

}  // namespace mirrorball::window
