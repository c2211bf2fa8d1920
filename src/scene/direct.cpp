// Direct evaluation. Terms stand in the order in which scene.h has them.
#include <mirrorball/direct.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <mirrorball/brdf.h>
#include <mirrorball/dfg.h>
#include <mirrorball/light.h>
#include <mirrorball/lookup.h>

#include <mirrorball/projections/sphere.h>

#include "core/parallel.h"
#include "scene/bump_lookup.h"
#include "scene/picture_lookup.h"

namespace mirrorball {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

// How much of each layer's light reaches the eye.
struct Weights {
    Vec3d layer, base;
    Vec3d compensation{1};  // of microfacets, for what scatters more than once
};

// A and B of one roughness by the cosine, tabulated: exact ones take too long for each pixel. The
// samples are at squares, close to each other where the curves bend, next to grazing view.
class DfgCurve {
  public:
    explicit DfgCurve(double roughness) {
        for (int i = 0; i <= kSteps; ++i) {
            const double root = static_cast<double>(i) / kSteps;
            samples_.push_back(ggx_dfg(root * root, roughness));
        }
    }

    [[nodiscard]] Dfg operator()(double cosine) const {
        const double place = std::sqrt(cosine) * kSteps;
        const int i = std::min(static_cast<int>(place), kSteps - 1);
        const double share = place - i;
        const Dfg &a = samples_[i], &b = samples_[i + 1];
        return {a.scale + (b.scale - a.scale) * share, a.bias + (b.bias - a.bias) * share};
    }

  private:
    static constexpr int kSteps = 1024;

    std::vector<Dfg> samples_;
};

Weights split_sum_weights(const Material& material, const DfgCurve& curve, double cosine) {
    const Dfg dfg = curve(cosine);
    const Vec3d f0 = material.fresnel(1), f90 = material.fresnel(0);
    const Vec3d compensation = energy_compensation(f0, dfg.albedo());
    const Vec3d reflected = (f0 * dfg.scale + f90 * dfg.bias) * compensation;
    const auto rest = [](double share) { return std::max(0.0, 1 - share); };
    return {reflected, {rest(reflected.x), rest(reflected.y), rest(reflected.z)}, compensation};
}

Weights fresnel_weights(const Material& material, double cosine) {
    const Coating coating =
        material.coupling == Coupling::added ? Coating::off : Coating::transparent;
    const LayerWeights weights = layer_weights(coating, material.fresnel, cosine);
    return {weights.mirror, weights.diffuse};
}

// The glossy term as a BRDF, for lights without extent; none of those it does not show.
std::optional<Brdf> glossy_brdf(const Material& material) {
    if (material.glossy == 0) return std::nullopt;
    const Lobe& lobe = material.lobe;
    switch (lobe.kind) {
        case Lobe::Kind::phong:
            return Phong{.exponent = std::min(lobe.parameter, 1e6)};
        case Lobe::Kind::blinn_phong:
            return BlinnPhong{.exponent = std::min(lobe.parameter, 1e6)};
        case Lobe::Kind::ggx:
            return Microfacet{.roughness_x = lobe.parameter,
                              .roughness_y = lobe.parameter,
                              .fresnel = material.fresnel};
        case Lobe::Kind::charlie:
            return Sheen{.roughness = lobe.parameter};
        default:
            return std::nullopt;
    }
}

// Any frame about the normal: the BRDFs are isotropic.
Axes frame_about(const Vec3d& n) {
    const Vec3d aside = std::abs(n.x) < 0.5 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
    const Vec3d x = n.cross(aside).normalized();
    return {x, n.cross(x), n};
}

// Along the ray, to the far side of the box; infinite if the ray misses it.
double distance_to(const BoxProxy& box, const Vec3d& p, const Vec3d& d) {
    double near = 0, far = kInfinite;
    for (int i = 0; i < 3; ++i) {
        if (d[i] == 0) {
            if (p[i] < box.least[i] || p[i] > box.most[i]) return kInfinite;
            continue;
        }
        const double a = (box.least[i] - p[i]) / d[i], b = (box.most[i] - p[i]) / d[i];
        near = std::max(near, std::min(a, b));
        far = std::min(far, std::max(a, b));
    }
    return near <= far ? far : kInfinite;
}

double distance_to(const SphereProxy& sphere, const Vec3d& p, const Vec3d& d) {
    const Vec3d from_centre = p - sphere.centre;
    const double d2 = d.dot(d), b = from_centre.dot(d) / d2;
    const double c = (from_centre.dot(from_centre) - sphere.radius * sphere.radius) / d2;
    if (b * b < c) return kInfinite;
    const double far = std::sqrt(b * b - c) - b;
    return far >= 0 ? far : kInfinite;
}

double distance_to(std::monostate, const Vec3d& /*p*/, const Vec3d& /*d*/) {
    return kInfinite;
}

}  // namespace

Vec3d seen_from_capture(const SceneEnvironment& environment, const Vec3d& position,
                        const Vec3d& direction) {
    const double t =
        std::visit([&](const auto& proxy) { return distance_to(proxy, position, direction); },
                   environment.proxy);
    if (t == kInfinite) return direction;
    const Vec3d seen = position + direction * t - environment.captured_at;
    return seen == Vec3d(0) ? direction : seen;  // captured on the very wall
}

Vec3d refracted(const Vec3d& v, const Vec3d& n, double index) {
    const double cosine = n.dot(v), ratio = 1 / index;
    const double behind2 = 1 - ratio * ratio * (1 - cosine * cosine);
    if (behind2 <= 0) return Vec3d(0);
    return n * (ratio * cosine - std::sqrt(behind2)) - v * ratio;
}

double roughness_of(const Lobe& lobe) {
    switch (lobe.kind) {
        case Lobe::Kind::ggx:
        case Lobe::Kind::charlie:
            return lobe.parameter;
        case Lobe::Kind::phong:
            return std::pow(2 / (4 * lobe.parameter + 2), 0.25);
        case Lobe::Kind::blinn_phong:
            return std::pow(2 / (lobe.parameter + 2), 0.25);
        default:
            return 0;
    }
}

class DirectShading::Impl {
  public:
    Impl(const Scene& scene, const SceneAssets& assets, const ReflectionMaps& maps)
        : scene_(scene),
          assets_(assets),
          maps_(maps),
          unturned_(turned(Axes(), scene.environment)),
          lights_(lights_now(scene)) {
        for (const SceneObject& object : scene.objects) surfaces_.push_back(surface_of(object));
    }

    [[nodiscard]] Vec3d surface(std::size_t object, const SurfacePoint& point,
                                const Vec3d& eye) const {
        const Material& material = scene_.objects[object].material;
        const Surface& surface = surfaces_[object];
        const View view = view_of(material, surface, point, eye);
        const Weights weights = weights_of(material, surface, view.fresnel_cosine);
        Vec3d base_color = material.base_color;
        if (surface.picture != nullptr)
            base_color *=
                detail::look_up_picture(*surface.picture, view.texture_coordinates, Wrap::repeat);
        const Vec3d mapped = weights.layer * layer_light(material, surface, point.position, view) +
                             weights.base * diffuse_light(material, view) * base_color;
        const Vec3d from_environment =
            mapped * view.luminance +
            glass_light(material, surface, point.position, view) * base_color;
        return from_environment * scene_.environment.intensity + base_color * material.emission +
               light_of_lights(material, surface, base_color, point.position, view, weights) *
                   view.luminance;
    }

    [[nodiscard]] Vec3d background(const Vec3d& eye, const Vec3d& direction) const {
        const SceneEnvironment& environment = scene_.environment;
        if (!environment.background) return environment.background_color;
        const Vec3d seen = unturned_.to_map(seen_from_capture(environment, eye, direction));
        return Vec3d(look_up(assets_.environment, seen)) * environment.intensity;
    }

  private:
    struct Surface {
        const EnvironmentMap* glossy_map = nullptr;
        std::optional<Brdf> glossy_brdf;
        std::optional<DfgCurve> dfg;  // of those coupled by split_sum
        const Image* picture = nullptr;
        const Image* floor_picture = nullptr;
        std::optional<detail::BumpLookup> bump;
        Vec3d centre{0};  // where light maps are made for
    };

    // Directions at a point, the normal on the eye's side.
    struct View {
        Vec3d n, v, r;
        Vec3d t;                // zero: nothing is seen through the surface
        double fresnel_cosine;  // at which F is taken
        Imath::V2d texture_coordinates;
        double above_horizon = 1;
        std::optional<Imath::V2d> shift;  // on sphere maps: the bump's, of the classic form
        double luminance = 1;
    };

    [[nodiscard]] Surface surface_of(const SceneObject& object) const {
        Surface surface;
        const Material& material = object.material;
        if (material.glossy > 0) surface.glossy_map = &maps_.glossy[maps_.index_of(material.lobe)];
        surface.glossy_brdf = glossy_brdf(material);
        if (material.coupling == Coupling::split_sum)
            surface.dfg.emplace(roughness_of(material.lobe));
        if (!material.base_color_map.empty())
            surface.picture = &assets_.pictures.at(material.base_color_map);
        if (material.floor && !material.floor->color_map.empty())
            surface.floor_picture = &assets_.pictures.at(material.floor->color_map);
        if (!material.bump.is_smooth()) {
            surface.bump.emplace(material.bump, assets_, scene_.time);
            surface.centre =
                object.transform.point(bounds(assets_.meshes.at(object.mesh)).centre());
        }
        return surface;
    }

    static Weights weights_of(const Material& material, const Surface& surface, double cosine) {
        return surface.dfg ? split_sum_weights(material, *surface.dfg, cosine)
                           : fresnel_weights(material, cosine);
    }

    static View view_of(const Material& material, const Surface& surface, const SurfacePoint& point,
                        const Vec3d& eye) {
        View view;
        // an eye at the very point, or a point without a normal: the surface faces the eye
        const Vec3d fallback = point.normal == Vec3d(0) ? Vec3d(0, 0, 1) : point.normal;
        view.v = (eye == point.position ? fallback : eye - point.position).normalized();
        const Vec3d smooth = point.normal == Vec3d(0) ? view.v : point.normal.normalized();
        const bool behind = smooth.dot(view.v) < 0;
        view.n = smooth;
        view.texture_coordinates = Imath::V2d(point.texture_coordinates);
        if (surface.bump) add_bump(material.bump, *surface.bump, point, smooth, behind, view);
        if (behind) view.n = -view.n;
        const double cosine = std::clamp(view.n.dot(view.v), 0.0, 1.0);
        view.r = view.n * (2 * view.n.dot(view.v)) - view.v;
        if (surface.bump && !view.shift && material.bump.horizon)
            view.above_horizon = detail::above_horizon(view.r, behind ? -smooth : smooth);
        view.t = Vec3d(0);
        view.fresnel_cosine = cosine;
        if (material.transmission > 0) {
            view.t = refracted(view.v, view.n, behind ? 1 / material.index : material.index);
            // F is the same along a ray to either side, and curves are for the outer one.
            if (behind) view.fresnel_cosine = std::clamp(-view.n.dot(view.t), 0.0, 1.0);
        }
        return view;
    }

    static void add_bump(const BumpMap& map, const detail::BumpLookup& bump,
                         const SurfacePoint& point, const Vec3d& smooth, bool behind, View& view) {
        Imath::V2d place = bump.place(view.texture_coordinates);
        if (map.form == BumpForm::classic) {
            view.shift = bump.shift(bump.slopes(place));
            view.luminance = bump.luminance(place);
            return;
        }
        const Vec3d in_frame(view.v.dot(point.tangent.normalized()),
                             view.v.dot(point.bitangent.normalized()), view.v.dot(smooth));
        if (!behind && map.relief > 0) {
            place = bump.seen_in_relief(place, in_frame);
            view.texture_coordinates = bump.texture_coordinates(place);
        }
        const Imath::V2d slopes = bump.slopes(place);
        view.n = (smooth - point.tangent * slopes.x - point.bitangent * slopes.y).normalized();
    }

    [[nodiscard]] Vec3d seen(const EnvironmentMap& map, const Vec3d& position,
                             const Vec3d& direction, const View& view) const {
        const Vec3d seen = seen_from_capture(scene_.environment, position, direction);
        return Vec3d(
            look_up(map, view.shift ? detail::moved_direction(map.axes, seen, *view.shift) : seen));
    }

    [[nodiscard]] Vec3d layer_light(const Material& material, const Surface& surface,
                                    const Vec3d& position, const View& view) const {
        Vec3d sum(0);
        if (material.mirror > 0)
            sum += seen(maps_.mirror, position, view.r, view) * material.mirror;
        if (material.glossy > 0)
            sum += seen(*surface.glossy_map, position, view.r, view) * material.glossy;
        return sum * view.above_horizon;
    }

    [[nodiscard]] Vec3d diffuse_light(const Material& material, const View& view) const {
        if (material.diffuse == 0) return Vec3d(0);
        const Vec3d n =
            view.shift ? detail::moved_direction(maps_.diffuse.axes, view.n, *view.shift) : view.n;
        return Vec3d(look_up(maps_.diffuse, n)) * (material.diffuse / kPi);
    }

    [[nodiscard]] Vec3d glass_light(const Material& material, const Surface& surface,
                                    const Vec3d& position, const View& view) const {
        if (view.t == Vec3d(0)) return Vec3d(0);
        const Vec3d passes = Vec3d(1) - material.fresnel(view.fresnel_cosine);
        const std::optional<Vec3d> floor = floor_light(material, surface, position, view.t);
        const Vec3d light =
            floor ? *floor
                  : Vec3d(look_up(maps_.mirror,
                                  seen_from_capture(scene_.environment, position, view.t)));
        return light * passes * material.transmission;
    }

    // None where there is no floor in that direction.
    [[nodiscard]] std::optional<Vec3d> floor_light(const Material& material, const Surface& surface,
                                                   const Vec3d& position, const Vec3d& t) const {
        if (!material.floor || t.y >= 0 || position.y <= material.floor->height)
            return std::nullopt;
        const Floor& floor = *material.floor;
        const double length = (floor.height - position.y) / t.y;
        const Vec3d there = position + t * length;
        Vec3d color = floor.color;
        if (surface.floor_picture != nullptr)
            color *= detail::look_up_picture(*surface.floor_picture,
                                             Imath::V2d(there.x, there.z) / floor.color_width,
                                             Wrap::repeat);
        const Vec3d passes(std::exp(-floor.absorption.x * length),
                           std::exp(-floor.absorption.y * length),
                           std::exp(-floor.absorption.z * length));
        return color * Vec3d(look_up(maps_.diffuse, Vec3d(0, 1, 0))) * passes / kPi;
    }

    // Eq. 15; of bumps of the classic form, where their light map has been made.
    [[nodiscard]] Vec3d light_of_lights(const Material& material, const Surface& surface,
                                        const Vec3d& base_color, const Vec3d& position,
                                        const View& view, const Weights& weights) const {
        if (!view.shift)
            return light_of_lights(material, surface, base_color, position, view.n, view.v,
                                   weights);
        const Axes& axes = maps_.mirror.axes;
        const FacePoint<double> place = detail::moved_place(axes, view.r, *view.shift);
        const double x = 2 * place.s - 1, y = 1 - 2 * place.t;
        const double z = std::sqrt(std::max(0.0, 1 - x * x - y * y));
        return light_of_lights(material, surface, base_color, surface.centre,
                               axes.to_world({x, y, z}), axes.z, weights_of(material, surface, z));
    }

    [[nodiscard]] Vec3d light_of_lights(const Material& material, const Surface& surface,
                                        const Vec3d& base_color, const Vec3d& position,
                                        const Vec3d& n, const Vec3d& v,
                                        const Weights& weights) const {
        if (lights_.empty()) return Vec3d(0);
        const Axes frame = frame_about(n);
        const Vec3d wo = frame.to_map(v);
        const Vec3d base = weights.base * base_color * (material.diffuse / kPi);
        const bool microfacets = material.lobe.kind == Lobe::Kind::ggx;
        const Vec3d layer = (microfacets ? weights.compensation : weights.layer) * material.glossy;
        Vec3d sum(0);
        for (const SceneLight& light : lights_) {
            const auto [wi, arriving] = arriving_from(light, position, frame);
            if (arriving == Vec3d(0)) continue;
            Vec3d f = base;
            if (surface.glossy_brdf) f += layer * surface.glossy_brdf->evaluate(wi, wo);
            sum += f * arriving;
        }
        return sum;
    }

    struct Arriving {
        Vec3d direction;   // in the surface's frame
        Vec3d irradiance;  // on the surface
    };

    static Arriving arriving_from(const SceneLight& light, const Vec3d& position,
                                  const Axes& frame) {
        if (const auto* sun = std::get_if<SceneDirectionalLight>(&light)) {
            const Vec3d direction = frame.to_map(sun->direction.normalized());
            return {direction, irradiance(DirectionalLight{direction, sun->normal_irradiance})};
        }
        const auto& point = std::get<ScenePointLight>(light);
        const Vec3d place = frame.to_map(point.position - position);
        if (place == Vec3d(0)) return {place, Vec3d(0)};
        return {place.normalized(), irradiance(PointLight{place, point.intensity})};
    }

    const Scene& scene_;
    const SceneAssets& assets_;
    const ReflectionMaps& maps_;
    Axes unturned_;                   // the world's, of which the environment knows nothing
    std::vector<SceneLight> lights_;  // where they are at the scene's time
    std::vector<Surface> surfaces_;   // one per object
};

DirectShading::DirectShading(const Scene& scene, const SceneAssets& assets,
                             const ReflectionMaps& maps)
    : impl_(std::make_unique<const Impl>(scene, assets, maps)) {}

DirectShading::~DirectShading() = default;

Vec3d DirectShading::surface(std::size_t object, const SurfacePoint& point,
                             const Vec3d& eye) const {
    return impl_->surface(object, point, eye);
}

Vec3d DirectShading::background(const Vec3d& eye, const Vec3d& direction) const {
    return impl_->background(eye, direction);
}

Image shade(const Scene& scene, const SceneAssets& assets, const ReflectionMaps& maps,
            const SurfaceBuffer& surfaces, const Progress& progress) {
    const int width = surfaces.object.width(), height = surfaces.object.height();
    const double aspect = static_cast<double>(width) / height;
    const DirectShading shading(scene, assets, maps);
    Image result(width, height, 3);
    const auto shade_row = [&](std::int64_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < width; ++x) {
            const int object = static_cast<int>(*surfaces.object.at(x, y));
            Vec3d radiance;
            if (object < 0) {
                const Vec3d ray =
                    view_ray(scene.camera, (x + 0.5) / width, (y + 0.5) / height, aspect);
                radiance = shading.background(scene.camera.eye, ray);
            } else {
                const float* place = surfaces.texture_coordinates.at(x, y);
                SurfacePoint point{Vec3d(surfaces.position.rgb(x, y)),
                                   Vec3d(surfaces.normal.rgb(x, y)),
                                   {place[0], place[1]}};
                if (!surfaces.tangent.empty()) {
                    point.tangent = Vec3d(surfaces.tangent.rgb(x, y));
                    point.bitangent = Vec3d(surfaces.bitangent.rgb(x, y));
                }
                radiance =
                    shading.surface(static_cast<std::size_t>(object), point, scene.camera.eye);
            }
            result.set_rgb(x, y, Vec3f(radiance));
        }
    };
    detail::parallel_for(height, shade_row, progress);
    return result;
}

}  // namespace mirrorball
