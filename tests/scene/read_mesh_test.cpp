#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <numeric>
#include <random>
#include <span>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <mirrorball/error.h>
#include <mirrorball/mesh.h>

#include "mesh/readers.h"
#include "mesh/triangulate.h"
#include "mesh_laws.h"
#include "support.h"

namespace mirrorball {
namespace {

class ReadMesh : public testing::Test {
  protected:
    Mesh read(const std::string& name, const std::string& content,
              const MeshReadOptions& options = {}) {
        write(name, content);
        return read_mesh(folder_ / name, options);
    }

    void write(const std::string& name, const std::string& content) {
        std::ofstream(folder_ / name, std::ios::binary) << content;
    }

    // The file is refused, and the message names it and says `words`.
    void expect_refused(const std::string& name, const std::string& content,
                        const std::string& words, const MeshReadOptions& options = {}) {
        try {
            (void)read(name, content, options);
            FAIL() << "was read, and should say " << words;
        } catch (const Error& error) {
            const std::string message = error.what();
            EXPECT_EQ(error.code(), Errc::cannot_read);
            EXPECT_NE(message.find(name), std::string::npos) << message;
            EXPECT_NE(message.find(words), std::string::npos) << message;
            EXPECT_LT(message.size(), 500u);
        }
    }

    TemporaryFolder folder_;
};

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

// OBJ --------------------------------------------------------------------------------------------

TEST_F(ReadMesh, ObjWithEverything) {
    const Mesh mesh = read("a.obj",
                           "# a comment that ends in \\\nmtllib none.mtl\no thing\ng a b\ns 1\n"
                           "v 0 0 0 0.5 0.5 0.5\nv +1.0e0 0 0\r\nv 1 1. 0\n\tv 0 1 -0\n"
                           "vt 0 0\nvt 1 0\nvt 1 1\nvt .25 0.75 0\nvn 0 0 2\n"
                           "usemtl red\nf 1/1/1 2/2/1 3/3/1 \\\n 4/4/1\nl 1 2\np 1\n");
    EXPECT_EQ(mesh.positions, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.normals, std::vector<Vec3f>(4, Vec3f(0, 0, 1)));
    // t counts down here.
    EXPECT_EQ(mesh.texture_coordinates,
              (std::vector<Vec2f>{{0, 1}, {1, 1}, {1, 0}, {0.25f, 0.25f}}));
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
}

TEST_F(ReadMesh, ObjIndicesCountBack) {
    const Mesh mesh = read("a.obj", kTriangle + "f -3 -2 -1\nv 0 0 5\nf 1 3 -1\n");
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(mesh.positions[3], Vec3f(0, 0, 5));
}

TEST_F(ReadMesh, ObjCornersOfEveryForm) {
    const std::string start = kTriangle + "vt 0.5 0.5\nvn 0 0 1\n";
    for (const char* face : {"f 1 2 3", "f 1/1 2/1 3/1", "f 1//1 2//1 3//1", "f 1/1/1 2/1/1 3/1/1",
                             "f 1/ 2/ 3/", "f 1// 2// 3//", "f 1/1/ 2/1/ 3/1/", "f 1 2//1 3/1"})
        EXPECT_EQ(read("a.obj", start + face).normals, std::vector<Vec3f>(3, Vec3f(0, 0, 1)))
            << face;
}

// What only one vertex has in common is cut into its own; what both have is shared.
TEST_F(ReadMesh, ObjHardEdgesHaveVerticesOfTheirOwn) {
    const Mesh mesh = read("a.obj", kTriangle +
                                        "v 0 0 1\nvn 0 0 1\nvn 0 -1 0\n"
                                        "f 1//1 2//1 3//1\nf 1//2 4//2 2//2\n");
    EXPECT_EQ(mesh.positions.size(), 6u);
}

TEST_F(ReadMesh, NormalsThatAreMissingOrZeroAreMade) {
    // Two faces at a right angle; the first vertices lie on both.
    const std::string roof = "v 0 0 0\nv 0 0 1\nv 1 0 0\nv 0 -1 0\nvn 0 0 0\n";
    for (const char* faces : {"f 1 2 3\nf 1 4 2\n", "f 1//1 2//1 3//1\nf 1//1 4//1 2//1\n"}) {
        const Mesh mesh = read("a.obj", roof + faces);
        EXPECT_NEAR((mesh.normals[2] - Vec3f(0, 1, 0)).length(), 0, 1e-6);
        EXPECT_NEAR((mesh.normals[3] - Vec3f(-1, 0, 0)).length(), 0, 1e-6);
        const Vec3f both = (Vec3f(0, 1, 0) + Vec3f(-1, 0, 0)).normalized();
        EXPECT_NEAR((mesh.normals[0] - both).length(), 0, 1e-6);
    }
}

TEST_F(ReadMesh, DegenerateTrianglesAreLeftOut) {
    const Mesh mesh = read("a.obj", kTriangle + "v 2 0 0\nv 7 7 7\nf 1 2 3\nf 1 2 4\nf 1 1 3\n");
    EXPECT_EQ(mesh.triangle_count(), 1u);
    EXPECT_EQ(mesh.positions.size(), 3u);
    expect_refused("a.obj", kTriangle + "v 2 0 0\nf 1 2 4\n", "no triangle");
}

TEST_F(ReadMesh, ConcavePolygonsAreCutWithinTheirBorder) {
    // A letter C, in every plane and both turns; a fan would cover its gap.
    const double c[8][2] = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {3, 2}, {3, 3}, {0, 3}};
    for (int plane = 0; plane < 6; ++plane) {
        std::string text, face = "f";
        for (int i = 0; i < 8; ++i) {
            double xyz[3] = {0, 0, 0};
            xyz[plane % 3] = c[i][plane / 3];
            xyz[(plane + 1) % 3] = c[i][1 - plane / 3];
            text += fmt::format("v {} {} {}\n", xyz[0], xyz[1], xyz[2]);
            face += fmt::format(" {}", i + 1);
        }
        const Mesh mesh = read("c.obj", text + face);
        EXPECT_NEAR(area(mesh), 7, 1e-6) << plane;
        Vec3d sum(0);
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
            sum += area_vector(mesh.positions, &mesh.indices[i]);
        EXPECT_NEAR(sum.length(), 7, 1e-6) << plane;  // all turn the same way
    }
}

// A star of many points, whose area is known, and one that crosses itself, which only has to end.
TEST(Triangulate, Stars) {
    std::vector<Vec3f> star;
    constexpr int kPoints = 400;
    for (int i = 0; i < kPoints; ++i) {
        const double angle = 2 * kPi * i / kPoints, radius = i % 2 == 0 ? 1 : 0.5;
        star.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
    std::vector<std::uint32_t> indices;
    for (const auto& triangle : detail::triangulate(star))
        indices.insert(indices.end(), triangle.begin(), triangle.end());
    EXPECT_EQ(indices.size(), 3u * (kPoints - 2));
    EXPECT_NEAR(area(star, indices), kPoints * 0.25 * std::sin(2 * kPi / kPoints), 1e-5);

    std::mt19937 random(3);
    std::shuffle(star.begin(), star.end(), random);
    EXPECT_EQ(detail::triangulate(star).size(), kPoints - 2u);
    star.resize(8);
    EXPECT_EQ(detail::triangulate(std::vector<Vec3f>(8, Vec3f(1))).size(), 6u);
}

TEST_F(ReadMesh, BadObjIsRefusedInWords) {
    expect_refused("a.obj", "", "no triangle");
    expect_refused("a.obj", kTriangle, "no triangle");
    expect_refused("a.obj", "v 0 0\nf 1 1 1\n", "line 1: 2 numbers");
    expect_refused("a.obj", "v 0 0 zero\n", "'zero' (expected a finite number)");
    expect_refused("a.obj", "v 0 0 nan\n", "line 1");
    expect_refused("a.obj", "v 0 0 inf\n", "line 1");
    expect_refused("a.obj", "v 0 0 1e39\n", "'1e39'");
    expect_refused("a.obj", "v 0 0 1e999999999\n", "line 1");
    expect_refused("a.obj", "v 0 0 " + std::string(100000, '9') + "\n", "line 1");
    expect_refused("a.obj", kTriangle + "vn 0 1\n", "line 4");
    expect_refused("a.obj", kTriangle + "vt x\n", "line 4");
    expect_refused("a.obj", kTriangle + "\r\n\r\nf 1 2\n", "line 6: a face of 2 corners");
    expect_refused("a.obj", kTriangle + "f 1 2 4\n", "face 1 refers to a position");
    expect_refused("a.obj", kTriangle + "f 1 2 -4\n", "face 1 refers to a position");
    expect_refused("a.obj", kTriangle + "f 1 2 0\n", "'0' (expected an index");
    expect_refused("a.obj", kTriangle + "f 1 2 99999999999\n", "line 4");
    expect_refused("a.obj", kTriangle + "f 1 2 2147483647\n", "face 1");
    expect_refused("a.obj", kTriangle + "f 1 2 -2147483648\n", "face 1");
    expect_refused("a.obj", kTriangle + "f 1/9 2/9 3/9\n", "texture coordinate");
    expect_refused("a.obj", kTriangle + "f 1//9 2//9 3//9\n", "normal");
    expect_refused("a.obj", kTriangle + "f 1/2/3/4 2 3\n", "'1/2/3/4'");
    expect_refused("a.obj", kTriangle + "f a b c\n", "'a'");
    expect_refused("a.obj", kTriangle + std::string("f 1 2 3\0 4\n", 12), "line 4");
}

TEST_F(ReadMesh, LongLinesAndManyCornersAreNoTrouble) {
    EXPECT_EQ(read("a.obj", "#" + std::string(5'000'000, 'x') + "\n" + kTriangle + "f 1 2 3")
                  .triangle_count(),
              1u);
    // A regular polygon of many corners is convex; a concave one of as many is refused.
    std::string circle, star, face = "f";
    for (int i = 0; i < 5000; ++i) {
        const double a = 2 * kPi * i / 5000, r = i % 2 == 0 ? 100 : 50;
        circle += fmt::format("v {:.9f} {:.9f} 0\n", 100 * std::cos(a), 100 * std::sin(a));
        star += fmt::format("v {:.9f} {:.9f} 0\n", r * std::cos(a), r * std::sin(a));
        face += fmt::format(" {}", i + 1);
    }
    EXPECT_GT(read("a.obj", circle + face).triangle_count(), 4000u);
    expect_refused("a.obj", star + face, "not convex");
}

TEST_F(ReadMesh, MemoryLimitIsKept) {
    std::string text = kTriangle;
    for (int i = 0; i < 1000; ++i) text += "f 1 2 3\n";
    expect_refused("a.obj", text, "memory", {10'000});
    expect_refused("a.obj", text, "memory", {1'000});
    EXPECT_EQ(read("a.obj", text, {1'000'000}).triangle_count(), 1000u);
}

TEST_F(ReadMesh, FilesOfOtherKindsAreRefused) {
    expect_refused("a.stl", "solid", ".obj, .gltf or .glb");
    expect_refused("mesh", "solid", ".obj, .gltf or .glb");
    EXPECT_THROW((void)read_mesh(folder_ / "missing.obj"), Error);
    EXPECT_THROW((void)read_mesh(folder_ / "missing.gltf"), Error);
    std::filesystem::create_directory(folder_ / "folder.obj");
    EXPECT_THROW((void)read_mesh(folder_ / "folder.obj"), Error);
    EXPECT_EQ(read("UPPER.OBJ", kTriangle + "f 1 2 3\n").triangle_count(), 1u);
}

TEST_F(ReadMesh, RealFiles) {
    const std::pair<const char*, std::size_t> files[] = {{"models/teapot.obj", 6320},
                                                         {"models/suzanne.obj", 968},
                                                         {"models/stanford-bunny.obj", 69451}};
    for (const auto& [name, most] : files) {
        const auto file = shared_file(name);
        if (!file) GTEST_SKIP() << name << " is not there";
        const Mesh mesh = read_mesh(*file);
        EXPECT_LE(mesh.triangle_count(), most);
        EXPECT_GT(mesh.triangle_count(), most * 9 / 10) << name;
        double agreement = 0;
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
            agreement += area_vector(mesh.positions, &mesh.indices[i])
                             .normalized()
                             .dot(Vec3d(mesh.normals[mesh.indices[i]]));
        EXPECT_GT(agreement, 0.7 * double(mesh.triangle_count())) << name;
    }
}

TEST(SmoothNormals, OfASphereAreItsPositions) {
    const Mesh mesh = make_mesh("sphere");
    const std::vector<Vec3f> normals = smooth_normals(mesh);
    // Seams too: positions that are equal share one. A step of pi / 64 turns; most of it cancels.
    for (std::size_t i = 0; i < normals.size(); ++i)
        ASSERT_NEAR((normals[i] - mesh.positions[i]).length(), 0, 2e-3);
}

TEST(SmoothNormals, DoNotDependOnHowAFaceIsCut) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.normals.assign(5, Vec3f(0));
    mesh.indices = {0, 1, 2, 0, 2, 3, 0, 4, 1};
    const Vec3f one_way = smooth_normals(mesh)[0];
    mesh.indices = {0, 1, 3, 1, 2, 3, 0, 4, 1};
    EXPECT_NEAR((one_way - smooth_normals(mesh)[0]).length(), 0, 1e-6);
    EXPECT_NEAR(one_way.z, std::sqrt(0.5), 1e-6);
}

TEST(SmoothNormals, OfATwoSidedSheetAreEachSides) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.indices = {0, 1, 2, 3, 5, 4};
    const std::vector<Vec3f> normals = smooth_normals(mesh);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(normals[i], Vec3f(0, 0, 1));
    for (int i = 3; i < 6; ++i) EXPECT_EQ(normals[i], Vec3f(0, 0, -1));
}

// glTF -------------------------------------------------------------------------------------------

template <class T>
std::string bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

std::string base64(const std::string& bytes) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k)
            word = word << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k <= bytes.size() ? kDigits[word >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

std::string glb(const std::string& text, const std::string& binary) {
    const auto word = [](std::size_t n) {
        return bytes_of(std::vector{static_cast<std::uint32_t>(n)});
    };
    std::string padded = text + std::string((4 - text.size() % 4) % 4, ' ');
    std::string chunk = binary + std::string((4 - binary.size() % 4) % 4, '\0');
    std::string result = word(padded.size()) + "JSON" + padded;
    if (!binary.empty()) result += word(chunk.size()) + std::string("BIN\0", 4) + chunk;
    return "glTF" + word(2) + word(result.size() + 12) + result;
}

// A square in x and y from 0 to 1, as a file to change by words.
struct Gltf {
    std::string binary =
        bytes_of<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) +  // 48 bytes of positions
        bytes_of<float>({0, 1, 1, 1, 1, 0, 0, 0}) +              // 32 of texture coordinates
        bytes_of<std::uint16_t>({0, 1, 2, 0, 2, 3});             // 12 of indices
    std::string asset = R"({"version": "2.0"})";
    std::string more;
    std::string views =
        R"({"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 32},)"
        R"({"buffer": 0, "byteOffset": 80, "byteLength": 12})";
    std::string position = R"("bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3")";
    std::string coordinate =
        R"("bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2")";
    std::string indices = R"("bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR")";
    std::string more_accessors;
    std::string attributes = R"("POSITION": 0, "TEXCOORD_0": 1)";
    std::string primitive = R"("indices": 2)";
    std::string nodes = R"({"mesh": 0})";
    std::string scenes = R"("scene": 0, "scenes": [{"nodes": [0]}])";

    [[nodiscard]] std::string text(const std::string& uri) const {
        const std::string with_uri = uri.empty() ? "" : fmt::format(R"(, "uri": "{}")", uri);
        return fmt::format(
            R"({{"asset": {}, {} "buffers": [{{"byteLength": {}{}}}], "bufferViews": [{}],
"accessors": [{{{}}}, {{{}}}, {{{}}} {}],
"meshes": [{{"primitives": [{{"attributes": {{{}}}, {}}}]}}], "nodes": [{}], {}}})",
            asset, more, binary.size(), with_uri, views, position, coordinate, indices,
            more_accessors, attributes, primitive, nodes, scenes);
    }
    [[nodiscard]] std::string embedded() const {
        return text("data:application/octet-stream;base64," + base64(binary));
    }
    [[nodiscard]] std::string container() const { return glb(text(""), binary); }
};

void expect_square(const Mesh& mesh) {
    EXPECT_EQ(mesh.positions, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.texture_coordinates, (std::vector<Vec2f>{{0, 1}, {1, 1}, {1, 0}, {0, 0}}));
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(mesh.normals, std::vector<Vec3f>(4, Vec3f(0, 0, 1)));
}

TEST_F(ReadMesh, GltfOfEveryContainer) {
    const Gltf gltf;
    expect_square(read("a.gltf", gltf.embedded()));
    expect_square(read("a.glb", gltf.container()));
    write("the data.bin", gltf.binary + "and more");
    expect_square(read("a.gltf", gltf.text("the%20data.bin")));
    // What a file is, its content says.
    expect_square(read("b.gltf", gltf.container()));
    expect_square(read("b.glb", gltf.embedded()));
}

TEST_F(ReadMesh, GltfWithoutSceneOrIndices) {
    Gltf gltf;
    gltf.scenes = R"("extras": {})";
    expect_square(read("a.gltf", gltf.embedded()));
    gltf.primitive = R"("mode": 6)";  // a fan of all vertices
    expect_square(read("a.gltf", gltf.embedded()));
    gltf.primitive = R"("mode": 5)";  // a strip
    EXPECT_EQ(read("a.gltf", gltf.embedded()).indices,
              (std::vector<std::uint32_t>{0, 1, 2, 1, 3, 2}));
}

TEST_F(ReadMesh, GltfIndicesOfEverySize) {
    for (const int type : {5121, 5123, 5125}) {
        Gltf gltf;
        gltf.binary.resize(80);
        for (const std::uint32_t index : {0, 1, 2, 0, 2, 3})
            gltf.binary.append(reinterpret_cast<const char*>(&index), type == 5121   ? 1
                                                                      : type == 5123 ? 2
                                                                                     : 4);
        gltf.views.replace(gltf.views.rfind("12"), 2, std::to_string(gltf.binary.size() - 80));
        gltf.indices.replace(gltf.indices.find("5123"), 4, std::to_string(type));
        expect_square(read("a.gltf", gltf.embedded()));
    }
}

TEST_F(ReadMesh, GltfStridesAndOffsets) {
    Gltf gltf;
    // position and texture coordinate of each vertex side by side, after 4 bytes
    gltf.binary = "skip" +
                  bytes_of<float>({0, 0, 0, 0, 1, 1, 0, 0, 1, 1, 1, 1, 0, 1, 0, 0, 1, 0, 0, 0}) +
                  bytes_of<std::uint16_t>({0, 1, 2, 0, 2, 3});
    gltf.views = R"({"buffer": 0, "byteOffset": 4, "byteLength": 80, "byteStride": 20},)"
                 R"({"buffer": 0, "byteOffset": 84, "byteLength": 12})";
    gltf.coordinate =
        R"("bufferView": 0, "byteOffset": 12, "componentType": 5126, "count": 4, "type": "VEC2")";
    gltf.indices.replace(gltf.indices.find("\"bufferView\": 2"), 15, "\"bufferView\": 1");
    expect_square(read("a.gltf", gltf.embedded()));
}

TEST_F(ReadMesh, GltfNodesMoveTurnAndScale) {
    Gltf gltf;
    // Scaled to 2 x 1, turned by 90 degrees about z: (x, y) to (-y, 2x); moved by (10, 0, 0); and
    // all of it raised by the parent.
    gltf.nodes =
        R"({"children": [1], "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,7,1]},
{"mesh": 0, "scale": [2, 1, 1], "rotation": [0, 0, 0.70710678118, 0.70710678118], "translation": [10, 0, 0]})";
    const Mesh mesh = read("a.gltf", gltf.embedded());
    const Vec3f expected[] = {{10, 0, 7}, {10, 2, 7}, {9, 2, 7}, {9, 0, 7}};
    for (int i = 0; i < 4; ++i) {
        EXPECT_NEAR((mesh.positions[i] - expected[i]).length(), 0, 1e-5);
        EXPECT_NEAR((mesh.normals[i] - Vec3f(0, 0, 1)).length(), 0, 1e-6);
    }
}

TEST_F(ReadMesh, GltfMirroredNodesKeepTheirOutside) {
    Gltf gltf;
    gltf.binary += bytes_of<float>({1, 0, 1, 1, 0, 1, 1, 0, 1, 1, 0, 1});
    gltf.views += R"(, {"buffer": 0, "byteOffset": 92, "byteLength": 48})";
    gltf.more_accessors =
        R"(, {"bufferView": 3, "componentType": 5126, "count": 4, "type": "VEC3"})";
    gltf.attributes += R"(, "NORMAL": 3)";
    gltf.nodes = R"({"mesh": 0, "scale": [-2, 1, 1]})";
    const Mesh mesh = read("a.gltf", gltf.embedded());
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 2, 1, 0, 3, 2}));
    // By the inverse transpose: (1, 0, 1) goes to (-1/2, 0, 1).
    EXPECT_NEAR((mesh.normals[0] - Vec3f(-0.5f, 0, 1).normalized()).length(), 0, 1e-6);
    EXPECT_GT(area_vector(mesh.positions, mesh.indices.data()).z, 0);
}

TEST_F(ReadMesh, GltfOfSeveralPrimitivesIsOneMesh) {
    Gltf gltf;
    gltf.nodes = R"({"mesh": 0}, {"mesh": 0, "translation": [5, 0, 0]}, {"mesh": 0})";
    gltf.scenes = R"("scenes": [{"nodes": [0, 1]}])";
    const Mesh mesh = read("a.gltf", gltf.embedded());
    EXPECT_EQ(mesh.positions.size(), 8u);
    EXPECT_EQ(mesh.indices[6], 4u);
    EXPECT_NEAR(area(mesh), 2, 1e-6);
}

// The square with normals and tangents; views and accessors 3 and 4.
Gltf with_tangent_attribute(const std::vector<float>& tangents) {
    Gltf gltf;
    gltf.binary += bytes_of<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}) + bytes_of(tangents);
    gltf.views += R"(, {"buffer": 0, "byteOffset": 92, "byteLength": 48})"
                  R"(, {"buffer": 0, "byteOffset": 140, "byteLength": 64})";
    gltf.more_accessors =
        R"(, {"bufferView": 3, "componentType": 5126, "count": 4, "type": "VEC3"})"
        R"(, {"bufferView": 4, "componentType": 5126, "count": 4, "type": "VEC4"})";
    gltf.attributes += R"(, "NORMAL": 3, "TANGENT": 4)";
    return gltf;
}
std::vector<float> four_times(const Vec4f& tangent) {
    std::vector<float> result;
    for (int i = 0; i < 16; ++i) result.push_back(tangent[i % 4]);
    return result;
}

void expect_tangents(const std::vector<Vec4f>& tangents, const Vec4f& expected) {
    ASSERT_EQ(tangents.size(), 4u);
    for (const Vec4f& tangent : tangents) EXPECT_NEAR((tangent - expected).length(), 0, 1e-6);
}

TEST_F(ReadMesh, GltfTangentsAreTakenOver) {
    // As long as they like, and leaning out of the surface.
    const Gltf gltf = with_tangent_attribute(four_times({1.5f, 2, 7, -1}));
    const Mesh mesh = read("a.gltf", gltf.embedded());
    expect_square(mesh);
    expect_tangents(mesh.tangents, {0.6f, 0.8f, 0, -1});
    EXPECT_EQ(with_tangents(mesh).tangents, mesh.tangents);
    EXPECT_TRUE(read("b.gltf", Gltf().embedded()).tangents.empty());
    expect_tangents(with_tangents(read("b.gltf", Gltf().embedded())).tangents, {1, 0, 0, 1});
}

TEST_F(ReadMesh, GltfTangentsStayWithTheirVertices) {
    Gltf gltf = with_tangent_attribute({1, 0, 0, 1, 0, 1, 0, 1, -1, 0, 0, 1, 0, -1, 0, 1});
    gltf.binary.replace(80, 12, bytes_of<std::uint16_t>({0, 2, 3, 0, 2, 3}));  // 1 is unused
    EXPECT_EQ(read("a.gltf", gltf.embedded()).tangents,
              (std::vector<Vec4f>{{1, 0, 0, 1}, {-1, 0, 0, 1}, {0, -1, 0, 1}}));
}

// What a file says of its tangents, and what is made where it does not, is one in every node.
TEST_F(ReadMesh, GltfTangentsGoWithTheirNodes) {
    for (const char* transform :
         {R"("translation": [3, 0, 0])", R"("scale": [2, 1, 5])", R"("scale": [-2, 1, 1])",
          R"("scale": [1, -3, 1])", R"("scale": [1, 1, -1])", R"("scale": [-1, -1, -1])",
          R"("rotation": [0.5, 0.5, 0.5, 0.5])",
          R"("matrix": [1,0,2,0, 0,1,1,0, -1,3,1,0, 0,0,0,1])",
          R"("matrix": [1,0,2,0, 0,1,1,0, 3,2,1,0, 0,0,0,1])"}) {
        SCOPED_TRACE(transform);
        Gltf gltf = with_tangent_attribute(four_times({1, 0, 0, 1}));
        gltf.nodes = fmt::format(R"({{"mesh": 0, {}}})", transform);
        const Mesh given = read("a.gltf", gltf.embedded());
        gltf.attributes.resize(gltf.attributes.find(R"(, "TANGENT")"));
        const Mesh made = with_tangents(read("a.gltf", gltf.embedded()));
        ASSERT_EQ(made.positions.size(), 4u);
        ASSERT_EQ(given.tangents.size(), 4u);
        for (std::size_t i = 0; i < 4; ++i)
            EXPECT_NEAR((given.tangents[i] - made.tangents[i]).length(), 0, 1e-6);
    }
}

// Quantised: bytes that are normalised.
TEST_F(ReadMesh, GltfTangentsOfBytes) {
    Gltf gltf = with_tangent_attribute(std::vector<float>(4));
    gltf.binary.resize(140);
    for (int i = 0; i < 4; ++i) gltf.binary += std::string("\x7f\0\0\x81", 4);
    gltf.views.replace(gltf.views.rfind("64"), 2, "16");
    gltf.more_accessors.replace(gltf.more_accessors.rfind("5126"), 4, "5120, \"normalized\": true");
    expect_tangents(read("a.gltf", gltf.embedded()).tangents, {1, 0, 0, -1});
}

TEST_F(ReadMesh, GltfTangentsThatAreIncompleteAreLeftOut) {
    const std::vector<float> good = four_times({0, 1, 0, 1});
    const auto tangents = [&](const Gltf& gltf) {
        const Mesh mesh = read("a.gltf", gltf.embedded());
        EXPECT_EQ(mesh.positions.size() % 4, 0u);
        return mesh.tangents.size();
    };
    EXPECT_EQ(tangents(with_tangent_attribute(good)), 4u);
    std::vector<float> zero = good;
    zero[5] = 0;
    EXPECT_EQ(tangents(with_tangent_attribute(zero)), 0u);
    std::vector<float> along_normal = good;
    along_normal[5] = 0, along_normal[6] = 1;
    EXPECT_EQ(tangents(with_tangent_attribute(along_normal)), 0u);

    Gltf gltf = with_tangent_attribute(good);
    gltf.attributes = R"("POSITION": 0, "TEXCOORD_0": 1, "TANGENT": 4)";  // normals are missing
    EXPECT_EQ(tangents(gltf), 0u);
    gltf.attributes = R"("POSITION": 0, "NORMAL": 3, "TANGENT": 4)";  // of no texture
    EXPECT_EQ(tangents(gltf), 0u);

    // Of two primitives one has them, the first or the second.
    const std::string all = with_tangent_attribute(good).attributes,
                      some = R"("POSITION": 0, "TEXCOORD_0": 1, "NORMAL": 3)";
    for (const auto& [first, second] : {std::pair(all, some), std::pair(some, all)}) {
        gltf.attributes = first;
        gltf.primitive =
            fmt::format(R"("indices": 2}}, {{"attributes": {{{}}}, "indices": 2)", second);
        EXPECT_EQ(tangents(gltf), 0u);
    }
    gltf.attributes = all;
    EXPECT_EQ(tangents(gltf), 8u);
}

TEST_F(ReadMesh, BadGltfTangentsAreRefusedInWords) {
    const auto refused = [&](std::size_t number, float value, const char* words) {
        std::vector<float> tangents = four_times({1, 0, 0, 1});
        tangents[number] = value;
        expect_refused("a.gltf", with_tangent_attribute(tangents).embedded(), words);
    };
    refused(7, 0, "tangent of vertex 1 has w = 0 (expected 1 or -1)");
    refused(3, 0.5f, "tangent of vertex 0 has w = 0.5");
    refused(3, std::nanf(""), "tangent of vertex 0");
    refused(4, std::nanf(""), "the tangent of vertex 1 is not a finite number");
    refused(4, INFINITY, "the tangent of vertex 1 is not a finite number");

    Gltf gltf = with_tangent_attribute(four_times({1, 0, 0, 1}));
    const std::string accessors = gltf.more_accessors;
    gltf.more_accessors.replace(accessors.rfind("VEC4"), 4, "VEC3");
    expect_refused("a.gltf", gltf.embedded(), "(TANGENT): has 3 components (expected 4)");
    gltf.more_accessors = accessors;
    gltf.more_accessors.replace(accessors.rfind("4, \"type"), 1, "3");
    expect_refused("a.gltf", gltf.embedded(), "4 positions and 3 tangents");
    gltf.more_accessors.replace(accessors.rfind("4, \"type"), 1, "5");
    expect_refused("a.gltf", gltf.embedded(), "reach over the end of a view");
    gltf.more_accessors = accessors;
    gltf.attributes.replace(gltf.attributes.rfind("4"), 1, "9");
    expect_refused("a.gltf", gltf.embedded(), "accessor 9 (TANGENT)");
}

TEST_F(ReadMesh, GltfPicturesAndUnknownThingsAreNotOpened) {
    Gltf gltf;
    gltf.more = R"("images": [{"uri": "missing.png"}], "textures": [{"source": 99}],
"materials": [{"pbrMetallicRoughness": 3}], "animations": [7], "skins": "none", "extensionsRequired": ["KHR_materials_ior"],)";
    expect_square(read("a.gltf", gltf.embedded()));
}

TEST_F(ReadMesh, BadGltfIsRefusedInWords) {
    using Change = std::function<void(Gltf&)>;
    const auto replace = [](std::string& text, const std::string& from, const std::string& to) {
        const std::size_t at = text.find(from);
        ASSERT_NE(at, std::string::npos);
        text.replace(at, from.size(), to);
    };
    const std::pair<Change, const char*> changes[] = {
        {[](Gltf& g) { g.asset = R"({"version": "1.0"})"; }, "glTF 1.0"},
        {[](Gltf& g) { g.asset = "{}"; }, "version"},
        {[](Gltf& g) { g.more = R"("extensionsRequired": ["KHR_draco_mesh_compression"],)"; },
         "KHR_draco_mesh_compression"},
        {[](Gltf& g) { g.more = R"("extensionsRequired": ["EXT_meshopt_compression"],)"; },
         "EXT_meshopt_compression"},
        {[&](Gltf& g) { replace(g.position, "4", "5"); }, "reach over the end of a view"},
        {[&](Gltf& g) { replace(g.position, "4,", "18446744073709551615,"); }, "a.gltf"},
        {[&](Gltf& g) { replace(g.position, "VEC3", "VEC2"); }, "2 components (expected 3)"},
        {[&](Gltf& g) { replace(g.position, "\"bufferView\": 0,", ""); }, "no buffer view"},
        {[&](Gltf& g) { replace(g.position, "\"bufferView\": 0,", "\"bufferView\": 77,"); },
         "no buffer view"},
        {[&](Gltf& g) { replace(g.position, "5126", "5130"); }, "type 5130"},
        {[&](Gltf& g) {
             g.position +=
                 R"(, "sparse": {"count": 1, "indices": {"bufferView": 2, "componentType": 5123}, "values": {"bufferView": 0}})";
         },
         "sparse"},
        {[&](Gltf& g) { g.position += R"(, "byteOffset": 49)"; }, "reach over"},
        {[&](Gltf& g) { replace(g.coordinate, "4,", "3,"); }, "4 positions and 3"},
        {[&](Gltf& g) { replace(g.indices, "6,", "5,"); }, "multiple of 3"},
        {[&](Gltf& g) { replace(g.indices, "6,", "7,"); }, "reach over"},
        {[&](Gltf& g) { replace(g.indices, "5123", "5126"); }, "reach over"},
        {[&](Gltf& g) { replace(g.views, "48}", "480}"); }, "reaches over the end of a buffer"},
        {[&](Gltf& g) { replace(g.views, "48}", "48, \"byteStride\": 8}"); }, "8 apart"},
        {[&](Gltf& g) { replace(g.views, "\"buffer\": 0", "\"buffer\": 9"); }, "no buffer"},
        {[&](Gltf& g) { g.binary[80] = 4; }, "index 4 of a primitive with 4"},
        {[&](Gltf& g) { g.binary[2] = '\x80', g.binary[3] = '\x7f'; }, "position of vertex 0"},
        {[&](Gltf& g) { g.attributes = R"("TEXCOORD_0": 1)"; }, "no positions"},
        {[&](Gltf& g) { g.attributes = R"("POSITION": 12)"; }, "accessor 12"},
        {[&](Gltf& g) { g.attributes = R"("POSITION": "a")"; }, "a.gltf"},
        {[&](Gltf& g) { g.primitive = R"("indices": 55)"; }, "a.gltf"},
        {[&](Gltf& g) { g.primitive = R"("mode": 1)"; }, "no triangle"},
        {[&](Gltf& g) { g.nodes = R"({"mesh": 8})"; }, "mesh 8"},
        {[&](Gltf& g) { g.nodes = R"({"mesh": 0, "children": [0]})"; }, "twice"},
        {[&](Gltf& g) { g.nodes = R"({"mesh": 0, "children": [4]})"; }, "node 4"},
        {[&](Gltf& g) { g.nodes = R"({"mesh": 0, "matrix": [1, 2]})"; }, "matrix"},
        {[&](Gltf& g) { g.nodes = R"({"mesh": 0, "scale": [1e300, 1, 1]})"; }, "not a finite"},
        {[&](Gltf& g) { g.scenes = R"("scene": 3, "scenes": [{"nodes": [0]}])"; }, "scene 3"},
        {[&](Gltf& g) { g.scenes = R"("scenes": [{}])"; }, "no triangle"},
        {[&](Gltf& g) { g.more = "\"extras\": " + std::string(100000, '[') + ","; }, "nests"},
    };
    for (std::size_t i = 0; i < std::size(changes); ++i) {
        SCOPED_TRACE(i);
        Gltf gltf;
        changes[i].first(gltf);
        expect_refused("a.gltf", gltf.embedded(), changes[i].second);
    }
}

TEST_F(ReadMesh, BadGltfContainersAreRefusedInWords) {
    const Gltf gltf;
    expect_refused("a.gltf", "", "not glTF");
    expect_refused("a.gltf", "[]", "an object was expected");
    expect_refused("a.gltf", "hello", "not glTF");
    expect_refused("a.gltf", gltf.text("missing.bin"), "missing.bin: cannot be opened");
    expect_refused("a.gltf", gltf.text("/dev/zero"), "regular file");
    write("short.bin", "1234");
    expect_refused("a.gltf", gltf.text("short.bin"), "has 4 bytes (expected 92)");
    expect_refused("a.gltf", gltf.text("data:application/octet-stream;base64,AAAA"), "a.gltf");
    expect_refused("a.gltf", gltf.text("data:what,ever"), "a.gltf");
    expect_refused("a.gltf", gltf.text(""), "no binary chunk");
    expect_refused("a.glb", glb(gltf.text(""), gltf.binary.substr(0, 20)),
                   "20 bytes (expected 92)");
    std::string version_3 = gltf.container();
    version_3[4] = 3;
    expect_refused("a.glb", version_3, "version 3");
    expect_refused("a.glb", gltf.container().substr(0, 50), "truncated");
    std::string long_chunk = gltf.container();
    long_chunk[15] = '\x7f';
    expect_refused("a.glb", long_chunk, "over the end");
    expect_refused("a.glb", gltf.container(), "memory", {500});
    Gltf zero;
    zero.binary.clear();
    expect_refused("a.gltf", zero.embedded(), "no byteLength");
}

// Mutations --------------------------------------------------------------------------------------

// Whatever is done to a file, it is read or refused. Run with sanitizers this is where they look.
TEST(MeshReaders, MutatedFilesAreReadOrRefused) {
    const std::pair<const char*, std::string> files[] = {
        {"a.obj", kTriangle + "v 0.5 0.2 1e1\nvt 0.5 1\nvn 0 0 1\ng x\nf 1/1/1 2/1/1 3/-1/-1\n"
                              "f -4 4 2 3\nusemtl a\nf 2 3//1 \\\n 4\n"},
        {"a.gltf", Gltf().embedded()},
        {"a.gltf", with_tangent_attribute(four_times({1, 0, 0, 1})).container()},
        {"a.glb", Gltf().container()}};
    int read_count = 0, refused_count = 0;
    const auto attempt = [&](const char* name, const std::string& content) {
        try {
            detail::InputFile file(name, std::as_bytes(std::span(content)));
            const Mesh mesh = detail::read_mesh(file, 64 << 20);
            ++read_count;
            for (const std::uint32_t index : mesh.indices) ASSERT_LT(index, mesh.positions.size());
            for (const Vec3f& n : mesh.normals) ASSERT_NEAR(n.length(), 1, 1e-5);
            if (mesh.texture_coordinates.empty()) return;
            const Mesh framed = with_tangents(mesh);
            ASSERT_EQ(framed.tangents.size(), framed.positions.size());
            for (const Vec4f& t : framed.tangents) ASSERT_NEAR(t.length2(), 2, 1e-5);
        } catch (const Error& error) {
            ASSERT_EQ(error.code(), Errc::cannot_read);
            ++refused_count;
        }
    };
    std::mt19937 random(1);
    for (const auto& [name, content] : files) {
        for (std::size_t length = 0; length <= content.size(); ++length)
            attempt(name, content.substr(0, length));
        for (int i = 0; i < 10000; ++i) {
            std::string changed = content;
            const int count = 1 + static_cast<int>(random() % 3);
            for (int k = 0; k < count; ++k) {
                char& byte = changed[random() % changed.size()];
                // Half of them other digits and signs, which keep more of the grammar alive.
                byte = random() % 2 == 0 ? static_cast<char>(random())
                                         : "0123456789-+./e[]{}\", "[random() % 22];
            }
            attempt(name, changed);
        }
    }
    EXPECT_GT(read_count, 1000);
    EXPECT_GT(refused_count, 1000);
}

}  // namespace
}  // namespace mirrorball
