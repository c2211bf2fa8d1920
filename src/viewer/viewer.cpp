// The viewer: a scene with what is loaded for it, drawn when something has changed.
#include <mirrorball/viewer.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <mirrorball/error.h>
#include <mirrorball/gl/renderer.h>
#include <mirrorball/material_presets.h>
#include <mirrorball/mesh.h>
#include <mirrorball/orbit.h>
#include <mirrorball/scene_file.h>
#include <mirrorball/tone_map.h>

#include "core/name_table.h"
#include "gl/check.h"
#include "gl/framebuffer_guard.h"
#include "hover.h"
#include "io/file.h"
#include "scene/scene_bounds.h"
#include "shown_maps.h"
#include "smooth_picture.h"
#include "viewer_state.h"

namespace mirrorball {
namespace {

namespace fs = std::filesystem;

// Where the program looks from unless it is said, as `mirrorball render` does.
constexpr double kUsualYaw = 25 * kPi / 180, kUsualPitch = 14 * kPi / 180;
// One step of a wheel.
constexpr double kZoomStep = 1.12;
constexpr double kMostStops = 20;

constexpr detail::NameTable<Showing, 3> kShowings{"a way to show methods",
                                                  {"one", "wipe", "difference"}};
constexpr detail::NameTable<MapContent, 3> kContents{"what a map holds",
                                                     {"environment", "glossy", "diffuse"}};

Scene usual_scene() {
    Scene scene;
    SceneObject object;
    object.mesh = "teapot";
    object.material = preset_material("chrome");
    scene.objects.push_back(object);
    return scene;
}

std::string lower_case_ending(const fs::path& path) {
    std::string ending = path.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return ending;
}

enum class FileKind { environment, mesh, scene };

FileKind kind_of(const fs::path& path) {
    const std::string ending = lower_case_ending(path);
    if (ending == ".obj" || ending == ".gltf" || ending == ".glb") return FileKind::mesh;
    if (ending == ".json") return FileKind::scene;
    return FileKind::environment;
}

std::string size_text(const EnvironmentMap& map) {
    const int faces = face_count(map.projection);
    return faces > 1 ? fmt::format("{} x {} x {}", faces, map.width(), map.height())
                     : fmt::format("{} x {}", map.width(), map.height());
}

Axes axes_of_lookup(Projection projection, const Camera& camera) {
    return projection == Projection::sphere ? axes(camera) : default_axes(projection);
}

// In the framebuffer that is bound.
bool is_depth_tested() {
    GLint framebuffer = 0, type = GL_NONE;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer);
    glGetFramebufferAttachmentParameteriv(GL_DRAW_FRAMEBUFFER,
                                          framebuffer == 0 ? GL_DEPTH : GL_DEPTH_ATTACHMENT,
                                          GL_FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE, &type);
    gl::check("asking for a depth buffer");
    return type != GL_NONE;
}

}  // namespace

std::string_view name(Showing showing) {
    return kShowings.name(showing);
}

Showing parse_showing(std::string_view name) {
    return kShowings.parse(name);
}

std::string_view name(MapContent content) {
    return kContents.name(content);
}

class Viewer::Impl {
  public:
    Impl(const Scene& scene, const fs::path& folder, const Options& options) : options_(options) {
        open(scene, folder);
    }

    // The scene and all that is made of its names. Nothing is changed until all of it is there.
    /// The mesh of the name `anew` is read again, if it was before.
    void set(const Scene& scene, const std::string& anew = {});
    void open(const Scene& scene, const fs::path& folder);
    void show_environment(Scene scene, LoadedMap map);
    void draw(int width, int height, int left, int bottom);

    [[nodiscard]] double usual_exposure() const { return usual_exposure_; }
    [[nodiscard]] double aspect() const {
        return height_ > 0 ? static_cast<double>(width_) / height_ : 16.0 / 9;
    }

    Scene scene_;
    Comparison comparison_;
    std::size_t selected_ = 0;
    fs::path folder_;
    std::shared_ptr<const SceneAssets> assets_;
    std::vector<std::string> notes_;
    Options options_;
    ShownMaps shown_maps_;
    bool smooth_ = false;
    bool held_ = false;

  private:
    // What one side of the comparison is drawn with.
    struct Side {
        std::optional<gl::Renderer> renderer;
        std::optional<SmoothPicture> picture;
    };
    // All that a picture depends on but the wipe.
    struct Drawn {
        Scene scene;
        Method other;
        std::shared_ptr<const SceneAssets> assets;
    };

    [[nodiscard]] AssetOptions asset_options() const {
        return {.memory_limit = options_.memory_limit,
                .builtin_width = options_.builtin_width,
                .reading = options_.reading};
    }
    void adopt(const Scene& scene, std::shared_ptr<const SceneAssets> assets);
    void take_environment(const LoadedMap& loaded);
    [[nodiscard]] bool has_changed() const;
    [[nodiscard]] SmoothPicture::Aim aim() const { return {options_.sample_count, held_}; }
    [[nodiscard]] bool shows_two() const { return comparison_.showing != Showing::one; }
    void draw_sides(bool again, int left, int bottom);
    [[nodiscard]] bool can_show_first() const;
    void show_first(int left, int bottom);
    void add_sample(Side& side, Method method);
    void show(int left, int bottom);

    double usual_exposure_ = 1;
    Side sides_[2];
    gl::ProgramCache programs_;
    gl::VertexArray nothing_;
    std::optional<Drawn> drawn_;
    int width_ = 0, height_ = 0;
};

void Viewer::Impl::take_environment(const LoadedMap& loaded) {
    notes_ = loaded.notes;
    notes_.insert(notes_.begin(), fmt::format("{}, {} {}", loaded.format,
                                              name(loaded.map.projection), size_text(loaded.map)));
    usual_exposure_ = mirrorball::usual_exposure(loaded.map);
    shown_maps_.set_environment(loaded.map);
}

void Viewer::Impl::adopt(const Scene& scene, std::shared_ptr<const SceneAssets> assets) {
    scene_ = scene;
    if (assets != assets_) {
        assets_ = std::move(assets);
        for (Side& side : sides_)
            if (side.renderer) side.renderer->set_assets(assets_);
    }
    selected_ = std::min(selected_, scene_.objects.empty() ? 0 : scene_.objects.size() - 1);
}

void Viewer::Impl::set(const Scene& scene, const std::string& anew) {
    if (scene.environment.source != scene_.environment.source) {
        show_environment(scene, load_environment(scene.environment, folder_, asset_options()));
        return;
    }
    if (anew.empty() && is_loaded(scene, *assets_)) return adopt(scene, assets_);
    SceneAssets assets = *assets_;
    assets.meshes.erase(anew);
    load_missing(assets, scene, folder_, asset_options());
    adopt(scene, std::make_shared<const SceneAssets>(std::move(assets)));
}

void Viewer::Impl::show_environment(Scene scene, LoadedMap map) {
    SceneAssets assets;
    assets.meshes = assets_->meshes;
    assets.pictures = assets_->pictures;
    assets.bumps = assets_->bumps;
    load_missing(assets, scene, folder_, asset_options());
    take_environment(map);
    assets.environment = std::move(map.map);
    adopt(scene, std::make_shared<const SceneAssets>(std::move(assets)));
}

void Viewer::Impl::open(const Scene& scene, const fs::path& folder) {
    SceneAssets assets;
    load_missing(assets, scene, folder, asset_options());
    LoadedMap map = load_environment(scene.environment, folder, asset_options());
    take_environment(map);
    assets.environment = std::move(map.map);
    folder_ = folder;
    selected_ = 0;
    adopt(scene, std::make_shared<const SceneAssets>(std::move(assets)));
}

bool Viewer::Impl::has_changed() const {
    return !drawn_ || drawn_->assets != assets_ || !(drawn_->scene == scene_);
}

// Pictures that move are drawn where they are shown, each method its part. That takes a depth
// buffer there.
bool Viewer::Impl::can_show_first() const {
    if (comparison_.showing == Showing::difference) return false;
    const auto is_first = [&](const Side& side) { return side.picture->is_first(aim()); };
    return is_first(sides_[0]) && (!shows_two() || is_first(sides_[1])) && is_depth_tested();
}

void Viewer::Impl::show_first(int left, int bottom) {
    // As show.frag has it: a pixel is on the side of its centre.
    const int middle =
        shows_two() ? static_cast<int>(std::ceil(comparison_.wipe * width_ - 0.5)) : width_;
    Scene scene = scene_;
    sides_[0].picture->show_first(*sides_[0].renderer, scene, aim(),
                                  {.left = left, .bottom = bottom, .last_column = middle});
    if (!shows_two()) return;
    scene.method = comparison_.other;
    sides_[1].picture->show_first(*sides_[1].renderer, scene, aim(),
                                  {.left = left, .bottom = bottom, .first_column = middle});
}

void Viewer::Impl::add_sample(Side& side, Method method) {
    const gl::FramebufferGuard guard;
    Scene scene = scene_;
    scene.method = method;
    side.picture->add(*side.renderer, scene, aim(), programs_);
}

void Viewer::Impl::draw_sides(bool again, int left, int bottom) {
    for (Side& side : sides_) {
        if (&side == &sides_[1] && !shows_two()) {
            if (again) side.picture.reset();
            break;
        }
        if (!side.renderer) {
            side.renderer.emplace(assets_);
            side.renderer->report_to(options_.prefiltering);
        }
        if (!side.picture) side.picture.emplace(width_, height_);
        if (again) side.picture->start_again();
    }
    if (shows_two() && drawn_ && drawn_->other != comparison_.other)
        sides_[1].picture->start_again();
    if (can_show_first()) return show_first(left, bottom);
    add_sample(sides_[0], scene_.method);
    if (shows_two()) add_sample(sides_[1], comparison_.other);
    show(left, bottom);
}

void Viewer::Impl::show(int left, int bottom) {
    using namespace gl;
    static constexpr const char* kShow[] = {"SHOW ONE", "SHOW WIPE", "SHOW DIFFERENCE"};
    glViewport(left, bottom, width_, height_);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    const bool two = shows_two();
    Definitions definitions = {kShow[static_cast<int>(comparison_.showing)]};
    if (sides_[0].picture->is_encoded()) definitions.emplace_back("FIRST_ENCODED");
    if (two && sides_[1].picture->is_encoded()) definitions.emplace_back("SECOND_ENCODED");
    const Program& program = programs_.get("full.vert", "show.frag", definitions);
    program.use();
    program.set("u_origin", Imath::V2f(static_cast<float>(left), static_cast<float>(bottom)));
    sides_[0].picture->bind_texture(0);
    program.set("u_first", 0);
    if (two) {
        sides_[1].picture->bind_texture(1);
        program.set("u_second", 1);
        program.set("u_wipe", static_cast<float>(comparison_.wipe * width_));
        program.set("u_full_scale", static_cast<float>(comparison_.full_scale));
    }
    glBindVertexArray(nothing_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    check("showing the picture");
}

void Viewer::Impl::draw(int width, int height, int left, int bottom) {
    if (width != width_ || height != height_) {
        width_ = width, height_ = height;
        for (Side& side : sides_) side.picture.reset();
    }
    try {
        draw_sides(has_changed(), left, bottom);
    } catch (const Error&) {
        if (drawn_) {
            comparison_.other = drawn_->other;
            adopt(Scene(drawn_->scene), drawn_->assets);
        }
        throw;
    }
    drawn_ = {scene_, comparison_.other, assets_};
    smooth_ =
        sides_[0].picture->is_done(aim()) && (!shows_two() || sides_[1].picture->is_done(aim()));
}

Viewer::Viewer() : Viewer(usual_scene(), {}, {}) {
    frame_all(16.0 / 9);
}
Viewer::Viewer(const Scene& scene, const fs::path& folder, const Options& options)
    : impl_(std::make_unique<Impl>(scene, folder, options)) {}
Viewer::~Viewer() = default;
Viewer::Viewer(Viewer&&) noexcept = default;
Viewer& Viewer::operator=(Viewer&&) noexcept = default;

const Scene& Viewer::scene() const {
    return impl_->scene_;
}

void Viewer::set_scene(const Scene& scene) {
    impl_->set(scene);
}

void Viewer::open_scene(const Scene& scene, const fs::path& folder) {
    impl_->open(scene, folder);
}

const fs::path& Viewer::folder() const {
    return impl_->folder_;
}

const Comparison& Viewer::comparison() const {
    return impl_->comparison_;
}

void Viewer::set_comparison(const Comparison& comparison) {
    impl_->comparison_ = comparison;
    impl_->comparison_.wipe = std::clamp(comparison.wipe, 0.0, 1.0);
    impl_->comparison_.full_scale = std::clamp(comparison.full_scale, 0.001, 1.0);
}

double Viewer::exposure() const {
    return exposure_of(impl_->scene_, impl_->usual_exposure());
}

double Viewer::exposure_stops() const {
    Scene usual = impl_->scene_;
    usual.exposure = 0;
    return std::log2(exposure() / exposure_of(usual, impl_->usual_exposure()));
}

void Viewer::set_exposure_stops(double stops) {
    Scene scene = impl_->scene_;
    scene.exposure = 0;
    if (std::abs(stops) > 1e-6) {
        const double usual = exposure_of(scene, impl_->usual_exposure());
        scene.exposure = usual * std::exp2(std::clamp(stops, -kMostStops, kMostStops));
    }
    impl_->set(scene);
}

std::size_t Viewer::selected() const {
    return impl_->selected_;
}

void Viewer::select(std::size_t object) {
    if (object < impl_->scene_.objects.size()) impl_->selected_ = object;
}

const SceneAssets& Viewer::assets() const {
    return *impl_->assets_;
}

const std::vector<std::string>& Viewer::environment_notes() const {
    return impl_->notes_;
}

Dropped Viewer::drop(const fs::path& path) {
    try {
        switch (kind_of(path)) {
            case FileKind::scene: {
                open_scene(read_scene(path), path.parent_path());
                return {true, fmt::format("{}: a scene of {} objects", path.filename().string(),
                                          scene().objects.size())};
            }
            case FileKind::mesh: {
                Scene next = scene();
                if (next.objects.empty()) next.objects = usual_scene().objects;
                next.objects[selected()].mesh = fs::absolute(path).string();
                impl_->set(next, next.objects[selected()].mesh);
                frame_all(impl_->aspect());
                const Mesh& mesh = assets().meshes.at(scene().objects[selected()].mesh);
                return {true, fmt::format("{}: {} triangles", path.filename().string(),
                                          mesh.triangle_count())};
            }
            case FileKind::environment: {
                MapReadOptions options;
                options.memory_limit = impl_->options_.memory_limit;
                options.progress = impl_->options_.reading;
                return drop_environment(fs::absolute(path).string(),
                                        read_map(path.string(), options));
            }
        }
    } catch (const Error& error) {
        return {false, error.what()};
    }
    return {};
}

Dropped Viewer::drop_environment(const std::string& name, LoadedMap map) {
    try {
        Scene next = scene();
        next.environment.source = name;
        next.exposure = 0;
        impl_->show_environment(std::move(next), std::move(map));
        return {true,
                fmt::format("{}: {}", fs::path(name).filename().string(), impl_->notes_.front())};
    } catch (const Error& error) {
        return {false, error.what()};
    }
}

void Viewer::save_scene(const fs::path& path) const {
    const fs::path target = fs::absolute(path).parent_path();
    // Beside the target, or where it is.
    const auto from_target = [&](const std::string& file) {
        const fs::path there = fs::absolute(folder() / file).lexically_normal();
        const fs::path relative = there.lexically_relative(target);
        const bool is_inside = !relative.empty() && *relative.begin() != "..";
        return (is_inside ? relative : there).string();
    };
    const auto set_file = [&](std::string& name, const auto& builtin_list) {
        const bool is_builtin =
            std::any_of(builtin_list.begin(), builtin_list.end(),
                        [&](const auto& builtin) { return builtin.name == name; });
        if (!name.empty() && !is_builtin) name = from_target(name);
    };
    const std::vector<BuiltinMesh> none;
    Scene saved = scene();
    for (SceneObject& object : saved.objects) {
        Material& material = object.material;
        set_file(object.mesh, builtin_meshes());
        set_file(material.base_color_map, none);
        set_file(material.bump.source, bump_sources());
        if (material.floor) set_file(material.floor->color_map, none);
    }
    std::string& source = saved.environment.source;
    if (!source.starts_with("builtin:")) {
        // Six faces, perhaps, with commas between them.
        std::string files;
        for (std::size_t start = 0; start <= source.size();) {
            const std::size_t end = std::min(source.find(',', start), source.size());
            files += (start > 0 ? "," : "") + from_target(source.substr(start, end - start));
            start = end + 1;
        }
        source = files;
    }
    const std::string text = to_json(saved);
    detail::OutputFile file(path);
    file.write(text);
    file.commit();
}

std::string Viewer::state() const {
    return to_text({scene(), comparison(), selected()});
}

void Viewer::set_state(std::string_view state) {
    const ViewerState parsed = parse_viewer_state(state);
    impl_->set(parsed.scene);
    set_comparison(parsed.comparison);
    select(parsed.selected);
}

void Viewer::orbit(double dx, double dy, int height) {
    impl_->scene_.camera = orbited(scene().camera, -dx * kPi / height, dy * kPi / height);
}

void Viewer::pan(double dx, double dy, int height) {
    impl_->scene_.camera = panned(scene().camera, dx / height, -dy / height);
}

void Viewer::zoom(double steps) {
    impl_->scene_.camera = zoomed(scene().camera, std::pow(kZoomStep, -steps));
}

void Viewer::turn_environment(double dx, int height) {
    Scene next = scene();
    double& yaw = next.environment.yaw;
    yaw = std::remainder(yaw - dx * kPi / height, 2 * kPi);
    impl_->set(next);
}

void Viewer::frame_all(double aspect) {
    Scene& shown = impl_->scene_;
    if (shown.objects.empty()) return;
    shown.camera = framing(detail::bounds_of(shown, assets()), aspect, kUsualYaw, kUsualPitch,
                           shown.camera.field_of_view);
}

void Viewer::draw(int width, int height, int left, int bottom) {
    impl_->draw(width, height, left, bottom);
}

bool Viewer::is_smooth() const {
    return impl_->smooth_;
}

void Viewer::hold(bool held) {
    impl_->held_ = held;
}

Hover Viewer::hover(double x, double y, int width, int height) const {
    return hover_at(scene(), assets(), (x + 0.5) / width, (y + 0.5) / height,
                    static_cast<double>(width) / height);
}

MapPlace Viewer::place_on_map(Projection projection, const Vec3d& direction) const {
    return mirrorball::place_on_map(projection, axes_of_lookup(projection, scene().camera),
                                    direction);
}

const ScreenPicture& Viewer::map_picture(MapContent content, Projection projection, int height) {
    ShownMaps::Look look;
    look.environment = turned(assets().environment.axes, scene().environment);
    look.exposure = exposure() * scene().environment.intensity;
    look.tone_map = scene().tone_map;
    look.axes = scene().method == Method::sphere_stale ? default_axes(projection)
                                                       : axes_of_lookup(projection, scene().camera);
    const std::vector<Lobe> lobes = lobes_of(scene());
    if (content == MapContent::glossy) {
        const bool selected_is_glossy =
            selected() < scene().objects.size() && scene().objects[selected()].material.glossy > 0;
        if (selected_is_glossy) {
            look.lobe = scene().objects[selected()].material.lobe;
        } else if (!lobes.empty()) {
            look.lobe = lobes.front();
        }
    }
    return impl_->shown_maps_.picture(content, projection, height, look);
}

}  // namespace mirrorball
