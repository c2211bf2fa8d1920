// Session: what a window has open besides the viewer's scene, and what keys and hands do to both.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include <mirrorball/viewer.h>

namespace mirrorball::window {

/// Pixels from the window's top left corner.
struct Area {
    double left = 0, top = 0;
    int width = 0, height = 0;
};

struct Message {
    std::string text;
    bool is_error = false;
    double since = 0;  ///< seconds on the window's clock
};

struct Session {
    explicit Session(Viewer& shown) : viewer(shown) {}

    Viewer& viewer;
    bool panel_open = true, help_open = false, quit = false;
    bool time_runs = false;  ///< for what moves: bumps and lights
    bool screenshot_asked = false;
    bool holds_wipe = false;  ///< the mouse, the line between two methods
    std::optional<Message> message;
    MapContent content = MapContent::environment;  ///< of the strip's maps
    std::string scene_path = "scene.json";         ///< where the panel saves
    std::optional<Hover> hover;                    ///< under the mouse
    Area picture;
    double scale = 1;          ///< of text
    double frame_seconds = 0;  ///< smoothed
    double clock = 0;

    void tell(const std::string& text, bool is_error = false);
    /// Does it, and tells the error if it is one.
    void attempt(const std::function<void()>& action);
    /// An edit of the scene, likewise.
    void edit(const std::function<void(Scene&)>& change);
    void edit_comparison(const std::function<void(Comparison&)>& change);

    void press(const std::string& key);
    void drop(const std::string& file);
    [[nodiscard]] double aspect() const;
};

}  // namespace mirrorball::window
