#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <mirrorball/axes.h>
#include <mirrorball/mesh.h>
#include <mirrorball/projection.h>
#include <mirrorball/projections/cube.h>

#include "mesh_laws.h"

namespace mirrorball {
namespace {

const Axes kCubeAxes{{1, 0, 0}, {0, 1, 0}, {0, 0, -1}};

double total_area(const SplitMesh& split) {
    double sum = 0;
    for (const auto& indices : split.indices) sum += area(split.positions, indices);
    return sum;
}

std::size_t triangle_count(const SplitMesh& split) {
    std::size_t count = 0;
    for (const auto& indices : split.indices) count += indices.size() / 3;
    return count;
}

Vec3d reflected(const Vec3d& p, const Vec3d& n, const Vec3d& eye) {
    const Vec3d v = (eye - p).normalized();
    return n * (2 * n.dot(v)) - v;
}

// Every vertex by itself, with a random unit normal: r of neighbouring corners point anywhere.
Mesh soup(int triangles, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> gauss;
    const auto vector = [&] { return Vec3d(gauss(random), gauss(random), gauss(random)); };
    Mesh mesh;
    for (int i = 0; i < 3 * triangles; ++i) {
        mesh.positions.emplace_back(vector());
        mesh.normals.emplace_back(vector().normalized());
        mesh.indices.push_back(i);
    }
    return mesh;
}

// A sphere whose normals are wrong, so that it is closed and yet every triangle is cut a lot.
Mesh rough_sphere(int detail, std::uint32_t seed) {
    Mesh mesh = make_mesh("sphere", detail);
    std::mt19937 random(seed);
    std::normal_distribution<double> gauss;
    std::map<PositionKey, Vec3f> normals;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const auto [place, is_new] = normals.try_emplace(key_of(mesh.positions[i]));
        if (is_new)
            place->second = Vec3f(Vec3d(gauss(random), gauss(random), gauss(random)).normalized());
        mesh.normals[i] = place->second;
    }
    return mesh;
}

struct Case {
    const char* name;
    Mesh mesh;
    Vec3d eye;
    Axes axes;
};

std::vector<Case> cases() {
    const Axes turned = rotated(kCubeAxes, 0.3, 0.7, 0.1);
    return {{"sphere", make_mesh("sphere"), {0, 0, 4}, kCubeAxes},
            {"sphere askew", make_mesh("sphere", 20), {1, 2, 3}, turned},
            {"teapot", make_mesh("teapot", 8), {1.5, 1, 3}, kCubeAxes},
            {"cube", make_mesh("cube", 3), {2, 3, 4}, turned},
            {"plane", make_mesh("plane", 1), {0, 0.4, 0}, kCubeAxes},
            {"soup", soup(2000, 1), {0, 0, 5}, kCubeAxes},
            {"soup around the eye", soup(2000, 2), {0, 0, 0}, turned},
            {"rough sphere", rough_sphere(6, 3), {0, 0, 4}, kCubeAxes}};
}

TEST(SplitMesh, AreaIsKept) {
    for (const Case& c : cases()) {
        const SplitMesh split = split_by_cube_face(c.mesh, c.eye, c.axes);
        // New points are rounded to float, each by 6e-8 of its coordinates.
        EXPECT_NEAR(total_area(split), area(c.mesh), 1e-6 * area(c.mesh)) << c.name;
    }
}

TEST(SplitMesh, PiecesLieOnTheirFaces) {
    for (const Case& c : cases()) {
        const SplitMesh split = split_by_cube_face(c.mesh, c.eye, c.axes);
        ASSERT_EQ(split.texture_coordinates.size(), split.positions.size());
        ASSERT_EQ(split.normals.size(), split.positions.size());
        for (const Vec3f& stq : split.texture_coordinates) {
            ASSERT_GT(stq.z, 0) << c.name;
            const double s = double(stq.x) / stq.z, t = double(stq.y) / stq.z;
            // two roundings to float
            ASSERT_TRUE(s >= -2e-7 && s <= 1 + 2e-7 && t >= -2e-7 && t <= 1 + 2e-7)
                << c.name << " " << s << " " << t;
        }
    }
}

// At random points of each triangle the piece there shows what the cube map indexed by the
// interpolated r would: the same face, s and t.
TEST(SplitMesh, ShowsWhatTheInterpolatedReflectionIndexes) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform;
    for (const Case& c : cases()) {
        // One triangle at a time, so that the pieces are known to be its.
        const std::size_t stride = std::max<std::size_t>(1, c.mesh.triangle_count() / 400);
        for (std::size_t i = 0; i < c.mesh.triangle_count(); i += stride) {
            Mesh one;
            Vec3d r[3];
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t index = c.mesh.indices[3 * i + k];
                one.positions.push_back(c.mesh.positions[index]);
                one.normals.push_back(c.mesh.normals[index]);
                one.indices.push_back(k);
                r[k] =
                    c.axes.to_map(reflected(Vec3d(one.positions[k]), Vec3d(one.normals[k]), c.eye));
            }
            const SplitMesh split = split_by_cube_face(one, c.eye, c.axes);
            const Vec3d whole = area_vector(one.positions, one.indices.data());
            for (int face = 0; face < 6; ++face) {
                for (std::size_t j = 0; j < split.indices[face].size(); j += 3) {
                    const std::uint32_t* corner = &split.indices[face][j];
                    if (area_vector(split.positions, corner).length() < 1e-3 * whole.length())
                        continue;  // barycentric coordinates of so small a piece are mostly
                                   // rounding
                    double a = uniform(random), b = uniform(random);
                    if (a + b > 1) a = 1 - a, b = 1 - b;
                    const double weights[3] = {1 - a - b, a, b};
                    Vec3d point(0), stq(0);
                    for (int k = 0; k < 3; ++k) {
                        point += Vec3d(split.positions[corner[k]]) * weights[k];
                        stq += Vec3d(split.texture_coordinates[corner[k]]) * weights[k];
                    }
                    Vec3d there(0);
                    for (int k = 0; k < 3; ++k) {
                        const Vec3d from(one.positions[(k + 1) % 3]);
                        const Vec3d to(one.positions[(k + 2) % 3]);
                        const Vec3d opposite = (to - from).cross(point - from) * 0.5;
                        there += r[k] * (opposite.dot(whole) / whole.length2());
                    }
                    const auto expected = Cube::project(there);
                    const double near_zero = there.length();
                    if (near_zero < 0.05) continue;
                    ASSERT_EQ(expected.face, face) << c.name;
                    ASSERT_NEAR(stq.x / stq.z, expected.s, 1e-4) << c.name;
                    ASSERT_NEAR(stq.y / stq.z, expected.t, 1e-4) << c.name;
                }
            }
        }
    }
}

// Where normals are the same on both sides of an edge; along the cube's hard edges the two sides
// reflect different things and are cut at different points.
TEST(SplitMesh, ClosedSmoothMeshesStayClosed) {
    for (const Case& c : cases()) {
        if (std::string(c.name) == "cube") continue;
        DirectedEdges before, after;
        count_edges(c.mesh.positions, c.mesh.indices, before);
        const SplitMesh split = split_by_cube_face(c.mesh, c.eye, c.axes);
        for (const auto& indices : split.indices) count_edges(split.positions, indices, after);
        if (open_edges(before) != 0) continue;
        EXPECT_EQ(open_edges(after), 0u) << c.name;
    }
}

// Within one triangle too: what is not on its border is used from both sides.
TEST(SplitMesh, PiecesOfOneTriangleMeet) {
    const Mesh many = soup(3000, 7);
    for (std::size_t i = 0; i < many.indices.size(); i += 3) {
        Mesh one;
        for (int k = 0; k < 3; ++k) {
            one.positions.push_back(many.positions[i + k]);
            one.normals.push_back(many.normals[i + k]);
            one.indices.push_back(k);
        }
        // The same triangle from behind closes it.
        const SplitMesh split = split_by_cube_face(one, {0, 0, 5}, kCubeAxes);
        std::swap(one.indices[1], one.indices[2]);
        const SplitMesh back = split_by_cube_face(one, {0, 0, 5}, kCubeAxes);
        DirectedEdges edges;
        for (int face = 0; face < 6; ++face) {
            count_edges(split.positions, split.indices[face], edges);
            count_edges(back.positions, back.indices[face], edges);
        }
        std::size_t borders = 0;
        for (const auto& [edge, uses] : edges)
            if (!edges.contains({edge.second, edge.first})) ++borders;
        ASSERT_EQ(borders, 0u) << i / 3;
    }
}

// Over a plane r is (x, h, z) to a common factor: vertices lie exactly on the walls between faces,
// edges run along them, and what rounding says about sides must not matter.
TEST(SplitMesh, VerticesAndEdgesOnWalls) {
    const Mesh plane = make_mesh("plane", 16);
    for (const Vec3d& eye : {Vec3d(0, 0.5, 0), Vec3d(0, 0.3, 0), Vec3d(0.125, 0.7, 0.125),
                             Vec3d(0.5, 0.31, -0.25), Vec3d(0.1, 0.1, 0.1), Vec3d(0, 1, 0)}) {
        const SplitMesh split = split_by_cube_face(plane, eye, Axes{});
        EXPECT_NEAR(total_area(split), 4, 4e-6) << eye;
        DirectedEdges edges;
        for (const auto& indices : split.indices) count_edges(split.positions, indices, edges);
        const auto on_border = [](const PositionKey& p) {
            return std::abs(p[0]) == 1 || std::abs(p[2]) == 1;
        };
        for (const auto& [edge, uses] : edges) {
            if (on_border(edge.first) && on_border(edge.second)) continue;
            ASSERT_TRUE(edges.contains({edge.second, edge.first})) << eye;
        }
    }
}

// Two triangles on either side of an edge whose r runs along the wall x = z, exactly: what is
// symmetric is rounded alike. New points on that edge have x = z too, and are the same for both.
TEST(SplitMesh, EdgesAlongAWallAreCutAlike) {
    std::mt19937 random(17);
    std::normal_distribution<double> gauss;
    const auto vector = [&] { return Vec3f(Vec3d(gauss(random), gauss(random), gauss(random))); };
    const auto symmetric = [&] {
        const Vec3f v = vector();
        return Vec3f(v.x, v.y, v.x);
    };
    int cut_count = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3d eye(symmetric() * 3.0f);
        const Vec3f ends[2] = {symmetric(), symmetric()};
        const Vec3f normals[2] = {symmetric().normalized(), symmetric().normalized()};
        std::set<PositionKey> on_edge[2];
        for (int side = 0; side < 2; ++side) {
            Mesh mesh;
            mesh.positions = {ends[side], ends[1 - side], vector()};
            mesh.normals = {normals[side], normals[1 - side], vector().normalized()};
            mesh.indices = {0, 1, 2};
            const SplitMesh split = split_by_cube_face(mesh, eye, Axes{});
            ASSERT_NEAR(total_area(split), area(mesh), 1e-5) << i;
            for (const auto& indices : split.indices)
                for (const std::uint32_t index : indices)
                    if (split.positions[index].x == split.positions[index].z)
                        on_edge[side].insert(key_of(split.positions[index]));
        }
        ASSERT_EQ(on_edge[0], on_edge[1]) << i;
        if (on_edge[0].size() > 2) ++cut_count;
    }
    EXPECT_GT(cut_count, 5000);
}

TEST(SplitMesh, ASphereUsesAllFaces) {
    const SplitMesh split = split_by_cube_face(make_mesh("sphere"), {0, 0, 4}, kCubeAxes);
    for (const auto& indices : split.indices) EXPECT_FALSE(indices.empty());
}

TEST(SplitMesh, TriangleWhollyOnOneFaceIsUnchanged) {
    Mesh mesh;
    mesh.positions = {{-0.1f, -0.1f, 0}, {0.1f, -0.1f, 0}, {0, 0.1f, 0}};
    mesh.normals.assign(3, Vec3f(0, 0, 1));
    mesh.indices = {0, 1, 2};
    const SplitMesh split = split_by_cube_face(mesh, {0, 0, 3}, Axes{});
    EXPECT_EQ(split.positions, mesh.positions);
    EXPECT_EQ(split.normals, mesh.normals);
    EXPECT_EQ(split.indices[4], mesh.indices);  // back to where the eye is: +Z
    EXPECT_EQ(triangle_count(split), 1u);
}

// The survey's worked example, by the table: (0.2, 0.4, 0.3) is (0.75, 0.875) of +Y.
TEST(SplitMesh, TextureCoordinatesAreTheSurveys) {
    const Vec3d stq = Cube::homogeneous(2, Vec3d(0.2, 0.4, 0.3));
    EXPECT_NEAR(stq.x / stq.z, 0.75, 1e-15);
    EXPECT_NEAR(stq.y / stq.z, 0.875, 1e-15);
}

TEST(SplitMesh, HomogeneousIsProjectOfEveryFace) {
    std::mt19937 random(11);
    std::normal_distribution<double> gauss;
    for (int i = 0; i < 1000; ++i) {
        const Vec3d d(gauss(random), gauss(random), gauss(random));
        const auto expected = Cube::project(d);
        const Vec3d stq = Cube::homogeneous(expected.face, d);
        EXPECT_NEAR(stq.x / stq.z, expected.s, 1e-14);
        EXPECT_NEAR(stq.y / stq.z, expected.t, 1e-14);
    }
}

// Normals chosen so that each corner reflects as asked: n is halfway between v and r.
Mesh reflecting(const Vec3d (&r)[3], const Vec3d& eye) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.indices = {0, 1, 2};
    for (int k = 0; k < 3; ++k) {
        const Vec3d v = (eye - Vec3d(mesh.positions[k])).normalized();
        mesh.normals.emplace_back((v + r[k].normalized()).normalized());
    }
    return mesh;
}

void expect_sane(const SplitMesh& split, double expected_area) {
    EXPECT_NEAR(total_area(split), expected_area, 1e-6);
    for (std::size_t i = 0; i < split.positions.size(); ++i) {
        EXPECT_TRUE(std::isfinite(split.positions[i].length()));
        EXPECT_TRUE(std::isfinite(split.normals[i].length()));
        EXPECT_TRUE(std::isfinite(split.texture_coordinates[i].length()));
        EXPECT_GT(split.texture_coordinates[i].z, 0);
    }
}

TEST(SplitMesh, ConstantReflectionsAlongEdgesAndCornersCountOnce) {
    const Vec3d eye(0.3, 0.2, 50);
    for (const Vec3d& r : {Vec3d(1, 0, 0), Vec3d(1, 1, 0), Vec3d(1, 1, 1), Vec3d(-1, 1, -1)}) {
        const SplitMesh split = split_by_cube_face(reflecting({r, r, r}, eye), eye, Axes{});
        expect_sane(split, 0.5);
    }
}

TEST(SplitMesh, OppositeReflections) {
    const Vec3d eye(0.3, 0.2, 5);
    const Vec3d x(1, 0, 0), y(0, 1, 0), d(1, 1, 1), e(1, -0.5, 0.2);
    const Vec3d triples[][3] = {{x, -x, y}, {x, -x, x}, {d, -d, d}, {d, -d, -d},
                                {e, -e, x}, {e, -e, e}, {x, y, -d}, {x, x + y * 0.001, -x},
                                {d, -d, e}};
    for (const auto& r : triples)
        expect_sane(split_by_cube_face(reflecting(r, eye), eye, Axes{}), 0.5);
}

// r in the plane between two faces is no piece of both: exactly so, where arithmetic is exact.
TEST(SplitMesh, ReflectionsBetweenTwoFacesBelongToOne) {
    Mesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
    mesh.indices = {0, 1, 2};
    mesh.normals.assign(3, Vec3f(0, 0, 1));
    // x and z of the cube lie at 45 degrees, so r of x = 0 is on the wall between them.
    const double h = std::sqrt(0.5);
    mesh.positions = {{0, -1, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.normals.assign(3, Vec3f(0, 0, 1));
    const Axes diagonal{{h, 0, h}, {0, 1, 0}, {-h, 0, h}};
    expect_sane(split_by_cube_face(mesh, {0, 0, 4}, diagonal), 1);
}

TEST(SplitMesh, EyeOnTheSurfaceIsNoNan) {
    const Mesh mesh = make_mesh("sphere", 4);
    expect_sane(split_by_cube_face(mesh, Vec3d(mesh.positions[9]), kCubeAxes), area(mesh));
}

TEST(SplitMesh, EmptyMeshIsEmpty) {
    const SplitMesh split = split_by_cube_face(Mesh{}, {0, 0, 1}, Axes{});
    EXPECT_EQ(triangle_count(split), 0u);
    EXPECT_TRUE(split.positions.empty());
}

}  // namespace
}  // namespace mirrorball
