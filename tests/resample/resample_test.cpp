#include <mirrorball/resample.h>

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <mirrorball/compare.h>
#include <mirrorball/error.h>
#include <mirrorball/io.h>
#include <tbb/global_control.h>

#include "support.h"
#include "synthetic.h"

namespace mirrorball {
namespace {

std::vector<Projection> all_projections() {
    std::vector<Projection> all;
    for (std::size_t i = 0; i < kProjectionCount; ++i) all.push_back(static_cast<Projection>(i));
    return all;
}

EnvironmentMap to(const EnvironmentMap& source, Projection projection, int size,
                  Interpolation interpolation = Interpolation::bicubic) {
    return resample(source, projection, size, default_axes(projection), {interpolation, {}});
}

void expect_same_bits(const EnvironmentMap& a, const EnvironmentMap& b) {
    ASSERT_EQ(a.levels[0].faces.size(), b.levels[0].faces.size());
    for (std::size_t i = 0; i < a.levels[0].faces.size(); ++i) {
        const auto va = a.levels[0].faces[i].values(), vb = b.levels[0].faces[i].values();
        ASSERT_TRUE(std::equal(va.begin(), va.end(), vb.begin(), vb.end()));
    }
}

double flux_error(const EnvironmentMap& found, const EnvironmentMap& expected) {
    const Vec3d a = flux(found), b = flux(expected);
    return std::max({std::abs(a.x / b.x - 1), std::abs(a.y / b.y - 1), std::abs(a.z / b.z - 1)});
}

// All 49 pairs: a smooth function arrives as itself. With 128 texels around, the curvature of the
// function over a texel is (2 pi / 128)^2 / 8 x 4 = 1e-3 of it at most; most of the sphere has
// less. At the rim of a sphere map single texels reach over tens of degrees, in which no bound on
// the largest error means much, and what is read from there is that coarse; the texels of an
// angular map's rim are wide, too, and their neighbours across it are only the nearest ones.
TEST(Resample, SmoothLightArrivesFromEveryProjectionInEveryOther) {
    for (const Projection from : all_projections()) {
        const EnvironmentMap source = averaged(from, size_for(from, 128), smooth_light);
        for (const Projection target : all_projections()) {
            SCOPED_TRACE(std::string(name(from)) + " to " + std::string(name(target)));
            for (const int texels_around : {64, 128, 200}) {
                const int size = size_for(target, texels_around);
                const EnvironmentMap result = to(source, target, size);
                const EnvironmentMap truth = averaged(target, size, smooth_light);
                const Difference d = compare(result, truth);
                const auto either = [&](Projection p) { return from == p || target == p; };
                const bool sphere = either(Projection::sphere),
                           angular = either(Projection::angular);
                EXPECT_LT(d.relative_rmse, from == Projection::sphere ? 1e-2 : 1.5e-3)
                    << texels_around;
                EXPECT_LT(d.maximum_relative, sphere ? 0.35 : 3e-2)
                    << d.face << " " << d.x << " " << d.y;
                EXPECT_LT(flux_error(result, source), sphere || angular ? 1.2e-3 : 2e-4)
                    << texels_around;
            }
        }
    }
}

// The three real ones, at equal resolution, where they lie beside the repository. A sum of a
// thousand lights of all sizes on a dim ground is their stand-in everywhere else.
EnvironmentMap many_lights() {
    std::mt19937 random(17);
    EnvironmentMap map = averaged(Projection::equirect, 512, smooth_light);
    for (int i = 0; i < 1000; ++i) {
        const int x = static_cast<int>(random() % 508), y = 20 + static_cast<int>(random() % 210);
        const int extent = 1 + static_cast<int>(random() % 4);
        const float power = std::exp2(static_cast<float>(random() % 10));
        for (int dy = 0; dy < extent; ++dy)
            for (int dx = 0; dx < extent; ++dx)
                map.levels[0].faces[0].set_rgb(x + dx, y + dy, {power, power, power});
    }
    return map;
}

void expect_flux_kept_everywhere(const EnvironmentMap& source) {
    for (const Projection target : all_projections()) {
        const int size =
            size_for(target, source.width() - 2);  // not quite equal: no bits are copied
        EXPECT_LT(flux_error(to(source, target, size / 2 * 2), source), 1e-3) << name(target);
    }
}

TEST(Resample, FluxOfManyLightsIsKept) {
    expect_flux_kept_everywhere(many_lights());
}

TEST(Resample, FluxOfRealPanoramasIsKept) {
    for (const char* file : {"hdri/venice.hdr", "hdri/studio.hdr", "hdri/forest.hdr"}) {
        const auto path = shared_file(file);
        if (!path) GTEST_SKIP() << "shared/" << file << " is not beside the repository";
        expect_flux_kept_everywhere(read_map(path->string()).map);
    }
}

// The same at the resolution of small real panoramas: the 1e-4 on smooth maps.
TEST(Resample, FluxOfSmoothLightIsKept) {
    const EnvironmentMap source = averaged(Projection::equirect, 512, smooth_light);
    for (const Projection target : all_projections())
        EXPECT_LT(flux_error(to(source, target, size_for(target, 512)), source), 2e-5)
            << name(target);
}

TEST(Resample, WhatChangesNothingKeepsEveryBit) {
    for (const Projection p : all_projections()) {
        const EnvironmentMap source = sampled(p, 16, smooth_light);
        expect_same_bits(to(source, p, 16), source);
    }
}

TEST(Resample, UniformLightStaysUniform) {
    for (const Projection from : all_projections()) {
        const EnvironmentMap source =
            sampled(from, 22, [](const Vec3d&) { return Vec3d(0.7, 1, 3); });
        for (const Projection target : all_projections()) {
            for (const int size : {2, 6, 10, 64}) {
                const EnvironmentMap result = to(source, target, size);
                const LevelStatistics s = statistics(result);
                for (int c = 0; c < 3; ++c) {
                    const float expected = source.levels[0].faces[0].rgb(11, 5)[c];
                    EXPECT_NEAR(s.minimum[c], expected, 2e-6 * expected)
                        << name(from) << " to " << name(target) << " " << size;
                    EXPECT_NEAR(s.maximum[c], expected, 2e-6 * expected);
                }
            }
        }
    }
}

// One lit texel anywhere: nothing of it is passed over, at any ratio of sizes.
TEST(Resample, OneLitTexelKeepsItsFlux) {
    std::mt19937 random(5);
    for (const int size : {4, 16, 32, 64, 100}) {
        double sum = 0, worst = 0;
        constexpr int count = 48;
        for (int i = 0; i < count; ++i) {
            EnvironmentMap source = make_environment_map(Projection::equirect, 256);
            const int x = static_cast<int>(random() % 256),
                      y = 12 + static_cast<int>(random() % 104);
            source.levels[0].faces[0].set_rgb(x, y, {1e5f, 1e5f, 1e5f});
            const double error = flux(to(source, Projection::cube, size)).x / flux(source).x - 1;
            sum += error / count;
            worst = std::max(worst, std::abs(error));
        }
        // Where the grids lie askew a cell's box stands in for its parallelogram. Its share of a
        // single texel is off by up to a quarter or so either way, by none on average: what a sun
        // of several texels, or a panorama, sees (docs/theory/resampling.md has their figures).
        EXPECT_LT(std::abs(sum), 0.03) << size;
        EXPECT_LT(worst, 0.35) << size;
    }
}

// Truth by brute force: the mean over a texel of the bilinear interpolant of an equirect, in
// double, with 24 x 24 samples weighed by solid angle, from nothing but the definitions.
Vec3d bilinear_equirect(const EnvironmentMap& map, const Vec3d& d) {
    const int width = map.width(), height = map.height();
    const Image& image = map.levels[0].faces[0];
    const double u = (0.5 + std::atan2(d.x, -d.z) / (2 * kPi)) * width - 0.5;
    const double v = std::acos(std::clamp(d.y, -1.0, 1.0)) / kPi * height - 0.5;
    const int x0 = static_cast<int>(std::floor(u)), y0 = static_cast<int>(std::floor(v));
    Vec3d sum(0.0);
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            int x = x0 + i, y = y0 + j;
            if (y < 0 || y >= height) {  // over the pole, to the opposite meridian
                y = y < 0 ? -1 - y : 2 * height - 1 - y;
                x += width / 2;
            }
            x = (x % width + width) % width;
            const double weight =
                (i == 0 ? 1 - (u - x0) : u - x0) * (j == 0 ? 1 - (v - y0) : v - y0);
            sum += Vec3d(image.rgb(x, y)) * weight;
        }
    return sum;
}

TEST(Resample, TexelIsTheMeanOverItsSolidAngle) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> uniform;
    const EnvironmentMap source = sampled(Projection::equirect, 128, [&](const Vec3d&) {
        return Vec3d(uniform(random), uniform(random), uniform(random));
    });
    for (const int size : {6, 20, 40}) {
        const EnvironmentMap result = to(source, Projection::cube, size, Interpolation::bilinear);
        double error = 0, power = 0;
        for (int face = 0; face < 6; ++face) {
            for (int y = 0; y < size; ++y)
                for (int x = 0; x < size; ++x) {
                    Vec3d sum(0.0);
                    double weight = 0;
                    constexpr int steps = 24;
                    for (int j = 0; j < steps; ++j)
                        for (int i = 0; i < steps; ++i) {
                            const FacePoint<double> p{face, (x + (i + 0.5) / steps) / size,
                                                      (y + (j + 0.5) / steps) / size};
                            const double w = Cube::density(p);
                            sum += bilinear_equirect(source,
                                                     result.axes.to_world(Cube::direction(p))) *
                                   w;
                            weight += w;
                        }
                    const Vec3d difference =
                        Vec3d(result.levels[0].faces[face].rgb(x, y)) - sum / weight;
                    // against the noise's own deviation, 0.29, not its mean
                    error += difference.dot(difference);
                    power += 3.0 / 12;
                }
        }
        EXPECT_LT(std::sqrt(error / power), 0.06) << size;
    }
}

// A sun over a dim sky, made finer: no dark ring and nothing brighter than the sun.
TEST(Resample, NothingGoesBeyondTheSource) {
    EnvironmentMap source =
        sampled(Projection::equirect, 64, [](const Vec3d&) { return Vec3d(0.01); });
    source.levels[0].faces[0].set_rgb(40, 10, {1e5f, 1e5f, 1e5f});
    for (const Interpolation interpolation : {Interpolation::bilinear, Interpolation::bicubic}) {
        const LevelStatistics s = statistics(to(source, Projection::cube, 128, interpolation));
        EXPECT_GE(s.minimum.x, 0.0099f);
        EXPECT_LE(s.maximum.x, 1.00001e5f);
    }
}

// Made four times finer, the picture's edges are as smooth as its middle.
TEST(Resample, InterpolationCrossesEdgesAndPolesWithoutASeam) {
    const auto rough = [](const Vec3d& d) {
        return Vec3d(1 + 0.5 * std::sin(6 * d.x + 4 * d.y) * std::cos(5 * d.z));
    };
    for (const Projection from : all_projections()) {
        const EnvironmentMap source = sampled(from, size_for(from, 64), rough);
        for (const Projection target : all_projections()) {
            const EnvironmentMap fine = to(source, target, size_for(target, 256));
            // 1.35 measured, at the folds of octahedral maps, across which texels turn
            EXPECT_LT(seam_ratio(fine), 1.5) << name(from) << " to " << name(target);
        }
    }
}

// Each direction keeps its colour whatever frame the maps are in: nothing is turned or mirrored.
TEST(Resample, FramesAreHonoured) {
    const EnvironmentMap source = sampled(Projection::equirect, 256, smooth_light);
    for (const char* frame : {"+x+y+z", "+z+y-x", "-x+y-z", "+x-z+y", "-x+y+z", "+y-x+z"}) {
        const Axes axes = parse_axes(frame, Projection::cube);
        const EnvironmentMap cube = resample(source, Projection::cube, 64, axes);
        EXPECT_EQ(cube.axes, axes);
        EXPECT_LT(compare(cube, sampled(Projection::cube, 64, axes, smooth_light)).relative_rmse,
                  1e-3)
            << frame;
        // and out of that frame again
        const EnvironmentMap back = resample(cube, Projection::equirect, 256, Axes{});
        EXPECT_LT(compare(back, source).relative_rmse, 1e-3) << frame;
    }
}

TEST(Resample, QuarterTurnOfAnEquirectIsAShift) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform;
    const EnvironmentMap source =
        sampled(Projection::equirect, 64, [&](const Vec3d&) { return Vec3d(uniform(random)); });
    EnvironmentMap turned = source;
    turned.axes = rotated(turned.axes, kPi / 2, 0, 0);
    const EnvironmentMap result =
        resample(turned, Projection::equirect, 64, Axes{}, {Interpolation::bicubic, {}});
    // the content moves to the left by a quarter; each texel is averaged over itself, which blurs
    // the noise by known weights (3/4 and 1/8 twice, along each axis away from the poles)
    for (int y = 10; y < 22; ++y)
        for (int x = 0; x < 64; ++x) {
            double expected = 0;
            for (int j = -1; j <= 1; ++j)
                for (int i = -1; i <= 1; ++i)
                    expected += (i == 0 ? 0.75 : 0.125) * (j == 0 ? 0.75 : 0.125) *
                                source.levels[0].faces[0].rgb((x + 16 + i + 64) % 64, y + j).x;
            ASSERT_NEAR(result.levels[0].faces[0].rgb(x, y).x, expected, 1e-4) << x << " " << y;
        }
}

TEST(Resample, SameBitsOnAnyNumberOfThreads) {
    const EnvironmentMap source = sampled(Projection::equirect, 200, smooth_light);
    const EnvironmentMap expected = to(source, Projection::cube, 37);
    for (const int threads : {1, 2, 3, 7}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        expect_same_bits(to(source, Projection::cube, 37), expected);
    }
}

TEST(Resample, SmallestMaps) {
    for (const Projection from : all_projections()) {
        const EnvironmentMap source = sampled(from, aspect(from), smooth_light);
        for (const Projection target : all_projections()) {
            for (const int size : {aspect(target), 2 * aspect(target), 18}) {
                const LevelStatistics s = statistics(to(source, target, size));
                EXPECT_EQ(s.non_finite_count, 0);
                EXPECT_GT(s.minimum.x, 0) << name(from) << " to " << name(target) << " " << size;
            }
        }
    }
    EXPECT_THROW((void)make_environment_map(Projection::cube, 0), Error);
    EXPECT_THROW((void)make_environment_map(Projection::equirect, 7), Error);
}

// A plan is used again and again, with other pixels each time, and into a map that held others. By
// all that its patches may do: whole and half faces, moved along a panorama or not at all, in axes
// that no symmetry fits, with rims and with texels cut into cells.
TEST(Resampler, GivesTheBitsOfResample) {
    const Axes askew = rotated(Axes{}, 0.3, 0.2, 0.1);
    for (const Projection from : all_projections()) {
        for (const Projection target : all_projections()) {
            for (const Axes& axes : {default_axes(target), askew}) {
                SCOPED_TRACE(std::string(name(from)) + " to " + std::string(name(target)));
                const EnvironmentMap first = sampled(from, size_for(from, 40), smooth_light);
                EnvironmentMap second = first;
                for (Image& face : second.levels[0].faces)
                    for (float& value : face.values()) value = 1 / (1 + value);
                const MapShape shape{target, size_for(target, 72), axes};
                const Resampler plan(shape_of(first), shape);
                EnvironmentMap result = plan(first);
                EXPECT_EQ(shape_of(result), shape);
                expect_same_bits(result, resample(first, target, shape.size, axes));
                plan(second, result);
                expect_same_bits(result, resample(second, target, shape.size, axes));
            }
        }
    }
}

TEST(Resampler, OverwritesAllOfAMap) {
    for (const Projection target : all_projections()) {
        // the smallest has no four texels side by side, which vectors take
        for (const int width : {2, 8, 64}) {
            const EnvironmentMap source = sampled(Projection::equirect, width, smooth_light);
            const MapShape shape{target, size_for(target, 50), default_axes(target)};
            const Resampler plan(shape_of(source), shape);
            EnvironmentMap result = plan(source);
            const EnvironmentMap expected = result;
            for (Image& face : result.levels[0].faces) std::ranges::fill(face.values(), -7.0f);
            plan(source, result);
            expect_same_bits(result, expected);
        }
    }
}

// The symmetries that a plan makes use of are found, not assumed. Here they differ by the sizes'
// being even and the panorama's being a multiple of four, and by the axes; what shows a wrong one
// is a colour in a wrong place.
TEST(Resampler, SymmetriesLeaveEveryColourInItsPlace) {
    const auto expect_in_place = [](const EnvironmentMap& source, const MapShape& shape) {
        const EnvironmentMap result = Resampler(shape_of(source), shape)(source);
        const EnvironmentMap truth =
            sampled(shape.projection, shape.size, shape.axes, smooth_light);
        EXPECT_LT(compare(result, truth).maximum_relative, 2e-2)
            << name(source.projection) << " " << source.width() << " to " << name(shape.projection)
            << " " << shape.size << " " << to_string(shape.axes);
    };
    const Axes askew = rotated(Axes{}, 0.3, 0.2, 0.1);
    for (const int width : {128, 130, 132})
        for (const int size : {31, 32})
            for (const char* frame : {"+x+y-z", "+z+y-x", "-x+y+z", "+y-x+z", "-z-y+x"}) {
                const Axes axes = parse_axes(frame, Projection::cube);
                const EnvironmentMap panorama = sampled(Projection::equirect, width, smooth_light);
                expect_in_place(panorama, {Projection::cube, size, axes});
                const EnvironmentMap cube =
                    sampled(Projection::cube, width / 4, axes, smooth_light);
                expect_in_place(cube, {Projection::cube, size, default_axes(Projection::cube)});
                expect_in_place(cube, {Projection::equirect, 2 * size, askew});
                expect_in_place(cube, {Projection::octahedral, 2 * size, axes});
            }
}

TEST(Resampler, SymmetriesSaveMemory) {
    const MapShape panorama{Projection::equirect, 256, Axes{}};
    const Axes cube = default_axes(Projection::cube), askew = rotated(cube, 0.3, 0.2, 0.1);
    // two of 24 quarters of faces; in any axes a half, since both look the same turned inside out
    const std::size_t texels = 6 * 128 * 128,
                      alike = Resampler(panorama, {Projection::cube, 128, cube}).bytes(),
                      general = Resampler(panorama, {Projection::cube, 128, askew}).bytes();
    // 16 bytes each; the cells of cut texels come on top
    EXPECT_GE(alike, texels / 12 * 16);
    EXPECT_LT(alike, 2 * texels / 12 * 16);
    EXPECT_GE(general, texels / 2 * 16);
    EXPECT_LT(general, 2 * texels / 2 * 16);
}

// The message says what was expected; the map that was to be written stays as it was.
TEST(Resampler, NamesMapsThatItsPlanIsNotFor) {
    const EnvironmentMap source = sampled(Projection::equirect, 32, smooth_light);
    const MapShape shape{Projection::cube, 8, default_axes(Projection::cube)};
    const Resampler plan(shape_of(source), shape);
    const auto expect_refused = [&](const EnvironmentMap& from, EnvironmentMap to,
                                    const std::string& words) {
        const EnvironmentMap before = to;
        try {
            plan(from, to);
            FAIL() << words;
        } catch (const Error& e) {
            EXPECT_EQ(e.code(), Errc::usage);
            EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
        }
        if (before.level_count() > 0) expect_same_bits(to, before);
    };
    const EnvironmentMap result = plan(source);
    expect_refused(sampled(Projection::equirect, 34, smooth_light), result,
                   "the source of a resampling is equirect of size 34");
    expect_refused(source, sampled(Projection::cube, 9, smooth_light),
                   "the result of a resampling is cube of size 9");
    expect_refused(EnvironmentMap{}, result, "has no levels");
    expect_refused(source, EnvironmentMap{}, "has no levels");
    EXPECT_THROW(Resampler(shape_of(source), {Projection::cube, 0, {}}), Error);
    EXPECT_THROW(Resampler({Projection::equirect, 7, {}}, shape), Error);
}

TEST(Resample, StopsWhenAsked) {
    const EnvironmentMap source = sampled(Projection::equirect, 64, smooth_light);
    try {
        (void)resample(source, Projection::cube, 64, {},
                       {Interpolation::bicubic, [](double) { return false; }});
        FAIL();
    } catch (const Error& e) {
        EXPECT_EQ(e.code(), Errc::cancelled);
    }
}

// Every level has the flux of the first; float rounding of the texels is all that is lost.
TEST(MipLevels, KeepTheFlux) {
    for (const Projection p : all_projections()) {
        for (const int size : {16, 22, 38}) {
            EnvironmentMap map = sampled(p, size, smooth_light);
            map.levels[0].faces[0].set_rgb(size / 2, size / 4, {1e5f, 3e4f, 1e4f});
            append_mip_levels(map);
            EXPECT_EQ(map.level_count(), full_level_count(p, size));
            EXPECT_EQ(map.levels.back().height(), 1);
            for (int level = 1; level < map.level_count(); ++level)
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(flux(map, level)[c] / flux(map)[c], 1, 1e-6)
                        << name(p) << " " << level;
        }
    }
}

// 5 -> 2: the middle column is shared in halves.
TEST(MipLevels, OddSizesShareTheirTexels) {
    EnvironmentMap map = make_environment_map(Projection::equal_area_octahedral, 5);
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 5; ++x) {
            const float v = static_cast<float>(x);
            map.levels[0].faces[0].set_rgb(x, y, {v, v, v});
        }
    append_mip_levels(map, 2);
    ASSERT_EQ(map.width(1), 2);
    EXPECT_FLOAT_EQ(map.levels[1].faces[0].rgb(0, 0).x, (0 + 1 + 0.5f * 2) / 2.5f);
    EXPECT_FLOAT_EQ(map.levels[1].faces[0].rgb(1, 1).x, (0.5f * 2 + 3 + 4) / 2.5f);
}

}  // namespace
}  // namespace mirrorball
