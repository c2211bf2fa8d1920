// What the viewer in other pages calls (web/embed.js): one object, lit by maps that were baked.
// Less than Viewer has, so that the script stays small: of files it knows KTX2, and no scenes or
// meshes.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <emscripten/emscripten.h>
#include <fmt/format.h>

#include <mirrorball/baked_maps.h>
#include <mirrorball/error.h>
#include <mirrorball/gl/renderer.h>
#include <mirrorball/mesh.h>
#include <mirrorball/orbit.h>

#include "core/frontal_view.h"
#include "gl/check.h"
#include "gl/framebuffer_guard.h"
#include "io/codec.h"
#include "io/map_metadata.h"
#include "viewer/smooth_picture.h"

namespace mirrorball {
namespace {

constexpr SmoothPicture::Aim kAim{.sample_count = 8};
constexpr double kZoomStep = 1.12, kNearest = 1.6, kFarthest = 30;
const Vec3d kPlastic(0.05, 0.20, 0.45);  // as the report's ball of plastic

FileContents decoded(const std::string& name, std::span<const std::byte> bytes) {
    detail::InputFile file(name, bytes);
    return detail::kKtx2.read(file, {});
}

EnvironmentMap cube_of(const std::string& name, FileContents contents) {
    EnvironmentMap map{Projection::cube, default_axes(Projection::cube), {}};
    for (std::vector<Image>& faces : contents.levels) {
        if (faces.size() != 6)
            throw Error(Errc::cannot_read, fmt::format("{}: is no cube map", name));
        map.levels.push_back({std::move(faces), {}});
    }
    detail::apply_lobes(detail::parse_words(contents.metadata, name), map, name);
    return map;
}

// Of the survey's terms one alone, or as the report shades its balls.
Material material_of(const std::string& kind, double parameter) {
    Material material;
    if (kind == "mirror") return material;
    material.mirror = 0;
    if (kind == "matte") {
        material.diffuse = 1;
        material.coupling = Coupling::added;
        return material;
    }
    material.glossy = 1;
    material.lobe = {Lobe::Kind::ggx, parameter, nullptr};
    if (kind == "glossy") return material;
    if (kind == "phong") {
        material.lobe.kind = Lobe::Kind::phong;
        return material;
    }
    material.coupling = Coupling::split_sum;
    if (kind == "plastic") {
        material.fresnel = Fresnel::dielectric(1.5);
        material.diffuse = 1;
        material.base_color = kPlastic;
    } else {
        material.fresnel = Fresnel::conductor(kind);
    }
    return material;
}

// Of the size of the ball, whatever the mesh, with its middle where the eye looks.
Transform fitted(const Mesh& mesh) {
    const Bounds bounds = mirrorball::bounds(mesh);
    Transform transform;
    transform.scale = Vec3d(1 / bounds.radius);
    transform.position = -bounds.centre() / bounds.radius;
    return transform;
}

class Embedded {
  public:
    Embedded(EnvironmentMap environment, std::vector<EnvironmentMap> others,
             std::shared_ptr<const Image> dfg, double exposure)
        : exposure_(exposure) {
        assets_.environment = std::move(environment);
        assets_.dfg = std::move(dfg);
        // A mirror is the sharpest level of GGX.
        EnvironmentMap mirror = assets_.environment;
        mirror.levels.resize(1);
        mirror.levels[0].lobe = Lobe{Lobe::Kind::mirror, 0, nullptr};
        others.push_back(std::move(mirror));
        assets_.baked = std::make_shared<BakedMaps>(others);
        scene_.objects.emplace_back();
        scene_.method = Method::cube;
        face();
    }

    void face() {
        scene_.camera = {.eye = {0, 0, detail::kFrontalDistance},
                         .field_of_view = detail::kFrontalField};
        changed_ = true;
    }

    void show(const std::string& mesh, const std::string& material, double parameter,
              double stops) {
        SceneObject& object = scene_.objects[0];
        if (!assets_.meshes.contains(mesh)) {
            assets_.meshes[mesh] = make_mesh(mesh);
            adopt();
        }
        object.mesh = mesh;
        object.transform = fitted(assets_.meshes[mesh]);
        object.material = material_of(material, parameter);
        scene_.exposure = exposure_ * std::exp2(stops);
        changed_ = true;
    }

    // What is under the hand turns with it, as in the window: half a turn in a picture's height.
    void orbit(double dx, double dy, double height) {
        scene_.camera = orbited(scene_.camera, -dx * kPi / height, dy * kPi / height);
        changed_ = true;
    }
    void zoom(double steps) {
        const double distance = scene_.camera.eye.length();
        const double wanted =
            std::clamp(distance * std::pow(kZoomStep, -steps), kNearest, kFarthest);
        scene_.camera = zoomed(scene_.camera, wanted / distance);
        changed_ = true;
    }

    /// Into the canvas, which has a depth buffer.
    void draw(int width, int height) {
        if (!picture_ || width != width_ || height != height_) {
            picture_.emplace(width, height);
            width_ = width, height_ = height;
        } else if (changed_) {
            picture_->start_again();
        }
        changed_ = false;
        if (picture_->is_first(kAim)) return picture_->show_first(*renderer_, scene_, kAim, {});
        add_sample();
        show_mean();
    }
    [[nodiscard]] bool is_smooth() const { return picture_ && picture_->is_done(kAim); }

  private:
    void add_sample() {
        const gl::FramebufferGuard guard;
        picture_->add(*renderer_, scene_, kAim, programs_);
    }

    void show_mean() {
        glViewport(0, 0, width_, height_);
        glDisable(GL_DEPTH_TEST);
        glDisable(GL_BLEND);
        const gl::Program& program = programs_.get("full.vert", "show.frag", {"SHOW ONE"});
        program.use();
        program.set("u_origin", Imath::V2f(0, 0));
        picture_->bind_texture(0);
        program.set("u_first", 0);
        glBindVertexArray(nothing_.name());
        glDrawArrays(GL_TRIANGLES, 0, 3);
        gl::check("showing the picture");
    }

    void adopt() {
        auto assets = std::make_shared<const SceneAssets>(assets_);
        renderer_ ? renderer_->set_assets(std::move(assets))
                  : static_cast<void>(renderer_.emplace(std::move(assets)));
    }

    SceneAssets assets_;
    double exposure_;
    Scene scene_;
    std::optional<gl::Renderer> renderer_;
    gl::ProgramCache programs_;
    gl::VertexArray nothing_;
    std::optional<SmoothPicture> picture_;
    int width_ = 0, height_ = 0;
    bool changed_ = true;
};

// One to a module: a page that shows two loads it twice.
std::optional<EnvironmentMap> environment;
std::vector<EnvironmentMap> prefiltered;
std::shared_ptr<const Image> dfg;
std::optional<Embedded> embedded;

// Empty, or why it failed.
template <class Do>
const char* attempt(Do&& act) {
    static std::string message;
    message.clear();
    try {
        act();
    } catch (const std::exception& error) {
        message = error.what();
    }
    return message.c_str();
}

}  // namespace
}  // namespace mirrorball

extern "C" {

using namespace mirrorball;

/// A file that bake wrote, in this module's memory: "environment", "dfg", or a prefiltered map.
EMSCRIPTEN_KEEPALIVE const char* mirrorball_take(const char* name, const std::byte* bytes,
                                                 std::size_t count) {
    return attempt([&] {
        const std::string_view what = name;
        FileContents contents = decoded(name, {bytes, count});
        if (what == "environment")
            environment = cube_of(name, std::move(contents));
        else if (what == "dfg")
            dfg = std::make_shared<const Image>(std::move(contents.levels.at(0).at(0)));
        else
            prefiltered.push_back(cube_of(name, std::move(contents)));
    });
}

/// With what was taken. \pre the context is current
EMSCRIPTEN_KEEPALIVE const char* mirrorball_open(double exposure) {
    return attempt([&] {
        if (!environment) throw Error(Errc::usage, "there is no map of the environment");
        embedded.emplace(std::move(*environment), std::move(prefiltered), std::move(dfg), exposure);
    });
}

EMSCRIPTEN_KEEPALIVE const char* mirrorball_show(const char* mesh, const char* material,
                                                 double parameter, double stops) {
    return attempt([&] { embedded->show(mesh, material, parameter, stops); });
}

EMSCRIPTEN_KEEPALIVE void mirrorball_orbit(double dx, double dy, double height) {
    embedded->orbit(dx, dy, height);
}
EMSCRIPTEN_KEEPALIVE void mirrorball_zoom(double steps) {
    embedded->zoom(steps);
}
EMSCRIPTEN_KEEPALIVE void mirrorball_face() {
    embedded->face();
}

EMSCRIPTEN_KEEPALIVE const char* mirrorball_draw(int width, int height) {
    return attempt([&] { embedded->draw(width, height); });
}
EMSCRIPTEN_KEEPALIVE bool mirrorball_is_smooth() {
    return embedded->is_smooth();
}
}
