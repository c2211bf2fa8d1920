#include "painter.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <mirrorball/brdf.h>
#include <mirrorball/direct.h>
#include <mirrorball/projections/cube.h>
#include <mirrorball/reflection_maps.h>
#include <mirrorball/resample.h>

#include "paraboloid_matrix.h"
#include "same_assets.h"

namespace mirrorball::gl {
namespace {

// Texture units; one each, so that nothing is bound where something else is looked for.
enum Unit {
    kMirrorUnit,
    kGlossyUnit,
    kDiffuseUnit,
    kFresnelUnit,
    kDfgUnit,
    kBaseColorUnit,
    kRoughUnit,
    kBumpUnit,
    kLightMapUnit,
    kFloorUnit
};

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

std::string_view glsl_name(ToneMap tone_map) {
    switch (tone_map) {
        case ToneMap::none:
            return "NO_TONE_MAP";
        case ToneMap::reinhard:
            return "REINHARD";
        case ToneMap::aces:
            return "ACES";
        case ToneMap::agx:
            return "AGX";
        case ToneMap::film:
            return "FILM";
    }
    return {};
}

std::string_view glsl_name(Output output) {
    switch (output) {
        case Output::display:
            return "DISPLAY";
        case Output::screen:
            return "SCREEN";
        case Output::radiance:
            return "RADIANCE";
        case Output::half_floats:
            return "HALF_FLOATS";
    }
    return {};
}

std::string_view glsl_name(BumpForm form) {
    return form == BumpForm::normals ? "NORMALS" : "CLASSIC";
}

std::string_view glsl_name(BumpFilter filter) {
    switch (filter) {
        case BumpFilter::none:
            return "NONE";
        case BumpFilter::mean:
            return "MEAN";
        case BumpFilter::variance:
            return "VARIANCE";
    }
    return {};
}

// Classic bumps are on sphere maps only: other objects' cube maps show the surface without.
bool has_bump(const Material& material, const LookupMaps& maps) {
    return !material.bump.is_smooth() && can_show(maps.method, material.bump);
}

bool has_light_map(const Scene& scene, const Material& material, const LookupMaps& maps) {
    return has_bump(material, maps) && material.bump.form == BumpForm::classic &&
           !scene.lights.empty();
}

Definitions light_definitions(const Scene& scene, const Material& material) {
    return {fmt::format("LIGHT_COUNT {}", scene.lights.size()),
            fmt::format("LOBE {}", glsl_name(material.lobe.kind))};
}

void add_bump_definitions(Definitions& definitions, const BumpMap& bump, const LookupMaps& maps) {
    definitions.emplace_back("HAS_BUMP");
    definitions.emplace_back("HAS_TANGENTS");
    definitions.push_back(fmt::format("BUMP_FORM {}", glsl_name(bump.form)));
    definitions.push_back(fmt::format("BUMP_FILTER {}", glsl_name(bump.filter)));
    if (bump.form == BumpForm::classic) return;
    if (bump.relief > 0) definitions.emplace_back("HAS_RELIEF");
    if (bump.horizon) definitions.emplace_back("HAS_HORIZON");
    if (bump.filter == BumpFilter::none) definitions.emplace_back("FINEST_ONLY");
    // Maps of dynamic objects have no chain: there the mean is all that is shown.
    if (bump.filter == BumpFilter::variance && !maps.textures->rough.empty())
        definitions.emplace_back("HAS_ROUGH_MAP");
}

void add_output(const Scene& scene, const Shot& shot, Definitions& definitions) {
    definitions.emplace_back(glsl_name(shot.output));
    if (shot.output == Output::display || shot.output == Output::screen)
        definitions.push_back(fmt::format("TONE_MAP {}", glsl_name(scene.tone_map)));
}

// What a program needs to know when it is compiled, and no more: what differs from object to object
// only by numbers shares one.
Definitions definitions_for(const Scene& scene, const Material& material, const LookupMaps& maps,
                            int pass, const Shot& shot) {
    Definitions definitions = {fmt::format("METHOD {}", glsl_name(maps.method)),
                               fmt::format("PASS {}", pass),
                               fmt::format("COUPLING {}", glsl_name(material.coupling)),
                               fmt::format("PROXY {}", glsl_name(maps.proxy))};
    add_output(scene, shot, definitions);
    if (material.mirror > 0) definitions.emplace_back("HAS_MIRROR");
    if (material.glossy > 0) definitions.emplace_back("HAS_GLOSSY");
    if (material.diffuse > 0) definitions.emplace_back("HAS_DIFFUSE");
    if (material.transmission > 0) definitions.emplace_back("HAS_TRANSMISSION");
    if (material.emission > 0) definitions.emplace_back("HAS_EMISSION");
    if (!material.base_color_map.empty()) definitions.emplace_back("HAS_BASE_COLOR_MAP");
    if (material.floor) {
        definitions.emplace_back("HAS_FLOOR");
        if (!material.floor->color_map.empty()) definitions.emplace_back("HAS_FLOOR_MAP");
    }
    if (has_bump(material, maps)) add_bump_definitions(definitions, material.bump, maps);
    if (has_light_map(scene, material, maps)) {
        definitions.emplace_back("HAS_LIGHT_MAP");
    } else if (!scene.lights.empty()) {
        const Definitions lights = light_definitions(scene, material);
        definitions.insert(definitions.end(), lights.begin(), lights.end());
    }
    if (shot.layered()) definitions.emplace_back("SIX_VIEWS");
    return definitions;
}

void set_proxy(const Program& program, const Proxy& proxy, const Vec3d& captured_at) {
    program.set("u_captured_at", captured_at);
    if (const auto* box = std::get_if<BoxProxy>(&proxy)) {
        program.set("u_proxy_least", box->least);
        program.set("u_proxy_most", box->most);
    } else if (const auto* sphere = std::get_if<SphereProxy>(&proxy)) {
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

Mesh moved(const Mesh& mesh, const Transform& transform) {
    Mesh result = mesh;
    for (Vec3f& position : result.positions) position = Vec3f(transform.point(Vec3d(position)));
    for (Vec3f& normal : result.normals) normal = Vec3f(transform.normal(Vec3d(normal)));
    return result;
}

// The level of a cube with such faces whose texels are as large as pixels, if it is one for the
// whole picture: of a cube's own faces, and where no texel, not the smallest, in a face's corner,
// is smaller than the largest pixel, in the picture's middle.
std::optional<float> known_level(int face_size, const Shot& shot) {
    if (shot.face_size > 0)
        return std::log2(static_cast<float>(face_size) / static_cast<float>(shot.face_size));
    if (shot.height == 0) return std::nullopt;
    const Imath::M33d& ray = shot.views[0].ray;
    const double pixel = 2 * Vec3d(ray[1][0], ray[1][1], ray[1][2]).length() / shot.height;
    const double texel = 2.0 / face_size;
    const bool is_magnified = pixel * pixel <= texel * texel / std::pow(3, 1.5);
    return is_magnified ? std::optional(0.0f) : std::nullopt;
}

// One of a layered shot's views for each face, else one for all.
void set_to_clip(const Program& program, const Shot& shot) {
    if (shot.layered()) {
        std::vector<Imath::M44f> matrices;
        for (const View& view : shot.views) matrices.emplace_back(view.to_clip);
        program.set("u_face_to_clip", matrices);
    } else {
        program.set("u_to_clip", Imath::M44f(shot.views[0].to_clip));
    }
}

void set_ray(const Program& program, const Shot& shot) {
    if (shot.layered()) {
        std::vector<Imath::M33f> matrices;
        for (const View& view : shot.views) matrices.emplace_back(view.ray);
        program.set("u_face_ray", matrices);
    } else {
        program.set("u_ray", Imath::M33f(shot.views[0].ray));
    }
}

}  // namespace

// For normals: the inverse transpose.
Imath::M33f normal_matrix(const Imath::M44d& m) {
    Imath::M33d turn(m[0][0], m[0][1], m[0][2], m[1][0], m[1][1], m[1][2], m[2][0], m[2][1],
                     m[2][2]);
    turn.invert(true);
    turn.transpose();
    return Imath::M33f(turn);
}

float handedness(const Imath::M44d& m) {
    return m.determinant() < 0 ? -1.0f : 1.0f;
}

int map_size(const Scene& scene, const SceneAssets& assets) {
    return scene.map_size > 0 ? scene.map_size
                              : mirror_map_size(assets.environment, Projection::cube);
}

// Seen sharply whatever the method: a cube map as fine as the environment.
const Texture& Painter::background_for(const Scene& scene) {
    const int size = std::max(map_size(scene, *assets_),
                              mirror_map_size(assets_->environment, Projection::cube));
    if (!background_ || background_size_ != size) {
        EnvironmentMap cube =
            resample(assets_->environment, Projection::cube, size, default_axes(Projection::cube));
        append_mip_levels(cube);
        background_ = upload(cube);
        background_size_ = size;
    }
    return *background_;
}

double Painter::exposure_for(const Scene& scene) {
    if (scene.exposure <= 0 && !usual_exposure_)
        usual_exposure_ = usual_exposure(assets_->environment);
    return exposure_of(scene, usual_exposure_.value_or(1));
}

void Painter::set_assets(std::shared_ptr<const SceneAssets> assets) {
    std::erase_if(buffers_, [&](const auto& buffers) {
        return !is_same(assets_->meshes, assets->meshes, buffers.first);
    });
    if (!is_same(assets_->environment, assets->environment)) {
        background_.reset();
        usual_exposure_.reset();
    }
    textures_.set_assets(assets);
    bumps_.set_assets(assets);
    assets_ = std::move(assets);
}

const MeshBuffers& Painter::buffers_of(const SceneObject& object) {
    const auto found = buffers_.find(object.mesh);
    if (found != buffers_.end()) return found->second;
    return buffers_.emplace(object.mesh, MeshBuffers(mesh_of(object))).first->second;
}

void Painter::set_display(const Program& program, const Scene& scene) {
    program.set("u_exposure", static_cast<float>(exposure_for(scene)));
}

void Painter::set_material(const Program& program, const Material& material) {
    program.set("u_base_color", material.base_color);
    program.set("u_mirror", static_cast<float>(material.mirror));
    program.set("u_glossy", static_cast<float>(material.glossy));
    program.set("u_diffuse", static_cast<float>(material.diffuse));
    program.set("u_transmission", static_cast<float>(material.transmission));
    program.set("u_emission", static_cast<float>(material.emission));
    program.set("u_index", static_cast<float>(material.index));
    textures_.fresnel(material.fresnel).bind(kFresnelUnit);
    program.set("u_fresnel_map", kFresnelUnit);
    program.set("u_roughness", static_cast<float>(roughness_of(material.lobe)));
    program.set("u_exponent", static_cast<float>(exponent_of(material.lobe)));
    program.set("u_lobe_scale", static_cast<float>(lobe_scale(material.lobe)));
    if (material.coupling == Coupling::split_sum) {
        textures_.dfg().bind(kDfgUnit);
        program.set("u_dfg_table", kDfgUnit);
        program.set("u_f0", material.fresnel(1));
        program.set("u_f90", material.fresnel(0));
    }
    if (material.floor) {
        const Floor& floor = *material.floor;
        program.set("u_floor_height", static_cast<float>(floor.height));
        program.set("u_floor_color", floor.color);
        program.set("u_floor_absorption", floor.absorption);
        program.set("u_floor_width", static_cast<float>(floor.color_width));
        if (!floor.color_map.empty()) textures_.picture(floor.color_map).bind(kFloorUnit);
        program.set("u_floor_map", kFloorUnit);
    }
    if (!material.base_color_map.empty()) {
        textures_.picture(material.base_color_map).bind(kBaseColorUnit);
        program.set("u_base_color_map", kBaseColorUnit);
    }
}

void Painter::set_bump(const Program& program, const BumpMap& bump, double time) {
    bumps_.get(bump, time).bind(kBumpUnit);
    program.set("u_bump_map", kBumpUnit);
    program.set("u_bump_strength", static_cast<float>(bump.strength));
    program.set("u_bump_repeat", Imath::V2f(bump.repeat));
    program.set("u_bump_offset", Imath::V2f(offset_at(bump, time)));
    program.set("u_bump_relief", static_cast<float>(bump.relief));
    const Imath::M22f m(matrix_at(bump, time));
    const Imath::V4f rows(m[0][0], m[0][1], m[1][0], m[1][1]);
    program.set("u_bump_matrix", std::span(&rows, 1));
    program.set("u_bump_luminance", Imath::V2f(static_cast<float>(bump.luminance_scale),
                                               static_cast<float>(bump.luminance_offset)));
}

// Of an eye at +z of the maps' own frame, for the object's middle.
void Painter::make_light_map(const Scene& scene, const SceneObject& object,
                             const LookupMaps& maps) {
    if (!light_map_) light_map_.emplace();
    const Material& material = object.material;
    for (int layer = 0; layer < 2; ++layer) {
        Definitions definitions = light_definitions(scene, material);
        definitions.push_back(fmt::format("LAYER {}", layer));
        definitions.push_back(fmt::format("COUPLING {}", glsl_name(material.coupling)));
        if (material.glossy > 0) definitions.emplace_back("HAS_GLOSSY");
        const Program& program = programs_.get("full.vert", "light_map.frag", definitions);
        program.use();
        set_material(program, material);
        set_lights(program, lights_now(scene));
        program.set("u_centre", object.transform.point(buffers_of(object).bounds().centre()));
        program.set("u_to_world", to_map_matrix(maps.axes).transposed());
        light_map_->draw(layer, program);
    }
}

void Painter::set_maps(const Program& program, const Material& material,
                       const LookupMaps& maps) const {
    program.set("u_to_map", to_map_matrix(maps.axes));
    program.set("u_to_front", Imath::M44f(paraboloid_matrix(maps.axes, true)));
    program.set("u_to_back", Imath::M44f(paraboloid_matrix(maps.axes, false)));
    program.set("u_intensity", static_cast<float>(maps.intensity));
    set_proxy(program, maps.proxy, maps.captured_at);
    maps.diffuse->bind(kDiffuseUnit);
    if (maps.method != Method::cube_split) {
        maps.textures->mirror.bind(kMirrorUnit);
        if (material.glossy > 0) maps.textures->glossy[maps.lobe].bind(kGlossyUnit);
    }
    const Texture& rough = maps.textures->rough;
    if (!rough.empty()) {
        rough.bind(kRoughUnit);
        program.set("u_rough_map", kRoughUnit);
        program.set("u_rough_levels", static_cast<float>(rough.level_count));
        program.set("u_mirror_alpha", static_cast<float>(maps.mirror_alpha));
    }
    program.set("u_mirror_map", kMirrorUnit);
    program.set("u_glossy_map", kGlossyUnit);
    program.set("u_diffuse_map", kDiffuseUnit);
}

void Painter::draw_split(const SceneObject& object, const Vec3d& eye, const LookupMaps& maps,
                         const Program& program) {
    const SplitMeshBuffers split(
        split_by_cube_face(moved(mesh_of(object), object.transform), eye, maps.axes));
    program.set("u_to_world", Imath::M44f());
    program.set("u_normal_to_world", Imath::M33f());
    for (int face = 0; face < Cube::face_count; ++face) {
        maps.textures->mirror_faces[face].bind(kMirrorUnit);
        if (object.material.glossy > 0)
            maps.textures->glossy_faces[maps.lobe][face].bind(kGlossyUnit);
        split.draw(face);
    }
}

void Painter::begin() {
    make_cubes_seamless();
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glDepthMask(GL_TRUE);
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void Painter::object(const Scene& scene, const SceneObject& object, const LookupMaps& maps,
                     const Shot& shot) {
    if (maps.method == Method::dual_paraboloid_passes) {
        draw_object(scene, object, maps, shot, 1);
        draw_object(scene, object, maps, shot, 2);
    } else {
        draw_object(scene, object, maps, shot, 0);
    }
}

void Painter::draw_object(const Scene& scene, const SceneObject& object, const LookupMaps& maps,
                          const Shot& shot, int pass) {
    const bool has_light_map = gl::has_light_map(scene, object.material, maps);
    if (has_light_map) make_light_map(scene, object, maps);
    const Program& program = programs_.get(
        "surface.vert", "surface.frag", definitions_for(scene, object.material, maps, pass, shot),
        shot.layered() ? "surface.geom" : "");
    program.use();
    const Imath::M44d to_world = matrix(object.transform);
    program.set("u_to_world", Imath::M44f(to_world));
    program.set("u_normal_to_world", normal_matrix(to_world));
    program.set("u_handedness", handedness(to_world));
    set_to_clip(program, shot);
    program.set("u_eye", shot.views[0].eye);
    // What is made when it is first asked for takes the first unit for that, so maps come last.
    set_material(program, object.material);
    if (has_bump(object.material, maps)) set_bump(program, object.material.bump, scene.time);
    set_maps(program, object.material, maps);
    if (has_light_map) {
        light_map_->texture().bind(kLightMapUnit);
        program.set("u_light_map", kLightMapUnit);
    } else {
        set_lights(program, lights_now(scene));
    }
    set_display(program, scene);
    if (maps.method == Method::cube_split) {
        draw_split(object, shot.views[0].eye, maps, program);
    } else {
        buffers_of(object).draw();
    }
}

void Painter::background(const Scene& scene, const Shot& shot, bool plain) {
    const SceneEnvironment& environment = scene.environment;
    Definitions definitions = {fmt::format("PROXY {}", glsl_name(environment.proxy))};
    add_output(scene, shot, definitions);
    if (plain) definitions.emplace_back("PLAIN");
    const bool has_proxy = !std::holds_alternative<std::monostate>(environment.proxy);
    const Texture& cube = background_for(scene);
    const std::optional<float> level = has_proxy ? std::nullopt : known_level(cube.width, shot);
    if (level) definitions.emplace_back("LEVEL_KNOWN");
    if (shot.layered()) definitions.emplace_back("SIX_VIEWS");
    const Program& program = programs_.get("background.vert", "background.frag", definitions,
                                           shot.layered() ? "background.geom" : "");
    program.use();
    set_ray(program, shot);
    program.set("u_eye", shot.views[0].eye);
    program.set("u_background", environment.background_color);
    program.set("u_intensity", static_cast<float>(environment.intensity));
    program.set("u_to_map", to_map_matrix(turned(default_axes(Projection::cube), environment)));
    cube.bind(kMirrorUnit);
    if (level) program.set("u_level", *level);
    program.set("u_mirror_map", kMirrorUnit);
    set_proxy(program, environment.proxy, environment.captured_at);
    set_display(program, scene);
    glBindVertexArray(nothing_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

}  // namespace mirrorball::gl
