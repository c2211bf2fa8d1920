// What keys do, in one table: for pressing and for reading.
#include <mirrorball/viewer.h>

#include <algorithm>
#include <array>
#include <functional>

#include <mirrorball/builtin.h>
#include <mirrorball/mesh.h>

namespace mirrorball {
namespace {

// What a press of an arrow is worth, in pixels of a picture of that height.
constexpr int kHeight = 720, kStep = 30;
constexpr double kStops = 1.0 / 3;

template <class T>
T neighbour(const std::vector<T>& values, const T& value, int step) {
    const auto found = std::find(values.begin(), values.end(), value);
    const int count = static_cast<int>(values.size());
    const int i =
        found == values.end() ? (step > 0 ? -1 : count) : static_cast<int>(found - values.begin());
    return values[static_cast<std::size_t>((i + step + count) % count)];
}

void edit(Viewer& viewer, const std::function<void(Scene&)>& change) {
    Scene scene = viewer.scene();
    change(scene);
    viewer.set_scene(scene);
}

void step_method(Viewer& viewer, int step) {
    edit(viewer,
         [&](Scene& scene) { scene.method = neighbour(all_methods(), scene.method, step); });
}

void step_other(Viewer& viewer, int step) {
    Comparison comparison = viewer.comparison();
    comparison.other = neighbour(all_methods(), comparison.other, step);
    if (comparison.showing == Showing::one) comparison.showing = Showing::wipe;
    viewer.set_comparison(comparison);
}

void toggle(Viewer& viewer, Showing showing) {
    Comparison comparison = viewer.comparison();
    comparison.showing = comparison.showing == showing ? Showing::one : showing;
    viewer.set_comparison(comparison);
}

void step_environment(Viewer& viewer, int step) {
    std::vector<std::string> sources;
    for (const Builtin& builtin : builtins()) sources.push_back("builtin:" + builtin.name);
    edit(viewer, [&](Scene& scene) {
        scene.environment.source = neighbour(sources, scene.environment.source, step);
    });
}

void step_mesh(Viewer& viewer, int step) {
    if (viewer.selected() >= viewer.scene().objects.size()) return;
    std::vector<std::string> meshes;
    for (const BuiltinMesh& mesh : builtin_meshes()) meshes.push_back(mesh.name);
    edit(viewer, [&](Scene& scene) {
        std::string& mesh = scene.objects[viewer.selected()].mesh;
        mesh = neighbour(meshes, mesh, step);
    });
}

struct Binding {
    std::vector<std::string_view> keys;
    std::string shown, what;
    std::function<void(Viewer&, std::size_t key, double aspect)>
        act;  ///< the key's place in `keys`
};

const std::vector<Binding>& bindings() {
    const auto signs = [](std::size_t key) { return key == 0 ? -1.0 : 1.0; };
    static const std::vector<Binding> table = {
        {{"ArrowLeft", "ArrowRight"},
         "\u2190 \u2192",
         "turn the view sideways",
         [=](Viewer& v, std::size_t k, double) { v.orbit(signs(k) * kStep, 0, kHeight); }},
        {{"ArrowUp", "ArrowDown"},
         "\u2191 \u2193",
         "turn the view up and down",
         [=](Viewer& v, std::size_t k, double) { v.orbit(0, signs(k) * kStep, kHeight); }},
        {{"-", "+", "="},
         "+ \u2212",
         "nearer, farther",
         [](Viewer& v, std::size_t k, double) { v.zoom(k == 0 ? -1 : 1); }},
        {{"a", "d"},
         "A D",
         "move the view sideways",
         [=](Viewer& v, std::size_t k, double) { v.pan(-signs(k) * kStep, 0, kHeight); }},
        {{"s", "w"},
         "W S",
         "move the view up and down",
         [=](Viewer& v, std::size_t k, double) { v.pan(0, signs(k) * kStep, kHeight); }},
        {{"f", "Home"},
         "F",
         "show all from the usual place",
         [](Viewer& v, std::size_t, double aspect) { v.frame_all(aspect); }},
        {{"[", "]"},
         "[ ]",
         "turn the environment",
         [=](Viewer& v, std::size_t k, double) { v.turn_environment(signs(k) * kStep, kHeight); }},
        {{",", "."},
         ", .",
         "darker, brighter by a third of a stop",
         [=](Viewer& v, std::size_t k, double) {
             v.set_exposure_stops(v.exposure_stops() + signs(k) * kStops);
         }},
        {{"0"},
         "0",
         "the environment's usual exposure",
         [](Viewer& v, std::size_t, double) { v.set_exposure_stops(0); }},
        {{"M", "m"},
         "M",
         "next method; with Shift the one before",
         [=](Viewer& v, std::size_t k, double) { step_method(v, static_cast<int>(signs(k))); }},
        {{"N", "n"},
         "N",
         "next method to compare with",
         [=](Viewer& v, std::size_t k, double) { step_other(v, static_cast<int>(signs(k))); }},
        {{"c"},
         "C",
         "compare two methods side by side",
         [](Viewer& v, std::size_t, double) { toggle(v, Showing::wipe); }},
        {{"x"},
         "X",
         "how two methods differ, in false colours",
         [](Viewer& v, std::size_t, double) { toggle(v, Showing::difference); }},
        {{"E", "e"},
         "E",
         "next built-in environment",
         [=](Viewer& v, std::size_t k, double) {
             step_environment(v, static_cast<int>(signs(k)));
         }},
        {{"O", "o"},
         "O",
         "next built-in object",
         [=](Viewer& v, std::size_t k, double) { step_mesh(v, static_cast<int>(signs(k))); }},
        {{"b"},
         "B",
         "environment or plain colour behind the objects",
         [](Viewer& v, std::size_t, double) {
             edit(v, [](Scene& scene) {
                 scene.environment.background = !scene.environment.background;
             });
         }},
    };
    return table;
}

}  // namespace

bool Viewer::press(std::string_view key, double aspect) {
    for (const Binding& binding : bindings()) {
        const auto found = std::find(binding.keys.begin(), binding.keys.end(), key);
        if (found == binding.keys.end()) continue;
        binding.act(*this, static_cast<std::size_t>(found - binding.keys.begin()), aspect);
        return true;
    }
    return false;
}

std::span<const KeyHelp> Viewer::keys() {
    static const std::vector<KeyHelp> help = [] {
        std::vector<KeyHelp> list;
        for (const Binding& binding : bindings()) list.push_back({binding.shown, binding.what});
        return list;
    }();
    return help;
}

}  // namespace mirrorball
