// What a picture is taken for, what is refused, and with which words.
#include <mirrorball/io.h>

#include <cmath>
#include <fstream>
#include <limits>

#include <fmt/format.h>
#include <mirrorball/builtin.h>

#include "io/texel_use.h"
#include "io_test_support.h"
#include "support.h"

namespace mirrorball {
namespace {

const float kNan = std::numeric_limits<float>::quiet_NaN();
const float kInfinity = std::numeric_limits<float>::infinity();

MapReadOptions reading(std::optional<Projection> projection, Layout layout = Layout::automatic) {
    MapReadOptions options;
    options.projection = projection;
    options.layout = layout;
    return options;
}

bool has_note(const LoadedMap& loaded, const std::string& words) {
    for (const std::string& note : loaded.notes) {
        if (note.find(words) != std::string::npos) return true;
    }
    return false;
}

class MapReader : public testing::Test {
  protected:
    [[nodiscard]] std::string path(const std::string& name) const {
        return (folder_ / name).string();
    }
    std::string picture(const Image& image, const std::string& name = "sky.pfm") {
        write_image(path(name), image);
        return path(name);
    }
    std::string picture(int width, int height, const std::string& name = "sky.pfm") {
        return picture(numbered_image(width, height), name);
    }
    // By hand, since no writer of ours takes texels that are no number. Bottom row first.
    std::string raw_pfm(const Image& image, const std::string& name = "sky.pfm") {
        std::ofstream file(path(name), std::ios::binary);
        file << "PF\n" << image.width() << ' ' << image.height() << "\n-1.0\n";
        for (int y = image.height() - 1; y >= 0; --y) {
            const std::span<const float> row = image.row(y);
            file.write(reinterpret_cast<const char*>(row.data()),
                       std::streamsize(row.size_bytes()));
        }
        return path(name);
    }

    TemporaryFolder folder_;
};

TEST_F(MapReader, GuessesByShapeAndSaysSo) {
    const struct {
        int width, height;
        Projection projection;
        const char* note;
    } cases[] = {
        {8, 4, Projection::equirect, "equirect"},      {2, 1, Projection::equirect, "equirect"},
        {8, 6, Projection::cube, "horizontal-cross"},  {6, 8, Projection::cube, "vertical-cross"},
        {12, 2, Projection::cube, "horizontal-strip"}, {1, 6, Projection::cube, "vertical-strip"},
    };
    for (const auto& c : cases) {
        SCOPED_TRACE(c.note);
        const LoadedMap loaded = read_map(picture(c.width, c.height));
        EXPECT_EQ(loaded.map.projection, c.projection);
        EXPECT_EQ(loaded.map.axes, default_axes(c.projection));
        ASSERT_EQ(loaded.notes.size(), 1u);
        EXPECT_TRUE(has_note(loaded, c.note)) << loaded.notes[0];
        EXPECT_TRUE(has_note(loaded, "by its"));
        EXPECT_TRUE(read_map(path("sky.pfm"), reading(c.projection)).notes.empty());
    }
}

TEST_F(MapReader, RefusesSquarePicturesThatNobodyNamed) {
    expect_error([&] { (void)read_map(picture(4, 4)); }, Errc::usage,
                 {"sky.pfm", "4 x 4", "sphere", "angular", "octahedral", "--from"});
    for (const Projection projection :
         {Projection::sphere, Projection::angular, Projection::octahedral,
          Projection::equal_area_octahedral}) {
        EXPECT_EQ(read_map(path("sky.pfm"), reading(projection)).map.projection, projection);
    }
}

TEST_F(MapReader, RefusesOtherShapes) {
    expect_error([&] { (void)read_map(picture(5, 3)); }, Errc::cannot_read,
                 {"sky.pfm", "5 x 3", "2:1", "4:3", "6:1"});
    expect_error([&] { (void)read_map(picture(10, 4), reading(Projection::equirect)); },
                 Errc::cannot_read,
                 {"sky.pfm: 10 x 4 is not an equirect map (its width must be twice its height)"});
    expect_error([&] { (void)read_map(picture(1, 1), reading(Projection::equirect)); },
                 Errc::cannot_read, {"1 x 1 is not an equirect map"});
    expect_error([&] { (void)read_map(picture(8, 4), reading(Projection::sphere)); },
                 Errc::cannot_read, {"8 x 4 is not a sphere map", "square"});
    expect_error([&] { (void)read_map(picture(8, 4), reading(Projection::cube)); },
                 Errc::cannot_read, {"8 x 4 is not a cube map", "4:3", "1:6"});
    expect_error([&] { (void)read_map(picture(4, 4), reading(Projection::dual_paraboloid)); },
                 Errc::cannot_read, {"4 x 4 is not a dual-paraboloid map", "2:1"});
    expect_error(
        [&] { (void)read_map(picture(9, 6), reading(std::nullopt, Layout::horizontal_cross)); },
        Errc::cannot_read, {"9 x 6 is not a horizontal-cross", "4 square faces wide and 3 high"});
    // 4:3 in whole numbers only
    expect_error([&] { (void)read_map(picture(401, 300)); }, Errc::cannot_read, {"401 x 300"});
}

TEST_F(MapReader, RefusesWordsThatContradictEachOther) {
    expect_error(
        [&] {
            (void)read_map(picture(8, 6), reading(Projection::equirect, Layout::horizontal_cross));
        },
        Errc::usage, {"horizontal-cross", "cube", "equirect"});
    expect_error([&] { (void)read_map(picture(8, 6), reading(Projection::cube, Layout::single)); },
                 Errc::usage, {"cube", "6 faces"});
    expect_error([&] { (void)read_map(picture(8, 6), reading(std::nullopt, Layout::single)); },
                 Errc::cannot_read, {"8 x 6"});
}

TEST_F(MapReader, TakesMapsOfOneTexel) {
    for (const Projection projection :
         {Projection::sphere, Projection::angular, Projection::octahedral,
          Projection::equal_area_octahedral}) {
        EXPECT_EQ(read_map(picture(1, 1), reading(projection)).map.height(), 1);
    }
    for (const char* face : {"px", "nx", "py", "ny", "pz", "nz"}) {
        picture(1, 1, std::string(face) + ".pfm");
    }
    EXPECT_EQ(read_map(path("%s.pfm")).map.height(), 1);
    EXPECT_EQ(read_map(picture(2, 1)).map.projection, Projection::equirect);
}

TEST_F(MapReader, TakesTwoToOneForParaboloidsOnlyWhenAsked) {
    const Image image = numbered_image(4, 2);
    EXPECT_EQ(read_map(picture(image)).map.projection, Projection::equirect);
    const LoadedMap pair = read_map(picture(image), reading(Projection::dual_paraboloid));
    EXPECT_EQ(pair.map.levels[0].faces[1].rgb(0, 0), image.rgb(2, 0));
    const LoadedMap turned =
        read_map(picture(image), reading(std::nullopt, Layout::side_by_side_turned));
    EXPECT_EQ(turned.map.projection, Projection::dual_paraboloid);
    EXPECT_EQ(turned.map.levels[0].faces[1].rgb(0, 0), image.rgb(3, 1));
}

// Six colours in a cross painted by hand, each with a mark at its top left texel.
TEST_F(MapReader, PutsEveryFaceInItsPlace) {
    constexpr int size = 2;
    const int cells[6][2] = {{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {1, 3}};  // vertical cross
    Image cross(3 * size, 4 * size, 3);
    for (int face = 0; face < 6; ++face) {
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                cross.set_rgb(cells[face][0] * size + x, cells[face][1] * size + y,
                              Vec3f(float(face + 1)));
            }
        }
        const int mark = face == 5 ? size - 1 : 0;  // -Z hangs upside down
        cross.set_rgb(cells[face][0] * size + mark, cells[face][1] * size + mark,
                      Vec3f(float(face + 1), 100, 100));
    }
    const LoadedMap loaded = read_map(picture(cross));
    for (int face = 0; face < 6; ++face) {
        const Image& image = loaded.map.levels[0].faces[face];
        EXPECT_EQ(image.rgb(0, 0), Vec3f(float(face + 1), 100, 100));
        EXPECT_EQ(image.rgb(1, 0), Vec3f(float(face + 1)));
        EXPECT_EQ(image.rgb(0, 1), Vec3f(float(face + 1)));
        EXPECT_EQ(image.rgb(1, 1), Vec3f(float(face + 1)));
    }
}

TEST_F(MapReader, ReadsFacesByPatternOrList) {
    const char* names[] = {"right", "left", "top", "bottom", "front", "back"};
    std::string list;
    for (int face = 0; face < 6; ++face) {
        list += (face > 0 ? "," : "") +
                picture(numbered_image(2, 2, float(100 * face)), std::string(names[face]) + ".pfm");
    }
    for (const std::string& source : {path("%s.pfm"), list}) {
        const LoadedMap loaded = read_map(source);
        EXPECT_EQ(loaded.map.projection, Projection::cube);
        for (int face = 0; face < 6; ++face) {
            expect_equal(loaded.map.levels[0].faces[face], numbered_image(2, 2, float(100 * face)));
        }
    }
    EXPECT_TRUE(has_note(read_map(path("%s.pfm")), "right left top bottom front back"));

    const LoadedMap pair = read_map(path("%s.pfm"), reading(Projection::dual_paraboloid));
    EXPECT_EQ(pair.map.projection, Projection::dual_paraboloid);
    expect_equal(pair.map.levels[0].faces[0], numbered_image(2, 2, 400));

    expect_error([&] { (void)read_map(path("%s.pfm"), reading(Projection::octahedral)); },
                 Errc::usage, {"octahedral"});
    expect_error([&] { (void)read_map(list, reading(Projection::octahedral)); }, Errc::usage,
                 {"6 faces", "cube", "octahedral"});
    expect_error(
        [&] { (void)read_map(path("%s.pfm"), reading(std::nullopt, Layout::vertical_cross)); },
        Errc::usage, {"vertical-cross"});
}

TEST_F(MapReader, RefusesFacesThatDoNotMatch) {
    for (const char* face : {"px", "nx", "py", "ny", "pz", "nz"}) {
        picture(2, 2, std::string(face) + ".pfm");
    }
    picture(4, 4, "ny.pfm");
    expect_error([&] { (void)read_map(path("%s.pfm")); }, Errc::cannot_read,
                 {"ny.pfm", "4 x 4", "px.pfm", "2 x 2"});
    picture(4, 2, "ny.pfm");
    expect_error([&] { (void)read_map(path("%s.pfm")); }, Errc::cannot_read,
                 {"ny.pfm", "4 x 2", "square"});
    std::filesystem::remove(path("ny.pfm"));
    expect_error([&] { (void)read_map(path("%s.pfm")); }, Errc::cannot_read, {"ny.pfm", "missing"});
}

TEST_F(MapReader, MakesThreeChannelsOfAny) {
    picture(numbered_image(4, 2, 1, 1));
    const LoadedMap grey = read_map(path("sky.pfm"));
    EXPECT_EQ(grey.map.levels[0].faces[0].rgb(3, 1), Vec3f(8, 8, 8));

    Image image = numbered_image(4, 2, 1, 4);
    for (int y = 0; y < 2; ++y) {
        for (int x = 0; x < 4; ++x) image.at(x, y)[3] = 1;
    }
    picture(image, "sky.tif");
    const LoadedMap opaque = read_map(path("sky.tif"));
    EXPECT_EQ(opaque.map.levels[0].faces[0].rgb(1, 0), Vec3f(5, 6, 7));
    EXPECT_FALSE(has_note(opaque, "alpha"));

    image.at(2, 1)[3] = 0.5f;
    picture(image, "sky.tif");
    const LoadedMap clear = read_map(path("sky.tif"));
    EXPECT_EQ(clear.map.levels[0].faces[0].rgb(1, 0), Vec3f(5, 6, 7));
    EXPECT_TRUE(has_note(clear, "alpha"));
}

TEST_F(MapReader, TakesTheUsersAxes) {
    MapReadOptions options;
    options.axes = "-x+y-z";
    EXPECT_EQ(to_string(read_map(picture(4, 2), options).map.axes), "-x+y-z");
    options.axes = "sideways";
    expect_error([&] { (void)read_map(picture(4, 2), options); }, Errc::usage, {"sideways"});
}

TEST_F(MapReader, TheUsersWordGoesBeforeTheFiles) {
    EnvironmentMap map = numbered_map(Projection::octahedral, 4);
    map.axes = parse_axes("+x-z+y", map.projection);
    write_map(path("map.ktx2"), map);
    EXPECT_EQ(read_map(path("map.ktx2")).map.projection, Projection::octahedral);
    EXPECT_TRUE(read_map(path("map.ktx2")).notes.empty());

    MapReadOptions options = reading(Projection::sphere);
    options.axes = "+x+y+z";
    const LoadedMap loaded = read_map(path("map.ktx2"), options);
    EXPECT_EQ(loaded.map.projection, Projection::sphere);
    EXPECT_EQ(to_string(loaded.map.axes), "+x+y+z");
    EXPECT_TRUE(has_note(loaded, "octahedral"));
    expect_error([&] { (void)read_map(path("map.ktx2"), reading(Projection::equirect)); },
                 Errc::cannot_read, {"4 x 4", "equirect"});
}

TEST_F(MapReader, RefusesAFileWhoseWordContradictsItsShape) {
    // one face of a cube, of which the file says that it is a cube
    write_map(path("%s.ktx2"), numbered_map(Projection::cube, 4));
    expect_error([&] { (void)read_map(path("px.ktx2")); }, Errc::cannot_read,
                 {"px.ktx2", "4 x 4 is not a cube map"});
}

TEST_F(MapReader, RefusesTexelsThatAreNoNumber) {
    Image image(12, 2, 3);  // a strip of faces
    image.set_rgb(5, 1, {0, kNan, 0});
    image.set_rgb(11, 0, {kInfinity, 0, 0});
    raw_pfm(image);
    expect_error([&] { (void)read_map(path("sky.pfm")); }, Errc::cannot_read,
                 {"sky.pfm", "2 texels are no number", "texel (1, 1) of face +Y", "--repair"});

    MapReadOptions options;
    options.repair = true;
    const LoadedMap repaired = read_map(path("sky.pfm"), options);
    EXPECT_EQ(repaired.map.levels[0].faces[2].rgb(1, 1), Vec3f(0, 0, 0));
    EXPECT_TRUE(has_note(repaired, "2 texels are no number"));

    for (float& value : image.values()) value = kNan;
    raw_pfm(image);
    expect_error([&] { (void)read_map(path("sky.pfm"), options); }, Errc::cannot_read,
                 {"24 texels", "no good one"});
}

TEST_F(MapReader, IgnoresWhatLiesOutsideTheBall) {
    Image image = numbered_image(8, 8);
    image.set_rgb(0, 0, {kNan, kNan, kNan});
    image.set_rgb(7, 7, {-3, -3, -3});
    raw_pfm(image);
    const LoadedMap loaded = read_map(path("sky.pfm"), reading(Projection::sphere));
    EXPECT_TRUE(loaded.notes.empty());
    EXPECT_EQ(loaded.map.levels[0].faces[0].rgb(0, 0), Vec3f(0, 0, 0));
    expect_error([&] { (void)read_map(path("sky.pfm"), reading(Projection::octahedral)); },
                 Errc::cannot_read, {"1 texel is no number", "texel (0, 0)"});
}

TEST_F(MapReader, KeepsNegativeTexelsAndSaysSo) {
    Image image(4, 2, 3);
    image.set_rgb(1, 1, {1, -0.25f, 2});
    image.set_rgb(2, 1, {-0.5f, -0.25f, 2});
    const LoadedMap loaded = read_map(picture(image));
    EXPECT_EQ(loaded.map.levels[0].faces[0].rgb(1, 1), Vec3f(1, -0.25f, 2));
    EXPECT_TRUE(has_note(loaded, "2 texels are negative, down to -0.5"));
}

TEST_F(MapReader, KeepsToTheMemoryLimit) {
    picture(12, 2);
    MapReadOptions options;
    constexpr std::uint64_t decoded = 12 * 2 * 3 * sizeof(float);
    options.memory_limit = decoded * 2 - 1;  // the strip and the faces cut from it
    expect_error([&] { (void)read_map(path("sky.pfm"), options); }, Errc::cannot_read,
                 {"sky.pfm", "MiB", "limit"});
    options.memory_limit = decoded * 2;
    EXPECT_NO_THROW((void)read_map(path("sky.pfm"), options));

    picture(4, 2);  // an equirect is kept as it was decoded
    options.memory_limit = 4 * 2 * 3 * sizeof(float);
    EXPECT_NO_THROW((void)read_map(path("sky.pfm"), options));

    for (const char* face : {"px", "nx", "py", "ny", "pz", "nz"}) {
        picture(2, 2, std::string(face) + ".pfm");
    }
    options.memory_limit = 6 * 4 * 3 * sizeof(float) - 1;  // all but a byte of the last face
    expect_error([&] { (void)read_map(path("%s.pfm"), options); }, Errc::cannot_read, {"nz.pfm"});
    options.memory_limit = 1000;
    expect_error([&] { (void)read_map("builtin:white", options); }, Errc::cannot_read,
                 {"builtin:white", "MiB"});
}

// A ball photographed off centre, between pixels, before a bright wall.
TEST_F(MapReader, CropsAPhotographOfABall) {
    const auto radiance = [](const Vec3d& d) {
        return Vec3f(float(2 + d.x + d.y * d.z), float(2 + d.y - d.x * d.x), float(2 + d.z));
    };
    const CropCircle circle{151.37, 108.9, 80.25};
    const auto on_ball = [&](double x, double y) {
        return FacePoint<double>{0, 0.5 + (x - circle.x) / (2 * circle.radius),
                                 0.5 + (y - circle.y) / (2 * circle.radius)};
    };
    Image photograph(300, 220, 3);
    for (int y = 0; y < 220; ++y) {
        for (int x = 0; x < 300; ++x) {
            const FacePoint<double> p = on_ball(x + 0.5, y + 0.5);
            photograph.set_rgb(
                x, y, SphereMap::covers(p) ? radiance(SphereMap::direction(p)) : Vec3f(50, 50, 50));
        }
    }
    MapReadOptions options = reading(Projection::sphere);
    options.crop = circle;
    const LoadedMap loaded = read_map(picture(photograph), options);
    ASSERT_EQ(loaded.map.height(), 161);  // 160.5, rounded

    double worst = 0;
    for (int y = 0; y < 161; ++y) {
        for (int x = 0; x < 161; ++x) {
            const FacePoint<double> p{0, (x + 0.5) / 161, (y + 0.5) / 161};
            if (std::hypot(p.s - 0.5, p.t - 0.5) > 0.45) continue;
            const Vec3f difference =
                loaded.map.levels[0].faces[0].rgb(x, y) - radiance(SphereMap::direction(p));
            worst = std::max(worst, double(difference.length()));
        }
    }
    // Bilinear interpolation errs by an eighth of the second derivatives, here per pixel: they grow
    // toward the rim as 1 / h_z^3, to about 60 per square radius at 0.9 of it, so 1/8 * 2 * 60 /
    // 80^2 at most. Half a pixel's shift would err by ten times that.
    EXPECT_LT(worst, 2.4e-3);
    EXPECT_GT(worst, 0);

    options.projection = std::nullopt;
    expect_error([&] { (void)read_map(path("sky.pfm"), options); }, Errc::usage,
                 {"sphere", "angular", "--from"});
    options.projection = Projection::octahedral;
    expect_error([&] { (void)read_map(path("sky.pfm"), options); }, Errc::usage,
                 {"octahedral", "circle"});
    options.projection = Projection::angular;
    EXPECT_EQ(read_map(path("sky.pfm"), options).map.projection, Projection::angular);
    options.crop = CropCircle{20, 100, 80};
    expect_error([&] { (void)read_map(path("sky.pfm"), options); }, Errc::usage,
                 {"sky.pfm", "leaves the picture", "300 x 220"});
}

TEST_F(MapReader, DrawsBuiltins) {
    const LoadedMap equirect = read_map("builtin:white");
    EXPECT_EQ(equirect.map.projection, Projection::equirect);
    EXPECT_EQ(equirect.map.width(), 1024);
    MapReadOptions options = reading(Projection::cube);
    options.axes = "+x+y+z";
    const LoadedMap cube = read_map("builtin:white", options);
    EXPECT_EQ(cube.map.projection, Projection::cube);
    EXPECT_EQ(to_string(cube.map.axes), "+x+y+z");
    expect_error([&] { (void)read_map("builtin:moon"); }, Errc::usage, {"moon"});
    options.layout = Layout::vertical_cross;
    expect_error([&] { (void)read_map("builtin:white", options); }, Errc::usage, {"layout"});
}

TEST_F(MapReader, NamesWhatIsMissing) {
    expect_error([&] { (void)read_map(path("none.hdr")); }, Errc::cannot_read, {"none.hdr"});
}

TEST_F(MapReader, ReadsASharedPanorama) {
    std::optional<std::filesystem::path> file;
    for (const auto& entry :
         std::filesystem::directory_iterator(shared_file("hdri").value_or(folder_.path()))) {
        if (entry.path().extension() == ".hdr") file = entry.path();
    }
    if (!file) GTEST_SKIP() << "no shared/hdri beside the repository";
    const LoadedMap loaded = read_map(file->string(), reading(Projection::equirect));
    EXPECT_EQ(loaded.map.width(), 2 * loaded.map.height());
    EXPECT_EQ(statistics(loaded.map).non_finite_count, 0);
}

}  // namespace
}  // namespace mirrorball
