#include "io/map_metadata.h"

#include "io_test_support.h"

namespace mirrorball::detail {
namespace {

EnvironmentMap chain() {
    EnvironmentMap map = make_environment_map(Projection::octahedral, 4);
    map.axes = rotated(map.axes, 0.3, 0.2, 0.1);
    for (const int size : {2, 1}) {
        map.levels.push_back({{Image(size, size, 3)}, std::nullopt});
    }
    map.levels[1].lobe = parse_lobe("ggx:0.5");
    map.levels[2].lobe = parse_lobe("phong:100");
    return map;
}

TEST(MapMetadata, ComesBack) {
    const EnvironmentMap map = chain();
    const Metadata metadata =
        describe(map, Layout::single, {{"author", "Ada"}, {"mirrorball.layout", "of old"}});
    EXPECT_EQ(metadata.at("author"), "Ada");
    EXPECT_EQ(metadata.at("mirrorball.lobes"), "source,ggx:0.5,phong:100");
    EXPECT_EQ(metadata.at("mirrorball.quantity"), "radiance");
    EXPECT_EQ(metadata.count("mirrorball.layout"), 0u);

    const MapWords words = parse_words(metadata, "x.ktx2");
    EXPECT_EQ(words.projection, Projection::octahedral);
    EXPECT_EQ(to_string(parse_axes(words.axes.value(), Projection::octahedral)),
              to_string(map.axes));
    EnvironmentMap read = make_environment_map(Projection::octahedral, 4);
    read.levels.resize(3);
    apply_lobes(words, read, "x.ktx2");
    for (int level = 0; level < 3; ++level) {
        EXPECT_EQ(read.levels[level].lobe, map.levels[level].lobe);
    }
}

TEST(MapMetadata, SaysIrradianceWhereEveryLevelIsDiffuse) {
    EnvironmentMap map = make_environment_map(Projection::cube, 1);
    map.levels[0].lobe = Lobe{Lobe::Kind::diffuse};
    const Metadata metadata = describe(map, Layout::vertical_cross, {});
    EXPECT_EQ(metadata.at("mirrorball.quantity"), "irradiance");
    EXPECT_EQ(metadata.at("mirrorball.layout"), "vertical-cross");

    // and irradiance without a word on lobes is of the diffuse one
    EnvironmentMap read = make_environment_map(Projection::cube, 1);
    apply_lobes(parse_words({{"mirrorball.quantity", "irradiance"}}, "x"), read, "x");
    EXPECT_EQ(read.levels[0].lobe, map.levels[0].lobe);
}

TEST(MapMetadata, SaysWhatIsWrongWithAValue) {
    const auto expect_refused = [](const char* key, const char* value) {
        expect_error(
            [&] {
                (void)parse_words({{key, value}}, "sky.ktx2");
            },
            Errc::cannot_read, {"sky.ktx2", key});
    };
    expect_refused("mirrorball.projection", "mercator");
    expect_refused("mirrorball.layout", "spiral");
    expect_refused("mirrorball.axes", "+x+x+z");
    expect_refused("mirrorball.lobes", "source,,ggx:0.5");
    expect_refused("mirrorball.lobes", "");
    expect_refused("mirrorball.quantity", "flux");
}

TEST(MapMetadata, RefusesLobesThatDoNotFit) {
    EnvironmentMap map = make_environment_map(Projection::cube, 1);
    expect_error(
        [&] {
            apply_lobes(parse_words({{"mirrorball.lobes", "source,ggx:1"}}, "x"), map, "x");
        },
        Errc::cannot_read, {"mirrorball.lobes", "2 levels", "has 1"});
    const Metadata contradiction = {{"mirrorball.lobes", "ggx:1"},
                                    {"mirrorball.quantity", "irradiance"}};
    expect_error([&] { apply_lobes(parse_words(contradiction, "x"), map, "x"); }, Errc::cannot_read,
                 {"mirrorball.quantity", "diffuse"});
}

}  // namespace
}  // namespace mirrorball::detail
