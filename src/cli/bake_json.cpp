#include <nlohmann/json.hpp>

#include "bake.h"

namespace mirrorball::cli {
namespace {

Json facts_json(const LevelFacts& facts) {
    const LevelStatistics& s = facts.statistics;
    return {{"level", facts.level},
            {"size", facts.size},
            {"lobe", facts.lobe ? Json(to_string(*facts.lobe)) : Json()},
            {"minimum", to_json(s.minimum)},
            {"maximum", to_json(s.maximum)},
            {"rms", s.rms},
            {"flux", to_json(s.flux)},
            {"flux_ratio", to_json(facts.flux_ratio)},
            {"seam_ratio", facts.seam_ratio},
            {"estimated_error", facts.estimated_error ? Json(*facts.estimated_error) : Json()}};
}

Json map_json(const BakedMap& baked) {
    Json json = to_json(baked.file, baked.map, baked.written);
    json["use"] = baked.use;
    json["quantity"] =
        baked.map.levels[0].lobe == Lobe{Lobe::Kind::diffuse} ? "irradiance" : "radiance";
    json["level_facts"] = Json::array();
    for (const LevelFacts& facts : baked.facts) json["level_facts"].push_back(facts_json(facts));
    return json;
}

Json table_json(const BakedTable& table) {
    Json json = {{"file", table.file},           {"use", table.use},
                 {"width", table.image.width()}, {"height", table.image.height()},
                 {"format", name(table.format)}, {"bytes", table.written.byte_count}};
    for (const auto& [key, value] : table.metadata) json[key.substr(key.find('.') + 1)] = value;
    return json;
}

Json source_json(const Bake& bake) {
    const LoadedMap& source = bake.source;
    const LevelStatistics& s = bake.source_statistics;
    return {{"name", bake.options.input.source},
            {"format", source.format},
            {"texel_format", name(source.stored)},
            {"projection", name(source.map.projection)},
            {"width", source.map.width()},
            {"height", source.map.height()},
            {"axes", to_string(source.map.axes)},
            {"minimum", to_json(s.minimum)},
            {"maximum", to_json(s.maximum)},
            {"rms", s.rms},
            {"flux", to_json(s.flux)},
            {"negative_texels", s.negative_count},
            {"seam_ratio", seam_ratio(source.map)},
            {"notes", source.notes}};
}

Json options_json(const BakeOptions& options) {
    Json phong = Json::array();
    for (const Lobe& lobe : options.phong) phong.push_back(lobe.parameter);
    return {{"size", options.size},
            {"mapping", options.mapping},
            {"tolerance", options.prefilter.tolerance},
            {"phong", phong},
            {"environment_size", options.environment_size},
            {"diffuse_size", options.diffuse_size},
            {"fresnel", to_string(options.fresnel)},
            {"format", name(options.format)}};
}

Json coefficients_json(const NineHarmonics& harmonics) {
    Json json = Json::array();
    for (int l = 0; l <= 2; ++l) {
        for (int m = -l; m <= l; ++m) {
            json.push_back(
                {{"l", l}, {"m", m}, {"rgb", to_json(harmonics.coefficients[l * l + l + m])}});
        }
    }
    return json;
}

}  // namespace

Json bake_json(const Bake& bake) {
    Json files = Json::array();
    for (const BakedMap* baked : {&bake.environment, &bake.specular, &bake.phong, &bake.diffuse}) {
        files.push_back(map_json(*baked));
    }
    Json seconds = Json::object();
    for (const Timing& timing : bake.timings) seconds[timing.work] = timing.seconds;
    return {
        {"writer", "mirrorball " MIRRORBALL_VERSION},
        {"source", source_json(bake)},
        {"options", options_json(bake.options)},
        {"maps", files},
        {"tables", {table_json(bake.dfg_file), table_json(bake.fresnel_file)}},
        {"harmonics", {{"file", "irradiance-sh.json"}, {"relative_rmse", bake.harmonics_error}}},
        {"pictures", {{"folder", kPictureFolder}, {"exposure", bake.exposure}}},
        {"seconds", seconds}};
}

Json harmonics_json(const Bake& bake) {
    return {{"writer", "mirrorball " MIRRORBALL_VERSION},
            {"source", bake.options.input.source},
            {"basis",
             "real, orthonormal, no Condon-Shortley sign (Ramamoorthi and Hanrahan 2001): "
             "Y00 = 0.282095; Y1-1, Y10, Y11 = 0.488603 (y, z, x); Y2-2, Y2-1, Y21 = 1.092548 "
             "(xy, yz, xz); Y20 = 0.315392 (3 z^2 - 1); Y22 = 0.546274 (x^2 - y^2)"},
            {"axes", "right-handed, +X right, +Y up, -Z ahead"},
            {"order", "(l, m) at l^2 + l + m"},
            {"colour", "scene-linear RGB"},
            {"radiance",
             {{"meaning", "L_lm = integral of L Y_lm dw over the sphere"},
              {"coefficients", coefficients_json(bake.radiance)}}},
            {"irradiance",
             {{"meaning",
               "E(n) = sum of E_lm Y_lm(n), not divided by pi; E_lm = A_l L_lm with "
               "A = pi, 2 pi / 3, pi / 4, no windowing"},
              {"relative_rmse_against_diffuse_map", bake.harmonics_error},
              {"coefficients", coefficients_json(convolved_with_cosine(bake.radiance))}}}};
}

}  // namespace mirrorball::cli
