#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <mirrorball/error.h>
#include <mirrorball/mesh.h>

#include "mesh_laws.h"
#include "support.h"

namespace mirrorball {
namespace {

class EveryBuiltin : public testing::TestWithParam<std::pair<const char*, int>> {
  protected:
    Mesh mesh = make_mesh(GetParam().first, GetParam().second);
};

TEST_P(EveryBuiltin, IsWhole) {
    ASSERT_FALSE(mesh.indices.empty());
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    ASSERT_EQ(mesh.texture_coordinates.size(), mesh.positions.size());
    std::set<std::uint32_t> used;
    for (const std::uint32_t index : mesh.indices) {
        ASSERT_LT(index, mesh.positions.size());
        used.insert(index);
    }
    EXPECT_EQ(used.size(), mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        ASSERT_NEAR(mesh.normals[i].length(), 1, 1e-6) << i;  // rounding of three floats
        ASSERT_TRUE(std::isfinite(mesh.positions[i].length()));
        ASSERT_TRUE(mesh.texture_coordinates[i].x >= 0 && mesh.texture_coordinates[i].x <= 1);
        ASSERT_TRUE(mesh.texture_coordinates[i].y >= 0 && mesh.texture_coordinates[i].y <= 1);
    }
}

TEST_P(EveryBuiltin, HasNoTriangleWithoutArea) {
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        ASSERT_GT(area_vector(mesh.positions, &mesh.indices[i]).length(), 1e-9) << i / 3;
}

// A triangle of a curved surface is off its corners' normals by as much as its step turns: at usual
// detail most where the lip of the teapot's spout rolls over.
TEST_P(EveryBuiltin, NormalsPointToTheSideFromWhichFacesAreCounterClockwise) {
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const Vec3d face = area_vector(mesh.positions, &mesh.indices[i]).normalized();
        for (int k = 0; k < 3; ++k)
            ASSERT_GT(face.dot(Vec3d(mesh.normals[mesh.indices[i + k]])),
                      GetParam().second == 0 ? 0.6 : 0.0)
                << GetParam().first << " triangle " << i / 3 << " at "
                << mesh.positions[mesh.indices[i + k]];
    }
}

// s to the right and t down, as seen from outside: pictures are not mirrored.
TEST_P(EveryBuiltin, TextureIsNotMirrored) {
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const Vec2f a = mesh.texture_coordinates[mesh.indices[i]];
        const Vec2f b = mesh.texture_coordinates[mesh.indices[i + 1]] - a;
        const Vec2f c = mesh.texture_coordinates[mesh.indices[i + 2]] - a;
        ASSERT_LT(b.x * c.y - b.y * c.x, 0) << i / 3;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Mesh, EveryBuiltin,
    testing::Values(std::pair("sphere", 0), std::pair("sphere", 2), std::pair("sphere", 37),
                    std::pair("torus", 0), std::pair("torus", 2), std::pair("plane", 0),
                    std::pair("plane", 1), std::pair("cube", 0), std::pair("cube", 1),
                    std::pair("teapot", 0), std::pair("teapot", 12), std::pair("teapot", 64)),
    [](const auto& instance) {
        return std::string(instance.param.first) + std::to_string(instance.param.second);
    });

// A surface inscribed in a smooth one, of n steps to a quarter, lacks about (pi / 2n)^2 / 3 or less
// of its area and volume; 32 steps: 0.0008.
TEST(BuiltinMesh, SphereIsClosedAndAsLargeAsASphere) {
    const Mesh mesh = make_mesh("sphere");
    EXPECT_EQ(open_edges(mesh), 0u);
    EXPECT_NEAR(area(mesh), 4 * kPi, 4 * kPi * 1e-3);
    EXPECT_NEAR(volume(mesh), 4 * kPi / 3, 4 * kPi / 3 * 2e-3);
    for (const Vec3f& p : mesh.positions) ASSERT_NEAR(p.length(), 1, 1e-6);
}

TEST(BuiltinMesh, SphereIsAGridOfOneVertexPerPole) {
    DirectedEdges edges;
    const Mesh mesh = make_mesh("sphere", 3);
    std::set<PositionKey> places;
    for (const Vec3f& p : mesh.positions) places.insert(key_of(p));
    count_edges(mesh.positions, mesh.indices, edges);
    // Euler: V - E + F = 2
    EXPECT_EQ(places.size() - edges.size() / 2 + mesh.triangle_count(), 2u);
    EXPECT_EQ(places.size(), 12u * 5 + 2);
}

TEST(BuiltinMesh, TorusIsClosedAndAsLargeAsATorus) {
    const Mesh mesh = make_mesh("torus");
    EXPECT_EQ(open_edges(mesh), 0u);
    EXPECT_NEAR(area(mesh), 4 * kPi * kPi * 0.4, 4 * kPi * kPi * 0.4 * 2e-3);
    EXPECT_NEAR(volume(mesh), 2 * kPi * kPi * 0.16, 2 * kPi * kPi * 0.16 * 4e-3);
    const Bounds box = bounds(mesh);
    EXPECT_NEAR((box.most - Vec3d(1.4, 0.4, 1.4)).length(), 0, 1e-6);
    EXPECT_NEAR((box.least + Vec3d(1.4, 0.4, 1.4)).length(), 0, 1e-6);
}

TEST(BuiltinMesh, PlaneFacesUp) {
    const Mesh mesh = make_mesh("plane", 3);
    EXPECT_NEAR(area(mesh), 4, 1e-6);
    for (const Vec3f& n : mesh.normals) EXPECT_EQ(n, Vec3f(0, 1, 0));
    // The picture's top lies at -z, ahead.
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        EXPECT_NEAR(mesh.texture_coordinates[i].x, (mesh.positions[i].x + 1) / 2, 1e-6);
        EXPECT_NEAR(mesh.texture_coordinates[i].y, (mesh.positions[i].z + 1) / 2, 1e-6);
    }
}

TEST(BuiltinMesh, CubeIsClosedWithFlatFaces) {
    const Mesh mesh = make_mesh("cube", 4);
    EXPECT_EQ(open_edges(mesh), 0u);
    EXPECT_NEAR(area(mesh), 24, 1e-6);
    EXPECT_NEAR(volume(mesh), 8, 1e-6);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        EXPECT_EQ(mesh.positions[i].dot(mesh.normals[i]), 1);
}

TEST(BuiltinMesh, TeapotIsTwoWideCentredAndLooksToPlusX) {
    const Mesh mesh = make_mesh("teapot", 32);
    const Bounds box = bounds(mesh);
    // The spout's tip lies between two rows; a parabola through them is off by less than this.
    EXPECT_NEAR(box.least.x, -1, 1e-6);
    EXPECT_NEAR(box.most.x, 1, 1e-4);
    EXPECT_LE(box.most.x, 1 + 1e-6);
    EXPECT_NEAR(box.least.y + box.most.y, 0, 1e-6);
    EXPECT_NEAR(box.most.y - box.least.y, 3.15 * 2 / 6.4340751255, 1e-6);
    EXPECT_NEAR(box.most.z - box.least.z, 4 * 2 / 6.4340751255, 2e-3);
    // The spout is narrower and higher than the handle where each is farthest out.
    for (const Vec3f& p : mesh.positions) {
        if (p.x > 0.9f) {
            EXPECT_GT(p.y, 0.2f);
        }
    }
}

TEST(BuiltinMesh, TeapotIsSymmetricInZ) {
    const Mesh mesh = make_mesh("teapot", 4);
    for (const Vec3f& p : mesh.positions) {
        const Vec3f mirrored(p.x, p.y, -p.z);
        const bool found =
            std::any_of(mesh.positions.begin(), mesh.positions.end(),
                        [&](const Vec3f& q) { return (q - mirrored).length() < 1e-6f; });
        ASSERT_TRUE(found) << p;
    }
}

// Newell's is open at the lid's rim and the pot's (four edges of patches each), and at both ends of
// handle and spout (two each); nowhere else.
TEST(BuiltinMesh, TeapotIsOpenOnlyWhereNewellsIs) {
    // At a detail of 1 tubes are flat, and their two sides cancel.
    for (const int detail : {2, 3, 8})
        EXPECT_EQ(open_edges(make_mesh("teapot", detail)), 16u * detail) << detail;
}

// At the knob's top and the bottom's centre, where the tangent around vanishes.
TEST(BuiltinMesh, TeapotHasNormalsAtItsPoles) {
    const Mesh mesh = make_mesh("teapot");
    const Bounds box = bounds(mesh);
    int poles = 0;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const Vec3f& p = mesh.positions[i];
        const double axis = -(3.4340751255 - 3) / 6.4340751255;
        if (std::abs(p.x - axis) > 1e-6 || std::abs(p.z) > 1e-6) continue;
        const bool top = std::abs(p.y - box.most.y) < 1e-6;
        if (!top && std::abs(p.y - box.least.y) > 1e-6) continue;
        EXPECT_NEAR(mesh.normals[i].y, top ? 1 : -1, 1e-6);
        ++poles;
    }
    EXPECT_EQ(poles, 2 * 4 * 16);
}

// The normals of the equations against those made from the faces, at a detail at which a step
// turns by a few degrees.
TEST(BuiltinMesh, TeapotNormalsAreThoseOfItsFaces) {
    const Mesh mesh = make_mesh("teapot", 48);
    const std::vector<Vec3f> made = smooth_normals(mesh);
    double worst = 1, sum = 0;
    for (std::size_t i = 0; i < made.size(); ++i) {
        // The handle's lower end is a point of the pot as well.
        if ((Vec3d(mesh.positions[i]) - Vec3d(-0.689155, -0.20982, 0)).length() < 1e-5) continue;
        worst = std::min<double>(worst, made[i].dot(mesh.normals[i]));
        sum += 1 - made[i].dot(mesh.normals[i]);
    }
    EXPECT_GT(worst, std::cos(0.15));
    EXPECT_LT(sum / double(made.size()), 1e-3);
}

// The common file of the teapot has every patch in 10 x 10 steps.
TEST(BuiltinMesh, TeapotIsTheOneThatEveryoneHas) {
    const auto file = shared_file("models/teapot.obj");
    if (!file) GTEST_SKIP() << "models/teapot.obj is not there";
    const Mesh mesh = make_mesh("teapot", 10);
    std::ifstream stream(*file);
    std::string line;
    int count = 0;
    double worst = 0;
    while (std::getline(stream, line)) {
        if (line.rfind("v ", 0) != 0) continue;
        std::istringstream words(line.substr(2));
        Vec3d p;
        words >> p.x >> p.y >> p.z;
        p = (p - Vec3d((3.4340751255 - 3) / 2, 3.15 / 2, 0)) * (2 / 6.4340751255);
        double nearest = 1;
        for (const Vec3f& q : mesh.positions) nearest = std::min(nearest, (Vec3d(q) - p).length());
        worst = std::max(worst, nearest);
        ++count;
    }
    EXPECT_GT(count, 3000);
    EXPECT_LT(worst, 2e-6);  // the file has six decimals
}

TEST(BuiltinMesh, UnknownNameIsRefusedWithTheNamesThereAre) {
    try {
        (void)make_mesh("bunny");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), Errc::usage);
        for (const BuiltinMesh& builtin : builtin_meshes())
            EXPECT_NE(std::string(error.what()).find(builtin.name), std::string::npos);
    }
}

TEST(BuiltinMesh, DetailOutOfRangeIsRefused) {
    EXPECT_THROW((void)make_mesh("sphere", -1), Error);
    EXPECT_THROW((void)make_mesh("sphere", 513), Error);
    EXPECT_NO_THROW((void)make_mesh("plane", 512));
}

}  // namespace
}  // namespace mirrorball
