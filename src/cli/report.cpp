// index.html: what the bake made, as pictures and figures. Works from a folder, without a network.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "bake.h"
#include "bake_materials.h"
#include "html.h"

namespace mirrorball::cli {
namespace {

std::string picture(const std::string& file, const std::string& alt, const char* classes = "") {
    return fmt::format(R"(<img src="{}/{}" alt="{}" class="{}" loading="lazy">)", kPictureFolder,
                       file, escaped(alt), classes);
}

// Figures
// -------------------------------------------------------------------------------------------

double largest(const Vec3f& v) {
    return std::max({v.x, v.y, v.z});
}

// The largest deviation of a channel's flux from what it should be, in percent. A channel without
// light has no ratio.
double flux_error(const LevelFacts& facts) {
    double worst = 0;
    for (int c = 0; c < 3; ++c) {
        if (std::isfinite(facts.flux_ratio[c])) {
            worst = std::max(worst, std::abs(facts.flux_ratio[c] - 1) * 100);
        }
    }
    return worst;
}

std::string percent(double value) {
    return value < 0.001 ? "&lt; 0.001 %" : fmt::format("{:.{}f} %", value, value < 0.1 ? 3 : 2);
}

std::string amount(double value) {
    const double size = std::abs(value);
    if (value == 0) return "0";
    if (size >= 1e5 || size < 1e-3) return fmt::format("{:.2e}", value);
    return fmt::format("{:.{}f}", value, size >= 100 ? 0 : size >= 1 ? 2 : 3);
}

std::string tile(const std::string& name, const std::string& value, const std::string& note) {
    return fmt::format("<div><dt>{}</dt><dd>{} <small>{}</small></dd></div>\n", name, value, note);
}

std::string tiles(const Bake& bake) {
    const LevelStatistics& s = bake.source_statistics;
    std::int64_t clipped = 0;
    double worst_flux = 0, seconds = 0;
    for (const BakedMap* baked : {&bake.environment, &bake.specular, &bake.phong, &bake.diffuse}) {
        clipped += baked->written.clipped_texel_count;
        for (const LevelFacts& facts : baked->facts) {
            worst_flux = std::max(worst_flux, flux_error(facts));
        }
    }
    for (const Timing& timing : bake.timings) seconds += timing.seconds;
    const Vec3d mean = s.flux / (4 * kPi);
    const double mean_grey = (mean.x + mean.y + mean.z) / 3;
    return "<dl class=\"tiles\">\n" +
           tile("Brightest", amount(largest(s.maximum)),
                mean_grey > 0
                    ? fmt::format("{} times the mean", amount(largest(s.maximum) / mean_grey))
                    : "no light") +
           tile("Darkest", amount(std::min({s.minimum.x, s.minimum.y, s.minimum.z})),
                s.negative_count > 0 ? fmt::format("{} negative texels", s.negative_count)
                                     : "no negative texels") +
           tile("Flux", amount((s.flux.x + s.flux.y + s.flux.z) / 3),
                fmt::format("R {} · G {} · B {}", amount(s.flux.x), amount(s.flux.y),
                            amount(s.flux.z))) +
           tile("Flux kept within", percent(worst_flux), "worst channel of any level") +
           tile("Clipped texels", fmt::format("{}", clipped),
                clipped > 0 ? "see Files below" : "none exceeds the format") +
           tile("Baked in", fmt::format("{:.1f} s", seconds), "all steps, pictures included") +
           "</dl>\n";
}

// Sections
// ------------------------------------------------------------------------------------------

// The faces of a horizontal cross, in words. A cube in our axes has its +Z face ahead.
std::string labelled_cross() {
    const struct {
        int column, row;
        const char* label;
    } faces[] = {{1, 0, "up +Y"},    {0, 1, "left −X"}, {1, 1, "ahead +Z"},
                 {2, 1, "right +X"}, {3, 1, "back −Z"}, {1, 2, "down −Y"}};
    std::string html = "<div class=\"unfolded\">" +
                       picture("cube.png",
                               "The environment as an unfolded cube: ahead in the middle, "
                               "left and right beside it, up above, down below");
    for (const auto& face : faces) {
        html += fmt::format(R"(<span style="left:{}%;top:{:.2f}%">{}</span>)", face.column * 25,
                            face.row * 100 / 3.0, face.label);
    }
    return html + "</div>";
}

std::string figure_card(const char* well, const std::string& content, const std::string& heading,
                        const std::string& text, const char* classes = "") {
    return fmt::format(
        "<figure class=\"card {}\"><div class=\"well {}\">{}</div>"
        "<figcaption><h3>{}</h3><p>{}</p></figcaption></figure>\n",
        classes, well, content, heading, text);
}

std::string projections_section() {
    return "<section>\n<h2>The environment, laid out</h2>\n"
           "<p>The same light in every projection, at one exposure.</p>\n"
           "<div class=\"grid two\">\n" +
           figure_card("", labelled_cross(), "Unfolded cube",
                       "Seen from inside. The names are directions in the world and faces of "
                       "<code>environment.ktx2</code>.") +
           figure_card("",
                       picture("equirect.png", "The environment as an equirectangular panorama"),
                       "Equirectangular",
                       "Ahead in the middle, right at three quarters, back at both ends.") +
           "</div>\n<div class=\"grid\">\n" +
           figure_card(
               "", picture("sphere.png", "A mirror ball that reflects the environment", "round"),
               "Sphere map",
               "A mirror ball, looking ahead: in its middle what lies behind the camera, "
               "around its rim what lies ahead.") +
           figure_card("pair",
                       picture("paraboloid-front.png", "Front paraboloid", "round") +
                           picture("paraboloid-back.png", "Back paraboloid", "round"),
                       "Dual paraboloid",
                       "First the half around +Z, as a mirror shows it, then the half ahead, −Z.") +
           figure_card("", picture("angular.png", "The environment as an angular map", "round"),
                       "Angular map", "Ahead in the middle; the radius is the angle.") +
           figure_card("", picture("octahedral.png", "The environment as an octahedral map"),
                       "Octahedral", "The sphere folded out into one square.") +
           figure_card("",
                       picture("equal-area-octahedral.png",
                               "The environment as an equal-area octahedral map"),
                       "Equal-area octahedral", "The same, every texel of one solid angle.") +
           "</div>\n</section>\n";
}

std::string lobe_heading(const Lobe& lobe) {
    switch (lobe.kind) {
        case Lobe::Kind::mirror:
            return "Mirror";
        case Lobe::Kind::diffuse:
            return "Diffuse";
        case Lobe::Kind::phong:
            return fmt::format("Exponent {:g}", lobe.parameter);
        case Lobe::Kind::blinn_phong:
            return fmt::format("Blinn exponent {:g}", lobe.parameter);
        case Lobe::Kind::ggx:
            return lobe.is_delta() ? "Roughness 0, a mirror"
                                   : fmt::format("Roughness {:.3g}", lobe.parameter);
        case Lobe::Kind::charlie:
            return fmt::format("Sheen, roughness {:.3g}", lobe.parameter);
        case Lobe::Kind::tabulated:
            return fmt::format("Measured: {}", lobe.table->name);
    }
    return "";
}

std::string level_facts(const LevelFacts& facts) {
    return "<dl class=\"facts\">" + html_fact("Faces", fmt::format("6 × {0}²", facts.size)) +
           html_fact(
               "Range",
               fmt::format("{} – {}",
                           amount(std::min({facts.statistics.minimum.x, facts.statistics.minimum.y,
                                            facts.statistics.minimum.z})),
                           amount(largest(facts.statistics.maximum)))) +
           html_fact("Flux off by", percent(flux_error(facts))) +
           html_fact("Seam ratio", fmt::format("{:.2f}", facts.seam_ratio)) +
           (facts.estimated_error ? html_fact("Estimated error", amount(*facts.estimated_error))
                                  : "") +
           "</dl>";
}

std::string level_card(const LevelFacts& facts, const std::string& stem) {
    const std::string name = lobe_heading(*facts.lobe);
    return fmt::format(
        "<figure class=\"card levels\"><div class=\"well\">{}</div><div class=\"well\">"
        "<div class=\"unfolded\">{}</div></div>"
        "<figcaption><h3>{}</h3><p>Level {} · <code>{}</code></p>{}</figcaption></figure>\n",
        picture(stem + "-ball.png", fmt::format("A ball lit by level {}: {}", facts.level, name),
                "round ball"),
        picture(stem + ".png", fmt::format("Level {} as an unfolded cube", facts.level)), name,
        facts.level, to_string(*facts.lobe), level_facts(facts));
}

std::string chain_section(const BakedMap& baked, const std::string& heading,
                          const std::string& stem, const std::string& text) {
    std::string html = fmt::format(
        "<section>\n<h2>{}</h2>\n<p>{} <a href=\"{}\">{}</a></p>\n"
        "<div class=\"grid\">\n",
        heading, text, baked.file, baked.file);
    for (const LevelFacts& facts : baked.facts) {
        html += level_card(facts, fmt::format("{}-{}", stem, facts.level));
    }
    return html + "</div>\n</section>\n";
}

std::string diffuse_section(const Bake& bake) {
    return fmt::format(
               "<section>\n<h2>Diffuse</h2>\n<p>A white matte ball, by the irradiance map and by "
               "nine "
               "spherical-harmonic coefficients: <a href=\"{0}\">{0}</a>, "
               "<a href=\"irradiance-sh.json\">irradiance-sh.json</a></p>\n<div class=\"grid\">\n",
               bake.diffuse.file) +
           level_card(bake.diffuse.facts.front(), "diffuse") +
           fmt::format(
               "<figure class=\"card\"><div class=\"well\">{}</div><figcaption>"
               "<h3>Nine coefficients</h3><p>Bands 0 to 2, not windowed; error against the map</p>"
               "<dl class=\"facts\">{}</dl></figcaption></figure>\n",
               picture("harmonics-ball.png", "The same ball lit by nine coefficients",
                       "round ball"),
               html_fact("RMS error", percent(bake.harmonics_error * 100))) +
           "</div>\n</section>\n";
}

std::string shelf(const MaterialRow& row) {
    std::string balls;
    for (const Material& material : row.materials) {
        balls += fmt::format(
            "<div>{}<span>{}</span></div>\n",
            picture(material.file, fmt::format("A ball: {}, {}", row.heading, material.label),
                    "round"),
            material.label);
    }
    return fmt::format(
        "<figure class=\"card shelf\"><div class=\"well\" style=\"--balls:{}\">{}</div>"
        "<figcaption><h3>{}</h3><p>{}</p></figcaption></figure>\n",
        row.materials.size(), balls, row.heading, row.text);
}

std::string materials_section(const Bake& bake) {
    std::string html =
        "<section>\n<h2>Materials</h2>\n<p>Balls shaded with the files of this page and nothing "
        "else, seen from the front, at the exposure of the other pictures.</p>\n"
        "<div class=\"shelves\">\n";
    for (const MaterialRow& row : material_rows(bake)) html += shelf(row);
    return html + "</div>\n</section>\n";
}

std::string tables_section(const Bake& bake) {
    return fmt::format(
               "<section>\n<h2>Tables</h2>\n<p>What depends on the surface and not on the "
               "environment: <a href=\"{0}\">{0}</a>, <a href=\"{1}\">{1}</a></p>\n"
               "<div class=\"grid two\">\n",
               bake.dfg_file.file, bake.fresnel_file.file) +
           figure_card("",
                       "<div class=\"axes\"><span>n·v 0</span><span>1</span>" +
                           picture("dfg.png",
                                   "The DFG table: n.v grows to the right, roughness downwards") +
                           "<span>roughness 0 ↓ 1</span></div>",
                       "DFG",
                       "The split sum: L = L<sub>D</sub> (F0 R + F90 G). Red is the scale, green "
                       "the bias, blue the albedo of sheen, here cut off at 1.") +
           figure_card("",
                       picture("fresnel.svg", fmt::format("Reflectance by angle of {}",
                                                          to_string(bake.options.fresnel))),
                       "Fresnel",
                       fmt::format("The share of the light that <code>{}</code> mirrors, by the "
                                   "angle; the file has it by the cosine.",
                                   escaped(to_string(bake.options.fresnel)))) +
           "</div>\n</section>\n";
}

std::string table_row(const BakedTable& table) {
    return fmt::format(
        "<tr><td><a href=\"{0}\"><code>{0}</code></a></td><td>{1}</td>"
        "<td class=\"number\">{2} × {3}</td><td>{4}</td>"
        "<td class=\"number\">{5}</td><td class=\"number\">{6}</td></tr>\n",
        table.file, escaped(table.use), table.image.width(), table.image.height(),
        name(table.format), bytes_text(table.written.byte_count),
        table.written.clipped_texel_count);
}

std::string file_row(const BakedMap& baked, const Bake& bake) {
    const WriteReport& written = baked.written;
    std::string clipped = fmt::format("{}", written.clipped_texel_count);
    if (written.clipped_texel_count > 0) {
        clipped += fmt::format("<br>flux lost {}", figures(written.lost_flux));
    }
    return fmt::format(
        "<tr><td><a href=\"{0}\"><code>{0}</code></a></td><td>{1}</td>"
        "<td class=\"number\">{2}² × {3}</td><td>{4}</td>"
        "<td class=\"number\">{5}</td><td class=\"number\">{6}</td></tr>\n",
        baked.file, baked.use, baked.map.width(), baked.map.level_count(),
        name(bake.options.format), bytes_text(written.byte_count), clipped);
}

std::string files_section(const Bake& bake) {
    std::string html =
        "<section>\n<h2>Files</h2>\n<div class=\"scroll card\" tabindex=\"0\" role=\"region\" "
        "aria-label=\"Table of files\"><table>\n<thead><tr>"
        "<th>File</th><th>Use</th><th class=\"number\">Faces × levels</th><th>Texels</th>"
        "<th class=\"number\">Size</th><th class=\"number\">Clipped</th></tr></thead>\n<tbody>\n";
    for (const BakedMap* baked : {&bake.environment, &bake.specular, &bake.phong, &bake.diffuse}) {
        html += file_row(*baked, bake);
    }
    html += table_row(bake.dfg_file) + table_row(bake.fresnel_file);
    return html +
           "<tr><td><a href=\"irradiance-sh.json\"><code>irradiance-sh.json</code></a></td>"
           "<td colspan=\"5\">Nine coefficients of radiance and of irradiance, basis "
           "stated.</td></tr>\n"
           "<tr><td><a href=\"bake.json\"><code>bake.json</code></a></td>"
           "<td colspan=\"5\">All figures of this page and more, for programs.</td></tr>\n"
           "</tbody></table></div>\n</section>\n";
}

std::string times_section(const Bake& bake) {
    double longest = 0;
    for (const Timing& timing : bake.timings) longest = std::max(longest, timing.seconds);
    std::string html = "<section>\n<h2>Time</h2>\n<ul class=\"times\">\n";
    for (const Timing& timing : bake.timings) {
        html += fmt::format(
            "<li><span>{}</span><b style=\"width:{:.1f}%\"></b><em>{:.2f} s</em></li>\n",
            timing.work, 100 * timing.seconds / longest, timing.seconds);
    }
    return html + "</ul>\n</section>\n";
}

std::string source_section(const Bake& bake) {
    const LoadedMap& source = bake.source;
    std::string html = fmt::format(
        "<section>\n<h2>Source</h2>\n<div class=\"card\" style=\"padding:6px 16px 14px\">"
        "<dl class=\"facts\">{}{}{}{}{}{}{}</dl></div>\n",
        html_fact("Input", "<code>" + escaped(bake.options.input.source) + "</code>"),
        html_fact("Format", escaped(source.format) + ", " + std::string(name(source.stored))),
        html_fact("Layout", shape_text(source.map)),
        html_fact("Axes", "<code>" + to_string(source.map.axes) + "</code>"),
        html_fact("Level mapping", escaped(bake.options.mapping)),
        html_fact("Tolerance", amount(bake.options.prefilter.tolerance)),
        html_fact("Exposure of the pictures", amount(bake.exposure)));
    for (const std::string& note : source.notes) {
        html += fmt::format("<p style=\"margin-top:12px\">Note: {}</p>\n", escaped(note));
    }
    return html + "</section>\n";
}

}  // namespace

std::string report_html(const Bake& bake) {
    const std::string title = std::filesystem::path(bake.options.input.source).filename().string();
    const std::string top = fmt::format(
        "<div class=\"hero\">{1}</div>\n<header class=\"title\"><h1>{0}</h1>\n"
        "<p class=\"lead\">Baked for rendering from {2}.</p>\n{3}</header>\n",
        escaped(title), picture("equirect.png", "Panorama of the environment"),
        shape_text(bake.source.map), tiles(bake));
    std::string html = viewer_section(bake) + projections_section();
    html += chain_section(
        bake.specular, "Specular, one level per roughness", "specular",
        fmt::format(
            "The environment blurred more from level to level, by the mapping of {}. Each ball "
            "reflects its level; below it the level as an unfolded cube.",
            bake.options.mapping));
    html += chain_section(bake.phong, "Phong, one level per exponent", "phong",
                          "The environment blurred by the classic cosine lobe.");
    html += diffuse_section(bake) + materials_section(bake) + tables_section(bake) +
            files_section(bake) + times_section(bake) + source_section(bake);
    html +=
        "<footer>Flux is the integral of radiance over the sphere. The seam ratio is the step "
        "between texels across a cube's edges over the step beside them: 1 means that no edge "
        "shows. The estimated error is that of prefiltering, rms over the level's rms; 0 is the "
        "source, resampled. Made by mirrorball " MIRRORBALL_VERSION ".</footer>\n";
    return html_page(title, top, html);
}

}  // namespace mirrorball::cli
