// Materials by name, for those who would rather say "gold" than give its index of refraction.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <mirrorball/scene.h>

namespace mirrorball {

struct MaterialPreset {
    std::string name, description;
    Material material;
};
[[nodiscard]] const std::vector<MaterialPreset>& material_presets();
/// \throws Error(Errc::usage) naming the materials there are
[[nodiscard]] const Material& preset_material(std::string_view name);

}  // namespace mirrorball
