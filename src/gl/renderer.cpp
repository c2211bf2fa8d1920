// The renderer: makes the maps that a scene's method looks up, then has its objects painted.
#include <mirrorball/gl/renderer.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <list>
#include <optional>

#include <fmt/format.h>

#include <mirrorball/error.h>
#include <mirrorball/projections/cube.h>

#include "check.h"
#include "core/part_of.h"
#include "dynamic_maps.h"
#include "painter.h"
#include "same_assets.h"
#include "scene_maps.h"
#include "target.h"
#include "view.h"

namespace mirrorball::gl {
namespace {

constexpr int kMostLights = 16;
// Of maps by several methods, beyond which those that are not drawn with go.
constexpr std::uint64_t kMostMapBytes = 256 << 20;
// Of the progress, if maps of lobes come after those that every scene has.
constexpr double kUsualMapsShare = 0.5;

void check_range(const char* what, int value, int least, int most) {
    if (value >= least && value <= most) return;
    throw Error(Errc::usage, fmt::format("{} is from {} to {}, not {}", what, least, most, value));
}

void check_dynamic(const DynamicReflection& dynamic) {
    check_range("the size of a dynamic reflection", dynamic.size, 16, 4096);
    check_range("the number of faces per frame", dynamic.faces_per_frame, 1, Cube::face_count);
    check_range("the number of bounces", dynamic.bounces, 1, 8);
    if (dynamic.drawing == FaceDrawing::one_pass && dynamic.faces_per_frame < Cube::face_count) {
        throw Error(Errc::usage,
                    fmt::format("one-pass draws all six faces of a cube map; for {} per frame take "
                                "texture or copy",
                                dynamic.faces_per_frame));
    }
}

void check_bump(const SceneObject& object, Method method) {
    if (can_show(method, object.material.bump)) return;
    std::string able;
    for (const Method other : all_methods()) {
        if (can_show(other, object.material.bump))
            able += fmt::format("{}{}", able.empty() ? "" : ", ", name(other));
    }
    throw Error(Errc::usage,
                fmt::format("method {} cannot show a bump map of the form {}; those that can: {}",
                            name(method), name(object.material.bump.form), able));
}

void check_scene(const Scene& scene) {
    if (scene.lights.size() > kMostLights) {
        throw Error(Errc::usage, fmt::format("a scene may have {} lights, this one has {}",
                                             kMostLights, scene.lights.size()));
    }
    for (const SceneObject& object : scene.objects) {
        if (object.dynamic) check_dynamic(*object.dynamic);
        check_bump(object, scene.method);
    }
}

bool has_dynamic_objects(const Scene& scene) {
    return std::any_of(scene.objects.begin(), scene.objects.end(),
                       [](const SceneObject& object) { return object.dynamic.has_value(); });
}

// Does variance of bumps turn into roughness anywhere?
bool gets_rougher(const Scene& scene) {
    return std::any_of(scene.objects.begin(), scene.objects.end(), [](const SceneObject& object) {
        const BumpMap& bump = object.material.bump;
        return !bump.is_smooth() && bump.form == BumpForm::normals &&
               bump.filter == BumpFilter::variance;
    });
}

// As long as it is there, nothing else is drawn into.
class Scissor {
  public:
    Scissor(int left, int bottom, int width, int height) {
        glScissor(left, bottom, width, height);
        glEnable(GL_SCISSOR_TEST);
    }
    ~Scissor() { glDisable(GL_SCISSOR_TEST); }
    Scissor(const Scissor&) = delete;
    Scissor& operator=(const Scissor&) = delete;
};

}  // namespace

class Renderer::Impl {
  public:
    explicit Impl(std::shared_ptr<const SceneAssets> assets)
        : assets_(assets),
          painter_(std::move(assets)) {}

    void set_assets(std::shared_ptr<const SceneAssets> assets);
    void report_to(Progress progress) { progress_ = std::move(progress); }
    Image picture(const Scene& scene, const PictureOptions& options);
    /// Makes the scene's maps, then one picture.
    void draw(const Scene& scene, int width, int height, const DrawOptions& options = {});
    SurfaceBuffer surfaces(const Scene& scene, int width, int height, const Imath::V2d& shift);
    EnvironmentMap capture(const Scene& scene, const Vec3d& position, int size);
    std::vector<double> time_frames(const Scene& scene, int width, int height, int count);
    std::uint64_t map_bytes(const Scene& scene);
    const std::vector<FaceUpdate>& updates() const { return dynamic_.updates(); }

  private:
    // What maps are made for, besides lobes: when none of it changes, they are as they were.
    struct MapsKey {
        Method method;
        int size;
        bool rough;
        bool operator==(const MapsKey&) const = default;
    };
    struct KeptMaps {
        MapsKey key;
        SceneMaps maps;
    };

    SceneMaps& maps_for(const Scene& scene, Method method, bool quick);
    void forget_maps();
    void make_maps(const Scene& scene, bool quick = false);
    void draw_scene(const Scene& scene, const Shot& shot);

    std::shared_ptr<const SceneAssets> assets_;
    Painter painter_;
    ProgramCache programs_;               // of surfaces()
    std::shared_ptr<LobeFilter> filter_;  // of the environment, once maps are made of it
    std::list<KeptMaps> kept_;            // the last used first
    SceneMaps* maps_ = nullptr;           // of the scene's method; one of those
    DynamicMaps dynamic_;
    std::optional<Target> target_;
    Progress progress_;  // of making maps
};

void Renderer::Impl::set_assets(std::shared_ptr<const SceneAssets> assets) {
    if (!is_same(assets_->environment, assets->environment) || assets_->baked != assets->baked) {
        maps_ = nullptr;
        kept_.clear();
        filter_.reset();
    }
    painter_.set_assets(assets);
    assets_ = std::move(assets);
}

SceneMaps& Renderer::Impl::maps_for(const Scene& scene, Method method, bool quick) {
    const MapsKey key{method, map_size(scene, *assets_), gets_rougher(scene)};
    const std::vector<Lobe> lobes = lobes_of(scene);
    double begun = 0;  // of the progress
    const auto found = std::find_if(kept_.begin(), kept_.end(),
                                    [&](const KeptMaps& kept) { return kept.key == key; });
    if (found != kept_.end()) {
        kept_.splice(kept_.begin(), kept_, found);
    } else {
        forget_maps();
        if (!filter_) {
            filter_ = std::make_shared<LobeFilter>(
                std::shared_ptr<const EnvironmentMap>(assets_, &assets_->environment));
        }
        const double end = lobes.empty() ? 1 : kUsualMapsShare;
        kept_.push_front({key, SceneMaps(filter_, key.method, key.size, key.rough, assets_->baked,
                                         detail::part_of(progress_, 0, end))});
        begun = end;
    }
    kept_.front().maps.set_lobes(lobes, quick, detail::part_of(progress_, begun, 1));
    return kept_.front().maps;
}

// All but the last used, if they are many: a scene may come back to their method.
void Renderer::Impl::forget_maps() {
    std::uint64_t bytes = 0;
    for (const KeptMaps& kept : kept_) bytes += kept.maps.kept_bytes();
    while (kept_.size() > 1 && bytes > kMostMapBytes) {
        bytes -= kept_.back().maps.kept_bytes();
        kept_.pop_back();
    }
}

void Renderer::Impl::make_maps(const Scene& scene, bool quick) {
    check_scene(scene);
    maps_ = &maps_for(scene, scene.method, quick);
    maps_->look_from(axes(scene.camera), scene.environment);
    if (!has_dynamic_objects(scene)) return;
    dynamic_.update(scene, painter_, maps_for(scene, Method::cube, quick));
}

// With the maps that there are.
void Renderer::Impl::draw_scene(const Scene& scene, const Shot& shot) {
    painter_.begin();
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const SceneObject& object = scene.objects[i];
        std::optional<LookupMaps> maps;
        if (object.dynamic) maps = dynamic_.lookup(i);
        if (!maps) maps = maps_->lookup(object.material, scene.environment);
        painter_.object(scene, object, *maps, shot);
    }
    painter_.background(scene, shot, !scene.environment.background);
    check("drawing");
}

void Renderer::Impl::draw(const Scene& scene, int width, int height, const DrawOptions& options) {
    make_maps(scene, options.quick);
    const View view = view_of(scene.camera, static_cast<double>(width) / height,
                              {2 * options.shift.x / width, 2 * options.shift.y / height});
    glViewport(options.left, options.bottom, width, height);
    const int first = std::clamp(options.first_column, 0, width),
              last = std::clamp(options.last_column, first, width);
    const Scissor part(options.left + first, options.bottom, last - first, height);
    draw_scene(scene, {{&view, 1}, options.encoded ? Output::screen : Output::display, 0, height});
}

Image Renderer::Impl::picture(const Scene& scene, const PictureOptions& options) {
    const int width = options.width, height = options.height;
    if (!target_ || target_->width() != width || target_->height() != height)
        target_.emplace(width, height);
    make_maps(scene);
    Image sum;
    for (int i = 0; i < options.sample_count; ++i) {
        const Imath::V2d shift = sample_shift(i, options.sample_count);
        const View view = view_of(scene.camera, static_cast<double>(width) / height,
                                  {2 * shift.x / width, 2 * shift.y / height});
        target_->bind();
        draw_scene(scene,
                   {{&view, 1}, options.display ? Output::display : Output::radiance, 0, height});
        Image one = target_->read(3);
        if (sum.empty()) {
            sum = std::move(one);
        } else {
            std::transform(sum.values().begin(), sum.values().end(), one.values().begin(),
                           sum.values().begin(), std::plus<>());
        }
        if (options.progress && !options.progress((i + 1.0) / options.sample_count))
            throw Error(Errc::cancelled, "drawing was cancelled");
    }
    for (float& value : sum.values()) value /= static_cast<float>(options.sample_count);
    return sum;
}

EnvironmentMap Renderer::Impl::capture(const Scene& scene, const Vec3d& position, int size) {
    // Nothing nearer than this share of a metre is seen.
    constexpr double kNearest = 0.001;
    make_maps(scene);
    const Target target(size, size);
    EnvironmentMap map = make_environment_map(Projection::cube, size);
    for (int face = 0; face < Cube::face_count; ++face) {
        const View view = face_view(position, map.axes, face, kNearest);
        target.bind();
        draw_scene(scene, {{&view, 1}, Output::radiance, size});
        // The lowest row that OpenGL draws is the face's first.
        const Image flipped = target.read(3);
        Image& image = map.levels[0].faces[face];
        for (int y = 0; y < size; ++y)
            std::copy_n(flipped.at(0, size - 1 - y), 3 * size, image.at(0, y));
    }
    return map;
}

std::vector<double> Renderer::Impl::time_frames(const Scene& scene, int width, int height,
                                                int count) {
    using Clock = std::chrono::steady_clock;
    const Target target(width, height);
    std::vector<double> seconds;
    for (int i = -1; i < count; ++i) {  // the first makes ready and does not count
        target.bind();
        const Clock::time_point start = Clock::now();
        draw(scene, width, height);
        glFinish();
        if (i >= 0) seconds.push_back(std::chrono::duration<double>(Clock::now() - start).count());
    }
    return seconds;
}

std::uint64_t Renderer::Impl::map_bytes(const Scene& scene) {
    make_maps(scene);
    return maps_->bytes() + (has_dynamic_objects(scene) ? dynamic_.bytes() : 0);
}

SurfaceBuffer Renderer::Impl::surfaces(const Scene& scene, int width, int height,
                                       const Imath::V2d& shift) {
    const View view = view_of(scene.camera, static_cast<double>(width) / height,
                              {2 * shift.x / width, 2 * shift.y / height});
    const Target target(width, height, 4);
    target.bind();
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    constexpr float kNothing[4] = {0, 0, 0, -1};
    for (int i = 0; i < 4; ++i) glClearBufferfv(GL_COLOR, i, kNothing);
    glClear(GL_DEPTH_BUFFER_BIT);
    const Program& program =
        programs_.get("surface.vert", "facts.frag", {"METHOD CUBE", "HAS_TANGENTS"});
    program.use();
    program.set("u_to_clip", Imath::M44f(view.to_clip));
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Imath::M44d to_world = matrix(scene.objects[i].transform);
        program.set("u_to_world", Imath::M44f(to_world));
        program.set("u_normal_to_world", normal_matrix(to_world));
        program.set("u_handedness", handedness(to_world));
        program.set("u_object", static_cast<float>(i));
        painter_.buffers_of(scene.objects[i]).draw();
    }
    check("drawing surfaces");
    SurfaceBuffer buffer{target.read(3, 0),       target.read(3, 1), Image(width, height, 1),
                         Image(width, height, 2), target.read(3, 2), target.read(3, 3)};
    const Image with_object = target.read(4, 0), with_s = target.read(4, 1),
                with_t = target.read(4, 2);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            *buffer.object.at(x, y) = with_object.at(x, y)[3];
            buffer.texture_coordinates.at(x, y)[0] = with_s.at(x, y)[3];
            buffer.texture_coordinates.at(x, y)[1] = with_t.at(x, y)[3];
        }
    }
    return buffer;
}

Renderer::Renderer(std::shared_ptr<const SceneAssets> assets)
    : impl_(std::make_unique<Impl>(std::move(assets))) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

void Renderer::set_assets(std::shared_ptr<const SceneAssets> assets) {
    impl_->set_assets(std::move(assets));
}

void Renderer::report_to(Progress progress) {
    impl_->report_to(std::move(progress));
}

Image Renderer::picture(const Scene& scene, const PictureOptions& options) {
    constexpr int kLargestSide = 1 << 16, kMostSamples = 1024;
    check_range("a picture's width", options.width, 1, kLargestSide);
    check_range("a picture's height", options.height, 1, kLargestSide);
    check_range("a picture's number of samples", options.sample_count, 1, kMostSamples);
    return impl_->picture(scene, options);
}

void Renderer::draw(const Scene& scene, int width, int height, const DrawOptions& options) {
    impl_->draw(scene, width, height, options);
}

SurfaceBuffer Renderer::surfaces(const Scene& scene, int width, int height,
                                 const Imath::V2d& shift) {
    return impl_->surfaces(scene, width, height, shift);
}

EnvironmentMap Renderer::capture(const Scene& scene, const Vec3d& position, int size) {
    check_range("the size of a captured map", size, 1, 16384);
    return impl_->capture(scene, position, size);
}

const std::vector<FaceUpdate>& Renderer::face_updates() const {
    return impl_->updates();
}

std::vector<double> Renderer::time_frames(const Scene& scene, int width, int height, int count) {
    return impl_->time_frames(scene, width, height, count);
}

std::uint64_t Renderer::map_bytes(const Scene& scene) {
    return impl_->map_bytes(scene);
}

// Roberts's sequence of two dimensions: any first n of its points are spread evenly.
Imath::V2d sample_shift(int i, int count) {
    if (count == 1) return {0, 0};
    constexpr double kPlastic = 1.32471795724474602596;
    const auto fraction = [](double x) { return x - std::floor(x); };
    return {fraction(0.5 + (i + 1) / kPlastic) - 0.5,
            fraction(0.5 + (i + 1) / (kPlastic * kPlastic)) - 0.5};
}

}  // namespace mirrorball::gl
