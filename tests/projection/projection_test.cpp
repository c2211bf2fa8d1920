// The laws of a projection, for every one in the list, and what is particular to each.
#include <mirrorball/projection.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <type_traits>

#include <gtest/gtest.h>
#include <mirrorball/error.h>

namespace mirrorball {
namespace {

// How much further apart on the sphere two points are than on the picture, at worst: rounding of s
// and t by eps moves the direction by that times eps. Infinite at the rim of a sphere map, whose
// radius goes as the square root; hence the second term.
double direction_tolerance(double eps, const Vec3d& d, bool sphere_map) {
    return 64 * eps + (sphere_map && d.z < -0.5 ? 16 * eps / std::sqrt(std::max(1 + d.z, eps)) : 0);
}

std::vector<Vec3d> random_directions(int count) {
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    std::vector<Vec3d> directions;
    for (int i = 0; i < count; ++i) {
        const Vec3d v(normal(random), normal(random), normal(random));
        directions.push_back(v / v.length());
    }
    return directions;
}

// Where the folds and edges of all projections are: axes, edges and corners of the cube.
std::vector<Vec3d> awkward_directions() {
    std::vector<Vec3d> directions;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
                if (x != 0 || y != 0 || z != 0) {
                    const Vec3d v(x, y, z);
                    directions.push_back(v / v.length());
                    // and a hair beside it
                    const Vec3d w = v + Vec3d(1e-7, -2e-7, 3e-7);
                    directions.push_back(w / w.length());
                }
    return directions;
}

template <class T>
class ProjectionLaws : public testing::Test {};

template <class Tuple>
struct AsTypes;
template <class... P>
struct AsTypes<std::tuple<P...>> {
    using type = testing::Types<P...>;
};
struct ProjectionName {
    template <class P>
    static std::string GetName(int) {
        std::string text = P::name;
        std::replace(text.begin(), text.end(), '-', '_');
        return text;
    }
};
TYPED_TEST_SUITE(ProjectionLaws, AsTypes<Projections>::type, ProjectionName);

template <class P>
FacePoint<double> texel_centre(int face, int x, int y, int size) {
    return {face, (x + 0.5) / (P::aspect * size), (y + 0.5) / size};
}

TYPED_TEST(ProjectionLaws, DirectionsComeBackToRounding) {
    using P = TypeParam;
    constexpr bool sphere_map = std::is_same_v<P, SphereMap>;
    std::vector<Vec3d> directions = random_directions(200000);
    for (const Vec3d& d : awkward_directions()) directions.push_back(d);
    for (const Vec3d& d : directions) {
        const FacePoint<double> p = P::project(d);
        ASSERT_TRUE(p.face >= 0 && p.face < P::face_count);
        ASSERT_TRUE(p.s >= 0 && p.s <= 1 && p.t >= 0 && p.t <= 1) << d << " " << p.s << " " << p.t;
        const Vec3d back = P::direction(p);
        ASSERT_NEAR(back.length(), 1, 1e-14);
        ASSERT_LE((back - d).length(), direction_tolerance(0x1p-53, d, sphere_map))
            << d << " -> " << p.face << " " << p.s << " " << p.t << " -> " << back;

        const Vec3f df(d);
        const Vec3f back_f = P::direction(P::project(df));
        ASSERT_LE((Vec3d(back_f) - d).length(), direction_tolerance(0x1p-24, d, sphere_map)) << d;
    }
}

TYPED_TEST(ProjectionLaws, LengthOfADirectionDoesNotMatter) {
    using P = TypeParam;
    for (const Vec3d& d : random_directions(1000)) {
        const FacePoint<double> p = P::project(d), q = P::project(d * 37.0);
        ASSERT_EQ(p.face, q.face);
        ASSERT_NEAR(p.s, q.s, 1e-14);
        ASSERT_NEAR(p.t, q.t, 1e-14);
    }
}

TYPED_TEST(ProjectionLaws, TexelCentresComeBack) {
    using P = TypeParam;
    for (const int size : {1, 2, 3, 7, 16}) {
        for (int face = 0; face < P::face_count; ++face) {
            for (int y = 0; y < size; ++y) {
                for (int x = 0; x < P::aspect * size; ++x) {
                    const FacePoint<double> p = texel_centre<P>(face, x, y, size);
                    if (!P::covers(p)) continue;
                    const FacePoint<double> q = P::project(P::direction(p));
                    ASSERT_EQ(q.face, face) << size << ": " << x << " " << y;
                    ASSERT_NEAR(q.s, p.s, 1e-13);
                    ASSERT_NEAR(q.t, p.t, 1e-13);
                }
            }
        }
    }
}

TYPED_TEST(ProjectionLaws, SolidAnglesAddUpToTheSphere) {
    using P = TypeParam;
    for (const int size : {1, 2, 3, 5, 16, 61, 128}) {
        const int width = P::aspect * size;
        const auto projection = parse_projection(P::name);
        double sum = 0;
        for (const double solid_angle : solid_angle_table(projection, width, size)) {
            ASSERT_GE(solid_angle, 0);
            sum += solid_angle;
        }
        EXPECT_NEAR(sum * P::face_count, 4 * kPi, 1e-11) << size;
    }
}

// Midpoint rule with 64 x 64 points in the texel: an independent way to the same number.
TYPED_TEST(ProjectionLaws, SolidAngleIsTheIntegralOfTheDensity) {
    using P = TypeParam;
    constexpr int size = 5, steps = 64;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < P::aspect * size; ++x) {
            const double du = 1.0 / (P::aspect * size), dv = 1.0 / size;
            double sum = 0;
            for (int j = 0; j < steps; ++j)
                for (int i = 0; i < steps; ++i) {
                    const FacePoint<double> p{0, (x + (i + 0.5) / steps) * du,
                                              (y + (j + 0.5) / steps) * dv};
                    if (P::covers(p)) sum += P::density(p);
                }
            sum *= du * dv / (steps * steps);
            const double exact = P::solid_angle(0, {x * du, y * dv, (x + 1) * du, (y + 1) * dv});
            // a texel that the rim cuts is known by this rule to about one part in 64 of its edge
            const bool cut = exact < 0.999 * sum || exact > 1.001 * sum;
            EXPECT_NEAR(exact, sum, cut ? 0.02 * P::density({0, .5, .5}) * du * dv : 1e-3 * sum)
                << x << " " << y;
        }
    }
}

TYPED_TEST(ProjectionLaws, TangentsAreTheDerivativesOfTheDirection) {
    using P = TypeParam;
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> uniform(0.001, 0.999);
    constexpr double h = 1e-6;
    for (int i = 0; i < 20000; ++i) {
        const FacePoint<double> p{i % P::face_count, uniform(random), uniform(random)};
        const auto moved = [&](double ds, double dt) {
            return FacePoint<double>{p.face, p.s + ds, p.t + dt};
        };
        // not where the map has a crease or an end within reach of the difference quotient
        const double x = 2 * p.s - 1, y = 1 - 2 * p.t;
        const double crease =
            std::min({std::abs(x), std::abs(y), std::abs(std::abs(x) + std::abs(y) - 1),
                      std::abs(1 - std::hypot(x, y))});
        if (crease < 0.01 || !P::covers(p)) continue;
        const Tangents<double> tangents = P::tangents(p, P::direction(p));
        const Vec3d ds = (P::direction(moved(h, 0)) - P::direction(moved(-h, 0))) / (2 * h);
        const Vec3d dt = (P::direction(moved(0, h)) - P::direction(moved(0, -h))) / (2 * h);
        // truncation h^2 f''' and rounding eps / h, f''' up to about 1e3 at the sphere map's rim
        ASSERT_LE((tangents.ds - ds).length(), 1e-6) << p.s << " " << p.t;
        ASSERT_LE((tangents.dt - dt).length(), 1e-6) << p.s << " " << p.t;
        ASSERT_NEAR(tangents.ds.cross(tangents.dt).length(), P::density(p),
                    1e-10 * P::density(p) / crease);
        ASSERT_NEAR(tangents.ds.dot(P::direction(p)), 0, 1e-11 / crease);
    }
}

// A step over the edge lands next to where it left.
TYPED_TEST(ProjectionLaws, WrapWalksStraightAcrossTheEdge) {
    using P = TypeParam;
    constexpr double e = 1e-9;
    for (int face = 0; face < P::face_count; ++face) {
        for (int i = 0; i < 400; ++i) {
            const double along = (i + 0.5) / 400;
            for (const auto& [s, t, ds, dt] :
                 {std::tuple(0., along, -e, 0.), std::tuple(1., along, e, 0.),
                  std::tuple(along, 0., 0., -e), std::tuple(along, 1., 0., e)}) {
                const FacePoint<double> edge{face, s, t}, outside{face, s + ds, t + dt};
                if (!P::covers(edge)) continue;
                const FacePoint<double> inside = P::wrap(outside);
                ASSERT_TRUE(P::covers(inside));
                ASSERT_LE((P::direction(inside) - P::direction(edge)).length(), 1e-7)
                    << face << " " << s << " " << t;
            }
        }
        // and over the rim of a disc
        for (int i = 0; i < 400; ++i) {
            const double angle = 2 * kPi * (i + 0.5) / 400;
            const auto at = [&](double radius) {
                return FacePoint<double>{face, 0.5 + 0.5 * radius * std::cos(angle),
                                         0.5 + 0.5 * radius * std::sin(angle)};
            };
            if (P::covers(at(1.1))) continue;
            const Vec3d out = P::direction(P::wrap(at(1 + e))), rim = P::direction(at(1 - e));
            ASSERT_LE((out - rim).length(), 1e-3) << angle;  // sqrt(e) at a sphere map's rim
        }
    }
}

TEST(Arctan2, AgreesWithTheStandardLibrary) {
    double worst = 0;
    for (const Vec3d& v : random_directions(200000))
        worst = std::max(worst, std::abs(detail::arctan2(v.x, v.y) - std::atan2(v.x, v.y)));
    EXPECT_LE(worst, 9e-16);  // one rounding of an angle near pi is 4.4e-16
    for (const double x : {-1.0, 0.0, 1.0})
        for (const double y : {-1.0, 0.0, 1.0})
            EXPECT_DOUBLE_EQ(detail::arctan2(y, x), std::atan2(y, x)) << y << " " << x;
}

TEST(Cube, SurveyExample) {
    const FacePoint<double> p = Cube::project(Vec3d(0.2, 0.4, 0.3));
    EXPECT_EQ(p.face, 2);  // +Y
    EXPECT_DOUBLE_EQ(p.s, 0.75);
    EXPECT_DOUBLE_EQ(p.t, 0.875);
}

// Table 1: at each face's centre, s grows along sc and t along tc.
TEST(Cube, FacesFollowTable1) {
    const Vec3d axis[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    const Vec3d sc[] = {{0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {-1, 0, 0}};
    const Vec3d tc[] = {{0, -1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {0, -1, 0}, {0, -1, 0}};
    for (int face = 0; face < 6; ++face) {
        const FacePoint<double> p = Cube::project(axis[face] + sc[face] * 0.25 + tc[face] * 0.5);
        EXPECT_EQ(p.face, face);
        EXPECT_DOUBLE_EQ(p.s, 0.625);
        EXPECT_DOUBLE_EQ(p.t, 0.75);
    }
}

TEST(Cube, TiesGoToOneFace) {
    EXPECT_EQ(Cube::project(Vec3d(1, 1, 1)).face, 0);
    EXPECT_EQ(Cube::project(Vec3d(-1, 1, 1)).face, 1);
    EXPECT_EQ(Cube::project(Vec3d(0.5, -1, 1)).face, 3);
    EXPECT_EQ(Cube::project(Vec3d(-1, -1, 0)).face, 1);
    EXPECT_EQ(Cube::project(Vec3f(0.5f, 1, -1)).face, 2);
}

// Across each of the 12 edges texels of equal size line up one to one.
TEST(Cube, NeighboursLineUpAcrossEdges) {
    constexpr int size = 8;
    for (int face = 0; face < 6; ++face) {
        for (int i = 0; i < size; ++i) {
            for (const auto& [x, y] :
                 {std::pair(-1, i), std::pair(size, i), std::pair(i, -1), std::pair(i, size)}) {
                const FacePoint<double> out = texel_centre<Cube>(face, x, y, size);
                const FacePoint<double> p = Cube::wrap(out);
                EXPECT_NE(p.face, face);
                const double cx = p.s * size - 0.5, cy = p.t * size - 0.5;
                EXPECT_NEAR(cx, std::round(cx), 1e-12);
                EXPECT_NEAR(cy, std::round(cy), 1e-12);
                // and from there back
                const int bx = static_cast<int>(std::round(cx)),
                          by = static_cast<int>(std::round(cy));
                bool found = false;
                for (const auto& [dx, dy] :
                     {std::pair(1, 0), std::pair(-1, 0), std::pair(0, 1), std::pair(0, -1)}) {
                    const FacePoint<double> back =
                        Cube::wrap(texel_centre<Cube>(p.face, bx + dx, by + dy, size));
                    const int hx = x < 0 ? 0 : x == size ? size - 1 : x;
                    const int hy = y < 0 ? 0 : y == size ? size - 1 : y;
                    found =
                        found || (back.face == face && std::abs(back.s * size - 0.5 - hx) < 1e-9 &&
                                  std::abs(back.t * size - 0.5 - hy) < 1e-9);
                }
                EXPECT_TRUE(found) << face << " " << x << " " << y;
            }
        }
    }
}

// Eq. 1 and 2 as printed, and OpenGL's form of the same on [0, 1].
TEST(SphereMap, IsTheSurveysAndOpenGls) {
    for (const Vec3d& r : random_directions(1000)) {
        const FacePoint<double> p = SphereMap::project(r);
        const double m = std::sqrt(2 * (r.z + 1));
        const double tolerance = 1e-15 / (1 + r.z) + 1e-14;
        EXPECT_NEAR(2 * p.s - 1, r.x / m, tolerance);
        EXPECT_NEAR(1 - 2 * p.t, r.y / m, tolerance);
        const double gl_m = 2 * std::sqrt(r.x * r.x + r.y * r.y + (r.z + 1) * (r.z + 1));
        EXPECT_NEAR(p.s, r.x / gl_m + 0.5, tolerance);
        EXPECT_NEAR(1 - p.t, r.y / gl_m + 0.5, tolerance);  // GL's t runs up
    }
}

TEST(SphereMap, RimIsOneDirection) {
    const FacePoint<double> p = SphereMap::project(Vec3d(0, 0, -1));
    EXPECT_NEAR(std::hypot(2 * p.s - 1, 2 * p.t - 1), 1, 1e-15);
    for (int i = 0; i < 16; ++i) {
        const double angle = i * kPi / 8;
        const FacePoint<double> q{0, 0.5 + 0.5 * std::cos(angle), 0.5 + 0.5 * std::sin(angle)};
        EXPECT_LE((SphereMap::direction(q) - Vec3d(0, 0, -1)).length(), 1e-7);
    }
}

// Eq. 4 to 6: P S r with d_o = (0, 0, -1) divided by its last row is the front map, and with
// d_o = (0, 0, 1) the back map turned by 180 degrees.
TEST(DualParaboloid, AgreesWithTheSurveysMatrices) {
    for (const Vec3d& r : random_directions(1000)) {
        const bool front = r.z >= 0;
        const Vec3d d_o(0, 0, front ? -1 : 1);
        const Vec3d sum = d_o - r;                          // S
        const double x = sum.x / sum.z, y = sum.y / sum.z;  // P and its division
        const FacePoint<double> p = DualParaboloid::project(r);
        EXPECT_EQ(p.face, front ? 0 : 1);
        const double turned = front ? 1 : -1;
        EXPECT_NEAR(2 * p.s - 1, turned * x, 1e-14);
        EXPECT_NEAR(1 - 2 * p.t, turned * y, 1e-14);
    }
}

TEST(AngularMap, RadiusIsTheAngleFromTheAxis) {
    for (const Vec3d& d : random_directions(1000)) {
        const FacePoint<double> p = AngularMap::project(d);
        EXPECT_NEAR(std::hypot(2 * p.s - 1, 2 * p.t - 1), std::acos(-d.z) / kPi, 1e-12);
    }
}

TEST(Equirect, CentreAndQuarters) {
    const auto at = [](double x, double y, double z) { return Equirect::project(Vec3d(x, y, z)); };
    EXPECT_DOUBLE_EQ(at(0, 0, -1).s, 0.5);
    EXPECT_DOUBLE_EQ(at(1, 0, 0).s, 0.75);
    EXPECT_DOUBLE_EQ(at(-1, 0, 0).s, 0.25);
    EXPECT_DOUBLE_EQ(at(0, 0, -1).t, 0.5);
    EXPECT_DOUBLE_EQ(at(0, 1, 0).t, 0);
    EXPECT_DOUBLE_EQ(at(0, -1, 0).t, 1);
}

TEST(EqualAreaOctahedral, EveryTexelIsAsLarge) {
    const ProjectionFacts facts = measure(Projection::equal_area_octahedral, 64);
    EXPECT_NEAR(facts.solid_angle_ratio, 1, 1e-12);
}

// Section 3 of the survey, measured; the closed forms are in docs/theory/projections.md.
TEST(ProjectionFacts, AreTheClosedForms) {
    const ProjectionFacts cube = measure(Projection::cube),
                          dual = measure(Projection::dual_paraboloid);
    // the limits belong to points, the measured ones to texels of 1/512 of a face
    EXPECT_DOUBLE_EQ(cube.used_share, 1);
    EXPECT_NEAR(cube.solid_angle_ratio, 3 * std::sqrt(3.0), 0.03);
    EXPECT_NEAR(dual.used_share, kPi / 4, 1e-4);
    EXPECT_NEAR(dual.solid_angle_ratio, 4, 0.02);
    EXPECT_NEAR(dual.worst_stretch, 1, 1e-9);  // stereographic: conformal
    EXPECT_NEAR(cube.worst_stretch, std::sqrt(3.0), 0.01);
    const ProjectionFacts sphere = measure(Projection::sphere);
    EXPECT_NEAR(sphere.used_share, kPi / 4, 1e-4);
    EXPECT_NEAR(sphere.solid_angle_ratio, 1, 1e-9);
    EXPECT_GT(sphere.worst_stretch, 100);
    EXPECT_NEAR(measure(Projection::octahedral).solid_angle_ratio, 3 * std::sqrt(3.0), 0.06);
    // the centre of a cube face is 1 radian per half face
    EXPECT_NEAR(cube.pixels_per_degree, 6 * std::pow(2 / (kPi / 180), 2), 20);
}

TEST(ProjectionNames, ParseAndRefuse) {
    for (std::size_t i = 0; i < kProjectionCount; ++i) {
        const auto projection = static_cast<Projection>(i);
        EXPECT_EQ(parse_projection(name(projection)), projection);
    }
    try {
        (void)parse_projection("latlong");
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.code(), Errc::usage);
        EXPECT_NE(std::string(e.what()).find("equirect, cube"), std::string::npos) << e.what();
    }
}

}  // namespace
}  // namespace mirrorball
