// OpenEXR's grids: against OpenEXR's own mapping of pixels to directions, and by smooth functions
// of the direction that either grid must hold.
#include "io/edge_grid.h"

#include <cmath>
#include <functional>

#include <ImfEnvmap.h>
#include <gtest/gtest.h>
#include <mirrorball/projections/cube.h>
#include <mirrorball/projections/equirect.h>
#include <mirrorball/vector.h>

namespace mirrorball::detail {
namespace {

// Harmonics up to band 2 and a constant that keeps it positive, between about 0.3 and 4.
double smooth(const Vec3d& d, int channel) {
    const double turn = channel * 0.7;
    return 2 + d.x * std::cos(turn) - 0.8 * d.y + 0.4 * d.z * d.x +
           0.5 * d.y * d.z * std::sin(turn);
}

Image smooth_picture(int width, int height, const std::function<Vec3d(int, int)>& direction) {
    Image image(width, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < 3; ++c)
                image.at(x, y)[c] = static_cast<float>(smooth(direction(x, y), c));
    return image;
}

std::vector<Image> smooth_cube(int n) {
    std::vector<Image> faces;
    for (int face = 0; face < 6; ++face)
        faces.push_back(smooth_picture(n, n, [&](int x, int y) {
            return Cube::direction(FacePoint<double>{face, (x + 0.5) / n, (y + 0.5) / n});
        }));
    return faces;
}

// What OpenEXR has at the pixels of our face: its strip has -Z before +Z seen from our cube, whose
// z is the world's negated (exr.cpp).
std::vector<Image> smooth_edge_cube(int n) {
    const Imath::Box2i strip({0, 0}, {n - 1, 6 * n - 1});
    constexpr Imf::CubeMapFace kFaces[6] = {Imf::CUBEFACE_POS_X, Imf::CUBEFACE_NEG_X,
                                            Imf::CUBEFACE_POS_Y, Imf::CUBEFACE_NEG_Y,
                                            Imf::CUBEFACE_NEG_Z, Imf::CUBEFACE_POS_Z};
    std::vector<Image> faces(6, Image(n, n, 3));
    for (int face = 0; face < 6; ++face) {
        const Imath::Box2i window = Imf::CubeMap::dataWindowForFace(kFaces[face], strip);
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                const Imath::V2f in_face(static_cast<float>(i), static_cast<float>(j));
                const Imath::V2f at = Imf::CubeMap::pixelPosition(kFaces[face], strip, in_face);
                const Imath::V3f d = Imf::CubeMap::direction(kFaces[face], strip, in_face);
                const Vec3d ours = Vec3d(d.x, d.y, -d.z).normalized();
                for (int c = 0; c < 3; ++c)
                    faces[face].at(static_cast<int>(std::lround(at.x)) - window.min.x,
                                   static_cast<int>(std::lround(at.y)) - window.min.y)[c] =
                        static_cast<float>(smooth(ours, c));
            }
    }
    return faces;
}

Image smooth_equirect(int width) {
    const int height = width / 2;
    return smooth_picture(width, height, [&](int x, int y) {
        return Equirect::direction(FacePoint<double>{0, (x + 0.5) / width, (y + 0.5) / height});
    });
}

// OpenEXR's, in the frame that its pictures have for us: x and z negated.
Image smooth_edge_equirect(int width) {
    const int height = width / 2;
    const Imath::Box2i window({0, 0}, {width - 1, height - 1});
    return smooth_picture(width, height, [&](int x, int y) {
        const Imath::V3f d = Imf::LatLongMap::direction(
            window, Imath::V2f(static_cast<float>(x), static_cast<float>(y)));
        return Vec3d(-d.x, d.y, -d.z);
    });
}

double rms(const std::vector<Image>& a, const std::vector<Image>& b) {
    double sum = 0, count = 0;
    for (std::size_t face = 0; face < a.size(); ++face)
        for (std::size_t i = 0; i < a[face].values().size(); ++i, ++count)
            sum += std::pow(double(a[face].values()[i]) - b[face].values()[i], 2);
    return std::sqrt(sum / count);
}

double worst(const std::vector<Image>& a, const std::vector<Image>& b) {
    double most = 0;
    for (std::size_t face = 0; face < a.size(); ++face)
        for (std::size_t i = 0; i < a[face].values().size(); ++i)
            most = std::max(most, std::abs(double(a[face].values()[i]) - b[face].values()[i]));
    return most;
}

// Tolerances: what the cubic polynomials leave of a band-2 function on n samples of a quarter turn
// is about (pi / 2n)^4; the figures are two or three times what was measured. Holding results
// between the texels around them takes off the tops, which is (pi / 2n)^2 / 8 at a few texels:
// hence `worst`.
TEST(EdgeGrid, CubesMatchOpenExrsDirections) {
    constexpr int n = 64;
    EXPECT_LT(rms(cube_from_edge_grid(smooth_edge_cube(n)), smooth_cube(n)), 1e-5);
    EXPECT_LT(worst(cube_from_edge_grid(smooth_edge_cube(n)), smooth_cube(n)), 3e-4);
    // At the eight corners three faces meet, and there is no fourth texel to interpolate with.
    EXPECT_LT(rms(cube_to_edge_grid(smooth_cube(n)), smooth_edge_cube(n)), 5e-5);
    EXPECT_LT(worst(cube_to_edge_grid(smooth_cube(n)), smooth_edge_cube(n)), 5e-3);
}

TEST(EdgeGrid, EquirectsMatchOpenExrsDirections) {
    constexpr int width = 256;
    EXPECT_LT(rms({equirect_from_edge_grid(smooth_edge_equirect(width))}, {smooth_equirect(width)}),
              1e-5);
    EXPECT_LT(
        worst({equirect_from_edge_grid(smooth_edge_equirect(width))}, {smooth_equirect(width)}),
        3e-4);
    EXPECT_LT(rms({equirect_to_edge_grid(smooth_equirect(width))}, {smooth_edge_equirect(width)}),
              1e-5);
    EXPECT_LT(worst({equirect_to_edge_grid(smooth_equirect(width))}, {smooth_edge_equirect(width)}),
              3e-4);
}

TEST(EdgeGrid, ThereAndBackIsNearlyTheSame) {
    const auto cube = smooth_cube(64);
    const double cube_error = rms(cube_from_edge_grid(cube_to_edge_grid(cube)), cube);
    EXPECT_LT(cube_error, 1e-5);
    const std::vector<Image> equirect{smooth_equirect(256)};
    const double equirect_error =
        rms({equirect_from_edge_grid(equirect_to_edge_grid(equirect[0]))}, equirect);
    EXPECT_LT(equirect_error, 1e-5);
}

TEST(EdgeGrid, ConstantsStayToTheBitAtEverySize) {
    for (int n = 1; n <= 9; ++n) {
        std::vector<Image> faces(6, Image(n, n, 3));
        for (Image& face : faces)
            for (float& value : face.values()) value = 0.7f;
        for (const auto& result : {cube_from_edge_grid(faces), cube_to_edge_grid(faces)})
            for (const Image& face : result)
                for (const float value : face.values()) ASSERT_EQ(value, 0.7f) << n;
        Image image(2 * n, n, 3);
        for (float& value : image.values()) value = 0.7f;
        for (const Image& result : {equirect_from_edge_grid(image), equirect_to_edge_grid(image)})
            for (const float value : result.values()) ASSERT_FLOAT_EQ(value, 0.7f) << n;
    }
}

// A sun leaves no dark ring and no negative light, and gets no brighter.
TEST(EdgeGrid, StaysBetweenWhatItIsMadeOf) {
    std::vector<Image> faces(6, Image(16, 16, 3));
    for (Image& face : faces)
        for (float& value : face.values()) value = 0.5f;
    faces[2].set_rgb(0, 3, {50000, 50000, 50000});
    faces[4].set_rgb(8, 8, {60000, 60000, 60000});
    for (const auto& result : {cube_from_edge_grid(faces), cube_to_edge_grid(faces)})
        for (const Image& face : result)
            for (const float value : face.values()) {
                ASSERT_GE(value, 0.5f);
                ASSERT_LE(value, 60000.0f);
            }
}

// OpenEXR's poles are rows of one direction, and its last column is its first.
TEST(EdgeGrid, PolesAndSeamOfAnEquirectAreOneDirectionEach) {
    const Image edges = equirect_to_edge_grid(smooth_equirect(32));
    for (const int y : {0, edges.height() - 1})
        for (int x = 1; x < edges.width(); ++x) EXPECT_EQ(edges.rgb(x, y), edges.rgb(0, y));
    for (int y = 0; y < edges.height(); ++y)
        EXPECT_TRUE(edges.rgb(0, y).equalWithRelError(edges.rgb(edges.width() - 1, y), 1e-6f));
}

}  // namespace
}  // namespace mirrorball::detail
