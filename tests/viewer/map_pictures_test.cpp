#include <mirrorball/map_pictures.h>

#include <cmath>
#include <tuple>

#include <gtest/gtest.h>
#include <mirrorball/error.h>
#include <mirrorball/lookup.h>
#include <mirrorball/resample.h>

#include "synthetic.h"

namespace mirrorball {
namespace {

constexpr Projection kAll[] = {Projection::equirect,
                               Projection::cube,
                               Projection::sphere,
                               Projection::dual_paraboloid,
                               Projection::angular,
                               Projection::octahedral,
                               Projection::equal_area_octahedral};

// Spread evenly over the sphere: the Fibonacci lattice.
std::vector<Vec3d> directions(int count) {
    std::vector<Vec3d> list;
    for (int i = 0; i < count; ++i) {
        const double y = 1 - (2 * i + 1.0) / count, angle = i * 2.399963229728653;
        const double radius = std::sqrt(1 - y * y);
        list.emplace_back(radius * std::cos(angle), y, radius * std::sin(angle));
    }
    return list;
}

// What the picture shows at a direction's place is the light from that direction. A pixel of 96 is
// a few degrees wide in the worst map, over which this light changes by some percent; next to the
// rims of discs, where pixels are stretched without end, nothing is asked.
TEST(MapPicture, ShowsEachDirectionAtItsPlace) {
    const EnvironmentMap light = sampled(Projection::equirect, 256, smooth_light);
    const Axes turned = rotated({}, 0.4, 0.2, 0.1);
    for (const Projection projection : kAll) {
        const Image picture = map_picture(light, projection, turned, 96);
        EXPECT_NEAR(static_cast<double>(picture.width()) / picture.height(),
                    map_picture_aspect(projection), 1e-12);
        int seen = 0;
        for (const Vec3d& d : directions(500)) {
            const MapPlace place = place_on_map(projection, turned, d);
            ASSERT_TRUE(place.x >= 0 && place.x <= 1 && place.y >= 0 && place.y <= 1);
            const int x =
                std::min(static_cast<int>(place.x * picture.width()), picture.width() - 1);
            const int y =
                std::min(static_cast<int>(place.y * picture.height()), picture.height() - 1);
            if (picture.at(x, y)[3] == 0) continue;  // a rim runs through the pixel
            if (projection == Projection::sphere && turned.to_map(d).z < -0.9) continue;
            ++seen;
            const Vec3f expected = look_up(light, d), shown = picture.rgb(x, y);
            EXPECT_NEAR(shown.x, expected.x, 0.12 * expected.x + 0.02) << name(projection) << d;
            EXPECT_NEAR(shown.z, expected.z, 0.12 * expected.z + 0.02) << name(projection) << d;
        }
        EXPECT_GT(seen, 450) << name(projection);
    }
}

// An unfolded cube has half of its 12 cells; a disc pi / 4 of its square.
TEST(MapPicture, IsTransparentWhereThereIsNoMap) {
    const EnvironmentMap light = sampled(Projection::equirect, 64, smooth_light);
    const auto share = [&](Projection projection) {
        const Image picture = map_picture(light, projection, default_axes(projection), 96);
        double covered = 0;
        for (int y = 0; y < picture.height(); ++y)
            for (int x = 0; x < picture.width(); ++x) covered += picture.at(x, y)[3];
        return covered / static_cast<double>(picture.texel_count());
    };
    EXPECT_DOUBLE_EQ(share(Projection::cube), 0.5);
    EXPECT_DOUBLE_EQ(share(Projection::equirect), 1);
    EXPECT_DOUBLE_EQ(share(Projection::octahedral), 1);
    for (const Projection disc :
         {Projection::sphere, Projection::dual_paraboloid, Projection::angular})
        EXPECT_NEAR(share(disc), kPi / 4, 0.005) << name(disc);
}

// What is far smaller than a pixel is shown as its mean, unless pixels are long strips, as at a
// panorama's poles and the rim of an angular map.
TEST(MapPicture, PassesNothingOver) {
    EnvironmentMap stripes = make_environment_map(Projection::cube, 128);
    for (Image& face : stripes.levels[0].faces) {
        for (int y = 0; y < face.height(); ++y)
            for (int x = 0; x < face.width(); ++x)
                face.set_rgb(x, y, Vec3f((x + y) % 2 == 0 ? 0 : 2));
    }
    append_mip_levels(stripes);
    for (const Projection projection :
         {Projection::cube, Projection::sphere, Projection::dual_paraboloid, Projection::octahedral,
          Projection::equal_area_octahedral}) {
        const Image picture = map_picture(stripes, projection, rotated({}, 0.4, 0.2, 0.1), 48);
        int seen = 0;
        for (int y = 0; y < picture.height(); ++y) {
            for (int x = 0; x < picture.width(); ++x) {
                if (picture.at(x, y)[3] == 0) continue;
                ++seen;
                EXPECT_NEAR(picture.rgb(x, y).x, 1, 0.05) << name(projection) << x << ", " << y;
            }
        }
        EXPECT_GT(seen, 48 * 16);
    }
}

// The survey's own example, in the cube's own frame: r = (0.2, 0.4, 0.3) is on +Y at (0.75, 0.875),
// which the cross has in its first row and second column.
TEST(MapPlace, IsThatOfTheSurveysExample) {
    const MapPlace place = place_on_map(Projection::cube, {}, {0.2, 0.4, 0.3});
    EXPECT_EQ(place.face, 2);
    EXPECT_NEAR(place.s, 0.75, 1e-12);
    EXPECT_NEAR(place.t, 0.875, 1e-12);
    EXPECT_NEAR(place.x, (1 + 0.75) / 4, 1e-12);
    EXPECT_NEAR(place.y, 0.875 / 3, 1e-12);
}

TEST(MapPicture, RefusesHeightsOutOfRange) {
    const EnvironmentMap light = sampled(Projection::equirect, 64, smooth_light);
    for (const int height : {-1, 0, 3, 4097})
        EXPECT_THROW(std::ignore = map_picture(light, Projection::cube, {}, height), Error);
}

}  // namespace
}  // namespace mirrorball
