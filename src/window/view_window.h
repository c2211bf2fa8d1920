// A window that shows a Viewer, with controls; or the same by a script, for tests and pictures.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <mirrorball/gl/context.h>
#include <mirrorball/viewer.h>

#include "script.h"

namespace mirrorball::window {

struct Options {
    int width = 1280, height = 720;    ///< of the picture's pixels
    double scale = 0;                  ///< of text and controls; 0: as the screen says
    int frames = 0;                    ///< ends after so many; 0: when the window is closed
    std::filesystem::path screenshot;  ///< written at the end; or none
    bool panel = true;                 ///< controls and maps are there
    std::vector<Step> script;          ///< one step before each frame
    std::function<bool()> stop;        ///< asked before each frame
};

struct Report {
    std::vector<double> seconds;  ///< that each frame took
    gl::Driver driver;
};

/// Gives `make_viewer` what its viewer is to tell its progress to: the window shows it.
using MakeViewer = std::function<Viewer(const Progress& reading, const Progress& prefiltering)>;

/// `make_viewer` is called with the window's context current. Returns when the window is closed, or
/// all frames are drawn and the script is done. \throws Error(Errc::unsupported) naming what was
/// tried where no window can be opened; Error(Errc::cannot_write) for the screenshot
Report show(const MakeViewer& make_viewer, const Options& options);

/// What keys do besides those of Viewer::keys().
[[nodiscard]] std::vector<KeyHelp> window_keys();

}  // namespace mirrorball::window
