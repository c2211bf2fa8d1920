// A furnace: radiance 1 from everywhere. Whatever is lit by it and reflects all light disappears.
#include "environment.h"

namespace mirrorball::detail {
namespace {

class White final : public Environment {
  public:
    [[nodiscard]] Vec3d radiance(const Vec3d& /*direction*/) const override { return {1, 1, 1}; }
    [[nodiscard]] double detail() const override { return kPi; }
};

}  // namespace

std::unique_ptr<Environment> make_white() {
    return std::make_unique<White>();
}

}  // namespace mirrorball::detail
