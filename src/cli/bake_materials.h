// Balls of different materials, shaded with nothing but the files of a bake: what a renderer will
// make of them. The models are the survey's figures 5.3.4 and 5.4.
#pragma once

#include <string>
#include <vector>

#include "ball.h"

namespace mirrorball::cli {

struct Bake;

struct Material {
    std::string file;   ///< of its picture
    std::string label;  ///< under it
    Shade radiance;     ///< before tone mapping
};

/// Balls that belong together and are shown side by side.
struct MaterialRow {
    std::string heading, text;
    std::vector<Material> materials;
};

/// \pre the bake's maps are there, and stay where they are as long as the rows
[[nodiscard]] std::vector<MaterialRow> material_rows(const Bake& bake);

}  // namespace mirrorball::cli
