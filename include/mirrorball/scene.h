// Scene: what a picture shows, as plain data. Meshes, pictures and environments are named here and
// loaded elsewhere (scene_assets.h); the same as a JSON file: scene_file.h, docs/scene.md.
//
// The world is right-handed, +X right, +Y up; lengths are metres, angles radians, colours
// scene-linear. Directions and equations are the survey's: n the normal, v to the eye, r mirrored.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <ImathMatrix.h>

#include <mirrorball/axes.h>
#include <mirrorball/bump.h>
#include <mirrorball/fresnel.h>
#include <mirrorball/lobe.h>
#include <mirrorball/projection.h>
#include <mirrorball/tone_map.h>
#include <mirrorball/vector.h>

namespace mirrorball {

/// How the light of a layer of mirror and the diffuse base under it come together.
enum class Coupling {
    added,      ///< Eq. 20: F L_layer + L_diffuse
    layered,    ///< Eq. 21: F L_layer + (1 - F) L_diffuse
    split_sum,  ///< (F0 A + F90 B) L_layer, as rough surfaces reflect, and the base gets the rest
};
/// "added", "layered", "split-sum"
[[nodiscard]] std::string_view name(Coupling coupling);
/// \throws Error(Errc::usage) naming the couplings there are
[[nodiscard]] Coupling parse_coupling(std::string_view name);

/// How relief that only shading sees disturbs reflections: section 7 of the survey.
enum class BumpForm {
    /// The normal turns in its tangent frame before anything is looked up, in any map of methods
    /// that work per pixel: cube EMBM.
    normals,
    /// Places on sphere maps move, by a matrix, and the normal stays: classic EMBM. Light of lights
    /// comes from a sphere map, too, the light map, made for each picture.
    classic,
};
/// "normals", "classic"
[[nodiscard]] std::string_view name(BumpForm form);
/// \throws Error(Errc::usage) naming the forms there are
[[nodiscard]] BumpForm parse_bump_form(std::string_view name);

/// What becomes of bumps that are too fine for a pixel.
enum class BumpFilter {
    none,  ///< nothing: one point of the finest level, of the bump and of what it reflects;
           ///< sparkles
    mean,  ///< they cancel out, and the surface gets smoother than it is: plain mip levels
    /// They make it rougher: alpha'^2 = alpha^2 + ln 2 variance (1 + (n.v)^2), of GGX, whose lobe
    /// then has the median of that of so many normally distributed slopes; of mirrors and of any
    /// glossy lobe. docs/bump.md has its error.
    variance,
};
/// "none", "mean", "variance"
[[nodiscard]] std::string_view name(BumpFilter filter);
/// \throws Error(Errc::usage) naming the filters there are
[[nodiscard]] BumpFilter parse_bump_filter(std::string_view name);

/// Relief of a material, by the texture coordinates (s, t) of its mesh. Slopes are taken as the
/// source has them, in metres per metre, however large the mesh makes its tiles.
struct BumpMap {
    std::string source;              ///< of bump_sources(), or a picture; empty: smooth
    std::optional<BumpKind> kind;    ///< of a picture; else grey ones are heights
    Green green = Green::up;         ///< of a picture of normals
    Wrap wrap = Wrap::repeat;        ///< of a picture; sources are tiles
    double height_scale = 1;         ///< metres per value of a picture of heights
    double width = 0;                ///< metres that it covers; 0: 1, or the source's own
    int size = 512;                  ///< of a source, in texels; 1 to 4096
    Imath::V2d repeat{1};            ///< tiles from (0, 0) to (1, 1)
    Imath::V2d offset{0}, drift{0};  ///< of tiles; and what is added to it each second
    double strength = 1;             ///< multiplies slopes; -100 to 100
    BumpForm form = BumpForm::normals;
    BumpFilter filter = BumpFilter::variance;

    // Of the form `normals`.
    double relief =
        0;  ///< depth of the relief, which the eye looks into, in tiles; 0 to 1; 0: flat
    bool horizon = true;  ///< do reflections into the surface get darker?

    /// Of the form `classic`, (m00 m01; m10 m11):
    ///
    ///     s' = s + m00 dH/ds + m01 dH/dt        (s, t) on the sphere map
    ///     t' = t + m10 dH/ds + m11 dH/dt
    ///
    /// -1/2 is what the normals of a surface that faces the eye would do. Direct3D has m01 and m10
    /// the other way round. With luminance L, the height from 0 (lowest) to 1, light is multiplied
    /// by luminance_scale L + luminance_offset, clamped to 0 to 1.
    Imath::M22d matrix{-0.5, 0, 0, -0.5};
    double matrix_turn = 0;  ///< radians per second, by which it is turned
    double luminance_scale = 0, luminance_offset = 1;

    [[nodiscard]] bool is_smooth() const { return source.empty(); }
    bool operator==(const BumpMap&) const = default;
};

/// A level, diffuse plane, seen through a surface that transmits.
struct Floor {
    double height = -1;      ///< y, in the world
    Vec3d color{0.5};        ///< 0 to 1
    std::string color_map;   ///< a picture that multiplies it, repeated; or none
    double color_width = 1;  ///< metres that the picture covers
    Vec3d absorption{0};     ///< of what is above it, per metre: e^(-absorption length); 0 to 1000

    bool operator==(const Floor&) const = default;
};

/// The survey's figure 4.1, each term with its weight, and F the Fresnel term:
///
///     L_layer    = mirror L(r) + glossy L_lobe(r)
///     L_diffuse  = diffuse base_color E(n) / pi
///     L_glass    = transmission base_color (1 - F) L(t),  t refracted by `index`
///     L_own      = emission base_color, in all directions
///
/// L is the environment, L_lobe the same prefiltered by `lobe`, E its irradiance.
struct Material {
    Vec3d base_color{1};         ///< 0 to 1
    std::string base_color_map;  ///< a picture that multiplies it, by texture coordinates; or none
    double mirror = 1, glossy = 0, diffuse = 0, transmission = 0;  ///< 0 to 1
    double emission = 0;  ///< radiance of its own, of lamps and pictures on walls; 0 to 1e12
    /// Of the glossy term: phong, blinn-phong, ggx or charlie. \see Lobe
    Lobe lobe{Lobe::Kind::ggx, 0.3, nullptr};
    Fresnel fresnel;  ///< 1 at every angle unless it is said
    Coupling coupling = Coupling::layered;
    double index = 1.5;  ///< of refraction, for `transmission`; 0.01 to 100
    /// What refracted rays that go down meet, instead of the environment: base_color (1 - F) times
    /// color E(up) / pi, dimmed along the way. It is lit by the environment alone.
    std::optional<Floor> floor;
    BumpMap bump;

    bool operator==(const Material&) const = default;
};

/// Scale, then turn as rotated() of axes.h turns, then move.
struct Transform {
    Vec3d position{0};
    double yaw = 0, pitch = 0, roll = 0;
    Vec3d scale{1};  ///< not 0

    [[nodiscard]] Vec3d point(const Vec3d& p) const;
    /// Of the surface thus moved, unit.
    [[nodiscard]] Vec3d normal(const Vec3d& n) const;

    bool operator==(const Transform&) const = default;
};
/// The same for row vectors, as Imath multiplies: p * matrix(t) == t.point(p). Its sixteen numbers
/// in their order are those of OpenGL's matrix for columns.
[[nodiscard]] Imath::M44d matrix(const Transform& transform);

/// How the faces of a cube map are drawn; what comes out is the same.
enum class FaceDrawing {
    texture,  ///< each as what is drawn into: six passes
    copy,     ///< each drawn as a picture and copied into the map: the survey's glCopyTexSubImage2D
    one_pass,  ///< all six at once, by a geometry shader: desktop OpenGL only; always all faces
};
/// "texture", "copy", "one-pass"
[[nodiscard]] std::string_view name(FaceDrawing drawing);
/// \throws Error(Errc::usage) naming those there are
[[nodiscard]] FaceDrawing parse_face_drawing(std::string_view name);

/// A map of what is around an object, made anew for every picture from the middle of the object's
/// bounds, without the object itself.
struct DynamicReflection {
    int size = 256;           ///< edge of a face in texels, 16 to 4096
    int faces_per_frame = 6;  ///< 1 to 6: how many are drawn anew for each picture but the first
    /// 1 to 8: how often light goes to and fro between such objects. At 1 the others are seen in
    /// the map as they reflect the environment alone; at n as they reflect maps of n - 1 bounces.
    int bounces = 1;
    FaceDrawing drawing = FaceDrawing::texture;

    bool operator==(const DynamicReflection&) const = default;
};

struct SceneObject {
    std::string name;
    std::string mesh = "sphere";  ///< of builtin_meshes(), or a file
    Transform transform;
    Material material;
    std::optional<DynamicReflection> dynamic;  ///< else it reflects the environment

    bool operator==(const SceneObject&) const = default;
};

/// What stands in for the geometry around a map that was captured in a room, so that it is not seen
/// as if infinitely far away: a ray meets the proxy, and the map is asked for the direction from
/// where it was captured to there.
struct BoxProxy {
    Vec3d least{-1}, most{1};  ///< least < most

    bool operator==(const BoxProxy&) const = default;
};
struct SphereProxy {
    Vec3d centre{0};
    double radius = 1;

    bool operator==(const SphereProxy&) const = default;
};
using Proxy = std::variant<std::monostate, BoxProxy, SphereProxy>;

struct SceneEnvironment {
    std::string source = "builtin:sunset";  ///< as read_map() takes it
    double yaw = 0, pitch = 0, roll = 0;    ///< as rotated() of axes.h
    double intensity = 1;                   ///< multiplies its radiance; 0 to 1e6
    bool background = true;                 ///< is it seen behind the objects?
    Vec3d background_color{0};              ///< where it is not
    Proxy proxy;
    Vec3d captured_at{0};  ///< where the map was taken; matters with a proxy only

    bool operator==(const SceneEnvironment&) const = default;
};

struct ScenePointLight {
    Vec3d position{0, 3, 0};
    Vec3d intensity{10};  ///< W/sr
    double turn = 0;      ///< radians per second about the world's y axis, as Transform::yaw turns

    bool operator==(const ScenePointLight&) const = default;
};
struct SceneDirectionalLight {
    Vec3d direction{0, 1, 0};    ///< towards the light; any length but 0
    Vec3d normal_irradiance{1};  ///< W/m^2
    double turn = 0;             ///< as of a point light

    bool operator==(const SceneDirectionalLight&) const = default;
};
using SceneLight = std::variant<ScenePointLight, SceneDirectionalLight>;

struct Camera {
    Vec3d eye{0, 0, 5}, target{0}, up{0, 1, 0};
    double field_of_view = 0.6;  ///< vertical; 0.1 to 179 degrees

    bool operator==(const Camera&) const = default;
};
/// x to the right, y upwards, z back towards the eye: right-handed, unit, in the world. `up` only
/// needs to be roughly so; any will do if one looks along it. \pre eye != target
[[nodiscard]] Axes axes(const Camera& camera);
/// The unit direction from the eye through a point of the picture: x from 0 to 1 to the right, y
/// down; `aspect` is width over height.
[[nodiscard]] Vec3d view_ray(const Camera& camera, double x, double y, double aspect);
/// Looks at the middle of the ball around `bounds` from `yaw` to the right of +z and `pitch` above,
/// so far away that the ball fits.
struct Bounds;
[[nodiscard]] Camera framing(const Bounds& bounds, double aspect = 1, double yaw = 0.45,
                             double pitch = 0.3, double field_of_view = Camera().field_of_view);

/// How reflections are looked up: sections 2 and 3 of the survey. name() and parse_method() spell
/// them as below, with - for _. docs/rendering.md shows each.
enum class Method {
    sphere,                  ///< per pixel, map re-made for the camera
    sphere_vertex,           ///< the same per vertex, as glTexGen's GL_SPHERE_MAP
    sphere_stale,            ///< per pixel, map left as made for a camera that looks along -z
    cube,                    ///< per pixel
    cube_vertex,             ///< r per vertex, interpolated: GL_REFLECTION_MAP
    cube_seams,              ///< per pixel, faces filtered apart from each other
    cube_split,              ///< polygons cut where they reflect into two faces; 2-D textures
    dual_paraboloid,         ///< per pixel
    dual_paraboloid_vertex,  ///< per vertex by the matrices of Eq. 4-7, both maps in one pass
    dual_paraboloid_passes,  ///< the same in two passes, each masked by its map's disc
    equirect,                ///< per pixel
    octahedral,              ///< per pixel
};
[[nodiscard]] std::vector<Method> all_methods();
[[nodiscard]] std::string_view name(Method method);
[[nodiscard]] std::string_view describe(Method method);
/// \throws Error(Errc::usage) naming the methods there are
[[nodiscard]] Method parse_method(std::string_view name);
/// The projection whose maps it looks up.
[[nodiscard]] Projection projection_of(Method method);

/// Can such a method show a bump map? The classic form takes sphere maps, the other lookups per
/// pixel.
[[nodiscard]] bool can_show(Method method, const BumpMap& bump);

struct Scene {
    std::vector<SceneObject> objects;
    SceneEnvironment environment;
    std::vector<SceneLight> lights;
    Camera camera;
    Method method = Method::cube;
    int map_size = 0;     ///< of the map that mirrors show, to 16384; 0: as the environment's
    double exposure = 0;  ///< to 1e12; 0: the environment's usual_exposure()
    ToneMap tone_map = ToneMap::film;
    double time = 0;  ///< seconds, of what moves: bumps and lights; -1e6 to 1e6

    bool operator==(const Scene&) const = default;
};

/// Where the scene's lights are at its time.
[[nodiscard]] std::vector<SceneLight> lights_now(const Scene& scene);
/// A bump's offset and matrix at a time.
[[nodiscard]] Imath::V2d offset_at(const BumpMap& bump, double time);
[[nodiscard]] Imath::M22d matrix_at(const BumpMap& bump, double time);

/// The exposure that a scene asks for, or the one that suits an environment whose usual_exposure()
/// is given. A dark environment, of intensity 0, says nothing about lights.
[[nodiscard]] double exposure_of(const Scene& scene, double usual_exposure);

}  // namespace mirrorball
