// The live viewer in the report: a still picture that gives way to it, its controls, and what it
// reads. Pages that are opened as files may load scripts and nothing else, so that the maps are
// one.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mirrorball/lookup.h>
#include <mirrorball/reflection_maps.h>
#include <mirrorball/tone_map.h>

#include "bake.h"
#include "core/frontal_view.h"
#include "core/parallel.h"
#include "html.h"
#include "interrupt.h"
#include "io/file.h"

namespace mirrorball::cli {
namespace {

constexpr const char *kScript = "viewer.js", *kMaps = "maps.js", *kStill = "viewer.png";
// Faces as fine as a screen's picture of a ball shows, at 4 bytes a texel: what this holds of a
// panorama is some 2.5 MB, a third more as text.
constexpr int kLargestFace = 256;
constexpr int kStillWidth = 1200, kStillHeight = 600, kStillSamples = 2;

const char* const kStyle = R"(<style>
.live { display: grid; grid-template-columns: minmax(0, 1fr) 270px; margin-top: 18px; overflow: hidden;
  background: var(--card); border: 1px solid var(--line); border-radius: 14px; }
.stage { position: relative; height: min(62vh, 560px); background: var(--well); }
.stage img, .stage canvas { position: absolute; inset: 0; width: 100%; height: 100%; object-fit: cover; }
.stage canvas { cursor: grab; touch-action: pan-y; }
.stage canvas:focus { touch-action: none; }
.stage canvas:active { cursor: grabbing; }
.stage canvas:focus-visible { outline: 3px solid var(--accent); outline-offset: -3px; }
.stage button { position: absolute; left: 50%; bottom: 24px; transform: translateX(-50%);
  width: max-content; max-width: 86%; padding: 10px 20px; border: 0; border-radius: 99px;
  background: rgb(0 0 0 / 0.68); color: #fff; font: inherit; cursor: pointer; }
.stage button:hover { background: rgb(0 0 0 / 0.85); }
.stage button:focus-visible, .live form :focus-visible { outline: 3px solid var(--accent);
  outline-offset: 2px; }
.stage[data-state=live] button { display: none; }
.live form { padding: 18px 20px; font-size: 14px; }
.live fieldset { border: 0; margin: 0; padding: 0; display: grid; gap: 14px; min-width: 0; }
.live label { display: grid; grid-template-columns: 1fr auto; gap: 4px 8px; color: var(--soft); }
.live label[hidden] { display: none; }
.live select, .live input { grid-column: span 2; width: 100%; margin: 0; accent-color: var(--accent); }
.live select, .live form button { font: inherit; color: var(--ink); background: var(--page);
  border: 1px solid var(--line); border-radius: 8px; padding: 7px 10px; min-height: 38px; }
.live form output { font-variant-numeric: tabular-nums; color: var(--ink); }
.live p { margin: 0; color: var(--soft); font-size: 13px; line-height: 1.45; }
.live fieldset:disabled { opacity: 0.55; }
@media (max-width: 760px) {
  .live { grid-template-columns: minmax(0, 1fr); }
  .stage { height: min(100vw, 60vh); }
  .live fieldset { grid-template-columns: 1fr 1fr; gap: 14px 16px; }
  .live p { grid-column: span 2; }
}
@media print { .live form, .stage button { display: none; } }
</style>
)";

// Starts when half of the picture is in sight, or by its button. {0}: viewer.js, {1}: maps.js
const char* const kStart = R"(<script>
(() => {{
  const live = document.querySelector('.live'), stage = live.querySelector('.stage');
  const button = stage.querySelector('button');
  const load = (file) => new Promise((resolve, reject) => {{
    const script = document.createElement('script');
    script.onload = resolve;
    script.onerror = () => reject(new Error(`${{file}} is not beside this page.`));
    script.src = file;
    document.head.append(script);
  }});
  const sight = new IntersectionObserver(([seen]) => seen.isIntersecting && start(), {{ threshold: 0.5 }});
  async function start() {{
    sight.disconnect();
    if (stage.dataset.state) return;
    stage.dataset.state = 'loading';
    button.textContent = 'Loading …';
    try {{
      await Promise.all([load('{0}'), load('{1}')]);
      await mirrorball_embed(live, mirrorball_maps);
    }} catch (error) {{
      stage.dataset.state = 'failed';
      button.textContent = error.message;
    }}
  }}
  button.hidden = false;
  button.addEventListener('click', start);
  sight.observe(stage);
}})();
</script>
)";

std::string base64(const std::string& bytes) {
    constexpr std::string_view kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits =
                bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0);
        for (int digit = 3; digit >= 0; --digit) text += kDigits[bits >> (6 * digit) & 63];
    }
    const std::size_t padding = (3 - bytes.size() % 3) % 3;
    return text.replace(text.size() - padding, padding, padding, '=');
}

std::string contents(const std::filesystem::path& path) {
    detail::InputFile file(path);
    std::string bytes(file.size(), '\0');
    file.read(std::as_writable_bytes(std::span(bytes)));
    return bytes;
}

EnvironmentMap one_level(const EnvironmentMap& map, int level, int size) {
    const EnvironmentMap one{map.projection, map.axes, {map.levels[level]}};
    EnvironmentMap result =
        resample(one, map.projection, std::min(size, map.width(level)), map.axes);
    result.levels[0].lobe = one.levels[0].lobe;
    return result;
}

// As files of one level each. The mirror's level of a chain is the environment.
std::vector<std::pair<std::string, EnvironmentMap>> viewer_maps(const Bake& bake) {
    std::vector<std::pair<std::string, EnvironmentMap>> maps;
    maps.emplace_back("environment", one_level(bake.environment.map, 0, kLargestFace));
    const auto add = [&](const char* name, const BakedMap& baked) {
        for (const LevelFacts& facts : baked.facts) {
            if (facts.lobe->is_delta()) continue;
            const int size = std::min(kLargestFace, glossy_map_size(*facts.lobe, Projection::cube));
            maps.emplace_back(fmt::format("{}-{}", name, facts.level),
                              one_level(baked.map, facts.level, size));
        }
    };
    add("specular", bake.specular);
    add("phong", bake.phong);
    maps.emplace_back("diffuse", one_level(bake.diffuse.map, 0, kLargestFace));
    return maps;
}

void write_viewer_maps(const Bake& bake, const std::filesystem::path& folder) {
    Json files;
    const std::filesystem::path passing = folder / "viewer.ktx2";
    for (const auto& [name, map] : viewer_maps(bake)) {
        stop_if_interrupted();
        MapWriteOptions options;
        options.format = TexelFormat::rgb9e5;
        write_map(passing.string(), map, options);
        files[name] = base64(contents(passing));
    }
    std::filesystem::remove(passing);
    files["dfg"] = base64(contents(folder / bake.dfg_file.file));
    std::vector<double> roughnesses;
    for (const LevelFacts& facts : bake.specular.facts)
        roughnesses.push_back(facts.lobe->parameter);
    write_text(
        folder / kMaps,
        "// What the page's viewer looks up: the maps beside it, reduced, as KTX2 in base64.\n"
        "var mirrorball_maps = " +
            Json{{"exposure", bake.exposure}, {"roughnesses", roughnesses}, {"files", files}}.dump(
                0) +
            ";\n");
}

// Along the ray through a point of the picture, from -1 to 1 upwards and to the right by its
// height.
Vec3d seen(const EnvironmentMap& environment, double x, double y) {
    const double slope = std::tan(detail::kFrontalField / 2);
    const Vec3d eye(0, 0, detail::kFrontalDistance);
    const Vec3d ray = Vec3d(x * slope, y * slope, -1).normalized();
    const double nearest = -eye.dot(ray);
    const double miss = eye.length2() - nearest * nearest;
    if (miss >= 1) return Vec3d(look_up(environment, ray));
    const Vec3d n = eye + ray * (nearest - std::sqrt(1 - miss));
    return Vec3d(look_up(environment, ray - n * (2 * n.dot(ray))));
}

// A mirror ball, as the viewer shows it first.
void write_still(const Bake& bake, const std::filesystem::path& folder) {
    Image image(kStillWidth, kStillHeight, 3);
    detail::parallel_for(kStillHeight, [&](std::int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < kStillWidth; ++x) {
            Vec3f sum(0);
            for (int i = 0; i < kStillSamples * kStillSamples; ++i) {
                const double right = x + (i % kStillSamples + 0.5) / kStillSamples;
                const double down = y + (i / kStillSamples + 0.5) / kStillSamples;
                const Vec3d light =
                    seen(bake.environment.map, (2 * right - kStillWidth) / kStillHeight,
                         1 - 2 * down / kStillHeight);
                sum += tone_mapped(Vec3f(light), bake.exposure, ToneMap::film);
            }
            image.set_rgb(x, y, sum / static_cast<float>(kStillSamples * kStillSamples));
        }
    });
    write_image(folder / kPictureFolder / kStill, image, {.format = TexelFormat::unorm8});
}

std::string choice(const char* value, const std::string& label) {
    return fmt::format("<option value=\"{}\">{}</option>", value, label);
}

std::string slider(const char* name, const char* label, double least, double most, double step,
                   double value, const char* shown, bool hidden) {
    return fmt::format(
        "<label{7}>{1} <output data-of=\"{0}\">{6}</output><input type=\"range\" name=\"{0}\" "
        "min=\"{2:g}\" max=\"{3:g}\" step=\"{4:g}\" value=\"{5:g}\" "
        "autocomplete=\"off\"></label>\n",
        name, label, least, most, step, value, shown, hidden ? " hidden" : "");
}

std::string controls(const Bake& bake) {
    std::string exponents;
    for (const Lobe& lobe : bake.options.phong)
        exponents += fmt::format("<option>{:g}</option>", lobe.parameter);
    return "<form autocomplete=\"off\"><fieldset disabled>\n<label>Object<select name=\"mesh\">" +
           choice("sphere", "Ball") + choice("torus", "Torus") + choice("teapot", "Teapot") +
           choice("cube", "Cube") + "</select></label>\n<label>Material<select name=\"material\">" +
           choice("mirror", "Mirror") + choice("glossy", "Glossy (GGX)") +
           choice("phong", "Glossy (Phong)") + choice("matte", "Matte") +
           choice("plastic", "Plastic") + choice("gold", "Gold") + choice("copper", "Copper") +
           choice("silver", "Silver") + "</select></label>\n" +
           slider("roughness", "Roughness", 0, 1, 0.01, 0.25, "0.25", true) +
           "<label hidden>Exponent<select name=\"exponent\">" + exponents + "</select></label>\n" +
           slider("exposure", "Exposure", -5, 5, 0.25, 0, "0 stops", false) +
           "<button type=\"button\" name=\"front\">From the front</button>\n"
           "<p>Looks up <output data-of=\"maps\">environment.ktx2</output>.</p>\n"
           "<p>Drag to turn. Wheel or two fingers come nearer, once the picture has been touched; "
           "arrow keys, + and − do the same.</p>\n</fieldset></form>\n";
}

}  // namespace

void write_viewer_script(const BakeOptions& options, const std::filesystem::path& folder) {
    write_text(folder / kScript, contents(options.viewer_script));
}

void write_viewer(const Bake& bake, const std::filesystem::path& folder) {
    write_viewer_maps(bake, folder);
    write_still(bake, folder);
    if (!bake.options.shared_viewer) write_viewer_script(bake.options, folder);
}

std::string viewer_section(const Bake& bake) {
    if (bake.options.viewer_script.empty()) return "";
    const std::string script = (bake.options.shared_viewer ? "../" : "") + std::string(kScript);
    return std::string("<section>\n") + kStyle +
           "<h2>Turn it</h2>\n<p>An object in the environment, lit by the maps of this page and "
           "nothing else: what a renderer will make of them.</p>\n<div class=\"live\"><div "
           "class=\"stage\">" +
           fmt::format(
               "<img src=\"{}/{}\" alt=\"A mirror ball in the environment, seen from the "
               "front\"><button type=\"button\" hidden>Start</button></div>\n",
               kPictureFolder, kStill) +
           controls(bake) + "</div>\n" + fmt::format(fmt::runtime(kStart), script, kMaps) +
           "</section>\n";
}

}  // namespace mirrorball::cli
