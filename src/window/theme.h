// How the controls look.
#pragma once

#include <imgui.h>

namespace mirrorball::window {

inline constexpr ImU32 kAccent = IM_COL32(255, 176, 72, 255);  ///< what is reflected
inline constexpr ImU32 kSecond = IM_COL32(96, 200, 255, 255);  ///< what is refracted; the second
inline constexpr ImU32 kFaint = IM_COL32(255, 255, 255, 150);
inline constexpr ImU32 kShade = IM_COL32(14, 16, 20, 205);  ///< under text on the picture

/// Dark; sizes and text `scale` times the usual. Reads a font of the system, or else takes ImGui's
/// own.
void apply_theme(double scale);

}  // namespace mirrorball::window
