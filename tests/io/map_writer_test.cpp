// Maps written and read back, in every layout, and what formats cannot hold.
#include <mirrorball/io.h>

#include <limits>

#include <fmt/format.h>

#include "io/texel_use.h"
#include "io_test_support.h"
#include "support.h"

namespace mirrorball {
namespace {

const float kNan = std::numeric_limits<float>::quiet_NaN();

/// Every texel a different value that a byte holds, so that RGBE has it exactly; unused ones 0, as
/// they are written.
EnvironmentMap small_map(Projection projection) {
    EnvironmentMap map = numbered_map(projection, projection == Projection::cube ? 2 : 4);
    const int width = map.width(), height = map.height();
    const std::vector<double> used = solid_angle_table(projection, width, height);
    for (Image& face : map.levels[0].faces) {
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                if (used[std::size_t(y) * width + x] == 0) face.set_rgb(x, y, {0, 0, 0});
            }
        }
    }
    return map;
}

void expect_equal_levels(const EnvironmentMap& a, const EnvironmentMap& b) {
    ASSERT_EQ(a.level_count(), b.level_count());
    for (int level = 0; level < a.level_count(); ++level) {
        SCOPED_TRACE(level);
        ASSERT_EQ(a.levels[level].faces.size(), b.levels[level].faces.size());
        for (std::size_t face = 0; face < a.levels[level].faces.size(); ++face) {
            SCOPED_TRACE(face);
            expect_equal(a.levels[level].faces[face], b.levels[level].faces[face]);
        }
        EXPECT_EQ(a.levels[level].lobe, b.levels[level].lobe);
    }
}

std::vector<Layout> layouts_of(Projection projection) {
    if (projection == Projection::cube) {
        return {Layout::automatic, Layout::horizontal_cross, Layout::vertical_cross,
                Layout::horizontal_strip, Layout::vertical_strip};
    }
    if (projection == Projection::dual_paraboloid) {
        return {Layout::automatic, Layout::side_by_side, Layout::side_by_side_turned};
    }
    return {Layout::automatic, Layout::single};
}

/// OpenEXR's own cubes have their samples on the edges of faces: tests/io/edge_grid_test.cpp.
bool is_resampled(const std::string& ending, Projection projection, Layout layout) {
    return ending == ".exr" && projection == Projection::cube && layout == Layout::automatic;
}

/// A chain of levels; every one is filtered with another lobe but the first.
EnvironmentMap chain(Projection projection, int size, int level_count) {
    EnvironmentMap map = numbered_map(projection, size);
    for (int level = 1; level < level_count; ++level) {
        const int height = std::max(1, map.height() >> level);
        Level next;
        for (int face = 0; face < face_count(projection); ++face) {
            next.faces.push_back(
                numbered_image(aspect(projection) * height, height, float(100 * level + face)));
        }
        next.lobe = Lobe{Lobe::Kind::ggx, level / 8.0};
        map.levels.push_back(next);
    }
    return map;
}

class MapWriter : public testing::Test {
  protected:
    [[nodiscard]] std::string path(const std::string& name) const {
        return (folder_ / name).string();
    }

    TemporaryFolder folder_;
};

TEST_F(MapWriter, EveryProjectionComesBackFromEveryLayout) {
    for (const char* ending : {".pfm", ".hdr", ".ktx2", ".exr"}) {
        for (std::size_t i = 0; i < kProjectionCount; ++i) {
            const auto projection = static_cast<Projection>(i);
            for (const Layout layout : layouts_of(projection)) {
                SCOPED_TRACE(fmt::format("{} {} {}", ending, name(projection), name(layout)));
                if (is_resampled(ending, projection, layout)) continue;
                const EnvironmentMap map = small_map(projection);
                const std::string file = path(std::string("map") + ending);
                const WriteReport report =
                    write_map(file, map, {{.format = TexelFormat::automatic}, layout});
                EXPECT_EQ(report.clipped_texel_count, 0);
                EXPECT_EQ(report.byte_count, std::filesystem::file_size(file));

                MapReadOptions options;
                options.projection = projection;
                options.layout = layout;
                const LoadedMap loaded = read_map(file, options);
                EXPECT_EQ(loaded.map.projection, projection);
                EXPECT_EQ(loaded.map.axes, map.axes);
                expect_equal_levels(loaded.map, map);
            }
        }
    }
}

TEST_F(MapWriter, FilesWithMetadataSayThemselvesWhatTheyAre) {
    for (const char* ending : {".hdr", ".ktx2", ".exr"}) {
        for (std::size_t i = 0; i < kProjectionCount; ++i) {
            const auto projection = static_cast<Projection>(i);
            for (const Layout layout : layouts_of(projection)) {
                SCOPED_TRACE(fmt::format("{} {} {}", ending, name(projection), name(layout)));
                EnvironmentMap map = small_map(projection);
                map.axes = rotated(map.axes, kPi / 2, 0, 0);
                map.levels[0].lobe = Lobe{Lobe::Kind::phong, 30};
                const std::string file = path(std::string("map") + ending);
                MapWriteOptions options;
                options.layout = layout;
                options.metadata["author"] = "Ada";
                write_map(file, map, options);

                const LoadedMap loaded = read_map(file);
                EXPECT_EQ(loaded.map.projection, projection);
                EXPECT_EQ(loaded.map.axes, map.axes);
                if (ending != std::string(".hdr")) {  // which has no place for strange keys
                    EXPECT_EQ(loaded.metadata.at("author"), "Ada");
                }
                if (is_resampled(ending, projection, layout)) continue;
                expect_equal_levels(loaded.map, map);
            }
        }
    }
}

TEST_F(MapWriter, FacesGoToFilesOfTheirOwn) {
    for (const Projection projection : {Projection::cube, Projection::dual_paraboloid}) {
        const EnvironmentMap map = small_map(projection);
        const WriteReport report = write_map(path("%s.pfm"), map);
        const bool cube = projection == Projection::cube;
        std::uintmax_t byte_count = 0;
        for (const char* face : {cube ? "px" : "front", cube ? "nz" : "back"}) {
            EXPECT_TRUE(std::filesystem::exists(path(std::string(face) + ".pfm"))) << face;
        }
        for (const auto& entry : std::filesystem::directory_iterator(folder_.path())) {
            byte_count += entry.file_size();
            if (!cube && entry.path().stem().string().size() == 2) byte_count -= entry.file_size();
        }
        EXPECT_EQ(report.byte_count, byte_count);
        MapReadOptions options;
        options.projection = projection;
        expect_equal_levels(read_map(path("%s.pfm"), options).map, map);
    }
}

TEST_F(MapWriter, FacesOfSeveralLevelsGoToFilesOfTheirOwn) {
    const EnvironmentMap map = chain(Projection::cube, 4, 3);
    write_map(path("%s.ktx2"), map);
    expect_equal_levels(read_map(path("%s.ktx2")).map, map);
}

TEST_F(MapWriter, AllFaceFilesAppearOrNone) {
    // one of the six cannot be written: its folder is missing
    for (const char* face : {"px", "nx", "py", "ny", "pz"}) {
        std::filesystem::create_directory(folder_ / face);
    }
    expect_error([&] { write_map(path("%s/sky.pfm"), small_map(Projection::cube)); },
                 Errc::cannot_write, {"nz/sky.pfm"});
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_.path())) {
        EXPECT_TRUE(entry.is_directory()) << entry.path();
    }
}

TEST_F(MapWriter, LevelsAndTheirLobesComeBackFromKtx2) {
    for (std::size_t i = 0; i < kProjectionCount; ++i) {
        const auto projection = static_cast<Projection>(i);
        if (detail::has_unused_texels(projection)) continue;  // numbered there too, written 0
        for (const int size : {8, 6}) {
            SCOPED_TRACE(fmt::format("{} {}", name(projection), size));
            // an equirect of 3 rows is 6, 2, 2 columns wide; as pictures halve, it would be 6, 3, 1
            if (aspect(projection) == 2 && size == 6) continue;
            const EnvironmentMap map = chain(projection, size, 3);
            write_map(path("map.ktx2"), map);
            expect_equal_levels(read_map(path("map.ktx2")).map, map);
        }
    }
    const EnvironmentMap map = chain(Projection::cube, 4, 3);
    MapWriteOptions options;
    options.layout = Layout::vertical_cross;
    write_map(path("map.ktx2"), map, options);
    expect_equal_levels(read_map(path("map.ktx2")).map, map);
}

TEST_F(MapWriter, RefusesLevelsThatDoNotHalveInTheirLayout) {
    MapWriteOptions options;
    options.layout = Layout::horizontal_cross;
    // 5 -> 2 texels a face; 20 -> 8 columns in the cross, where the format wants 10
    expect_error([&] { write_map(path("map.ktx2"), chain(Projection::cube, 5, 2), options); },
                 Errc::usage, {"level 1", "8 x 6", "10 x 7"});
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(MapWriter, RefusesWhatAFormatCannotHold) {
    const EnvironmentMap levels = chain(Projection::cube, 4, 3), cube = small_map(Projection::cube);
    const EnvironmentMap equirect = small_map(Projection::equirect);
    const auto layout = [](Layout wanted) {
        MapWriteOptions options;
        options.layout = wanted;
        return options;
    };
    const auto format = [](TexelFormat wanted) {
        MapWriteOptions options;
        options.format = wanted;
        return options;
    };
    expect_error([&] { write_map(path("a.hdr"), levels); }, Errc::usage,
                 {"a.hdr", "one level", "has 3", "KTX2"});
    expect_error([&] { write_map(path("a.sky"), cube); }, Errc::usage, {"a.sky", ".hdr"});
    expect_error([&] { write_map(path("%s.hdr"), equirect); }, Errc::usage, {"%s", "equirect"});
    expect_error([&] { write_map(path("%s.hdr"), cube, layout(Layout::vertical_cross)); },
                 Errc::usage, {"%s", "vertical-cross"});
    expect_error([&] { write_map(path("a.hdr"), equirect, layout(Layout::vertical_cross)); },
                 Errc::usage, {"vertical-cross", "equirect"});
    expect_error([&] { write_map(path("a.hdr"), cube, layout(Layout::side_by_side)); }, Errc::usage,
                 {"side-by-side", "cube"});
    expect_error([&] { write_map(path("a.hdr"), cube, layout(Layout::single)); }, Errc::usage,
                 {"single", "cube"});
    expect_error([&] { write_map(path("a.hdr"), cube, format(TexelFormat::unorm8)); }, Errc::usage,
                 {"a.hdr", "unorm8"});
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(MapWriter, RefusesTexelsThatAreNoNumber) {
    EnvironmentMap map = small_map(Projection::cube);
    map.levels[0].faces[3].set_rgb(1, 0, {0, kNan, 0});
    for (const char* file : {"a.pfm", "a.ktx2", "%s.hdr"}) {
        expect_error([&] { write_map(path(file), map); }, Errc::cannot_write,
                     {"texel (1, 0) of face -Y", "not a number"});
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(MapWriter, WritesUnusedTexelsAsZero) {
    for (const int size : {8, 9, 64}) {
        EnvironmentMap map = make_environment_map(Projection::sphere, size);
        for (float& value : map.levels[0].faces[0].values()) value = 5;
        map.levels[0].faces[0].set_rgb(size - 1, 0, {kNan, kNan, 1e30f});
        write_map(path("ball.pfm"), map);
        const Image image = read_image(path("ball.pfm"));
        const std::vector<double> table = solid_angle_table(Projection::sphere, size, size);
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                const bool used = table[std::size_t(y) * size + x] > 0;
                EXPECT_EQ(image.rgb(x, y), used ? Vec3f(5, 5, 5) : Vec3f(0, 0, 0)) << x << ' ' << y;
            }
        }
        EXPECT_EQ(table[0], 0);
    }
}

// A face of one texel is a sixth of the sphere: 2/3 pi.
TEST_F(MapWriter, CountsWhatHalfFloatsCutOff) {
    constexpr double face = 2 * kPi / 3;
    EnvironmentMap map = make_environment_map(Projection::cube, 1);
    map.levels[0].faces[0].set_rgb(0, 0, {100000, 65504, 3});
    map.levels[0].faces[4].set_rgb(0, 0, {1, 70000, -70000});
    MapWriteOptions options;
    options.format = TexelFormat::rgba16f;
    const WriteReport report = write_map(path("map.ktx2"), map, options);
    EXPECT_EQ(report.clipped_texel_count, 2);
    // double sums of a few exact terms
    EXPECT_NEAR(report.lost_flux.x, (100000 - 65504) * face, 1e-9);
    EXPECT_NEAR(report.lost_flux.y, (70000 - 65504) * face, 1e-9);
    EXPECT_NEAR(report.lost_flux.z, -(70000 - 65504) * face, 1e-9);

    const LoadedMap loaded = read_map(path("map.ktx2"));
    EXPECT_EQ(loaded.map.levels[0].faces[0].rgb(0, 0), Vec3f(65504, 65504, 3));
    EXPECT_EQ(loaded.map.levels[0].faces[4].rgb(0, 0), Vec3f(1, 65504, -65504));
    // what was lost is what the file misses
    const Vec3d missing = flux(map) - flux(loaded.map) - report.lost_flux;
    EXPECT_LT(missing.length(), 1e-8);
    EXPECT_EQ(map.levels[0].faces[0].rgb(0, 0).x, 100000);  // the caller's map stays
}

TEST_F(MapWriter, KeepsEachChannelsOwnRange) {
    EnvironmentMap map = make_environment_map(Projection::cube, 1);
    map.levels[0].faces[0].set_rgb(0, 0, {65024, 65024, 64768});
    MapWriteOptions options;
    options.format = TexelFormat::r11g11b10f;
    const WriteReport report = write_map(path("map.ktx2"), map, options);
    EXPECT_EQ(report.clipped_texel_count, 1);
    EXPECT_EQ(report.lost_flux.x, 0);
    EXPECT_NEAR(report.lost_flux.z, 256 * 2 * kPi / 3, 1e-9);
}

TEST_F(MapWriter, CountsNegativeTexelsWhereTheFormatHasNoSign) {
    EnvironmentMap map = make_environment_map(Projection::cube, 1);
    map.levels[0].faces[1].set_rgb(0, 0, {-2, 1, 0});
    for (const auto& [file, format] : {std::pair("a.hdr", TexelFormat::automatic),
                                       {"a.ktx2", TexelFormat::rgb9e5},
                                       {"a.ktx2", TexelFormat::r11g11b10f},
                                       {"a.png", TexelFormat::unorm16}}) {
        SCOPED_TRACE(file);
        MapWriteOptions options;
        options.format = format;
        const WriteReport report = write_map(path(file), map, options);
        EXPECT_EQ(report.clipped_texel_count, 1);
        EXPECT_NEAR(report.lost_flux.x, -2 * 2 * kPi / 3, 1e-12);
        EXPECT_EQ(report.lost_flux.y, 0);
    }
    EXPECT_EQ(write_map(path("a.pfm"), map).clipped_texel_count, 0);
}

TEST_F(MapWriter, ReportsTheLevelThatLosesMost) {
    EnvironmentMap map = make_environment_map(Projection::cube, 2);
    map.levels.push_back(make_environment_map(Projection::cube, 1).levels[0]);
    map.levels[0].faces[0].set_rgb(0, 0, {65504 + 800, 0, 0});
    map.levels[1].faces[0].set_rgb(0, 0, {65504 + 100, 0, 0});
    MapWriteOptions options;
    options.format = TexelFormat::rgba16f;
    const WriteReport report = write_map(path("map.ktx2"), map, options);
    EXPECT_EQ(report.clipped_texel_count, 2);
    // a quarter of a face, by symmetry; 800 of it is more than 100 of the whole face
    EXPECT_NEAR(report.lost_flux.x, 800 * kPi / 6, 1e-9);
}

}  // namespace
}  // namespace mirrorball
