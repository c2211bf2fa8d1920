// Built-in environments: the same light at any size and in any projection, nothing mirrored, and
// the contrasts that they promise.
#include <mirrorball/builtin.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <mirrorball/environment_map.h>
#include <mirrorball/error.h>

#include "environments/atmosphere.h"
#include "environments/rasterise.h"
#include "environments/shading.h"

namespace mirrorball {
namespace {

constexpr std::array kProjections{Projection::equirect,
                                  Projection::cube,
                                  Projection::sphere,
                                  Projection::dual_paraboloid,
                                  Projection::angular,
                                  Projection::octahedral,
                                  Projection::equal_area_octahedral};
static_assert(kProjections.size() == kProjectionCount);

EnvironmentMap make(std::string_view name, Projection projection, int size) {
    return make_builtin(name, projection, size, default_axes(projection));
}

// About the same number of texels in each projection: an equirect of this width, others of half.
int size_for(Projection projection, int equirect_width) {
    const int half = equirect_width / 2;
    return projection == Projection::equirect ? equirect_width
           : projection == Projection::cube   ? std::max(1, half / 2)
                                              : half;
}

struct TexelPosition {
    int face, x, y;
};
TexelPosition texel_at(const EnvironmentMap& map, const Vec3d& world) {
    return visit(map.projection, [&]<class P>(P) -> TexelPosition {
        const FacePoint<double> p = P::project(map.axes.to_map(world));
        return {p.face, std::min(static_cast<int>(p.s * map.width()), map.width() - 1),
                std::min(static_cast<int>(p.t * map.height()), map.height() - 1)};
    });
}
Vec3f colour_at(const EnvironmentMap& map, const Vec3d& world) {
    const TexelPosition at = texel_at(map, world);
    return map.levels[0].faces[at.face].rgb(at.x, at.y);
}

bool same_bits(const EnvironmentMap& a, const EnvironmentMap& b) {
    for (std::size_t face = 0; face < a.levels[0].faces.size(); ++face) {
        const auto x = a.levels[0].faces[face].values(), y = b.levels[0].faces[face].values();
        if (x.size() != y.size() || std::memcmp(x.data(), y.data(), x.size_bytes()) != 0)
            return false;
    }
    return true;
}

double relative_difference(const Vec3d& a, const Vec3d& b) {
    double largest = 0;
    for (int i = 0; i < 3; ++i) largest = std::max(largest, std::abs(a[i] - b[i]) / b[i]);
    return largest;
}

TEST(Builtin, ListsNamesOnceWithDescriptions) {
    std::vector<std::string> names;
    for (const Builtin& builtin : builtins()) {
        names.push_back(builtin.name);
        EXPECT_FALSE(builtin.description.empty());
    }
    EXPECT_EQ(names,
              (std::vector<std::string>{"sunset", "noon", "studio", "axes", "grid", "white"}));
}

TEST(Builtin, RefusesUnknownNameAndSaysWhichThereAre) {
    try {
        (void)make("sunrise", Projection::cube, 4);
        FAIL() << "made an environment that there is not";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), Errc::usage);
        const std::string message = error.what();
        EXPECT_NE(message.find("sunrise"), std::string::npos) << message;
        for (const Builtin& builtin : builtins())
            EXPECT_NE(message.find(builtin.name), std::string::npos) << message;
    }
}

TEST(Builtin, RefusesSizesThatNoMapHas) {
    EXPECT_THROW((void)make("white", Projection::cube, 0), Error);
    EXPECT_THROW((void)make("white", Projection::equirect, 3), Error);
}

TEST(Builtin, WhiteIsExactlyOneInEveryUsedTexel) {
    for (const Projection projection : kProjections) {
        for (const int size : {2, 18, 64}) {
            const EnvironmentMap map = make("white", projection, size);
            const auto used = solid_angle_table(projection, map.width(), map.height());
            for (const Image& face : map.levels[0].faces)
                for (int y = 0; y < map.height(); ++y)
                    for (int x = 0; x < map.width(); ++x) {
                        const float expected = used[y * map.width() + x] > 0 ? 1.0f : 0.0f;
                        ASSERT_EQ(face.rgb(x, y), Vec3f(expected))
                            << name(projection) << ' ' << size << " at " << x << ", " << y;
                    }
        }
    }
}

class EachBuiltin : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(, EachBuiltin,
                         testing::Values("sunset", "noon", "studio", "axes", "grid", "white"),
                         [](const auto& each) { return std::string(each.param); });

// Maps of about 256 texels around the horizon, made once for all tests.
const EnvironmentMap& map_of(const std::string& name, Projection projection) {
    static std::map<std::pair<std::string, Projection>, EnvironmentMap> maps;
    const auto key = std::pair(name, projection);
    if (!maps.contains(key)) maps[key] = make(name, projection, size_for(projection, 256));
    return maps[key];
}

TEST_P(EachBuiltin, IsFiniteNotNegativeAndLitEverywhere) {
    for (const Projection projection : kProjections) {
        const LevelStatistics s = statistics(map_of(GetParam(), projection));
        EXPECT_EQ(s.non_finite_count, 0) << name(projection);
        EXPECT_EQ(s.negative_count, 0) << name(projection);
        for (int i = 0; i < 3; ++i) EXPECT_GT(s.minimum[i], 0) << name(projection);
    }
}

// Against the mean of all: none of them is the truth, each samples in its own places.
Vec3d mean_flux(const std::string& name) {
    Vec3d sum(0);
    for (const Projection projection : kProjections) sum += flux(map_of(name, projection));
    return sum / static_cast<double>(kProjections.size());
}

TEST_P(EachBuiltin, KeepsItsFluxInEveryProjection) {
    const Vec3d reference = mean_flux(GetParam());
    for (const Projection projection : kProjections)
        EXPECT_LT(relative_difference(flux(map_of(GetParam(), projection)), reference), 1e-3)
            << name(projection);
}

TEST_P(EachBuiltin, KeepsItsFluxAtEverySize) {
    const Vec3d reference = mean_flux(GetParam());
    for (const int width : {2, 512})
        EXPECT_LT(
            relative_difference(flux(make(GetParam(), Projection::equirect, width)), reference),
            1e-3)
            << width;
    EXPECT_LT(relative_difference(flux(make(GetParam(), Projection::cube, 1)), reference), 1e-3);
    // One texel whose rim is stretched without bound: the samples there are far apart.
    EXPECT_LT(relative_difference(flux(make(GetParam(), Projection::sphere, 1)), reference), 1e-2);
}

// At a size where the sun fills texels.
TEST(BuiltinSun, FitsHalfFloats) {
    for (const char* name : {"sunset", "noon"}) {
        const LevelStatistics s = statistics(make(name, Projection::equirect, 1024));
        EXPECT_GT(s.maximum.x, 10'000) << name;
        EXPECT_LT(std::max({s.maximum.x, s.maximum.y, s.maximum.z}), 65504) << name;
    }
}

// One with all that a sky has, and a chart.
TEST(Builtin, HasTheSameBitsAtAnyThreadCount) {
    for (const char* name : {"sunset", "axes"}) {
        std::vector<EnvironmentMap> maps;
        for (const std::size_t threads : {1, 2, 3}) {
            const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                              threads);
            maps.push_back(make(name, Projection::dual_paraboloid, 48));
        }
        EXPECT_TRUE(same_bits(maps[0], maps[1])) << name;
        EXPECT_TRUE(same_bits(maps[0], maps[2])) << name;
    }
}

// What is drawn is the world: a map in another frame has other texels but shows the same in every
// direction. Turning by a quarter about +Y permutes a cube's texels, so the comparison is exact but
// for samples on the very edge of a line.
TEST(Builtin, IsTheSameWorldInAnyFrame) {
    const Axes turned = rotated(default_axes(Projection::cube), kPi / 2, 0, 0);
    const EnvironmentMap map = make("axes", Projection::cube, 64);
    const EnvironmentMap other = make_builtin("axes", Projection::cube, 64, turned);
    EXPECT_EQ(other.axes, turned);
    int different = 0, count = 0;
    for (double azimuth = 0.013; azimuth < 2 * kPi; azimuth += 0.1)
        for (double elevation = -1.5; elevation < 1.55; elevation += 0.1) {
            const Vec3d d = detail::direction_at(elevation, azimuth);
            const Vec3f a = colour_at(map, d), b = colour_at(other, d);
            different += (a - b).length() > 0.02f * (a + b).length();
            ++count;
        }
    EXPECT_LE(different, count / 20);
}

TEST(Builtin, ReportsProgressAndStopsWhenAsked) {
    double last = 0;
    bool decreased = false;
    (void)make_builtin("grid", Projection::cube, 32, default_axes(Projection::cube), [&](double f) {
        decreased = decreased || f < last || f > 1;
        last = f;
        return true;
    });
    EXPECT_FALSE(decreased);
    EXPECT_GT(last, 0.9);

    try {
        (void)make_builtin("grid", Projection::cube, 32, default_axes(Projection::cube),
                           [](double) { return false; });
        FAIL() << "went on";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), Errc::cancelled);
    }
}

// The sun
// -------------------------------------------------------------------------------------------

// Nothing but a disc of radiance 1.
class BareDisc final : public detail::Environment {
  public:
    BareDisc(const Vec3d& direction, double radius) : disc_{direction.normalized(), radius} {}
    [[nodiscard]] Vec3d radiance(const Vec3d&) const override { return {0, 0, 0}; }
    [[nodiscard]] double detail() const override { return 1; }
    [[nodiscard]] std::optional<detail::Disc> disc() const override { return disc_; }
    [[nodiscard]] Vec3d disc_radiance(const Vec3d&) const override { return {1, 1, 1}; }

  private:
    detail::Disc disc_;
};

// The flux of an even disc is its solid angle, 2 pi (1 - cos r): exactly, wherever it lies, whether
// a texel holds the whole disc or a tiny part of it. The tolerance is the rounding of float texels.
TEST(BuiltinSun, DiscHasItsSolidAngleAsFlux) {
    const double radius = detail::radians(0.265);
    const double expected = 2 * kPi * (1 - std::cos(radius));
    for (const Vec3d& direction :
         {Vec3d(0.3, 0.2, -0.9), Vec3d(1, 1, 1), Vec3d(0, 1, 0), Vec3d(0, 0, -1)}) {
        const BareDisc disc(direction, radius);
        for (const Projection projection : kProjections)
            for (const int size : {2, 64, 300}) {
                const EnvironmentMap map =
                    detail::rasterise(disc, projection, size, default_axes(projection), {});
                EXPECT_NEAR(flux(map).x / expected, 1, 1e-6) << name(projection) << ' ' << size;
            }
    }
}

// A texel that lies wholly in the disc has its radiance. 1024 points per texel, evenly spread,
// leave about a percent.
TEST(BuiltinSun, DiscIsEvenWhereTexelsAreSmallerThanIt) {
    const Vec3d direction = Vec3d(0.2, 0.1, -1).normalized();
    const EnvironmentMap map =
        detail::rasterise(BareDisc(direction, detail::radians(6)), Projection::cube, 128,
                          default_axes(Projection::cube), {});
    for (const double x : {-0.06, 0.0, 0.05})
        for (const double y : {-0.05, 0.0, 0.06})
            EXPECT_NEAR(colour_at(map, direction + Vec3d(x, y, 0)).x, 1, 0.02);
}

// The closed form: the disc's irradiance above the air is pi, so what reaches the ground is pi
// times the transmittance toward its centre. Limb darkening is normalised; the transmittance is not
// quite linear across the disc, which matters near the horizon only.
TEST(BuiltinSun, DiscRadianceIntegratesToTheSunsIrradiance) {
    for (const double elevation : {10.0, 35.0, 60.0, 90.0}) {
        const detail::Atmosphere air(
            {.sun_elevation = detail::radians(elevation), .sun_azimuth = 1});
        const detail::Disc& sun = air.sun();
        const Vec3d right = sun.direction.cross(Vec3d(0.1, 0.2, 0.97)).normalized();
        const Vec3d up = sun.direction.cross(right);
        Vec3d sum(0);
        constexpr int kRings = 200, kSpokes = 64;
        for (int i = 0; i < kRings * kSpokes; ++i) {
            const double angle = sun.radius * std::sqrt((i / kSpokes + 0.5) / kRings);
            const double turn = 2 * kPi * (i % kSpokes + 0.5) / kSpokes;
            const Vec3d d =
                (sun.direction + (right * std::cos(turn) + up * std::sin(turn)) * std::tan(angle))
                    .normalized();
            sum += air.sun_radiance(d) * (sun.solid_angle() / (kRings * kSpokes));
        }
        const Vec3d expected = air.transmittance(sun.direction) * kPi;
        EXPECT_LT(relative_difference(sum, expected), 2e-3) << elevation;
    }
}

// A clear day's figures, as daylight tables have them: the sun gives 100 klx or so on a surface
// that faces it, the blue sky a tenth to a fifth of that on the ground, bluer than the sun; what is
// lost on a vertical way through clean air is Rayleigh's and ozone's optical depth.
TEST(BuiltinSun, SunAndSkyHaveDaylightsProportions) {
    const detail::Atmosphere noon(
        {.sun_elevation = detail::radians(60), .sun_azimuth = 0, .haze = 3});
    const auto luminance = [](const Vec3d& c) { return c.dot(Vec3d(0.2126, 0.7152, 0.0722)); };
    const double sun = luminance(noon.sun_irradiance()), sky = luminance(noon.sky_irradiance());
    constexpr double kLuxPerUnit = 133'800 / kPi;  // the solar illuminance constant
    EXPECT_GT(sun * kLuxPerUnit, 90'000);
    EXPECT_LT(sun * kLuxPerUnit, 120'000);
    EXPECT_GT(sky * kLuxPerUnit, 8'000);
    EXPECT_LT(sky * kLuxPerUnit, 22'000);
    EXPECT_GT(noon.sky_irradiance().z / noon.sky_irradiance().x, 1.5);

    const detail::Atmosphere clean({.sun_elevation = 1, .sun_azimuth = 0, .haze = 0});
    const Vec3d up = clean.transmittance({0, 1, 0});
    // beta H of each, ozone's tent having an area of 15 km; the eye is 10 m up
    EXPECT_NEAR(-std::log(up.y), 13.558e-6 * 8000 + 1.881e-6 * 15'000, 2e-3);
    EXPECT_NEAR(-std::log(up.z), 33.1e-6 * 8000 + 0.085e-6 * 15'000, 2e-3);
}

// At sunset the light is red, the zenith blue (by ozone) and the glow is on the sun's side.
TEST(BuiltinSun, SunsetIsRedAndItsZenithBlue) {
    const detail::Atmosphere air(
        {.sun_elevation = detail::radians(2.5), .sun_azimuth = 0, .haze = 4});
    EXPECT_GT(air.sun_irradiance().x, 5 * air.sun_irradiance().z);
    const Vec3d zenith = air.sky({0, 1, 0});
    EXPECT_GT(zenith.z, 1.2 * zenith.x);
    EXPECT_GT(air.sky(detail::direction_at(0.03, 0)).x,
              5 * air.sky(detail::direction_at(0.03, kPi)).x);
}

// Charts
// --------------------------------------------------------------------------------------------

TEST(BuiltinStudio, HasAContrastOfTenThousand) {
    const LevelStatistics s = statistics(make("studio", Projection::cube, 128));
    EXPECT_GT(s.maximum.y / s.minimum.y, 1e4);
}

// Where ink must be, and where it would be if the side were mirrored, turned or upside down: points
// on a side seen from inside, x to the right and y up, from -1 to 1. The sides' own frames are
// stated here once more, on purpose.
struct Probe {
    const char* side;
    Vec3d forward, right, up;
};
const Probe kSides[] = {
    {"+X", {1, 0, 0}, {0, 0, 1}, {0, 1, 0}},  {"-X", {-1, 0, 0}, {0, 0, -1}, {0, 1, 0}},
    {"+Y", {0, 1, 0}, {1, 0, 0}, {0, 0, 1}},  {"-Y", {0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
    {"+Z", {0, 0, 1}, {-1, 0, 0}, {0, 1, 0}}, {"-Z", {0, 0, -1}, {1, 0, 0}, {0, 1, 0}},
};

// A label's two glyphs are 0.62 high about (0, -0.16), the sign on the left and the letter on the
// right, 0.3 from the middle each.
TEST(BuiltinAxes, IsUprightAndNotMirroredInEveryProjection) {
    for (const Projection projection : kProjections) {
        // A sphere map shows -Z around its rim only, where texels are long.
        const bool sphere = projection == Projection::sphere;
        const EnvironmentMap map =
            make("axes", projection, size_for(projection, sphere ? 1024 : 512));
        for (const Probe& side : kSides) {
            const auto at = [&](double x, double y) {
                return colour_at(map, side.forward + side.right * x + side.up * y);
            };
            const Vec3f ink = at(0, 0.4);  // the arrow's shaft
            const Vec3f paper = at(-0.35, 0.4);
            ASSERT_GT((ink - paper).length(), 0.2f);
            const auto is_ink = [&](double x, double y) {
                const Vec3f c = at(x, y);
                return (c - ink).length() < (c - paper).length();
            };
            const std::string where = std::string(name(projection)) + ' ' + side.side;
            // the arrow points up: wide below its tip, nothing above or at its mirror image below
            EXPECT_TRUE(is_ink(0.1, 0.5)) << where;
            EXPECT_FALSE(is_ink(0.1, 0.36)) << where;
            EXPECT_FALSE(is_ink(0.1, 0.65)) << where;
            // the sign: a bar on the left, crossed or not
            EXPECT_TRUE(is_ink(-0.3, -0.16)) << where;
            EXPECT_EQ(is_ink(-0.3, -0.04), side.side[0] == '+') << where;
            // the letter on the right
            const bool is_z = side.side[1] == 'Z', is_y = side.side[1] == 'Y';
            EXPECT_EQ(is_ink(0.3, -0.47), is_z || is_y) << where;  // a foot in the middle
            EXPECT_EQ(is_ink(0.3, 0.15), is_z) << where;           // a bar at the top
            EXPECT_EQ(is_ink(0.14, -0.46), !is_y) << where;        // a foot at the left
            // Z's stroke falls to the left: mirrored, it would be an S
            EXPECT_EQ(is_ink(0.39, -0.01), true) << where;
            EXPECT_EQ(is_ink(0.21, -0.01), !is_z) << where;
        }
    }
}

TEST(BuiltinAxes, ColoursTellAxisByHueAndSignByLightness) {
    const EnvironmentMap map = make("axes", Projection::cube, 256);
    // to the upper right of the letters there is paper
    const auto paper = [&](const Probe& side) {
        return colour_at(map, side.forward + side.right * 0.6 + side.up * 0.6);
    };
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3f plus = paper(kSides[2 * axis]), minus = paper(kSides[2 * axis + 1]);
        for (int channel = 0; channel < 3; ++channel) {
            if (channel != axis) {
                EXPECT_GT(plus[axis], 2 * plus[channel]) << axis;
                EXPECT_GT(minus[axis], minus[channel]) << axis;
            }
            EXPECT_GT(minus[channel], plus[channel]) << axis;
        }
    }
}

// The equator is a line of ink, and so is the meridian ahead; hues turn with the longitude.
TEST(BuiltinGrid, LinesAreWhereTheyShouldBe) {
    const EnvironmentMap map = make("grid", Projection::equirect, 1024);
    for (double degrees = 7; degrees < 360; degrees += 15)
        EXPECT_GT(colour_at(map, detail::direction_at(0.001, detail::radians(degrees))).y, 0.8f);
    EXPECT_GT(colour_at(map, detail::direction_at(detail::radians(22), 0.001)).y, 0.8f);
    const Vec3f ahead =
        colour_at(map, detail::direction_at(detail::radians(8), detail::radians(8)));
    EXPECT_GT(ahead.x, ahead.z);
    const Vec3f behind =
        colour_at(map, detail::direction_at(detail::radians(8), detail::radians(173)));
    EXPECT_GT(behind.z, behind.x);
}

}  // namespace
}  // namespace mirrorball
