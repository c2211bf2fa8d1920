// What the page's script calls. Everything that has a structure goes to and fro as JSON, and what
// fails says why: {"error": "..."}, in the library's words.
#include <functional>
#include <optional>
#include <string>

#include <emscripten/bind.h>
#include <emscripten/val.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <mirrorball/builtin.h>
#include <mirrorball/bump.h>
#include <mirrorball/error.h>
#include <mirrorball/fresnel.h>
#include <mirrorball/gl/context.h>
#include <mirrorball/material_presets.h>
#include <mirrorball/mesh.h>
#include <mirrorball/scene_file.h>
#include <mirrorball/viewer.h>

#include "viewer/viewer_state.h"

namespace mirrorball {
namespace {

using nlohmann::json;

// Of a browser's 2 GiB, so that what is made of a map has room, too.
constexpr std::uint64_t kMemoryLimit = std::uint64_t{512} << 20;

constexpr std::string_view kBuiltin = "builtin:";
// Of built-in environments until they are drawn elsewhere, which takes seconds.
constexpr int kCoarseWidth = 128;

constexpr Projection kShownProjections[] = {Projection::equirect, Projection::cube,
                                            Projection::sphere, Projection::dual_paraboloid,
                                            Projection::octahedral};

// A reply, or why there is none.
std::string reply(const std::function<json()>& make) {
    try {
        return make().dump();
    } catch (const std::bad_alloc&) {
        return json{{"error", "there is not enough memory for that"}}.dump();
    } catch (const std::exception& error) {
        return json{{"error", error.what()}}.dump();
    }
}

template <class Entries>
json named(const Entries& entries) {
    json list = json::array();
    for (const auto& entry : entries)
        list.push_back({{"name", entry.name}, {"description", entry.description}});
    return list;
}

json vector(const Vec3d& v) {
    return {v.x, v.y, v.z};
}

MapContent content_of(const std::string& text) {
    for (const MapContent content :
         {MapContent::environment, MapContent::glossy, MapContent::diffuse})
        if (name(content) == text) return content;
    throw Error(Errc::usage, fmt::format("\"{}\" is nothing that a map holds", text));
}

class Page {
  public:
    /// What there is to choose from. \pre the context is current
    static std::string facts() {
        return reply([] {
            json facts{
                {"version", MIRRORBALL_VERSION},     {"renderer", gl::driver().renderer},
                {"environments", named(builtins())}, {"meshes", named(builtin_meshes())},
                {"bumps", named(bump_sources())},    {"materials", named(material_presets())}};
            for (const Method method : all_methods())
                facts["methods"].push_back(
                    {{"name", name(method)}, {"description", describe(method)}});
            for (const Metal& metal : metals()) facts["metals"].push_back(metal.name);
            for (const ToneMap tone_map :
                 {ToneMap::film, ToneMap::agx, ToneMap::aces, ToneMap::reinhard, ToneMap::none})
                facts["tone_maps"].push_back(name(tone_map));
            for (const Projection projection : kShownProjections)
                facts["projections"].push_back(
                    {{"name", name(projection)}, {"aspect", map_picture_aspect(projection)}});
            for (const KeyHelp& key : Viewer::keys())
                facts["keys"].push_back({{"keys", key.keys}, {"what", key.what}});
            return facts;
        });
    }

    /// `tell` is called while something takes its time: with a word for it and the share that is
    /// done.
    explicit Page(emscripten::val tell) : tell_(std::move(tell)) {}

    /// Opens the viewer: in the state that a link has, or the usual one. Built-in environments are
    /// coarse ones, here and in all else, until take_builtin() brings the whole.
    std::string open(const std::string& text, double aspect) {
        return reply([&] {
            ViewerState state;
            if (text.empty()) {
                state.scene.objects.emplace_back().mesh = "teapot";
                state.scene.objects.back().material = preset_material("chrome");
            } else {
                state = parse_viewer_state(text);
            }
            viewer_.emplace(state.scene, std::filesystem::path(),
                            Viewer::Options{.memory_limit = kMemoryLimit,
                                            .builtin_width = kCoarseWidth,
                                            .reading = telling("reading"),
                                            .prefiltering = telling("prefiltering")});
            viewer_->set_comparison(state.comparison);
            viewer_->select(state.selected);
            if (text.empty()) viewer_->frame_all(aspect);
            return json::object();
        });
    }

    /// A built-in environment as read_map() has it, for another thread's viewer: its texels, in
    /// this module's memory, from the top.
    emscripten::val builtin(const std::string& source) {
        auto result = emscripten::val::object();
        const std::string answer = reply([&] {
            MapReadOptions options;
            options.progress = telling("drawing");
            made_ = read_map(source, options).map.levels[0].faces[0];
            result.set("width", made_.width());
            result.set("height", made_.height());
            result.set("values", emscripten::val(emscripten::typed_memory_view(
                                     made_.values().size(), made_.values().data())));
            return json::object();
        });
        if (answer != "{}") result.set("error", json::parse(answer)["error"].get<std::string>());
        return result;
    }
    /// The same, from a file in this module's file system.
    std::string take_builtin(const std::string& source, const std::string& path) {
        return reply([&] {
            LoadedMap map = read_map(path);
            map.format = "built-in";
            map.notes.clear();
            const double exposure = viewer_->scene().exposure;
            const Dropped dropped = viewer_->drop_environment(source, std::move(map));
            if (!dropped.taken) throw Error(Errc::cannot_read, dropped.message);
            Scene scene = viewer_->scene();
            scene.exposure = exposure;
            viewer_->set_scene(scene);
            return json::object();
        });
    }

    [[nodiscard]] std::string status() {
        return reply([&] {
            const Comparison& comparison = viewer_->comparison();
            const bool is_coarse = viewer_->scene().environment.source.starts_with(kBuiltin) &&
                                   viewer_->assets().environment.width() == kCoarseWidth;
            return json{{"scene", json::parse(to_json(viewer_->scene()))},
                        {"showing", name(comparison.showing)},
                        {"other", name(comparison.other)},
                        {"wipe", comparison.wipe},
                        {"full_scale", comparison.full_scale},
                        {"selected", viewer_->selected()},
                        {"stops", viewer_->exposure_stops()},
                        {"notes", viewer_->environment_notes()},
                        {"coarse", is_coarse},
                        {"state", viewer_->state()}};
        });
    }

    std::string set_scene(const std::string& text) {
        return reply([&] {
            viewer_->set_scene(parse_scene(text, "scene"));
            return json::object();
        });
    }
    /// With the environment and the camera that there are: they may be others by now than when the
    /// script saw the scene.
    std::string edit_scene(const std::string& text) {
        return reply([&] {
            Scene scene = parse_scene(text, "scene");
            scene.environment.source = viewer_->scene().environment.source;
            scene.camera = viewer_->scene().camera;
            viewer_->set_scene(scene);
            return json::object();
        });
    }
    std::string set_state(const std::string& text) {
        return reply([&] {
            viewer_->set_state(text);
            return json::object();
        });
    }
    std::string set_comparison(const std::string& showing, const std::string& other, double wipe,
                               double full_scale) {
        return reply([&] {
            viewer_->set_comparison(
                {parse_showing(showing), parse_method(other), wipe, full_scale});
            return json::object();
        });
    }
    std::string set_stops(double stops) {
        return reply([&] {
            viewer_->set_exposure_stops(stops);
            return json::object();
        });
    }
    /// A file that the script has put into the file system of this module.
    std::string drop(const std::string& path) {
        return reply([&] {
            const Dropped dropped = viewer_->drop(path);
            if (!dropped.taken) return json{{"error", dropped.message}};
            return json{{"message", dropped.message}};
        });
    }

    void orbit(double dx, double dy, int height) { viewer_->orbit(dx, dy, height); }
    void pan(double dx, double dy, int height) { viewer_->pan(dx, dy, height); }
    void zoom(double steps) { viewer_->zoom(steps); }
    void hold(bool held) { viewer_->hold(held); }
    std::string turn(double dx, int height) {
        return reply([&] {
            viewer_->turn_environment(dx, height);
            return json::object();
        });
    }
    void frame_all(double aspect) { viewer_->frame_all(aspect); }
    std::string press(const std::string& key, double aspect) {
        return reply([&] { return json{{"done", viewer_->press(key, aspect)}}; });
    }

    std::string draw(int width, int height) {
        return reply([&] {
            viewer_->draw(width, height);
            return json{{"smooth", viewer_->is_smooth()}};
        });
    }

    /// What a pixel sees, and where on the pictures of all maps that is.
    std::string hover(double x, double y, int width, int height) {
        return reply([&] {
            const Hover hover = viewer_->hover(x, y, width, height);
            json result{{"reflected", vector(hover.reflected)}, {"places", json::object()}};
            if (hover.object) {
                result["object"] = *hover.object;
                result["normal"] = vector(hover.normal);
            }
            for (const Projection projection : kShownProjections) {
                const MapPlace place = viewer_->place_on_map(projection, hover.reflected);
                result["places"][std::string(name(projection))] = {{"x", place.x},
                                                                   {"y", place.y},
                                                                   {"face", place.face},
                                                                   {"s", place.s},
                                                                   {"t", place.t}};
            }
            return result;
        });
    }

    /// Bytes of this module's memory, to be copied before anything else is called; or a message.
    emscripten::val map_picture(const std::string& content, const std::string& projection,
                                int height) {
        auto result = emscripten::val::object();
        const std::string answer = reply([&] {
            const ScreenPicture& picture =
                viewer_->map_picture(content_of(content), parse_projection(projection), height);
            result.set("width", picture.width);
            result.set("height", picture.height);
            result.set("version", static_cast<double>(picture.version));
            result.set("rgba", emscripten::val(emscripten::typed_memory_view(picture.rgba.size(),
                                                                             picture.rgba.data())));
            return json::object();
        });
        if (answer != "{}") result.set("error", json::parse(answer)["error"].get<std::string>());
        return result;
    }

  private:
    [[nodiscard]] Progress telling(const char* what) const {
        return [what, tell = tell_](double share) {
            tell(std::string(what), share);
            return true;
        };
    }

    emscripten::val tell_;
    std::optional<Viewer> viewer_;
    Image made_;
};

}  // namespace
}  // namespace mirrorball

EMSCRIPTEN_BINDINGS(mirrorball) {
    using mirrorball::Page;
    emscripten::class_<Page>("Page")
        .constructor<emscripten::val>()
        .class_function("facts", &Page::facts)
        .function("open", &Page::open)
        .function("builtin", &Page::builtin)
        .function("take_builtin", &Page::take_builtin)
        .function("status", &Page::status)
        .function("set_scene", &Page::set_scene)
        .function("edit_scene", &Page::edit_scene)
        .function("set_state", &Page::set_state)
        .function("set_comparison", &Page::set_comparison)
        .function("set_stops", &Page::set_stops)
        .function("drop", &Page::drop)
        .function("orbit", &Page::orbit)
        .function("pan", &Page::pan)
        .function("zoom", &Page::zoom)
        .function("hold", &Page::hold)
        .function("turn", &Page::turn)
        .function("frame_all", &Page::frame_all)
        .function("press", &Page::press)
        .function("draw", &Page::draw)
        .function("hover", &Page::hover)
        .function("map_picture", &Page::map_picture);
}
