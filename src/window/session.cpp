#include "session.h"

#include <mirrorball/error.h>

#include "view_window.h"

namespace mirrorball::window {

std::vector<KeyHelp> window_keys() {
    return {{"Tab", "controls and maps"},
            {"Space", "time runs or stands: of bumps and lights that move"},
            {"P", "take a picture of what is shown, as PNG"},
            {"H F1", "these keys"},
            {"Q Esc", "end"}};
}

void Session::tell(const std::string& text, bool is_error) {
    message = Message{text, is_error, clock};
}

void Session::attempt(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) {
        tell(error.what(), true);
    }
}

void Session::edit(const std::function<void(Scene&)>& change) {
    attempt([&] {
        Scene scene = viewer.scene();
        change(scene);
        viewer.set_scene(scene);
    });
}

void Session::edit_comparison(const std::function<void(Comparison&)>& change) {
    Comparison comparison = viewer.comparison();
    change(comparison);
    viewer.set_comparison(comparison);
}

void Session::press(const std::string& key) {
    if (key == "Tab") {
        panel_open = !panel_open;
    } else if (key == "h" || key == "F1") {
        help_open = !help_open;
    } else if (key == " ") {
        time_runs = !time_runs;
    } else if (key == "p") {
        screenshot_asked = true;
    } else if (key == "Escape" && help_open) {
        help_open = false;
    } else if (key == "q" || key == "Escape") {
        quit = true;
    } else {
        attempt([&] { viewer.press(key, aspect()); });
    }
}

void Session::drop(const std::string& file) {
    const Dropped dropped = viewer.drop(file);
    tell(dropped.message, !dropped.taken);
}

double Session::aspect() const {
    return picture.height > 0 ? static_cast<double>(picture.width) / picture.height : 1;
}

}  // namespace mirrorball::window
