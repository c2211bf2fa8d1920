// Scene files: what is read, what is written, and what every mistake is called.
#include <mirrorball/scene_file.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include <mirrorball/error.h>
#include <mirrorball/material_presets.h>

#include "support.h"

namespace mirrorball {
namespace {

Scene parsed(const std::string& text) {
    return parse_scene(text, "s.json");
}

// The message of the error that the text is refused with.
std::string refusal(const std::string& text) {
    try {
        (void)parsed(text);
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), Errc::cannot_read);
        return error.what();
    }
    return "not refused";
}

TEST(SceneFile, EmptyIsTheDefault) {
    EXPECT_EQ(parsed("{}"), Scene());
    EXPECT_EQ(parsed(" // nothing\n{ /* at all */ }\n"), Scene());
    EXPECT_EQ(parsed("\xEF\xBB\xBF{}"), Scene());
    EXPECT_EQ(to_json(Scene()), "{}\n");
}

// Every member, none as it is by default.
Scene full_scene() {
    Scene scene;
    SceneObject object;
    object.name = "a \"quoted\" name";
    object.mesh = "pots/\xC3\xA9t\xC3\xA9.obj";
    object.transform = {{1, 2, -3}, 0.1, -0.2, 1.3, {1, -2, 0.5}};
    Material& m = object.material;
    m.base_color = {0.1, 0.2, 0.3};
    m.base_color_map = "wood.png";
    m.mirror = 0.1, m.glossy = 0.2, m.diffuse = 0.3, m.transmission = 0.4, m.emission = 25;
    m.lobe = {Lobe::Kind::blinn_phong, 12.5};
    m.fresnel = Fresnel::conductor("gold").coated(1.5);
    m.coupling = Coupling::split_sum;
    m.index = 1.33;
    m.floor = Floor{-2.5, {0.1, 0.2, 0.3}, "tiles.png", 0.4, {1, 0.5, 0.25}};
    BumpMap& b = m.bump;
    b.source = "stones.png", b.kind = BumpKind::slopes, b.green = Green::down,
    b.wrap = Wrap::mirror;
    b.height_scale = 0.02, b.width = 0.5, b.size = 64;
    b.repeat = {3, -2}, b.offset = {0.25, 0.5}, b.drift = {-1, 0.125};
    b.strength = 1.5, b.form = BumpForm::classic, b.filter = BumpFilter::mean;
    b.relief = 0.125, b.horizon = false;
    b.matrix = {0, 1, -1, 0.5};
    b.matrix_turn = kPi / 4;
    b.luminance_scale = 0.5, b.luminance_offset = 0.25;
    object.dynamic = DynamicReflection{64, 2, 3};
    scene.objects = {object, SceneObject()};
    SceneEnvironment& e = scene.environment;
    e.source = "room.hdr";
    e.yaw = 0.7, e.pitch = -0.3, e.roll = 2;
    e.intensity = 0.1;
    e.background = false;
    e.background_color = {0.5, 0.25, 0};
    e.proxy = BoxProxy{{-4, 0, -4}, {4, 3, 4}};
    e.captured_at = {0, 1.5, 0};
    scene.lights = {ScenePointLight{{1, 1, 1}, {3, 2, 1}, kPi / 2},
                    SceneDirectionalLight{{1, 0, 0}, {0.1, 0.2, 0.3}, -kPi / 6}, ScenePointLight()};
    scene.camera = {{1, 2, 3}, {0, 1, 0}, {0, 0, 1}, 1.1};
    scene.method = Method::dual_paraboloid_vertex;
    scene.map_size = 128;
    scene.exposure = 1.0 / 3;
    scene.tone_map = ToneMap::agx;
    scene.time = 12.5;
    return scene;
}

void expect_angles_near(double& a, double b) {
    EXPECT_NEAR(a, b, 2e-16 * std::abs(b) + 1e-300);
    a = b;
}

TEST(SceneFile, WritingAndReadingAreInverse) {
    const Scene scene = full_scene();
    Scene again = parsed(to_json(scene));
    EXPECT_EQ(parsed(to_json(again)), again) << "what was read is written exactly";
    // Radians that no number of degrees gives come back as their neighbours.
    Transform& t = again.objects.at(0).transform;
    const Transform& u = scene.objects[0].transform;
    expect_angles_near(t.yaw, u.yaw), expect_angles_near(t.pitch, u.pitch);
    expect_angles_near(t.roll, u.roll);
    SceneEnvironment& e = again.environment;
    expect_angles_near(e.yaw, scene.environment.yaw);
    expect_angles_near(e.pitch, scene.environment.pitch);
    expect_angles_near(e.roll, scene.environment.roll);
    expect_angles_near(again.camera.field_of_view, scene.camera.field_of_view);
    EXPECT_EQ(again, scene);
    Scene ball = scene;
    ball.environment.proxy = SphereProxy{{0, 1, 0}, 3};
    EXPECT_EQ(parsed(to_json(ball)).environment.proxy, ball.environment.proxy);
}

TEST(SceneFile, DegreesComeBackAsTheyWereTyped) {
    for (int degrees = -180; degrees <= 180; ++degrees) {
        Scene scene;
        scene.environment.yaw = degrees * kPi / 180;
        EXPECT_EQ(parsed(to_json(scene)), scene);
        const std::string typed = std::to_string(degrees) + ".0\n";
        EXPECT_TRUE(degrees == 0 || to_json(scene).find(typed) != std::string::npos) << typed;
    }
}

TEST(SceneFile, ColoursAndScalesMayBeOneNumber) {
    const Scene scene =
        parsed(R"({"objects": [{"transform": {"scale": 2}, "material": {"base_color": 0.5}}]})");
    EXPECT_EQ(scene.objects[0].transform.scale, Vec3d(2));
    EXPECT_EQ(scene.objects[0].material.base_color, Vec3d(0.5));
}

TEST(SceneFile, MaterialsByNameAndLikeAnother) {
    const Scene scene = parsed(R"({
        "objects": [{"material": "c"}, {"material": {"like": "a", "glossy": 0.5}}, {"material": "a"}],
        "materials": {"c": {"like": "b", "mirror": 0.25}, "b": {"like": "a", "diffuse": 0.5},
                      "a": {"fresnel": "metal=gold", "mirror": 0.75}}})");
    const Material &c = scene.objects[0].material, &own = scene.objects[1].material;
    EXPECT_EQ(c.mirror, 0.25);
    EXPECT_EQ(c.diffuse, 0.5);
    EXPECT_EQ(c.fresnel, Fresnel::conductor("gold"));
    EXPECT_EQ(own.glossy, 0.5);
    EXPECT_EQ(own.mirror, 0.75);
    EXPECT_EQ(scene.objects[2].material.diffuse, 0);
}

TEST(SceneFile, BumpsAndFloorsTakeOverWhatTheOnesTheyAreLikeHave) {
    const Scene scene = parsed(R"({"materials": {
        "sea": {"bump": {"source": "waves", "strength": 2, "repeat": 3},
                "floor": {"height": -4, "color": 0.2}},
        "calm sea": {"like": "sea", "bump": {"strength": 0.5}, "floor": {"color": [0, 0, 1]}}},
        "objects": [{"material": "calm sea"}]})");
    const Material& m = scene.objects.at(0).material;
    EXPECT_EQ(m.bump.source, "waves");
    EXPECT_EQ(m.bump.strength, 0.5);
    EXPECT_EQ(m.bump.repeat, Imath::V2d(3, 3));
    ASSERT_TRUE(m.floor);
    EXPECT_EQ(m.floor->height, -4);
    EXPECT_EQ(m.floor->color, Vec3d(0, 0, 1));
}

TEST(SceneFile, HoldsEveryPreset) {
    for (const MaterialPreset& preset : material_presets()) {
        Scene scene;
        scene.objects.emplace_back().material = preset.material;
        EXPECT_EQ(parsed(to_json(scene)), scene) << preset.name;
    }
}

TEST(SceneFile, PresetsWithBumpsAreMadeOfSources) {
    int count = 0;
    const std::vector<BumpSource> sources = bump_sources();
    for (const MaterialPreset& preset : material_presets()) {
        if (preset.material.bump.is_smooth()) continue;
        ++count;
        EXPECT_TRUE(std::any_of(sources.begin(), sources.end(), [&](const BumpSource& source) {
            return source.name == preset.material.bump.source;
        })) << preset.name;
        EXPECT_TRUE(can_show(Method::cube, preset.material.bump)) << preset.name;
    }
    EXPECT_EQ(count, 5);
}

TEST(SceneFile, PresetsAreThereUnlessTheFileUsesTheirNames) {
    const Scene preset = parse_scene(R"({"objects": [{"material": "gold"}, {"material": {"like":
        "plastic", "diffuse": 0.5}}]})",
                                     "s.json");
    EXPECT_EQ(preset.objects[0].material, preset_material("gold"));
    Material plastic = preset_material("plastic");
    plastic.diffuse = 0.5;
    EXPECT_EQ(preset.objects[1].material, plastic);
    const Scene own = parse_scene(R"({"materials": {"gold": {"mirror": 0.5}},
        "objects": [{"material": "gold"}]})",
                                  "s.json");
    Material half;
    half.mirror = 0.5;
    EXPECT_EQ(own.objects[0].material, half);
}

// A chain as long as a file can hold is followed without recursion.
TEST(SceneFile, LongChainsOfMaterials) {
    std::string text = R"({"objects": [{"material": "m0"}], "materials": {)";
    const int count = 20000;
    for (int i = 0; i < count; ++i)
        text += "\"m" + std::to_string(i) + R"(": {"like": "m)" + std::to_string(i + 1) + "\"},";
    text += "\"m" + std::to_string(count) + R"(": {"mirror": 0.125}}})";
    EXPECT_EQ(parsed(text).objects[0].material.mirror, 0.125);
}

struct Mistake {
    std::string text, message;
};

// Each with its place: line and column of the value (or key), and the way to it.
TEST(SceneFile, MistakesAreNamedWithTheirPlace) {
    const Mistake mistakes[] = {
        {"{\n  \"objects\": [{}, {\"material\":\n   {\"mirror\": 1.5}}]}",
         "s.json:3:15: objects[1].material.mirror: 1.5; expected a number from 0 to 1"},
        {"{\"materials\": {\"lamp\": {\"emission\": -1}}}",
         "materials.lamp.emission: -1; expected a number from 0 to 1000000000000"},
        {"{\"materials\": {\"a\": {\"bump\": {\"sorce\": \"waves\"}}}}",
         "materials.a.bump: no key is called \"sorce\" here; did you mean \"source\"?"},
        {"{\"objects\": [{\"material\": {\"bump\": {\"strength\": 101}}}]}",
         "objects[0].material.bump.strength: 101; expected a number from -100 to 100"},
        {"{\"objects\": [{\"material\": {\"bump\": {\"kind\": \"depth\"}}}]}",
         "\"depth\" is not a kind of bump map; there are: height, normal, dudv"},
        {"{\"objects\": [{\"material\": {\"bump\": {\"form\": \"modern\"}}}]}",
         "\"modern\" is not a form of bump mapping; there are: normals, classic"},
        {"{\"objects\": [{\"material\": {\"bump\": {\"repeat\": [1, 2, 3]}}}]}",
         "bump.repeat: an array of 3; expected a number or an array of two"},
        {"{\"objects\": [{\"material\": {\"bump\": {\"matrix\": [1, 0, 0, 1]}}}]}",
         "bump.matrix: an array of 4; expected two rows of two numbers"},
        {"{\"objects\": [{\"material\": {\"bump\": {\"matrix\": [[1, 0], [0, true]]}}}]}",
         "bump.matrix[1][1]: true; expected a number"},
        {"{\"objects\": [{\"material\": {\"floor\": {\"color_width\": 0}}}]}",
         "material.floor.color_width: 0; expected a number from "},
        {"{\"camra\": {}}",
         "s.json:1:2: no key is called \"camra\" here; did you mean \"camera\"?"},
        {"{\"camera\": {\"eye\": [1, 2]}}",
         "s.json:1:20: camera.eye: an array of 2; expected [x, y, z]"},
        {"{\"camera\": {\"eye\": [1, /* two */ \"2\", 3]}}",
         "s.json:1:34: camera.eye[1]: \"2\"; expected a number from -1000000000 to 1000000000"},
        {"{\"camera\": {\"eye\": [0, 0, 0]}}",
         "s.json:1:12: camera: eye and target are the same point"},
        {"{\"camera\": {\"up\": [0, 0, 0]}}", "camera: an `up` of length 0"},
        {"{\"camera\": {\"field_of_view_degrees\": 180}}",
         "camera.field_of_view_degrees: 180; expected a number from 0.1 to 179"},
        {"{\"method\": \"cubic\"}",
         "s.json:1:12: method: \"cubic\" is not a method; there are: sph"},
        {"{\"tone_map\": 3}", "s.json:1:14: tone_map: 3; expected text"},
        {"{\"map_size\": 2.5}", "map_size: 2.5; expected a whole number from 0 to 16384"},
        {"{\"map_size\": 1e9}", "map_size: 1000000000; expected a number from 0 to 16384"},
        {"{\"objects\": {}}", "objects: an object; expected an array of objects"},
        {"{\"objects\": [3]}", "objects[0]: 3; expected an object, { }"},
        {"{\"objects\": [{\"transform\": {\"scale\": [1, 0, 1]}}]}",
         "objects[0].transform.scale: a scale of 0"},
        {"{\"objects\": [{\"dynamic\": {\"bounces\": 9}}]}",
         "objects[0].dynamic.bounces: 9; expected a number from 1 to 8"},
        {"{\"objects\": [{\"material\": {\"lobe\": \"ggx:7\"}}]}", "objects[0].material.lobe: "},
        {"{\"objects\": [{\"material\": {\"lobe\": \"mirror\"}}]}",
         "objects[0].material.lobe: a material's lobe is phong, blinn-phong, ggx or charlie"},
        {"{\"objects\": [{\"material\": {\"fresnel\": \"metal=tin\"}}]}",
         "objects[0].material.fresnel: "},
        {"{\"objects\": [{\"material\": {\"coupling\": \"glued\"}}]}",
         "\"glued\" is not a coupling; there are: added, layered, split-sum"},
        {"{\"objects\": [{\"material\": \"glod\"}], \"materials\": {\"gold\": {}}}",
         "s.json:1:27: objects[0].material: no material is called \"glod\"; did you mean "
         "\"gold\"?"},
        {"{\"materials\": {\"gold\": {\"like\": \"b\"}}}",
         "materials.gold.like: no material is called \"b\"; there are: mirror, chrome"},
        {"{\"materials\": {\"a\": {\"like\": \"b\"}, \"b\": {\"like\": \"c\"},\n"
         "\"c\": {\"like\": \"b\"}}}",
         "s.json:2:15: materials.c.like: these materials are like each other in a circle: "
         "b -> c -> b"},
        {"{\"materials\": {\"a\": {\"like\": \"a\"}}}", "in a circle: a -> a"},
        {"{\"materials\": {\"unused\": {\"mirror\": -1}}}", "materials.unused.mirror: -1"},
        {"{\"lights\": [{\"lamp\": {}}]}", "lights[0]: \"lamp\" is no kind of light"},
        {"{\"lights\": [{}]}", "lights[0]: an object; expected light of one kind, as { \"point\""},
        {"{\"lights\": [{\"directional\": {\"direction\": [0, 0, 0]}}]}", "direction of length 0"},
        {"{\"lights\": [{\"point\": {\"intensity\": -1}}]}", "lights[0].point.intensity: -1"},
        {"{\"environment\": {\"proxy\": {\"box\": {\"least\": [2, 0, 0]}}}}",
         "environment.proxy: the box is empty"},
        {"{\"environment\": {\"background\": 1}}", "1; expected true or false"},
        {"{\"environment\": null}", "environment: null; expected an object"},
        // what is no JSON
        {"", "s.json:1:1: "},
        {"[]", "s.json:1:1: an array of 0; expected an object"},
        {"{\n\"objects\": [}", "s.json:2:13: "},
        {"{\"map_size\": 1, \"map_size\": 2}", "s.json:1:17: the key \"map_size\" is there twice"},
        {"{\"map_size\": 1e999}", "s.json:1:"},
        {"{\"map_size\": NaN}", "s.json:1:"},
        {"{\"mesh\": \"\xFF\"}", "s.json:1:"},
        {"{} {}", "s.json:1:4: "},
        {"{ /* no end", "s.json:1:"},
        {std::string(100000, '['), "s.json:1:65: more than 64 brackets"},
    };
    for (const auto& [text, message] : mistakes) {
        const std::string found = refusal(text);
        EXPECT_NE(found.find(message), std::string::npos)
            << text.substr(0, 80) << "\n  gives    " << found << "\n  expected " << message;
    }
}

TEST(SceneFile, TooManyValues) {
    std::string text = "[0";
    for (int i = 0; i < 1'000'000; ++i) text += ",0";
    EXPECT_NE(refusal(text + "]").find("more than 1000000 values"), std::string::npos);
}

// A text cut off anywhere is refused, not misread.
TEST(SceneFile, EveryTruncationIsRefused) {
    const std::string text = to_json(full_scene());
    for (std::size_t length = 0; length + 2 < text.size(); ++length)
        EXPECT_THROW((void)parsed(text.substr(0, length)), Error) << length;
}

TEST(SceneFile, ReadsFiles) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / "a.json";
    std::ofstream(path) << to_json(full_scene());
    EXPECT_EQ(read_scene(path), parsed(to_json(full_scene())));
    std::ofstream(path) << "{\"objects\": 1}";
    try {
        (void)read_scene(path);
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find(path.string() + ":1:13: objects"),
                  std::string::npos);
    }
    EXPECT_THROW((void)read_scene(folder / "none.json"), Error);
    EXPECT_THROW((void)read_scene(folder.path()), Error);
}

// The example in docs/scene.md is a scene.
TEST(SceneFile, DocumentedExample) {
    std::ifstream file(std::string(MIRRORBALL_SOURCE_DIR) + "/docs/scene.md");
    std::stringstream all;
    all << file.rdbuf();
    const std::string text = all.str(), fence = "```json\n";
    const std::size_t start = text.find(fence) + fence.size();
    const Scene scene = parsed(text.substr(start, text.find("```", start) - start));
    ASSERT_EQ(scene.objects.size(), 5u);
    EXPECT_EQ(scene.objects[1].material.bump.source, "hammered");
    EXPECT_EQ(scene.objects[4].material.floor.value_or(Floor()).color_map, "tiles.png");
    EXPECT_EQ(scene.objects[1].material.fresnel, Fresnel::conductor("gold"));
    EXPECT_EQ(scene.objects[1].material.coupling, Coupling::split_sum);
    EXPECT_EQ(scene.lights.size(), 2u);
    EXPECT_EQ(scene.tone_map, ToneMap::agx);
}

}  // namespace
}  // namespace mirrorball
