#include "bake_materials.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <mirrorball/direct.h>
#include <mirrorball/fresnel.h>
#include <mirrorball/lookup.h>

#include "bake.h"

namespace mirrorball::cli {
namespace {

const Vec3d kLacquer(0.55, 0.07, 0.05), kPlastic(0.05, 0.20, 0.45);

/// What shaders read of a bake's files. The view is along z: n.v is n.z.
class Light {
  public:
    explicit Light(const Bake& bake) : bake_(bake) {
        // A level of about as many texels as the ball has pixels, lest it sparkles.
        constexpr int kMirrorSize = 256;
        const EnvironmentMap& map = bake.environment.map;
        while (map.width(mirror_level_) > kMirrorSize) ++mirror_level_;
    }

    [[nodiscard]] Vec3d mirror(const Vec3d& n) const {
        return Vec3d(look_up(bake_.environment.map, reflected_view(n), mirror_level_));
    }
    [[nodiscard]] Vec3d phong(const Vec3d& n, int level) const {
        return Vec3d(look_up(bake_.phong.map, reflected_view(n), level));
    }
    // Radiance of a white matte surface.
    [[nodiscard]] Vec3d diffuse(const Vec3d& n) const {
        return Vec3d(look_up(bake_.diffuse.map, n)) / kPi;
    }
    // Between the levels of the nearest roughnesses, as a renderer's trilinear filter would.
    [[nodiscard]] Vec3d specular(const Vec3d& n, double roughness) const {
        const EnvironmentMap& map = bake_.specular.map;
        const Vec3d r = reflected_view(n);
        int level = 0;
        while (level + 1 < map.level_count() && roughness_at(level + 1) <= roughness) ++level;
        const Vec3d sharper(look_up(map, r, level));
        if (level + 1 == map.level_count()) return sharper;
        const double share = std::clamp(
            (roughness - roughness_at(level)) / (roughness_at(level + 1) - roughness_at(level)),
            0.0, 1.0);
        return sharper * (1 - share) + Vec3d(look_up(map, r, level + 1)) * share;
    }
    [[nodiscard]] Dfg dfg(const Vec3d& n, double roughness) const {
        return bake_.dfg->ggx(n.z, roughness);
    }

  private:
    [[nodiscard]] double roughness_at(int level) const {
        return roughness_of(*bake_.specular.map.levels[level].lobe);
    }

    const Bake& bake_;
    int mirror_level_ = 0;
};

template <class Radiance>
Material material(const std::string& file, const std::string& label, Radiance radiance) {
    return {"material-" + file + ".png", label,
            [radiance](const Vec3d& n) { return Vec3f(radiance(n)); }};
}

// Figure 5.3.4.
MaterialRow phong_row(const Bake& bake, const Light& light) {
    MaterialRow row{"Phong, sharper and sharper",
                    "The environment through cosine lobes of growing exponent, and the mirror that "
                    "they tend to.",
                    {}};
    for (int level = static_cast<int>(bake.options.phong.size()) - 1; level >= 0; --level) {
        row.materials.push_back(
            material(fmt::format("phong-{}", level),
                     fmt::format("N = {:g}", bake.options.phong[level].parameter),
                     [light, level](const Vec3d& n) { return light.phong(n, level); }));
    }
    row.materials.push_back(
        material("mirror", "N → ∞", [light](const Vec3d& n) { return light.mirror(n); }));
    return row;
}

constexpr double kIndices[] = {1.5, 2.4, 5, 100};

// A row of figure 5.4: one way to join mirror and base, for indices from glass to nearly metal.
template <class Join>
MaterialRow fresnel_row(const std::string& name, const std::string& heading,
                        const std::string& text, const Light& light, Join join) {
    MaterialRow row{heading, text, {}};
    for (const double index : kIndices) {
        const Fresnel fresnel = Fresnel::dielectric(index);
        row.materials.push_back(material(fmt::format("{}-{:g}", name, index),
                                         fmt::format("index {:g}", index),
                                         [=](const Vec3d& n) { return join(light, fresnel, n); }));
    }
    return row;
}

Vec3d layered(const Light& light, Coating coating, const Fresnel& fresnel, const Vec3d& n) {
    const LayerWeights weights = layer_weights(coating, fresnel, n.z);
    return weights.mirror * light.mirror(n) + weights.diffuse * kLacquer * light.diffuse(n);
}

std::vector<MaterialRow> fresnel_rows(const Light& light) {
    return {
        fresnel_row("fresnel", "Fresnel-weighted mirror",
                    "What a smooth surface mirrors by the angle: little from the front, all of it "
                    "at the rim; the more, the higher the index of refraction.",
                    light,
                    [](const Light& of, const Fresnel& fresnel, const Vec3d& n) {
                        return layer_weights(Coating::off, fresnel, n.z).mirror * of.mirror(n);
                    }),
        fresnel_row("fresnel-plus", "Plus diffuse (Eq. 20)",
                    "The mirrored light and a red base, added: the base gives off light that "
                    "never reached it.",
                    light,
                    [](const Light& of, const Fresnel& fresnel, const Vec3d& n) {
                        return layered(of, Coating::off, fresnel, n);
                    }),
        fresnel_row("fresnel-blend", "Blended with diffuse (Eq. 21)",
                    "A transparent coating: the base gets what the coating lets through.", light,
                    [](const Light& of, const Fresnel& fresnel, const Vec3d& n) {
                        return layered(of, Coating::transparent, fresnel, n);
                    })};
}

Material metal_ball(const Light& light, const char* name, double roughness) {
    const Vec3d f0 = Fresnel::conductor(name)(1);
    return material(fmt::format("{}-{:g}", name, roughness),
                    fmt::format("{}, roughness {:g}", name, roughness), [=](const Vec3d& n) {
                        const Dfg dfg = light.dfg(n, roughness);
                        return light.specular(n, roughness) * dfg.reflectance(f0) *
                               energy_compensation(f0, dfg.albedo());
                    });
}

Material plastic_ball(const Light& light, double roughness) {
    return material(
        "plastic", fmt::format("plastic, roughness {:g}", roughness), [=](const Vec3d& n) {
            const auto shares = multiple_scattering(light.dfg(n, roughness), Vec3d(0.04));
            return light.specular(n, roughness) * shares.single +
                   light.diffuse(n) * (shares.multiple + shares.diffuse * kPlastic);
        });
}

MaterialRow split_sum_row(const Bake& bake, const Light& light) {
    return {"Metals and plastic by the split sum",
            fmt::format("<code>{}</code> times <code>{}</code>, with what rough metal loses by "
                        "multiple scattering given back.",
                        bake.specular.file, bake.dfg_file.file),
            {metal_ball(light, "gold", 0.1), metal_ball(light, "gold", 0.5),
             metal_ball(light, "copper", 0.3), plastic_ball(light, 0.15)}};
}

MaterialRow energy_row(const Light& light) {
    constexpr double kRoughness = 0.9;
    const Vec3d f0 = Fresnel::conductor("silver")(1);
    const auto single = [=](const Vec3d& n) {
        return light.specular(n, kRoughness) * light.dfg(n, kRoughness).reflectance(f0);
    };
    return {"Rough silver, and where its light goes",
            "At roughness 0.9 one bounce loses more than half of the light. Two ways to give it "
            "back, and a white matte ball to compare.",
            {material("silver-single", "one bounce", single),
             material("silver-compensated", "scaled by 1 + F0 (1/E − 1)",
                      [=](const Vec3d& n) {
                          return single(n) *
                                 energy_compensation(f0, light.dfg(n, kRoughness).albedo());
                      }),
             material("silver-multiple", "further bounces diffuse",
                      [=](const Vec3d& n) {
                          return single(n) +
                                 light.diffuse(n) *
                                     multiple_scattering(light.dfg(n, kRoughness), f0).multiple;
                      }),
             material("matte", "matte white", [=](const Vec3d& n) { return light.diffuse(n); })}};
}

}  // namespace

std::vector<MaterialRow> material_rows(const Bake& bake) {
    const Light light(bake);
    std::vector<MaterialRow> rows = {phong_row(bake, light)};
    for (MaterialRow& row : fresnel_rows(light)) rows.push_back(std::move(row));
    rows.push_back(split_sum_row(bake, light));
    rows.push_back(energy_row(light));
    return rows;
}

}  // namespace mirrorball::cli
