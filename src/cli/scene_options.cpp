#include "scene_options.h"

#include <filesystem>

#include <fmt/format.h>

#include <mirrorball/bump.h>
#include <mirrorball/error.h>
#include <mirrorball/material_presets.h>
#include <mirrorball/mesh.h>
#include <mirrorball/scene_file.h>

#include "scene/scene_bounds.h"

namespace mirrorball::cli {
namespace {

constexpr double kDegree = kPi / 180;

/// An edit of the scene by a value that is parsed at once, so that a bad one is told as the
/// option's.
template <class Parse, class Apply>
SetValue edit(SceneInput& input, Parse parse, Apply apply) {
    return [&input, parse, apply](const std::string& text) {
        input.edits.push_back([value = parse(text), apply](Scene& scene) { apply(scene, value); });
    };
}

template <class Parse, class Apply>
SetValue edit_material(SceneInput& input, Parse parse, Apply apply) {
    return [&input, parse, apply](const std::string& text) {
        input.material_edits.push_back(
            [value = parse(text), apply](Material& material) { apply(material, value); });
    };
}

std::string same_text(const std::string& text) {
    return text;
}

auto number(double least, double most) {
    return [least, most](const std::string& text) { return parse_real_number(text, least, most); };
}

// "0.8" or "0.8/0.2/0.1", as in the spelling of BRDFs.
Vec3d parse_color(const std::string& text) {
    const std::vector<std::string> parts = split(text, '/');
    if (parts.size() != 1 && parts.size() != 3)
        throw Error(Errc::usage, fmt::format("\"{}\" is not a colour as 0.5 or 0.8/0.2/0.1", text));
    const auto channel = [](const std::string& part) { return parse_real_number(part, 0, 1); };
    if (parts.size() == 1) return Vec3d(channel(text));
    return {channel(parts[0]), channel(parts[1]), channel(parts[2])};
}

// So many numbers, as in "0.5,0,0,0.5".
std::vector<double> parse_numbers(const std::string& text, std::size_t count, double least,
                                  double most) {
    const std::vector<std::string> parts = split(text, ',');
    if (parts.size() != count)
        throw Error(Errc::usage,
                    fmt::format("\"{}\" is not {} numbers with commas between them", text, count));
    std::vector<double> numbers;
    for (const std::string& part : parts) numbers.push_back(parse_real_number(part, least, most));
    return numbers;
}

auto numbers(std::size_t count, double least, double most) {
    return [=](const std::string& text) { return parse_numbers(text, count, least, most); };
}

// "4", or "4,2" where it differs along s and t.
Imath::V2d parse_repeat(const std::string& text) {
    constexpr double kMost = 1e4;
    if (text.find(',') == std::string::npos)
        return Imath::V2d(parse_real_number(text, -kMost, kMost));
    const std::vector<double> both = parse_numbers(text, 2, -kMost, kMost);
    return {both[0], both[1]};
}

Choices bump_choices() {
    Choices choices = file_choices();
    for (const BumpSource& source : bump_sources()) choices.values.push_back(source.name);
    return choices;
}

Choices names_of(const std::vector<Method>& methods) {
    Choices choices{.values = {}, .closed = true};
    for (const Method method : methods) choices.values.emplace_back(name(method));
    return choices;
}

Choices mesh_choices() {
    Choices choices = file_choices();
    for (const BuiltinMesh& mesh : builtin_meshes()) choices.values.push_back(mesh.name);
    return choices;
}

Choices material_choices() {
    Choices choices{.values = {}, .closed = true};
    for (const MaterialPreset& preset : material_presets()) choices.values.push_back(preset.name);
    return choices;
}

// A lobe of the one object: it is what the object shows then, and not a mirror.
void set_lobe(Material& material, const Lobe& lobe) {
    if (lobe.kind == Lobe::Kind::mirror) {
        material.mirror = 1, material.glossy = 0;
        return;
    }
    material.lobe = lobe;
    material.mirror = 0, material.glossy = 1;
}

struct Orbit {
    double yaw, pitch;
    double nearer;  // 1: the object fills the picture
};

Orbit parse_orbit(const std::string& text) {
    const std::vector<std::string> parts = split(text, ',');
    if (parts.size() != 2 && parts.size() != 3) {
        throw Error(Errc::usage, fmt::format("\"{}\" is not yaw, pitch and, if you like, distance "
                                             "as 30,15 or 30,15,1.5",
                                             text));
    }
    return {parse_real_number(parts[0], -360, 360) * kDegree,
            parse_real_number(parts[1], -90, 90) * kDegree,
            parts.size() == 3 ? parse_real_number(parts[2], 1e-3, 1e6) : 1};
}

void place_camera(Scene& scene, const SceneAssets& assets, const SceneInput& input) {
    const Orbit orbit = parse_orbit(input.camera.empty() ? "25,14" : input.camera);
    const double aspect = static_cast<double>(input.width) / input.height;
    const double field_of_view = scene.camera.field_of_view;
    scene.camera =
        framing(detail::bounds_of(scene, assets), aspect, orbit.yaw, orbit.pitch, field_of_view);
    scene.camera.eye =
        scene.camera.target + (scene.camera.eye - scene.camera.target) * orbit.nearer;
}

SceneObject only_object(const SceneInput& input) {
    SceneObject object;
    object.mesh = input.mesh.empty() ? "teapot" : input.mesh;
    object.material = preset_material(input.material.empty() ? "mirror" : input.material);
    for (const auto& edit : input.material_edits) edit(object.material);
    return object;
}

// A map as fine as a cube of `size`, its floats, the driver's copy and one on the way there, and
// the same for the background.
void check_map_memory(int size, const Shared& shared) {
    constexpr std::uint64_t kBytesPerTexel = 80;
    const auto edge = static_cast<std::uint64_t>(size);
    check_memory(kBytesPerTexel * 6 * edge * edge, fmt::format("a map of size {}", size), shared);
}

// What a scene file names is beside it; what the command line names is here.
std::string from_here(const std::string& source) {
    if (source.starts_with("builtin:")) return source;
    std::string result;
    for (const std::string& file : split(source, ',')) {
        result += result.empty() ? "" : ",";
        result += std::filesystem::absolute(file).string();
    }
    return result;
}

}  // namespace

void add_scene_argument(Command& command, SceneInput& input) {
    command.arguments.push_back({"SCENE", "a scene file (docs/scene.md); or options say it all",
                                 text(input.file), file_choices(), false});
}

void add_scene_options(Command& command, SceneInput& input) {
    const std::vector<Option> options = {
        {"--env", "IN", "the environment: a map's file, or builtin:NAME [builtin:sunset]",
         text(input.environment), input_choices()},
        {"--turn-env", "YAW,PITCH,ROLL", "degrees; positive yaw turns what is ahead to the left",
         edit(input, parse_rotation,
              [](Scene& scene, const Rotation& r) {
                  scene.environment.yaw = r.yaw;
                  scene.environment.pitch = r.pitch;
                  scene.environment.roll = r.roll;
              })},
        {"--method", "METHOD", "how reflections are looked up [cube]",
         edit(input, parse_method, [](Scene& scene, Method m) { scene.method = m; }),
         names_of(all_methods())},
        {"--map-size", "N", "edge of a cube's face; other maps are as fine [as the environment]",
         edit(
             input, [](const std::string& text) { return parse_whole_number(text, 1, 16384); },
             [](Scene& scene, int size) { scene.map_size = size; })},
        {"--mesh", "MESH", "the object: a built-in mesh, or an .obj, .gltf or .glb file [teapot]",
         text(input.mesh), mesh_choices()},
        {"--material", "NAME", "of the object; the options below change it [mirror]",
         text(input.material), material_choices()},
        {"--lobe", "LOBE", "what it blurs its reflections by, as phong:100 or ggx:0.4",
         edit_material(input, parse_lobe, set_lobe), lobe_choices()},
        {"--fresnel", "SURFACE", "index=N, metal=NAME, n=N,k=K or f0=F; under ,coat=N",
         edit_material(input, parse_fresnel,
                       [](Material& m, const Fresnel& fresnel) { m.fresnel = fresnel; }),
         surface_choices()},
        {"--coupling",
         "HOW",
         "added (Eq. 20), layered (Eq. 21) or split-sum [layered]",
         edit_material(input, parse_coupling,
                       [](Material& m, Coupling coupling) { m.coupling = coupling; }),
         {.values = {"added", "layered", "split-sum"}, .closed = true}},
        {"--base-color", "COLOR", "of diffuse and transmitted light, as 0.8 or 0.8/0.2/0.1",
         edit_material(input, parse_color,
                       [](Material& m, const Vec3d& color) { m.base_color = color; })},
        {"--mirror", "W", "weight of the mirror term, 0 to 1",
         edit_material(input, number(0, 1), [](Material& m, double w) { m.mirror = w; })},
        {"--glossy", "W", "weight of the glossy term",
         edit_material(input, number(0, 1), [](Material& m, double w) { m.glossy = w; })},
        {"--diffuse", "W", "weight of the diffuse term",
         edit_material(input, number(0, 1), [](Material& m, double w) { m.diffuse = w; })},
        {"--transmission", "W", "weight of the light that is refracted",
         edit_material(input, number(0, 1), [](Material& m, double w) { m.transmission = w; })},
        {"--index", "N", "of refraction, of what is transmitted",
         edit_material(input, number(0.01, 100), [](Material& m, double n) { m.index = n; })},
        {"--bump", "BUMP", "relief: a picture, or a source as mirrorball bump --list names them",
         edit_material(input, same_text,
                       [](Material& m, const std::string& source) { m.bump.source = source; }),
         bump_choices()},
        {"--bump-kind",
         "KIND",
         "of a picture: height, normal or dudv [height if it is grey, else normal]",
         edit_material(input, parse_bump_kind,
                       [](Material& m, BumpKind kind) { m.bump.kind = kind; }),
         {.values = {"height", "normal", "dudv"}, .closed = true}},
        {"--bump-green",
         "WAY",
         "of a picture of normals: up (OpenGL) or down (Direct3D) [up]",
         edit_material(input, parse_green, [](Material& m, Green green) { m.bump.green = green; }),
         {.values = {"up", "down"}, .closed = true}},
        {"--bump-height", "METRES", "what a value of 1 in a picture of heights stands for [1]",
         edit_material(input, number(-1e6, 1e6),
                       [](Material& m, double height) { m.bump.height_scale = height; })},
        {"--bump-width", "METRES", "that the picture covers [1; sources: their own]",
         edit_material(input, number(1e-6, 1e6),
                       [](Material& m, double width) { m.bump.width = width; })},
        {"--bump-repeat", "N[,M]", "tiles along s and t [1]",
         edit_material(input, parse_repeat,
                       [](Material& m, const Imath::V2d& repeat) { m.bump.repeat = repeat; })},
        {"--bump-strength", "K", "multiplies its slopes [1]",
         edit_material(input, number(-100, 100),
                       [](Material& m, double strength) { m.bump.strength = strength; })},
        {"--bump-form",
         "FORM",
         "normals, or classic: places on sphere maps move [normals]",
         edit_material(input, parse_bump_form,
                       [](Material& m, BumpForm form) { m.bump.form = form; }),
         {.values = {"normals", "classic"}, .closed = true}},
        {"--bump-filter",
         "FILTER",
         "of what is too fine for a pixel: none, mean or variance [variance]",
         edit_material(input, parse_bump_filter,
                       [](Material& m, BumpFilter filter) { m.bump.filter = filter; }),
         {.values = {"none", "mean", "variance"}, .closed = true}},
        {"--bump-relief", "DEPTH", "that the eye looks into, in tiles, 0 to 1 [0]",
         edit_material(input, number(0, 1),
                       [](Material& m, double depth) { m.bump.relief = depth; })},
        {"--bump-matrix", "A,B,C,D", "of the classic form, by rows [-0.5,0,0,-0.5]",
         edit_material(input, numbers(4, -100, 100),
                       [](Material& m, const std::vector<double>& n) {
                           m.bump.matrix = {n[0], n[1], n[2], n[3]};
                       })},
        {"--bump-luminance", "SCALE,OFFSET", "of the classic form, by the height [0,1]",
         edit_material(input, numbers(2, -100, 100),
                       [](Material& m, const std::vector<double>& n) {
                           m.bump.luminance_scale = n[0], m.bump.luminance_offset = n[1];
                       })},
        {"--time", "SECONDS", "of what moves: bumps and lights [0]",
         edit(input, number(-1e6, 1e6), [](Scene& scene, double time) { scene.time = time; })},
        {"--camera", "YAW,PITCH[,D]",
         "degrees around the objects, and how many times as far as just fits [25,14,1]",
         text(input.camera)},
        {"--field-of-view", "DEGREES", "vertical [34.4]",
         edit(
             input, number(0.1, 179),
             [](Scene& scene, double degrees) { scene.camera.field_of_view = degrees * kDegree; })},
        {"--exposure", "E", "what radiance is multiplied by to be shown [by the environment]",
         edit(input, number(1e-12, 1e12), [](Scene& scene, double e) { scene.exposure = e; })},
        {"--tone-map", "CURVE", "from light to what a screen shows [film]",
         edit(input, parse_tone_map, [](Scene& scene, ToneMap t) { scene.tone_map = t; }),
         tone_map_choices()},
        {"--plain-background", "COLOR", "behind the object, not the environment",
         edit(input, parse_color, [](Scene& scene, const Vec3d& color) {
             scene.environment.background = false;
             scene.environment.background_color = color;
         })}};
    command.options.insert(command.options.end(), options.begin(), options.end());
}

void add_picture_size_options(Command& command, SceneInput& input) {
    command.options.push_back(
        {"--width", "N", "of the picture in pixels [1280]", whole_number(input.width, 1, 65536)});
    command.options.push_back({"--height", "N", "[720]", whole_number(input.height, 1, 65536)});
}

std::filesystem::path folder_of(const SceneInput& input) {
    return std::filesystem::path(input.file).parent_path();
}

Scene scene_of(const SceneInput& input) {
    const bool has_file = !input.file.empty();
    if (has_file &&
        (!input.mesh.empty() || !input.material.empty() || !input.material_edits.empty())) {
        throw Error(Errc::usage,
                    fmt::format("--mesh, --material and what changes a material say what the only "
                                "object is; {} has objects of its own",
                                input.file));
    }
    Scene scene = has_file ? read_scene(input.file) : Scene{};
    if (!has_file) scene.objects.push_back(only_object(input));
    if (!input.environment.empty())
        scene.environment.source = has_file ? from_here(input.environment) : input.environment;
    for (const auto& edit : input.edits) edit(scene);
    return scene;
}

void place_camera_as_asked(Scene& scene, const SceneAssets& assets, const SceneInput& input) {
    const bool is_asked = input.file.empty() || !input.camera.empty();
    if (is_asked && !scene.objects.empty()) place_camera(scene, assets, input);
}

LoadedScene load_scene(const SceneInput& input, const Shared& shared) {
    LoadedScene loaded{scene_of(input), nullptr};
    check_map_memory(loaded.scene.map_size, shared);
    AssetOptions options;
    options.memory_limit = shared.memory_limit;
    loaded.assets =
        std::make_shared<const SceneAssets>(load_assets(loaded.scene, folder_of(input), options));
    place_camera_as_asked(loaded.scene, *loaded.assets, input);
    return loaded;
}

bool holds_radiance(const std::string& target) {
    return target.ends_with(".exr") || target.ends_with(".hdr") || target.ends_with(".pfm");
}

}  // namespace mirrorball::cli
