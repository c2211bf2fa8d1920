#include "panel.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <mirrorball/builtin.h>
#include <mirrorball/bump.h>
#include <mirrorball/direct.h>
#include <mirrorball/material_presets.h>
#include <mirrorball/mesh.h>

#include "controls.h"

namespace mirrorball::window {
namespace {

namespace fs = std::filesystem;

std::string file_name(const std::string& name) {
    return fs::path(name).filename().string();
}

// Where `value` stands in a list made of things with a name; -1 if nowhere.
template <class List>
int index_of(const List& list, std::string_view value) {
    const auto found = std::find_if(list.begin(), list.end(),
                                    [&](const auto& entry) { return entry.name == value; });
    return found == list.end() ? -1 : static_cast<int>(found - list.begin());
}

template <class List>
std::vector<Choice> choices_of(const List& list) {
    std::vector<Choice> choices;
    for (const auto& entry : list)
        choices.push_back({std::string(entry.name), std::string(entry.description)});
    return choices;
}

// Scene
// ---------------------------------------------------------------------------------------------

void environment_group(Session& session) {
    if (!begin_group("Environment", true)) return;
    const std::vector<Builtin> list = builtins();
    SceneEnvironment environment = session.viewer.scene().environment;
    const std::string& source = environment.source;
    int index = source.starts_with("builtin:") ? index_of(list, source.substr(8)) : -1;
    bool changed = false;
    if (choose("Source", choices_of(list), index, file_name(source))) {
        environment.source = "builtin:" + list[static_cast<std::size_t>(index)].name;
        changed = true;
    }
    note(session.viewer.environment_notes().front());
    changed |= degrees("Yaw", environment.yaw, -180, 180);
    changed |= degrees("Pitch", environment.pitch, -90, 90);
    changed |= degrees("Roll", environment.roll, -180, 180);
    changed |= checkbox("Background", environment.background);
    if (!environment.background) changed |= color("Colour", environment.background_color);
    if (changed) session.edit([&](Scene& scene) { scene.environment = environment; });

    double stops = session.viewer.exposure_stops();
    if (slider("Exposure", stops, -8, 8, "%+.2f stops"))
        session.attempt([&] { session.viewer.set_exposure_stops(stops); });
    static constexpr ToneMap kToneMaps[] = {ToneMap::none, ToneMap::reinhard, ToneMap::aces,
                                            ToneMap::agx, ToneMap::film};
    std::vector<Choice> tone_maps;
    for (const ToneMap tone_map : kToneMaps) tone_maps.push_back({std::string(name(tone_map)), {}});
    int tone_map = static_cast<int>(session.viewer.scene().tone_map);
    if (choose("Tone map", tone_maps, tone_map))
        session.edit([&](Scene& scene) { scene.tone_map = kToneMaps[tone_map]; });
    end_group();
}

std::vector<Choice> method_choices() {
    std::vector<Choice> choices;
    for (const Method method : all_methods())
        choices.push_back({std::string(name(method)), std::string(describe(method))});
    return choices;
}

void method_group(Session& session) {
    if (!begin_group("Method", true)) return;
    const std::vector<Choice> methods = method_choices();
    int method = static_cast<int>(session.viewer.scene().method);
    if (choose("Method", methods, method))
        session.edit([&](Scene& scene) { scene.method = static_cast<Method>(method); });
    note(describe(session.viewer.scene().method));

    Comparison comparison = session.viewer.comparison();
    const Choice showings[] = {
        {"one method", {}}, {"two, with a wipe", {}}, {"their difference", {}}};
    int showing = static_cast<int>(comparison.showing);
    bool changed = choose("Show", showings, showing);
    comparison.showing = static_cast<Showing>(showing);
    if (comparison.showing != Showing::one) {
        int other = static_cast<int>(comparison.other);
        if (choose("Other", methods, other)) {
            comparison.other = static_cast<Method>(other);
            changed = true;
        }
        if (comparison.showing == Showing::difference)
            changed |= slider("White at", comparison.full_scale, 0.005, 1, "%.3f", true);
    }
    if (changed) session.viewer.set_comparison(comparison);

    static constexpr int kSizes[] = {0, 32, 64, 128, 256, 512, 1024};
    std::vector<Choice> sizes;
    int index = -1;
    const int size = session.viewer.scene().map_size;
    for (const int one : kSizes) {
        if (one == size) index = static_cast<int>(sizes.size());
        sizes.push_back({one == 0 ? "as the environment" : fmt::format("{}", one), {}});
    }
    if (choose("Map size", sizes, index, fmt::format("{}", size)))
        session.edit([&](Scene& scene) { scene.map_size = kSizes[index]; });
    end_group();
}

// Material
// ---------------------------------------------------------------------------------------------

// Of another kind, as wide as it was.
Lobe lobe_like(const Lobe& lobe, Lobe::Kind kind) {
    const double roughness = std::clamp(roughness_of(lobe), 0.02, 1.0);
    const double exponent = std::max(0.0, (2 / std::pow(roughness, 4) - 2) / 4);
    switch (kind) {
        case Lobe::Kind::phong:
            return {kind, std::clamp(exponent, 1.0, 1e5), nullptr};
        case Lobe::Kind::blinn_phong:
            return {kind, std::clamp(4 * exponent, 1.0, 1e5), nullptr};
        default:
            return {kind, roughness, nullptr};
    }
}

bool lobe_controls(Lobe& lobe) {
    static constexpr Lobe::Kind kKinds[] = {Lobe::Kind::ggx, Lobe::Kind::phong,
                                            Lobe::Kind::blinn_phong, Lobe::Kind::charlie};
    static const Choice choices[] = {{"GGX", "microfacets, by roughness"},
                                     {"Phong", "a cosine lobe about r, by exponent"},
                                     {"Blinn\u2013Phong", "about the half vector, by exponent"},
                                     {"Charlie", "sheen of cloth, by roughness"}};
    const auto* found = std::find(std::begin(kKinds), std::end(kKinds), lobe.kind);
    int index = found == std::end(kKinds) ? -1 : static_cast<int>(found - kKinds);
    bool changed = false;
    if (choose("Lobe", choices, index, to_string(lobe))) {
        lobe = lobe_like(lobe, kKinds[index]);
        changed = true;
    }
    if (lobe.kind == Lobe::Kind::phong || lobe.kind == Lobe::Kind::blinn_phong) {
        changed |= slider("Exponent", lobe.parameter, 1, 100000, "%.1f", true);
    } else if (lobe.kind == Lobe::Kind::ggx) {
        changed |= slider("Roughness", lobe.parameter, 0, 1, "%.3f");
    } else if (lobe.kind == Lobe::Kind::charlie) {
        changed |= slider("Roughness", lobe.parameter, kLeastCharlieRoughness, 1, "%.3f");
    }
    return changed;
}

bool fresnel_controls(Fresnel& fresnel) {
    std::vector<Choice> choices = {{"ideal", "reflects all light at every angle"},
                                   {"dielectric", "glass, plastic, water: by its index"},
                                   {"Schlick", "by its reflectance at normal incidence"}};
    const std::size_t first_metal = choices.size();
    int index = fresnel.kind() == Fresnel::Kind::dielectric ? 1
                : fresnel.kind() == Fresnel::Kind::schlick  ? 2
                : fresnel.kind() == Fresnel::Kind::ideal    ? 0
                                                            : -1;
    for (const Metal& metal : metals()) {
        if (fresnel.kind() == Fresnel::Kind::conductor && fresnel.index() == metal.index)
            index = static_cast<int>(choices.size());
        choices.push_back({std::string(metal.name), "a metal"});
    }
    bool changed = choose("Surface", choices, index, to_string(fresnel));
    if (changed) {
        const double coat = fresnel.coat();
        const bool takes_coat = index == 1 || index >= static_cast<int>(first_metal);
        fresnel = index == 0   ? Fresnel()
                  : index == 1 ? Fresnel::dielectric(1.5)
                  : index == 2 ? Fresnel::schlick(Vec3d(0.04))
                               : Fresnel::conductor(choices[static_cast<std::size_t>(index)].text);
        if (takes_coat && coat > 1) fresnel = fresnel.coated(coat);
    }
    const bool takes_coat =
        fresnel.kind() == Fresnel::Kind::dielectric || fresnel.kind() == Fresnel::Kind::conductor;
    double coat = fresnel.coat();
    if (fresnel.kind() == Fresnel::Kind::dielectric) {
        double n = fresnel.index().x;
        if (slider("Index", n, 1, 3)) {
            fresnel = Fresnel::dielectric(n);
            if (coat > 1) fresnel = fresnel.coated(coat);
            changed = true;
        }
    } else if (fresnel.kind() == Fresnel::Kind::schlick) {
        Vec3d f0 = fresnel.f0();
        if (color("F0", f0)) {
            fresnel = Fresnel::schlick(f0, fresnel.f90());
            changed = true;
        }
    }
    if (takes_coat && slider("Coat", coat, 1, 3, coat > 1 ? "index %.2f" : "none")) {
        fresnel = fresnel.coated(coat);
        changed = true;
    }
    return changed;
}

bool preset_controls(Material& material) {
    const std::vector<MaterialPreset>& presets = material_presets();
    int index = -1;
    for (std::size_t i = 0; i < presets.size(); ++i)
        if (presets[i].material == material) index = static_cast<int>(i);
    if (!choose("Preset", choices_of(presets), index, "of your own")) return false;
    material = presets[static_cast<std::size_t>(index)].material;
    return true;
}

void material_group(Session& session) {
    const Scene& shown = session.viewer.scene();
    if (session.viewer.selected() >= shown.objects.size()) return;
    if (!begin_group("Material", true)) return;
    Material material = shown.objects[session.viewer.selected()].material;
    bool changed = preset_controls(material);
    changed |= slider("Mirror", material.mirror, 0, 1);
    changed |= slider("Glossy", material.glossy, 0, 1);
    if (material.glossy > 0) changed |= lobe_controls(material.lobe);
    changed |= slider("Diffuse", material.diffuse, 0, 1);
    changed |= slider("Glass", material.transmission, 0, 1);
    if (material.transmission > 0)
        changed |= slider("Refraction", material.index, 1, 3, "index %.2f");
    if (material.diffuse > 0 || material.transmission > 0 || material.emission > 0)
        changed |= color("Colour", material.base_color);
    changed |= fresnel_controls(material.fresnel);
    static const Choice couplings[] = {{"added (Eq. 20)", "F L_layer + L_diffuse"},
                                       {"layered (Eq. 21)", "F L_layer + (1 \u2212 F) L_diffuse"},
                                       {"split sum", "as rough surfaces reflect"}};
    int coupling = static_cast<int>(material.coupling);
    changed |= choose("Coupling", couplings, coupling);
    material.coupling = static_cast<Coupling>(coupling);
    if (changed) {
        session.edit(
            [&](Scene& scene) { scene.objects[session.viewer.selected()].material = material; });
    }
    end_group();
}

// Bumps
// ---------------------------------------------------------------------------------------------

std::vector<Choice> bump_choices(const std::vector<BumpSource>& sources) {
    std::vector<Choice> choices = {{"smooth", "no bumps"}};
    for (const BumpSource& source : sources) choices.push_back({source.name, source.description});
    return choices;
}

void bump_group(Session& session) {
    const Scene& shown = session.viewer.scene();
    if (session.viewer.selected() >= shown.objects.size()) return;
    if (!begin_group("Bumps", false)) return;
    BumpMap bump = shown.objects[session.viewer.selected()].material.bump;
    const std::vector<BumpSource> sources = bump_sources();
    int index = bump.is_smooth() ? 0 : index_of(sources, bump.source) + 1;
    if (index == 0 && !bump.is_smooth()) index = -1;
    bool changed = false;
    if (choose("Source", bump_choices(sources), index, file_name(bump.source))) {
        bump.source = index == 0 ? "" : sources[static_cast<std::size_t>(index - 1)].name;
        changed = true;
    }
    if (!bump.is_smooth()) {
        changed |= slider("Strength", bump.strength, 0, 4);
        double repeat = bump.repeat.x;
        if (slider("Repeat", repeat, 0.25, 16, "%.2f", true)) {
            bump.repeat = Imath::V2d(repeat);
            changed = true;
        }
        static const Choice forms[] = {{"normals", "the normal turns: methods per pixel"},
                                       {"classic", "places on sphere maps move: sphere methods"}};
        int form = static_cast<int>(bump.form);
        changed |= choose("Form", forms, form);
        bump.form = static_cast<BumpForm>(form);
        static const Choice filters[] = {{"none", "one point; sparkles"},
                                         {"mean", "plain mip levels"},
                                         {"variance", "what is too fine makes it rougher"}};
        int filter = static_cast<int>(bump.filter);
        changed |= choose("Filter", filters, filter);
        bump.filter = static_cast<BumpFilter>(filter);
        if (bump.form == BumpForm::normals) {
            changed |= slider("Relief", bump.relief, 0, 0.2, "%.3f");
            changed |= checkbox("Horizon", bump.horizon);
        }
    }
    if (changed) {
        session.edit(
            [&](Scene& scene) { scene.objects[session.viewer.selected()].material.bump = bump; });
    }
    end_group();
}

// Objects, lights, camera, files
// ---------------------------------------------------------------------------------------------

void object_group(Session& session) {
    if (!begin_group("Object", true)) return;
    const Scene& shown = session.viewer.scene();
    if (shown.objects.size() > 1) {
        std::vector<Choice> choices;
        for (std::size_t i = 0; i < shown.objects.size(); ++i) {
            const SceneObject& object = shown.objects[i];
            choices.push_back(
                {fmt::format("{} {}", i + 1,
                             object.name.empty() ? file_name(object.mesh) : object.name),
                 {}});
        }
        int index = static_cast<int>(session.viewer.selected());
        if (choose("Chosen", choices, index))
            session.viewer.select(static_cast<std::size_t>(index));
    }
    if (session.viewer.selected() < shown.objects.size()) {
        const std::vector<BuiltinMesh> meshes = builtin_meshes();
        SceneObject object = shown.objects[session.viewer.selected()];
        int index = index_of(meshes, object.mesh);
        bool changed = false;
        if (choose("Shape", choices_of(meshes), index, file_name(object.mesh))) {
            object.mesh = meshes[static_cast<std::size_t>(index)].name;
            changed = true;
        }
        changed |= degrees("Turn", object.transform.yaw, -180, 180);
        if (changed) {
            session.edit([&](Scene& scene) { scene.objects[session.viewer.selected()] = object; });
        }
    }
    end_group();
}

// True if the light is to go.
bool light_controls(ScenePointLight& light, bool& changed) {
    note("a point of light");
    changed |= vector("Place", light.position, 0.02);
    changed |= vector("W/sr", light.intensity, 0.1);
    return ImGui::SmallButton("Remove");
}

bool light_controls(SceneDirectionalLight& light, bool& changed) {
    note("a sun");
    changed |= vector("Towards", light.direction, 0.01);
    changed |= vector("W/m\u00b2", light.normal_irradiance, 0.05);
    return ImGui::SmallButton("Remove");
}

void keep_valid(SceneLight& light) {
    const auto positive = [](Vec3d& v) {
        for (int i = 0; i < 3; ++i) v[i] = std::max(0.0, v[i]);
    };
    if (auto* point = std::get_if<ScenePointLight>(&light)) {
        positive(point->intensity);
    } else {
        auto& sun = std::get<SceneDirectionalLight>(light);
        positive(sun.normal_irradiance);
        if (sun.direction.length() < 1e-6) sun.direction = {0, 1, 0};
    }
}

void lights_group(Session& session) {
    if (!begin_group("Lights", false)) return;
    constexpr std::size_t kMost = 16;
    std::vector<SceneLight> lights = session.viewer.scene().lights;
    bool changed = false;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        const bool remove =
            std::visit([&](auto& light) { return light_controls(light, changed); }, lights[i]);
        ImGui::PopID();
        if (remove) {
            lights.erase(lights.begin() + static_cast<std::ptrdiff_t>(i));
            changed = true;
            break;
        }
        keep_valid(lights[i]);
    }
    if (lights.size() < kMost) {
        if (ImGui::Button("Add a point")) lights.push_back(ScenePointLight{}), changed = true;
        ImGui::SameLine();
        if (ImGui::Button("Add a sun"))
            lights.push_back(SceneDirectionalLight{{1, 1, 1}, Vec3d(1)}), changed = true;
    }
    if (changed) session.edit([&](Scene& scene) { scene.lights = lights; });
    end_group();
}

void camera_group(Session& session) {
    if (!begin_group("Camera and time", false)) return;
    double field_of_view = session.viewer.scene().camera.field_of_view;
    if (degrees("Field of view", field_of_view, 5, 120))
        session.edit([&](Scene& scene) { scene.camera.field_of_view = field_of_view; });
    if (ImGui::Button("Show all")) session.viewer.frame_all(session.aspect());
    checkbox("Time runs", session.time_runs);
    end_group();
}

void file_group(Session& session) {
    if (!begin_group("File", false)) return;
    note("Drop environments, meshes and scenes on the window.");
    ImGui::SetNextItemWidth(-1);
    ImGui::InputText("##path", &session.scene_path);
    if (ImGui::Button("Open")) session.drop(session.scene_path);
    ImGui::SameLine();
    if (ImGui::Button("Save scene")) {
        session.attempt([&] {
            session.viewer.save_scene(session.scene_path);
            session.tell(fmt::format("{} is written", session.scene_path));
        });
    }
    ImGui::SameLine();
    if (ImGui::Button("Picture")) session.screenshot_asked = true;
    end_group();
}

}  // namespace

void draw_panel(Session& session, const Area& area) {
    ImGui::SetNextWindowPos({static_cast<float>(area.left), static_cast<float>(area.top)});
    ImGui::SetNextWindowSize({static_cast<float>(area.width), static_cast<float>(area.height)});
    ImGui::Begin("##panel", nullptr,
                 (ImGuiWindowFlags_NoDecoration & ~ImGuiWindowFlags_NoScrollbar) |
                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoBringToFrontOnFocus);
    object_group(session);
    material_group(session);
    bump_group(session);
    environment_group(session);
    method_group(session);
    lights_group(session);
    camera_group(session);
    file_group(session);
    note(fmt::format("{:.1f} ms a frame   H: keys", session.frame_seconds * 1000));
    ImGui::End();
}

}  // namespace mirrorball::window
