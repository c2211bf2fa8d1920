#include <mirrorball/material_presets.h>

#include <fmt/format.h>

#include <mirrorball/error.h>

namespace mirrorball {
namespace {

Material polished(const Fresnel& fresnel) {
    Material material;
    material.fresnel = fresnel;
    return material;
}

Material rough(const Fresnel& fresnel, double roughness) {
    Material material = polished(fresnel);
    material.mirror = 0;
    material.glossy = 1;
    material.lobe = {Lobe::Kind::ggx, roughness, nullptr};
    material.coupling = Coupling::split_sum;
    return material;
}

// The survey's: a lobe alone, without a Fresnel term.
Material phong(double exponent) {
    Material material;
    material.mirror = 0;
    material.glossy = 1;
    material.lobe = {Lobe::Kind::phong, exponent, nullptr};
    return material;
}

Material coated(const Vec3d& base_color, const Fresnel& fresnel = Fresnel::dielectric(1.5)) {
    Material material = polished(fresnel);
    material.base_color = base_color;
    material.diffuse = 1;
    return material;
}

Material matte(const Vec3d& base_color) {
    Material material;
    material.base_color = base_color;
    material.mirror = 0;
    material.diffuse = 1;
    material.coupling = Coupling::added;
    return material;
}

Material transparent(double index) {
    Material material = polished(Fresnel::dielectric(index));
    material.transmission = 1;
    material.index = index;
    return material;
}

Material satin(const Vec3d& base_color, double roughness) {
    Material material = rough(Fresnel::dielectric(1.5), roughness);
    material.base_color = base_color;
    material.diffuse = 1;
    return material;
}

// Tiles are as wide as high on a ball.
Material bumpy(Material material, std::string_view source, int tiles, double strength = 1) {
    material.bump.source = source;
    material.bump.repeat = {2.0 * tiles, 1.0 * tiles};
    material.bump.strength = strength;
    return material;
}

std::vector<MaterialPreset> make_presets() {
    const auto metal = [](std::string_view name) { return Fresnel::conductor(name); };
    return {
        {"mirror", "reflects all light, at every angle", Material{}},
        {"chrome", "polished chromium", polished(metal("chromium"))},
        {"silver", "polished", polished(metal("silver"))},
        {"gold", "polished", polished(metal("gold"))},
        {"copper", "polished", polished(metal("copper"))},
        {"satin-gold", "GGX, roughness 0.3", rough(metal("gold"), 0.3)},
        {"cast-iron", "GGX, roughness 0.55", rough(metal("iron"), 0.55)},
        {"plastic", "red, index 1.5: Eq. 21", coated({0.6, 0.03, 0.02})},
        {"satin-plastic", "blue, index 1.5, GGX, roughness 0.35", satin({0.03, 0.12, 0.45}, 0.35)},
        {"ceramic", "white, index 1.5: Eq. 21", coated(Vec3d(0.8))},
        {"matte", "grey, diffuse only", matte(Vec3d(0.6))},
        {"glass", "index 1.5", transparent(1.5)},
        {"diamond", "index 2.42", transparent(2.42)},
        {"water", "index 1.33, with waves", bumpy(transparent(1.33), "waves", 1, 0.5)},
        {"hammered-gold", "dents, polished", bumpy(polished(metal("gold")), "hammered", 2)},
        {"brushed-steel", "GGX, roughness 0.25, fine lines",
         bumpy(rough(metal("chromium"), 0.25), "brushed", 2, 1.5)},
        {"leather", "blue, index 1.5, GGX, roughness 0.35, wrinkles",
         bumpy(satin({0.02, 0.13, 0.4}, 0.35), "noise", 1)},
        {"bark", "diffuse only, furrows", bumpy(matte({0.35, 0.2, 0.1}), "bark", 2, 1.5)},
        {"phong-10", "a Phong lobe alone, exponent 10", phong(10)},
        {"phong-100", "exponent 100", phong(100)},
        {"phong-1000", "exponent 1000", phong(1000)},
    };
}

}  // namespace

const std::vector<MaterialPreset>& material_presets() {
    static const std::vector<MaterialPreset> presets = make_presets();
    return presets;
}

const Material& preset_material(std::string_view name) {
    std::string names;
    for (const MaterialPreset& preset : material_presets()) {
        if (preset.name == name) return preset.material;
        names += fmt::format("{}{}", names.empty() ? "" : ", ", preset.name);
    }
    throw Error(Errc::usage, fmt::format("\"{}\" is not a material; there are: {}", name, names));
}

}  // namespace mirrorball
