// Direct evaluation: what a scene's surfaces send to the eye, by the equations and on the
// processor. The truth that renderers are held against. Equations: Material in scene.h and
// docs/scene.md.
#pragma once

#include <memory>

#include <mirrorball/image.h>
#include <mirrorball/reflection_maps.h>
#include <mirrorball/scene.h>
#include <mirrorball/scene_assets.h>

namespace mirrorball {

/// What is seen through each pixel's centre: images of one size.
struct SurfaceBuffer {
    Image position;             ///< of the world
    Image normal;               ///< of the world, unit, on the mesh's outer side
    Image object;               ///< one channel: index in Scene::objects, or -1 for none
    Image texture_coordinates;  ///< two channels; (0, 0) is top left
    /// x and y of the tangent frame (bump.h), of the world: slopes du, dv turn the normal to
    /// normal - du tangent - dv bitangent. 0 where the mesh has none; empty if no object has.
    Image tangent = {}, bitangent = {};
};

/// A point of a surface.
struct SurfacePoint {
    Vec3d position, normal;  ///< of the world; the normal is unit, on the outer side
    Vec2f texture_coordinates{0, 0};
    Vec3d tangent{0}, bitangent{0};  ///< as in SurfaceBuffer
};

/// A scene made ready to be evaluated anywhere. May be used from many threads at once.
///
/// Surfaces have two sides: one seen from behind has its normal turned. Of a glass seen so, the eye
/// is in the medium: directions are refracted outwards, F is taken at the angle outside, and where
/// no light gets out, F is that of grazing light. Maps are looked up at their finest level, bump
/// maps too, so that of a filter of bumps this is the truth for a point, not for a pixel.
class DirectShading {
  public:
    /// \pre all outlive this; `maps` are of the environment as the scene turns it, have the lobes
    /// of its glossy materials, and are sphere maps if one has a bump map of the classic form
    DirectShading(const Scene& scene, const SceneAssets& assets, const ReflectionMaps& maps);
    ~DirectShading();

    /// Radiance from a point of an object to the eye.
    [[nodiscard]] Vec3d surface(std::size_t object, const SurfacePoint& point,
                                const Vec3d& eye) const;
    /// Radiance to the eye from the direction in which it looks, where no object is.
    [[nodiscard]] Vec3d background(const Vec3d& eye, const Vec3d& direction) const;

  private:
    class Impl;
    std::unique_ptr<const Impl> impl_;
};

/// A picture, three channels of linear radiance. The same bits at any number of threads. About 0.2
/// us per pixel and map; 10 ms more per material coupled by split_sum, whose A and B are tabulated,
/// within 2e-5.
[[nodiscard]] Image shade(const Scene& scene, const SceneAssets& assets, const ReflectionMaps& maps,
                          const SurfaceBuffer& surfaces, const Progress& progress = {});

/// The direction from where the environment was captured to where the ray from `position` meets the
/// proxy: what to look up in the map. `direction` itself where there is no proxy, or it is missed.
[[nodiscard]] Vec3d seen_from_capture(const SceneEnvironment& environment, const Vec3d& position,
                                      const Vec3d& direction);

/// t, where light that leaves towards v, unit, came from; `index` is that of the medium behind the
/// surface over that in front of it, n and v being in front. Zero where there is none: total
/// reflection, for index < 1.
[[nodiscard]] Vec3d refracted(const Vec3d& v, const Vec3d& n, double index);

/// The roughness at which a GGX surface is as wide about its axis as the lobe: for tables by
/// roughness. phong:N and blinn-phong:4N are alike, (2 / (4N + 2))^(1/4); charlie has its own.
[[nodiscard]] double roughness_of(const Lobe& lobe);

}  // namespace mirrorball
