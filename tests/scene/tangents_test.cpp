// Tangent frames against formulas: of surfaces whose dP/ds is known, and of triangles by hand.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <random>
#include <string>
#include <tuple>

#include <ImathMatrix.h>
#include <gtest/gtest.h>
#include <mirrorball/error.h>
#include <mirrorball/mesh.h>

namespace mirrorball {
namespace {

Vec3f direction(const Vec4f& tangent) {
    return {tangent.x, tangent.y, tangent.z};
}

// The frame's y axis.
Vec3f up(const Mesh& mesh, std::size_t i) {
    return mesh.normals[i].cross(direction(mesh.tangents[i])) * mesh.tangents[i].w;
}

// What holds for every mesh whatsoever.
void expect_frames(const Mesh& mesh) {
    ASSERT_EQ(mesh.tangents.size(), mesh.positions.size());
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    ASSERT_EQ(mesh.texture_coordinates.size(), mesh.positions.size());
    for (std::size_t i = 0; i < mesh.tangents.size(); ++i) {
        // rounding of floats: of the normal, and of the result
        ASSERT_NEAR(direction(mesh.tangents[i]).length(), 1, 3e-7) << i;
        ASSERT_NEAR(direction(mesh.tangents[i]).dot(mesh.normals[i]), 0, 3e-7) << i;
        ASSERT_EQ(std::abs(mesh.tangents[i].w), 1) << i;
    }
}

// Corners tell what is drawn; how vertices are numbered does not.
using CornerKey = std::array<float, 9>;
std::map<CornerKey, std::vector<Vec4f>> tangents_by_corner(const Mesh& mesh) {
    std::map<CornerKey, std::vector<Vec4f>> result;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const std::uint32_t v = mesh.indices[i];
        const Vec3f &p = mesh.positions[v], &n = mesh.normals[v];
        const Vec2f& place = mesh.texture_coordinates[v];
        result[{p.x, p.y, p.z, n.x, n.y, n.z, place.x, place.y, mesh.tangents[v].w}].push_back(
            mesh.tangents[v]);
    }
    return result;
}

// Each corner of one mesh within a distance of one of the other's that is equal in all else.
void expect_equal_frames(const Mesh& a, const Mesh& b, double tolerance) {
    const auto first = tangents_by_corner(a), second = tangents_by_corner(b);
    ASSERT_EQ(first.size(), second.size());
    for (const auto& [key, tangents] : first) {
        const auto found = second.find(key);
        ASSERT_NE(found, second.end());
        ASSERT_EQ(found->second.size(), tangents.size());
        for (const Vec4f& tangent : tangents)
            ASSERT_LE((tangent - found->second.front()).length(), tolerance);
    }
}

// Vertices of its own for each corner.
Mesh unindexed(const Mesh& mesh) {
    Mesh result;
    for (const std::uint32_t i : mesh.indices) {
        result.indices.push_back(static_cast<std::uint32_t>(result.positions.size()));
        result.positions.push_back(mesh.positions[i]);
        result.normals.push_back(mesh.normals[i]);
        result.texture_coordinates.push_back(mesh.texture_coordinates[i]);
    }
    return result;
}

// A square in x and y that shows the picture as it is.
Mesh square() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    mesh.normals.assign(4, Vec3f(0, 0, 1));
    mesh.texture_coordinates = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    return mesh;
}

// Surfaces of equations --------------------------------------------------------------------------

TEST(Tangents, OfThePlane) {
    const Mesh mesh = with_tangents(make_mesh("plane", 4));
    expect_frames(mesh);
    for (std::size_t i = 0; i < mesh.tangents.size(); ++i) {
        ASSERT_EQ(mesh.tangents[i], Vec4f(1, 0, 0, 1));
        ASSERT_EQ(up(mesh, i), Vec3f(0, 0, -1));  // t grows along +z
    }
}

TEST(Tangents, OfTheCubesFaces) {
    const Mesh mesh = with_tangents(make_mesh("cube", 2));
    expect_frames(mesh);
    EXPECT_EQ(mesh.positions.size(), make_mesh("cube", 2).positions.size());
    for (std::size_t i = 0; i < mesh.tangents.size(); ++i) {
        ASSERT_EQ(mesh.tangents[i].w, 1);
        // s = 1/2 + right.p / 2
        const float s = (1 + direction(mesh.tangents[i]).dot(mesh.positions[i])) / 2;
        ASSERT_NEAR(mesh.texture_coordinates[i].x, s, 1e-6);
        const float t = (1 - up(mesh, i).dot(mesh.positions[i])) / 2;
        ASSERT_NEAR(mesh.texture_coordinates[i].y, t, 1e-6);
    }
}

// Around y from -z by -x to +z: p = (-r sin a, y, -r cos a), dp/da = (z, 0, -x). Triangles have the
// chords on the left and on the right of a vertex, which lean from it by as much to either side;
// and meridians are straight in a vertex's plane, so that both sides have half a turn. What is left
// is rounding, of positions in chords that are this much shorter.
void expect_turned_about_y(const Mesh& mesh, double least_radius) {
    expect_frames(mesh);
    constexpr double kTolerance = 3e-6;
    for (std::size_t i = 0; i < mesh.tangents.size(); ++i) {
        const Vec3f& p = mesh.positions[i];
        const double radius = std::hypot(p.x, p.z);
        ASSERT_EQ(mesh.tangents[i].w, 1);
        if (radius < least_radius) continue;
        const Vec3f around(Vec3d(p.z, 0, -p.x) / radius);
        ASSERT_NEAR((direction(mesh.tangents[i]) - around).length(), 0, kTolerance) << p;
    }
}

TEST(Tangents, OfTheSphere) {
    const Mesh mesh = make_mesh("sphere");
    // 32 segments a quarter: poles aside, from their next row on
    expect_turned_about_y(with_tangents(mesh), 0.04);
    EXPECT_EQ(with_tangents(mesh).positions.size(), mesh.positions.size());
}

// Each triangle at a pole has a vertex of its own there, turned as the column's middle is.
TEST(Tangents, OfTheSpheresPoles) {
    const Mesh mesh = with_tangents(make_mesh("sphere", 4));
    int count = 0;
    for (std::size_t i = 0; i < mesh.tangents.size(); ++i) {
        if (std::abs(mesh.positions[i].y) != 1) continue;
        const double angle = 2 * kPi * mesh.texture_coordinates[i].x;
        const Vec3f around(Vec3d(-std::cos(angle), 0, std::sin(angle)));
        EXPECT_NEAR((direction(mesh.tangents[i]) - around).length(), 0, 1e-6);
        ++count;
    }
    EXPECT_EQ(count, 32);
}

TEST(Tangents, OfTheTorus) {
    expect_turned_about_y(with_tangents(make_mesh("torus")), 0);
}

TEST(Tangents, OfTheTeapotFollowItsTexture) {
    const Mesh mesh = with_tangents(make_mesh("teapot"));
    expect_frames(mesh);
    double agreement = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const std::uint32_t* v = &mesh.indices[i];
        const Vec3f a = mesh.positions[v[1]] - mesh.positions[v[0]],
                    b = mesh.positions[v[2]] - mesh.positions[v[0]];
        const Vec2f c = mesh.texture_coordinates[v[1]] - mesh.texture_coordinates[v[0]],
                    d = mesh.texture_coordinates[v[2]] - mesh.texture_coordinates[v[0]];
        // s is linear with this gradient on the triangle
        const Vec3f face = a.cross(b);
        const Vec3f along = (b.cross(face) * c.x + face.cross(a) * d.x) / face.length2();
        const Vec3f down = (b.cross(face) * c.y + face.cross(a) * d.y) / face.length2();
        agreement +=
            (direction(mesh.tangents[v[0]]).dot(along) > 0) + (up(mesh, v[0]).dot(down) < 0);
    }
    EXPECT_GT(agreement / double(mesh.triangle_count()), 1.99);
}

// Where a tile meets itself its two sides have one frame, to the bit.
TEST(Tangents, SeamsOfTilesDoNotShow) {
    for (const char* name : {"sphere", "torus"}) {
        const Mesh mesh = with_tangents(make_mesh(name, 8));
        std::map<std::tuple<float, float, float>, std::vector<std::size_t>> here;
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            const Vec3f& p = mesh.positions[i];
            if (std::abs(p.y) < 1) here[{p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}].push_back(i);
        }
        int shared = 0;
        for (const auto& [place, vertices] : here) {
            for (const std::size_t i : vertices)
                ASSERT_EQ(mesh.tangents[i], mesh.tangents[vertices.front()]) << name;
            shared += vertices.size() > 1;
        }
        EXPECT_GE(shared, 15) << name;
    }
}

// Triangles by hand ------------------------------------------------------------------------------

// The mean of two triangles around an edge, each with its angle: by the formula, in numbers.
TEST(Tangents, AreMeansWeightedByAngles) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, -1, 0}};
    mesh.normals.assign(4, Vec3f(0, 0, 1));
    // On the first triangle s = x and t = -y.
    mesh.texture_coordinates = {{0, 0}, {1, 0}, {0, -1}, {-2, 0}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    // On the second s = 2x and t = x - y, so s grows along (1, 1) where t stays. Their angles at
    // the origin are 90 and 135 degrees.
    const Vec3d expected = (Vec3d(1, 0, 0) * 90 + Vec3d(1, 1, 0).normalized() * 135).normalized();
    const Mesh result = with_tangents(mesh);
    expect_frames(result);
    EXPECT_NEAR((direction(result.tangents[0]) - Vec3f(expected)).length(), 0, 1e-7);
    EXPECT_EQ(result.tangents[1], Vec4f(1, 0, 0, 1));
    EXPECT_NEAR((direction(result.tangents[3]) - Vec3f(1, 1, 0).normalized()).length(), 0, 1e-7);
}

// Angles and directions are those seen along the vertex's normal, not those in the triangle.
TEST(Tangents, LieInTheVertexsPlane) {
    Mesh mesh = square();
    const Vec3f leaning = Vec3f(0.6f, 0, 0.8f);
    mesh.normals.assign(4, leaning);
    const Mesh result = with_tangents(mesh);
    for (const Vec4f& tangent : result.tangents)
        EXPECT_NEAR((tangent - Vec4f(0.8f, 0, -0.6f, 1)).length(), 0, 1e-7);
}

TEST(Tangents, MirroredTexturesHaveTheOtherHand) {
    Mesh mesh = square();
    for (Vec2f& place : mesh.texture_coordinates) place.x = 1 - place.x;
    const Mesh result = with_tangents(mesh);
    EXPECT_EQ(result.tangents, std::vector<Vec4f>(4, Vec4f(-1, 0, 0, -1)));
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(up(result, i), Vec3f(0, 1, 0));

    mesh = square();
    for (Vec2f& place : mesh.texture_coordinates) place.y = 1 - place.y;
    EXPECT_EQ(with_tangents(mesh).tangents, std::vector<Vec4f>(4, Vec4f(1, 0, 0, -1)));
}

// A picture on the right half and its mirror image on the left one, as faces of characters have it.
Mesh half_mirrored() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {-1, 1, 0}, {-1, 0, 0}};
    mesh.normals.assign(6, Vec3f(0, 0, 1));
    mesh.texture_coordinates = {{0, 1}, {1, 1}, {1, 0}, {0, 0}, {1, 0}, {1, 1}};
    mesh.indices = {0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5};
    return mesh;
}

TEST(Tangents, VerticesOfBothHandsAreSplit) {
    const Mesh mesh = half_mirrored(), result = with_tangents(mesh);
    expect_frames(result);
    ASSERT_EQ(result.positions.size(), 8u);
    EXPECT_EQ(result.positions[6], mesh.positions[0]);
    EXPECT_EQ(result.positions[7], mesh.positions[3]);
    EXPECT_EQ(result.texture_coordinates[7], mesh.texture_coordinates[3]);
    EXPECT_EQ(result.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3, 6, 7, 4, 6, 4, 5}));
    const Vec4f right(1, 0, 0, 1), left(-1, 0, 0, -1);
    EXPECT_EQ(result.tangents,
              (std::vector<Vec4f>{right, right, right, right, left, left, left, left}));
    EXPECT_EQ(with_tangents(unindexed(mesh)).positions.size(), 12u);  // nothing left to split
}

// Laws -------------------------------------------------------------------------------------------

// Bumps on a grid, its texture turned, sheared and mirrored in stripes.
Mesh rough_mesh() {
    constexpr int kSize = 12;
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(-0.3f, 0.3f);
    Mesh mesh;
    for (int row = 0; row <= kSize; ++row) {
        for (int column = 0; column <= kSize; ++column) {
            const auto x = static_cast<float>(column), y = static_cast<float>(row);
            mesh.positions.emplace_back(x + uniform(random), y + uniform(random), uniform(random));
            const float folded = std::abs(x - 4);
            mesh.texture_coordinates.emplace_back(0.1f * folded + 0.02f * y,
                                                  -0.1f * y + 0.03f * folded);
        }
    }
    for (std::uint32_t y = 0; y < kSize; ++y) {
        for (std::uint32_t x = 0; x < kSize; ++x) {
            const std::uint32_t a = y * (kSize + 1) + x, b = a + 1, c = b + kSize, d = c + 1;
            mesh.indices.insert(mesh.indices.end(), {a, b, d, a, d, c});
        }
    }
    mesh.normals = smooth_normals(mesh);
    return mesh;
}

TEST(Tangents, DoNotDependOnIndices) {
    const Mesh mesh = rough_mesh(), expected = with_tangents(mesh);
    expect_frames(expected);
    EXPECT_GT(expected.positions.size(), mesh.positions.size());
    // Sums of doubles in another order: an ulp or none of a float, 1.2e-7.
    expect_equal_frames(with_tangents(unindexed(mesh)), expected, 2.5e-7);

    std::mt19937 random(5);
    std::vector<std::size_t> order(mesh.triangle_count());
    std::iota(order.begin(), order.end(), 0u);
    std::shuffle(order.begin(), order.end(), random);
    Mesh shuffled = mesh;
    for (std::size_t i = 0; i < order.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k)  // and each begun at another corner
            shuffled.indices[3 * i + k] = mesh.indices[3 * order[i] + (k + i) % 3];
    expect_equal_frames(with_tangents(shuffled), expected, 2.5e-7);
}

// The definition, triangle by triangle in loops over all of them: where t stays is a direction at a
// right angle to its gradient.
Vec3d brute_force(const Mesh& mesh, std::uint32_t v, double handedness) {
    const Vec3d n(mesh.normals[v]);
    Vec3d sum(0);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const std::uint32_t here = mesh.indices[i], next = mesh.indices[i - i % 3 + (i + 1) % 3],
                            last = mesh.indices[i - i % 3 + (i + 2) % 3];
        if (mesh.positions[here] != mesh.positions[v] || mesh.normals[here] != mesh.normals[v] ||
            mesh.texture_coordinates[here] != mesh.texture_coordinates[v])
            continue;
        const Vec3d a(mesh.positions[next] - mesh.positions[here]),
            b(mesh.positions[last] - mesh.positions[here]);
        const Vec2f c = mesh.texture_coordinates[next] - mesh.texture_coordinates[here],
                    d = mesh.texture_coordinates[last] - mesh.texture_coordinates[here];
        const Vec3d face = a.cross(b);
        const Vec3d s_grows = b.cross(face) * c.x + face.cross(a) * d.x,
                    t_grows = b.cross(face) * c.y + face.cross(a) * d.y;
        if ((s_grows.cross(t_grows).dot(face) < 0 ? 1 : -1) != handedness) continue;
        Vec3d along = face.cross(t_grows);
        if (along.dot(s_grows) < 0) along = -along;
        const Vec3d flat_a = n.cross(a), flat_b = n.cross(b);  // turned alike by a right angle
        sum += (along - n * along.dot(n)).normalized() *
               std::acos(flat_a.normalized().dot(flat_b.normalized()));
    }
    return sum.normalized();
}

TEST(Tangents, AreThoseOfTheDefinition) {
    const Mesh mesh = rough_mesh(), result = with_tangents(mesh);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const Vec4f& tangent = result.tangents[result.indices[i]];
        ASSERT_NEAR(
            (Vec3d(direction(tangent)) - brute_force(mesh, mesh.indices[i], tangent.w)).length(), 0,
            1e-6);  // texture coordinates of 1, subtracted as floats here
    }
}

TEST(Tangents, TurnWithTheMesh) {
    const Mesh mesh = rough_mesh(), expected = with_tangents(mesh);
    Imath::M44f turn;
    turn.setEulerAngles(Vec3f(0.3f, -1.1f, 2));
    Mesh turned = mesh;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        turned.positions[i] = mesh.positions[i] * turn * 3.0f;
        turned.normals[i] = mesh.normals[i] * turn;
    }
    const Mesh result = with_tangents(turned);
    ASSERT_EQ(result.indices, expected.indices);
    for (std::size_t i = 0; i < result.tangents.size(); ++i) {
        // positions of up to 36 are rounded to 2e-6, on triangles of 1
        ASSERT_NEAR(
            (direction(result.tangents[i]) - direction(expected.tangents[i]) * turn).length(), 0,
            1e-5);
        ASSERT_EQ(result.tangents[i].w, expected.tangents[i].w);
    }
}

// A picture that is moved, or shown larger, turns nothing.
TEST(Tangents, DoNotDependOnWhereInTheTexture) {
    const Mesh mesh = rough_mesh(), expected = with_tangents(mesh);
    Mesh moved = mesh;
    for (Vec2f& place : moved.texture_coordinates) place = place * 5.0f + Vec2f(2.5f, -1.25f);
    const Mesh result = with_tangents(moved);
    ASSERT_EQ(result.indices, expected.indices);
    for (std::size_t i = 0; i < result.tangents.size(); ++i)
        ASSERT_NEAR((result.tangents[i] - expected.tangents[i]).length(), 0, 1e-5);
}

TEST(Tangents, ThatAreThereStay) {
    Mesh mesh = square();
    mesh.tangents.assign(4, Vec4f(0, 1, 0, -1));
    EXPECT_EQ(with_tangents(mesh).tangents, mesh.tangents);
    const Mesh once = with_tangents(rough_mesh()), twice = with_tangents(once);
    EXPECT_EQ(once.tangents, twice.tangents);
    EXPECT_EQ(once.indices, twice.indices);
}

// Bad input --------------------------------------------------------------------------------------

TEST(Tangents, NeedTextureCoordinates) {
    Mesh mesh = square();
    mesh.texture_coordinates.clear();
    for (int i = 0; i < 2; ++i) {
        try {
            (void)with_tangents(mesh);
            FAIL();
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), Errc::usage);
            EXPECT_NE(std::string(error.what()).find("texture coordinates"), std::string::npos);
        }
        mesh.tangents.assign(4, Vec4f(1, 0, 0, 1));
    }
}

TEST(Tangents, OfTexturesWithoutAreaAreSomeDirection) {
    for (const Vec2f& step : {Vec2f(0, 0), Vec2f(1, 0), Vec2f(0.1f, 0.3f)}) {
        Mesh mesh = square();
        for (std::size_t i = 0; i < 4; ++i)
            mesh.texture_coordinates[i] = Vec2f(7, 5) + step * static_cast<float>(i);
        const Mesh result = with_tangents(mesh);
        expect_frames(result);
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_EQ(result.tangents[i], result.tangents[0]);
            EXPECT_EQ(result.tangents[i].w, 1);
        }
    }
}

// A part whose texture has no area takes what is around, and splits nothing.
TEST(Tangents, WithoutTextureAreaFollowTheirNeighbours) {
    for (const bool mirrored : {false, true}) {
        Mesh mesh = square();
        if (mirrored)
            for (Vec2f& place : mesh.texture_coordinates) place.x = 1 - place.x;
        const Vec4f expected = mirrored ? Vec4f(-1, 0, 0, -1) : Vec4f(1, 0, 0, 1);
        mesh.positions.insert(mesh.positions.end(), {{2, 1, 0}, {5, 5, 0}});  // one is unused
        mesh.normals.insert(mesh.normals.end(), 2, Vec3f(0, 0, 1));
        mesh.texture_coordinates.insert(mesh.texture_coordinates.end(), 2,
                                        mesh.texture_coordinates[2]);
        mesh.indices.insert(mesh.indices.end(), {1, 4, 2});
        const Mesh result = with_tangents(mesh);
        expect_frames(result);
        EXPECT_EQ(result.positions.size(), 6u);
        for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(result.tangents[i], expected);
    }
}

// Where both hands are around, such a part takes the one that is not mirrored.
TEST(Tangents, WithoutTextureAreaBetweenBothHandsAreNotMirrored) {
    Mesh mesh = half_mirrored();
    mesh.positions.emplace_back(0, -1, 0);
    mesh.normals.emplace_back(0, 0, 1);
    mesh.texture_coordinates.push_back(mesh.texture_coordinates[0]);
    mesh.indices.insert(mesh.indices.end(), {0, 5, 6});
    const Mesh result = with_tangents(mesh);
    expect_frames(result);
    EXPECT_EQ(result.positions.size(), 9u);
    EXPECT_EQ(result.indices[12], 0u);
    EXPECT_EQ(result.tangents[0], Vec4f(1, 0, 0, 1));
}

TEST(Tangents, TrianglesWithoutAreaAddNothing) {
    const Mesh mesh = rough_mesh(), expected = with_tangents(mesh);
    Mesh more = mesh;
    // Three on a line, whose middle one, vertex 0, has an angle of half a turn; and points.
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    for (const float step : {-1.0f, 1.0f}) {
        more.positions.push_back(mesh.positions[0] + Vec3f(0, step, 0));
        more.normals.push_back(mesh.normals[0]);
        more.texture_coordinates.push_back({0.9f * step, 0.1f});
    }
    more.indices.insert(more.indices.end(), {base, 0, base + 1, 3, 3, 4, 5, 5, 5});
    const Mesh result = with_tangents(more);
    expect_frames(result);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        ASSERT_EQ(result.tangents[i], expected.tangents[i]);
}

// Triangles that cancel out: nothing is left but some direction, of their hand.
TEST(Tangents, ThatCancelOutAreSomeDirection) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
    mesh.normals.assign(5, Vec3f(0, 0, 1));
    mesh.texture_coordinates = {{0, 0}, {1, 0}, {0, -1}, {1, 0}, {0, -1}};
    mesh.indices = {0, 1, 2, 0, 3, 4};
    const Mesh result = with_tangents(mesh);
    expect_frames(result);
    EXPECT_EQ(result.tangents[1], Vec4f(1, 0, 0, 1));
    EXPECT_EQ(result.tangents[3], Vec4f(-1, 0, 0, 1));
}

// Whatever meshes are made of, frames are frames.
TEST(Tangents, OfRandomMeshesAreFrames) {
    std::mt19937 random(11);
    const float scales[] = {0, 1e-40f, 1e-20f, 1e-3f, 1, 1e10f, 1e30f};
    const auto number = [&] {
        const int digit = static_cast<int>(random() % 5) - 2;  // equal ones are frequent
        return static_cast<float>(digit);
    };
    for (int round = 0; round < 3000; ++round) {
        const float size = scales[random() % std::size(scales)],
                    texture_size = scales[random() % std::size(scales)];
        Mesh mesh;
        const auto count = static_cast<std::uint32_t>(3 + random() % 12);
        for (std::uint32_t i = 0; i < count; ++i) {
            mesh.positions.push_back(Vec3f(number(), number(), number()) * size);
            mesh.texture_coordinates.push_back(Vec2f(number(), number()) * texture_size);
            Vec3d normal(number(), number(), number());
            mesh.normals.emplace_back(normal == Vec3d(0) ? Vec3d(0, 0, -1) : normal.normalized());
        }
        mesh.indices.resize(3 * (random() % 10));
        for (std::uint32_t& index : mesh.indices)
            index = static_cast<std::uint32_t>(random() % count);
        const Mesh result = with_tangents(mesh);
        expect_frames(result);
        ASSERT_EQ(result.indices.size(), mesh.indices.size());
        for (std::size_t i = 0; i < mesh.indices.size(); ++i)
            ASSERT_EQ(result.positions[result.indices[i]], mesh.positions[mesh.indices[i]]);
        expect_equal_frames(with_tangents(unindexed(mesh)), with_tangents(unindexed(result)), 0);
    }
    expect_frames(with_tangents([] {
        Mesh empty = square();
        empty.indices.clear();
        return empty;
    }()));
}

}  // namespace
}  // namespace mirrorball
