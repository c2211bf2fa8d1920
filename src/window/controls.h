// Controls: ImGui's widgets in rows of a label and a value.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <mirrorball/vector.h>

namespace mirrorball::window {

struct Session;

// Each says whether the value has changed.

/// A number from least to most; `format` as printf's. Logarithmic where asked.
bool slider(const char* label, double& value, double least, double most,
            const char* format = "%.2f", bool logarithmic = false);
bool degrees(const char* label, double& radians, double least, double most);
bool color(const char* label, Vec3d& value);
/// Numbers without limits, dragged.
bool vector(const char* label, Vec3d& value, double speed);
bool checkbox(const char* label, bool& value);

struct Choice {
    std::string text, tip;
};
/// The place of what is chosen; -1: `shown` stands there, which is none of them.
bool choose(const char* label, std::span<const Choice> choices, int& index,
            const std::string& shown = {});

/// A group that opens and closes.
bool begin_group(const char* title, bool open);
void end_group();

/// Faint text over its whole width.
void note(std::string_view text);

}  // namespace mirrorball::window
