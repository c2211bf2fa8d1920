// The ideal mirror.
#include "brdf/directions.h"
#include "brdf/model.h"

namespace mirrorball::detail {
namespace {

class MirrorModel : public ModelOf<Mirror> {
  public:
    using ModelOf::ModelOf;

    Vec3d evaluate(const Vec3d&, const Vec3d&) const override { return Vec3d(0); }
    double density(const Vec3d&, const Vec3d&) const override { return 0; }
    Choice choose(const Vec3d& wo, const Vec3d&) const override {
        return {mirrored(wo), true, p_.fresnel(wo.z)};
    }
    Vec3d mirror_reflectance(const Vec3d& wo) const override { return p_.fresnel(wo.z); }
};

}  // namespace

ModelPointer make_model(const Mirror& parameters) {
    return std::make_shared<MirrorModel>(parameters);
}

}  // namespace mirrorball::detail
