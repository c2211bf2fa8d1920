// What a built-in environment is: radiance as a function of the world's direction.
//
// Each lives in a file of its own and knows nothing of images; rasterise.h turns any of them into
// texels. A light too small to be seen by samples (the sun) is kept apart as a disc, so that it can
// be drawn with its exact flux at any size.
#pragma once

#include <memory>
#include <optional>

#include <mirrorball/vector.h>

namespace mirrorball::detail {

/// A round light at infinity.
struct Disc {
    Vec3d direction;  ///< of its centre; unit length
    double radius;    ///< angle, radians

    [[nodiscard]] double solid_angle() const;
};

class Environment {
  public:
    virtual ~Environment() = default;

    /// Radiance from a unit direction in the world, without the disc. Finite and never negative.
    [[nodiscard]] virtual Vec3d radiance(const Vec3d& direction) const = 0;

    /// Samples this far apart (radians) miss nothing: no feature is narrower.
    [[nodiscard]] virtual double detail() const = 0;

    [[nodiscard]] virtual std::optional<Disc> disc() const { return std::nullopt; }
    /// Radiance that the disc adds in a unit direction inside of it.
    [[nodiscard]] virtual Vec3d disc_radiance(const Vec3d& /*direction*/) const {
        return {0, 0, 0};
    }
};

[[nodiscard]] std::unique_ptr<Environment> make_sunset();
[[nodiscard]] std::unique_ptr<Environment> make_noon();
[[nodiscard]] std::unique_ptr<Environment> make_studio();
[[nodiscard]] std::unique_ptr<Environment> make_axes_chart();
[[nodiscard]] std::unique_ptr<Environment> make_grid();
[[nodiscard]] std::unique_ptr<Environment> make_white();

}  // namespace mirrorball::detail
