// The renderer: objects by their materials' programs, then the background where nothing is.
#include <mirrorball/gl/renderer.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <optional>

#include <fmt/format.h>

#include <mirrorball/brdf.h>
#include <mirrorball/dfg.h>
#include <mirrorball/error.h>
#include <mirrorball/resample.h>

#include "check.h"
#include "mesh_buffers.h"
#include "paraboloid_matrix.h"
#include "program.h"
#include "scene_maps.h"
#include "target.h"
#include "texture.h"
#include "view.h"

namespace mirrorball::gl {
namespace {

// Texture units; one each, so that nothing is bound where something else is looked for.
enum Unit { kMirrorUnit, kGlossyUnit, kDiffuseUnit, kFresnelUnit, kDfgUnit, kBaseColorUnit };

constexpr int kFresnelSampleCount = 512;
constexpr int kDfgSize = 128;
constexpr int kMostLights = 16;

std::string_view glsl_name(Method method) {
    switch (method) {
        case Method::sphere:
        case Method::sphere_stale:
            return "SPHERE";
        case Method::sphere_vertex:
            return "SPHERE_VERTEX";
        case Method::cube:
            return "CUBE";
        case Method::cube_vertex:
            return "CUBE_VERTEX";
        case Method::cube_seams:
            return "CUBE_SEAMS";
        case Method::cube_split:
            return "CUBE_SPLIT";
        case Method::dual_paraboloid:
            return "DUAL_PARABOLOID";
        case Method::dual_paraboloid_vertex:
        case Method::dual_paraboloid_passes:
            return "DUAL_PARABOLOID_VERTEX";
        case Method::equirect:
            return "EQUIRECT";
        case Method::octahedral:
            return "OCTAHEDRAL";
    }
    return {};
}

std::string_view glsl_name(Coupling coupling) {
    switch (coupling) {
        case Coupling::added:
            return "ADDED";
        case Coupling::layered:
            return "LAYERED";
        case Coupling::split_sum:
            return "SPLIT_SUM";
    }
    return {};
}

// What lights without extent show of a lobe; 0 where they show nothing.
std::string_view glsl_name(Lobe::Kind kind) {
    switch (kind) {
        case Lobe::Kind::phong:
            return "PHONG";
        case Lobe::Kind::blinn_phong:
            return "BLINN_PHONG";
        case Lobe::Kind::ggx:
            return "GGX";
        case Lobe::Kind::charlie:
            return "CHARLIE";
        default:
            return "0";
    }
}

std::string_view glsl_name(const Proxy& proxy) {
    if (std::holds_alternative<BoxProxy>(proxy)) return "BOX_PROXY";
    if (std::holds_alternative<SphereProxy>(proxy)) return "SPHERE_PROXY";
    return "NO_PROXY";
}

// What a program needs to know when it is compiled, and no more: what differs from object to object
// only by numbers shares one.
Definitions definitions_for(const Scene& scene, const Material& material, int pass, bool display) {
    Definitions definitions = {fmt::format("METHOD {}", glsl_name(scene.method)),
                               fmt::format("PASS {}", pass),
                               fmt::format("COUPLING {}", glsl_name(material.coupling)),
                               fmt::format("PROXY {}", glsl_name(scene.environment.proxy))};
    if (material.mirror > 0) definitions.emplace_back("HAS_MIRROR");
    if (material.glossy > 0) definitions.emplace_back("HAS_GLOSSY");
    if (material.diffuse > 0) definitions.emplace_back("HAS_DIFFUSE");
    if (material.transmission > 0) definitions.emplace_back("HAS_TRANSMISSION");
    if (material.emission > 0) definitions.emplace_back("HAS_EMISSION");
    if (!material.base_color_map.empty()) definitions.emplace_back("HAS_BASE_COLOR_MAP");
    if (!scene.lights.empty()) {
        definitions.push_back(fmt::format("LIGHT_COUNT {}", scene.lights.size()));
        definitions.push_back(fmt::format("LOBE {}", glsl_name(material.lobe.kind)));
    }
    if (display) definitions.emplace_back("DISPLAY");
    return definitions;
}

void set_proxy(const Program& program, const SceneEnvironment& environment) {
    program.set("u_captured_at", environment.captured_at);
    if (const auto* box = std::get_if<BoxProxy>(&environment.proxy)) {
        program.set("u_proxy_least", box->least);
        program.set("u_proxy_most", box->most);
    } else if (const auto* sphere = std::get_if<SphereProxy>(&environment.proxy)) {
        program.set("u_proxy_centre", sphere->centre);
        program.set("u_proxy_radius", static_cast<float>(sphere->radius));
    }
}

void set_lights(const Program& program, std::span<const SceneLight> lights) {
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const auto element = [&](const char* array) { return fmt::format("{}[{}]", array, i); };
        const auto set = [&](const Vec3d& place, const Vec3d& strength, bool is_point) {
            program.set(element("u_light_place").c_str(), place);
            program.set(element("u_light_strength").c_str(), strength);
            program.set(element("u_light_is_point").c_str(), is_point ? 1.0f : 0.0f);
        };
        if (const auto* point = std::get_if<ScenePointLight>(&lights[i])) {
            set(point->position, point->intensity, true);
        } else {
            const auto& sun = std::get<SceneDirectionalLight>(lights[i]);
            set(sun.direction.normalized(), sun.normal_irradiance, false);
        }
    }
}

// BRDFs have exponents to a million; next to a light without extent no one sees the difference.
double exponent_of(const Lobe& lobe) {
    return std::min(lobe.parameter, 1e6);
}

// What normalises a cosine lobe as a BRDF: its value at the peak.
double lobe_scale(const Lobe& lobe) {
    const Vec3d normal(0, 0, 1);
    if (lobe.kind == Lobe::Kind::phong)
        return Brdf(Phong{.exponent = exponent_of(lobe)}).evaluate(normal, normal).x;
    if (lobe.kind == Lobe::Kind::blinn_phong)
        return Brdf(BlinnPhong{.exponent = exponent_of(lobe)}).evaluate(normal, normal).x;
    return 0;
}

void check_scene(const Scene& scene) {
    if (scene.lights.size() > kMostLights) {
        throw Error(Errc::usage, fmt::format("a scene may have {} lights, this one has {}",
                                             kMostLights, scene.lights.size()));
    }
}

Mesh moved(const Mesh& mesh, const Transform& transform) {
    Mesh result = mesh;
    for (Vec3f& position : result.positions) position = Vec3f(transform.point(Vec3d(position)));
    for (Vec3f& normal : result.normals) normal = Vec3f(transform.normal(Vec3d(normal)));
    return result;
}

// For normals: the inverse transpose.
Imath::M33f normal_matrix(const Imath::M44d& m) {
    Imath::M33d turn(m[0][0], m[0][1], m[0][2], m[1][0], m[1][1], m[1][2], m[2][0], m[2][1],
                     m[2][2]);
    turn.invert(true);
    turn.transpose();
    return Imath::M33f(turn);
}

}  // namespace

class Renderer::Impl {
  public:
    explicit Impl(std::shared_ptr<const SceneAssets> assets) : assets_(std::move(assets)) {}

    Image picture(const Scene& scene, const PictureOptions& options);
    void draw(const Scene& scene, int width, int height, const Imath::V2d& shift, bool display);
    SurfaceBuffer surfaces(const Scene& scene, int width, int height, const Imath::V2d& shift);
    std::vector<double> time_frames(const Scene& scene, int width, int height, int count);
    std::uint64_t map_bytes(const Scene& scene) { return maps_for(scene).bytes(); }

  private:
    // What maps are made for: when none of it changes, they are as they were.
    struct MapsKey {
        Method method;
        int size;
        std::vector<Lobe> lobes;
        bool operator==(const MapsKey&) const = default;
    };

    SceneMaps& maps_for(const Scene& scene);
    const Texture& background_for(const Scene& scene);
    int size_for(const Scene& scene) const;
    double exposure_for(const Scene& scene);
    const Mesh& mesh_of(const SceneObject& object) const { return assets_->meshes.at(object.mesh); }
    const MeshBuffers& buffers_of(const SceneObject& object);
    const Texture& picture_texture(const std::string& name);
    const Texture& fresnel_texture(const Fresnel& fresnel);
    const Texture& dfg_texture();

    void draw_object(const Scene& scene, const SceneObject& object, const View& view,
                     SceneMaps& maps, int pass, bool display);
    void draw_split(const SceneObject& object, const View& view, const SceneMaps& maps,
                    const Program& program);
    void set_material(const Program& program, const Material& material);
    void set_maps(const Program& program, const Material& material, const SceneMaps& maps);
    void set_display(const Program& program, const Scene& scene);
    void draw_background(const Scene& scene, const View& view, bool display);

    std::shared_ptr<const SceneAssets> assets_;
    ProgramCache programs_;
    std::optional<MapsKey> maps_key_;
    std::optional<SceneMaps> maps_;
    std::optional<Texture> background_;
    int background_size_ = 0;
    std::optional<double> usual_exposure_;
    std::map<std::string, MeshBuffers> buffers_;
    std::map<std::string, Texture> pictures_;
    std::map<std::string, Texture> fresnels_;
    std::optional<Texture> dfg_;
    std::optional<Target> target_;
    VertexArray nothing_;
};

int Renderer::Impl::size_for(const Scene& scene) const {
    return scene.map_size > 0 ? scene.map_size
                              : mirror_map_size(assets_->environment, Projection::cube);
}

SceneMaps& Renderer::Impl::maps_for(const Scene& scene) {
    const MapsKey key{scene.method, size_for(scene), lobes_of(scene)};
    if (!maps_ || maps_key_ != key) {
        maps_.emplace(assets_->environment, key.method, key.size, key.lobes);
        maps_key_ = key;
    }
    return *maps_;
}

// Seen sharply whatever the method: a cube map as fine as the environment.
const Texture& Renderer::Impl::background_for(const Scene& scene) {
    const int size =
        std::max(size_for(scene), mirror_map_size(assets_->environment, Projection::cube));
    if (!background_ || background_size_ != size) {
        EnvironmentMap cube =
            resample(assets_->environment, Projection::cube, size, default_axes(Projection::cube));
        append_mip_levels(cube);
        background_ = upload(cube);
        background_size_ = size;
    }
    return *background_;
}

double Renderer::Impl::exposure_for(const Scene& scene) {
    if (scene.exposure > 0) return scene.exposure;
    if (!usual_exposure_) usual_exposure_ = usual_exposure(assets_->environment);
    return *usual_exposure_ / scene.environment.intensity;
}

const MeshBuffers& Renderer::Impl::buffers_of(const SceneObject& object) {
    const auto found = buffers_.find(object.mesh);
    if (found != buffers_.end()) return found->second;
    return buffers_.emplace(object.mesh, MeshBuffers(mesh_of(object))).first->second;
}

const Texture& Renderer::Impl::picture_texture(const std::string& name) {
    const auto found = pictures_.find(name);
    if (found != pictures_.end()) return found->second;
    Texture texture = upload(assets_->pictures.at(name), true);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_REPEAT);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_REPEAT);
    return pictures_.emplace(name, std::move(texture)).first->second;
}

const Texture& Renderer::Impl::fresnel_texture(const Fresnel& fresnel) {
    const std::string key = to_string(fresnel);
    const auto found = fresnels_.find(key);
    if (found != fresnels_.end()) return found->second;
    const FresnelMap map(fresnel, kFresnelSampleCount);
    return fresnels_.emplace(key, upload(map.image())).first->second;
}

const Texture& Renderer::Impl::dfg_texture() {
    if (!dfg_) dfg_ = upload(DfgTable(kDfgSize, kDfgSize).image());
    return *dfg_;
}

void Renderer::Impl::set_material(const Program& program, const Material& material) {
    program.set("u_base_color", material.base_color);
    program.set("u_mirror", static_cast<float>(material.mirror));
    program.set("u_glossy", static_cast<float>(material.glossy));
    program.set("u_diffuse", static_cast<float>(material.diffuse));
    program.set("u_transmission", static_cast<float>(material.transmission));
    program.set("u_emission", static_cast<float>(material.emission));
    program.set("u_index", static_cast<float>(material.index));
    fresnel_texture(material.fresnel).bind(kFresnelUnit);
    program.set("u_fresnel_map", kFresnelUnit);
    program.set("u_roughness", static_cast<float>(roughness_of(material.lobe)));
    program.set("u_exponent", static_cast<float>(exponent_of(material.lobe)));
    program.set("u_lobe_scale", static_cast<float>(lobe_scale(material.lobe)));
    if (material.coupling == Coupling::split_sum) {
        dfg_texture().bind(kDfgUnit);
        program.set("u_dfg_table", kDfgUnit);
        program.set("u_f0", material.fresnel(1));
        program.set("u_f90", material.fresnel(0));
    }
    if (!material.base_color_map.empty()) {
        picture_texture(material.base_color_map).bind(kBaseColorUnit);
        program.set("u_base_color_map", kBaseColorUnit);
    }
}

void Renderer::Impl::set_maps(const Program& program, const Material& material,
                              const SceneMaps& maps) {
    program.set("u_to_map", to_map_matrix(maps.axes()));
    program.set("u_to_front", Imath::M44f(paraboloid_matrix(maps.axes(), true)));
    program.set("u_to_back", Imath::M44f(paraboloid_matrix(maps.axes(), false)));
    maps.mirror().bind(kMirrorUnit);
    maps.diffuse().bind(kDiffuseUnit);
    if (material.glossy > 0) maps.glossy(material.lobe).bind(kGlossyUnit);
    program.set("u_mirror_map", kMirrorUnit);
    program.set("u_glossy_map", kGlossyUnit);
    program.set("u_diffuse_map", kDiffuseUnit);
    program.set("u_glossy_level", 0.0f);
    program.set("u_finest_level", 0.0f);
}

void Renderer::Impl::set_display(const Program& program, const Scene& scene) {
    program.set("u_exposure", static_cast<float>(exposure_for(scene)));
    program.set("u_tone_map", static_cast<int>(scene.tone_map));
}

void Renderer::Impl::draw_split(const SceneObject& object, const View& view, const SceneMaps& maps,
                                const Program& program) {
    const SplitMeshBuffers split(
        split_by_cube_face(moved(mesh_of(object), object.transform), view.eye, maps.axes()));
    program.set("u_to_world", Imath::M44f());
    program.set("u_normal_to_world", Imath::M33f());
    for (int face = 0; face < Cube::face_count; ++face) {
        maps.mirror_face(face).bind(kMirrorUnit);
        if (object.material.glossy > 0)
            maps.glossy_face(object.material.lobe, face).bind(kGlossyUnit);
        split.draw(face);
    }
}

void Renderer::Impl::draw_object(const Scene& scene, const SceneObject& object, const View& view,
                                 SceneMaps& maps, int pass, bool display) {
    const Program& program = programs_.get("surface.vert", "surface.frag",
                                           definitions_for(scene, object.material, pass, display));
    program.use();
    const Imath::M44d to_world = matrix(object.transform);
    program.set("u_to_world", Imath::M44f(to_world));
    program.set("u_normal_to_world", normal_matrix(to_world));
    program.set("u_to_clip", Imath::M44f(view.to_clip));
    program.set("u_eye", view.eye);
    program.set("u_intensity", static_cast<float>(scene.environment.intensity));
    set_material(program, object.material);
    set_maps(program, object.material, maps);
    set_proxy(program, scene.environment);
    set_lights(program, scene.lights);
    set_display(program, scene);
    if (scene.method == Method::cube_split) {
        draw_split(object, view, maps, program);
    } else {
        buffers_of(object).draw();
    }
}

void Renderer::Impl::draw_background(const Scene& scene, const View& view, bool display) {
    Definitions definitions = {fmt::format("PROXY {}", glsl_name(scene.environment.proxy))};
    if (!scene.environment.background) definitions.emplace_back("PLAIN");
    if (display) definitions.emplace_back("DISPLAY");
    const Program& program = programs_.get("background.vert", "background.frag", definitions);
    program.use();
    program.set("u_ray", Imath::M33f(view.ray));
    program.set("u_eye", view.eye);
    program.set("u_background", scene.environment.background_color);
    program.set("u_intensity", static_cast<float>(scene.environment.intensity));
    program.set("u_to_map", to_map_matrix(default_axes(Projection::cube)));
    background_for(scene).bind(kMirrorUnit);
    program.set("u_mirror_map", kMirrorUnit);
    set_proxy(program, scene.environment);
    set_display(program, scene);
    glBindVertexArray(nothing_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void Renderer::Impl::draw(const Scene& scene, int width, int height, const Imath::V2d& shift,
                          bool display) {
    check_scene(scene);
    const View view = view_of(scene.camera, static_cast<double>(width) / height,
                              {2 * shift.x / width, 2 * shift.y / height});
    SceneMaps& maps = maps_for(scene);
    maps.look_from(view.frame);

    if (epoxy_is_desktop_gl()) glEnable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
    glViewport(0, 0, width, height);
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_TRUE);
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    for (const SceneObject& object : scene.objects) {
        if (scene.method == Method::dual_paraboloid_passes) {
            draw_object(scene, object, view, maps, 1, display);
            draw_object(scene, object, view, maps, 2, display);
        } else {
            draw_object(scene, object, view, maps, 0, display);
        }
    }
    draw_background(scene, view, display);
    check("drawing");
}

Image Renderer::Impl::picture(const Scene& scene, const PictureOptions& options) {
    if (!target_ || target_->width() != options.width || target_->height() != options.height)
        target_.emplace(options.width, options.height);
    Image sum;
    for (int i = 0; i < options.sample_count; ++i) {
        target_->bind();
        draw(scene, options.width, options.height, sample_shift(i, options.sample_count),
             options.display);
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

std::vector<double> Renderer::Impl::time_frames(const Scene& scene, int width, int height,
                                                int count) {
    using Clock = std::chrono::steady_clock;
    const Target target(width, height);
    std::vector<double> seconds;
    for (int i = -1; i < count; ++i) {  // the first makes ready and does not count
        target.bind();
        const Clock::time_point start = Clock::now();
        draw(scene, width, height, {0, 0}, true);
        glFinish();
        if (i >= 0) seconds.push_back(std::chrono::duration<double>(Clock::now() - start).count());
    }
    return seconds;
}

SurfaceBuffer Renderer::Impl::surfaces(const Scene& scene, int width, int height,
                                       const Imath::V2d& shift) {
    const View view = view_of(scene.camera, static_cast<double>(width) / height,
                              {2 * shift.x / width, 2 * shift.y / height});
    const Target target(width, height, 3);
    target.bind();
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    constexpr float kNothing[4] = {0, 0, 0, -1};
    for (int i = 0; i < 3; ++i) glClearBufferfv(GL_COLOR, i, kNothing);
    glClear(GL_DEPTH_BUFFER_BIT);
    const Program& program = programs_.get("surface.vert", "facts.frag", {"METHOD CUBE"});
    program.use();
    program.set("u_to_clip", Imath::M44f(view.to_clip));
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Imath::M44d to_world = matrix(scene.objects[i].transform);
        program.set("u_to_world", Imath::M44f(to_world));
        program.set("u_normal_to_world", normal_matrix(to_world));
        program.set("u_object", static_cast<float>(i));
        buffers_of(scene.objects[i]).draw();
    }
    check("drawing surfaces");
    SurfaceBuffer buffer{target.read(3, 0), target.read(3, 1), Image(width, height, 1),
                         target.read(2, 2)};
    const Image with_object = target.read(4, 0);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) *buffer.object.at(x, y) = with_object.at(x, y)[3];
    }
    return buffer;
}

Renderer::Renderer(std::shared_ptr<const SceneAssets> assets)
    : impl_(std::make_unique<Impl>(std::move(assets))) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Image Renderer::picture(const Scene& scene, const PictureOptions& options) {
    constexpr int kLargestSide = 1 << 16, kMostSamples = 1024;
    const auto check_range = [](const char* what, int value, int most) {
        if (value >= 1 && value <= most) return;
        throw Error(Errc::usage,
                    fmt::format("a picture's {} is from 1 to {}, not {}", what, most, value));
    };
    check_range("width", options.width, kLargestSide);
    check_range("height", options.height, kLargestSide);
    check_range("number of samples", options.sample_count, kMostSamples);
    return impl_->picture(scene, options);
}

void Renderer::draw(const Scene& scene, int width, int height) {
    impl_->draw(scene, width, height, {0, 0}, true);
}

SurfaceBuffer Renderer::surfaces(const Scene& scene, int width, int height,
                                 const Imath::V2d& shift) {
    return impl_->surfaces(scene, width, height, shift);
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
