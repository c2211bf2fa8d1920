#include <mirrorball/axes.h>

#include <gtest/gtest.h>
#include <mirrorball/error.h>
#include <mirrorball/projection.h>

namespace mirrorball {
namespace {

Vec3d equirect_direction(const Axes& axes, double s, double t) {
    return axes.to_world(Equirect::direction(FacePoint<double>{0, s, t}));
}

void expect_direction(const Vec3d& found, const Vec3d& expected) {
    EXPECT_LE((found - expected).length(), 1e-12) << found << " is not " << expected;
}

// The table of docs/conventions.md: each program's own forward map, in its own world, says where
// its centre and its three quarters look; the world is then turned into ours by hand.
TEST(Axes, EquirectPresetsLookWhereTheProgramsSay) {
    const struct {
        const char* program;
        Vec3d centre, three_quarters;
    } rows[] = {
        {"mirrorball", {0, 0, -1}, {1, 0, 0}},
        {"debevec", {0, 0, -1}, {1, 0, 0}},
        {"three.js", {1, 0, 0}, {0, 0, 1}},
        {"gltf", {1, 0, 0}, {0, 0, 1}},
        {"openexr", {0, 0, 1}, {-1, 0, 0}},
        {"oiio-y-up", {0, 0, 1}, {-1, 0, 0}},
        {"mitsuba", {0, 0, 1}, {-1, 0, 0}},
        // z up, left-handed: (x, y, z) is (x, z, y) of ours
        {"renderman", {1, 0, 0}, {0, 0, 1}},
        {"oiio", {1, 0, 0}, {0, 0, 1}},
        // Blender's -Y is our +Z; Unity's -Z is our +Z
        {"blender", {1, 0, 0}, {0, 0, 1}},
        {"unity", {1, 0, 0}, {0, 0, 1}},
        {"cmft", {0, 0, -1}, {1, 0, 0}},
    };
    for (const auto& row : rows) {
        SCOPED_TRACE(row.program);
        const Axes axes = axes_preset(row.program, Projection::equirect);
        expect_direction(equirect_direction(axes, 0.5, 0.5), row.centre);
        expect_direction(equirect_direction(axes, 0.75, 0.5), row.three_quarters);
        expect_direction(equirect_direction(axes, 0.3, 0), {0, 1, 0});
        EXPECT_FALSE(axes.mirrored());
    }
}

// A cube's own space is left-handed; ours shows on +Z what lies ahead, and no face is mirrored.
TEST(Axes, CubesShowTheWorldUnmirroredFromInside) {
    const Axes axes = default_axes(Projection::cube);
    const auto at = [&](int face, double s, double t) {
        return axes.to_world(Cube::direction(FacePoint<double>{face, s, t}));
    };
    expect_direction(at(4, 0.5, 0.5), {0, 0, -1});
    expect_direction(at(0, 0.5, 0.5), {1, 0, 0});
    // who looks ahead has +X on the right and +Y above
    EXPECT_GT(at(4, 0.9, 0.5).x, 0);
    EXPECT_GT(at(4, 0.5, 0.1).y, 0);
    // who looks to the right, along +X, has +Z (behind) on the right
    EXPECT_GT(at(0, 0.9, 0.5).z, 0);
    EXPECT_TRUE(axes.mirrored());
    EXPECT_TRUE(axes_preset("three.js", Projection::cube).mirrored());
    EXPECT_FALSE(axes_preset("opengl", Projection::cube).mirrored());
}

TEST(Axes, TextComesBack) {
    for (const char* text : {"+x+y+z", "-z+y+x", "+x-z+y", "-x-y-z"}) {
        EXPECT_EQ(to_string(parse_axes(text, Projection::equirect)), text);
    }
    const Axes turned = rotated(Axes{}, 0.3, -0.2, 1.1);
    const Axes back = parse_axes(to_string(turned), Projection::equirect);
    EXPECT_EQ(back, turned);
}

TEST(Axes, RefusesWhatIsNoFrame) {
    for (const char* text :
         {"", "+x+x+z", "+x+y", "+x+y+w", "1 0 0 0 1 0 0 0 2", "1 0 0", "photoshop"}) {
        try {
            (void)parse_axes(text, Projection::equirect);
            ADD_FAILURE() << text;
        } catch (const Error& e) {
            EXPECT_EQ(e.code(), Errc::usage);
            EXPECT_NE(std::string(e.what()).find(text), std::string::npos);
        }
    }
    EXPECT_THROW((void)axes_preset("fold-y", Projection::cube), Error);
}

TEST(Axes, RotationMovesWhatIsAhead) {
    constexpr double quarter = kPi / 2;
    // what the unturned map had ahead, -Z, comes to lie ...
    const auto ahead = [](const Axes& axes) { return axes.to_world({0, 0, -1}); };
    expect_direction(ahead(rotated({}, quarter, 0, 0)), {-1, 0, 0});  // ... to the left
    expect_direction(ahead(rotated({}, 0, quarter, 0)), {0, 1, 0});   // ... above
    const Vec3d right = rotated({}, 0, 0, quarter).to_world({1, 0, 0});
    expect_direction(right, {0, -1, 0});  // clockwise: the right sinks
    EXPECT_EQ(rotated({}, 4 * quarter, 0, 0), Axes{});
    EXPECT_EQ(to_string(rotated({}, quarter, 0, 0)), "-z+y+x");
}

TEST(Axes, MirrorExchangesLeftAndRight) {
    const Axes axes = mirrored(Axes{});
    expect_direction(axes.to_world({1, 0, 0}), {-1, 0, 0});
    expect_direction(axes.to_world({0, 1, 0}), {0, 1, 0});
    EXPECT_TRUE(axes.mirrored());
    EXPECT_EQ(mirrored(axes), Axes{});
}

}  // namespace
}  // namespace mirrorball
