// The DFG table as files: what they hold, and a C header in a real compiler.
#include <nlohmann/json.hpp>

#include <mirrorball/dfg.h>
#include <mirrorball/io.h>

#include "program.h"

namespace mirrorball {
namespace {

using Json = nlohmann::json;

TEST(DfgVerb, WritesFloatsWithTheirMeaning) {
    const TemporaryFolder folder;
    const DfgTable table(12, 6);
    for (const char* name : {"dfg.ktx2", "dfg.exr"}) {
        const std::string file = (folder / name).string();
        const Outcome outcome = run({"dfg", "-o", file, "--size", "12x6", "--json"});
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(Json::parse(outcome.out)["channels"], "scale,bias,charlie");
        FileContents read = read_file(file);
        EXPECT_EQ(read.stored, TexelFormat::rgba32f);
        EXPECT_EQ(read.metadata["mirrorball.table"], "dfg");
        EXPECT_EQ(read.metadata["mirrorball.columns"], "n.v = (x + 0.5) / width");
        EXPECT_NE(read.metadata["mirrorball.rows"].find("row 0 first"), std::string::npos);
        ASSERT_EQ(read.levels.size(), 1u);
        ASSERT_EQ(read.levels[0].size(), 1u);
        const Image& image = read.levels[0][0];
        ASSERT_EQ(image.width(), 12);
        ASSERT_EQ(image.height(), 6);
        for (int y = 0; y < 6; ++y)
            for (int x = 0; x < 12; ++x)
                EXPECT_EQ(image.rgb(x, y), table.image().rgb(x, y)) << x << " " << y;
    }
}

TEST(DfgVerb, WritesTheChannelsAskedFor) {
    const TemporaryFolder folder;
    const std::string file = (folder / "dfg.ktx2").string();
    const DfgTable table(8, 8);
    const Vec3f texel = table.image().rgb(2, 5);
    ASSERT_EQ(run({"dfg", "-o", file, "--size", "8", "--channels", "filament"}).code, 0);
    EXPECT_EQ(read_image(file).rgb(2, 5), Vec3f(texel.y, texel.x + texel.y, texel.z));
    ASSERT_EQ(run({"dfg", "-o", file, "--size", "8", "--channels", "unreal"}).code, 0);
    EXPECT_EQ(read_image(file).rgb(2, 5), Vec3f(texel.x, texel.y, 0));
    ASSERT_EQ(run({"dfg", "-o", file, "--size", "8", "--channels", "charlie"}).code, 0);
    EXPECT_EQ(read_image(file).rgb(2, 5), Vec3f(texel.z, texel.z, texel.z));
    ASSERT_EQ(run({"dfg", "-o", file, "--size", "8", "--format", "rgba16f"}).code, 0);
    EXPECT_NEAR(read_image(file).rgb(2, 5).x, texel.x, 2.5e-4);  // half of 2^-11
}

TEST(DfgVerb, PrintsTheValuesAtAPoint) {
    const Json json = Json::parse(run({"dfg", "--at", "0.5,0.5", "--json"}).out);
    EXPECT_NEAR(json["scale"], 0.8349, 1e-4);
    EXPECT_NEAR(json["bias"], 0.0224, 1e-4);
    EXPECT_NEAR(json["charlie"], 0.2296, 1e-4);
    EXPECT_NE(run({"dfg", "--at", "0.5,0.5"}).out.find("scale    0.834916"), std::string::npos);
}

// As C and as C++, with warnings as errors; what it looks up is what the library does.
TEST(DfgVerb, WritesAHeaderThatCompilesAndLooksUp) {
    if (std::system("command -v cc > /dev/null") != 0) GTEST_SKIP() << "there is no C compiler";
    const TemporaryFolder folder;
    const std::string header = (folder / "my-dfg.h").string();
    ASSERT_EQ(run({"dfg", "-o", header, "--size", "16x8", "--channels", "scale,bias"}).code, 0);
    write_contents(folder / "main.c",
                   "#include \"my-dfg.h\"\n#include \"my-dfg.h\"\n#include <stdio.h>\n"
                   "int main(void) {\n    float ab[MY_DFG_CHANNELS];\n"
                   "    my_dfg_look_up(0.37f, 0.61f, ab);\n"
                   "    printf(\"%.6f %.6f \", (double)ab[0], (double)ab[1]);\n"
                   "    my_dfg_look_up(1.0f, 0.0f, ab);\n"
                   "    printf(\"%.6f %.6f\\n\", (double)ab[0], (double)ab[1]);\n"
                   "    return 0;\n}\n");
    const DfgTable table(16, 8);
    for (const char* language : {"c -std=c99", "c++ -std=c++11"}) {
        const std::string folder_name = folder.path().string();
        const std::string build = "cd " + folder_name + " && cc -Wall -Wextra -Werror -x " +
                                  language + " main.c -o main 2> log && ./main > out";
        ASSERT_EQ(std::system(build.c_str()), 0) << contents(folder / "log");
        std::istringstream out(contents(folder / "out"));
        for (const auto& [n_dot_v, roughness] : {std::pair{0.37, 0.61}, {1.0, 0.0}}) {
            double scale = 0, bias = 0;
            out >> scale >> bias;
            EXPECT_NEAR(scale, table.ggx(n_dot_v, roughness).scale, 2e-6);
            EXPECT_NEAR(bias, table.ggx(n_dot_v, roughness).bias, 2e-6);
        }
    }
}

void expect_dfg_refused(const std::vector<std::string>& arguments, int code,
                        const std::string& words) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
}

TEST(DfgVerb, RefusesInWords) {
    const TemporaryFolder folder;
    const std::string file = (folder / "dfg.ktx2").string();
    expect_dfg_refused({"dfg"}, 2, "--output FILE is missing");
    expect_dfg_refused({"dfg", "-o", (folder / "a.doc").string()}, 2, "a.doc");
    expect_dfg_refused({"dfg", "-o", file, "--size", "1"}, 2, "--size");
    expect_dfg_refused({"dfg", "-o", file, "--size", "8x8x8"}, 2, "as 128 or 256x64");
    expect_dfg_refused({"dfg", "-o", file, "--size", "4097"}, 2, "4096");
    expect_dfg_refused({"dfg", "-o", file, "--channels", "skale"}, 2, "did you mean \"scale\"");
    expect_dfg_refused({"dfg", "-o", file, "--channels", "scale,bias,albedo,charlie"}, 2,
                       "at most 3");
    expect_dfg_refused({"dfg", "-o", file, "--format", "unorm8"}, 2, "unorm8");
    expect_dfg_refused({"dfg", "--at", "0.5"}, 2, "n.v and roughness");
    expect_dfg_refused({"dfg", "--at", "0.5,1.5"}, 2, "from 0 to 1");
    expect_dfg_refused({"dfg", "--at", "nan,0.5"}, 2, "from 0 to 1");
    expect_dfg_refused({"dfg", "-o", (folder / "a.h").string(), "--format", "rgba16f"}, 2,
                       "C header");
    expect_dfg_refused({"dfg", "-o", "/nowhere/dfg.ktx2"}, 4, "/nowhere");
    expect_dfg_refused({"dfg", "-o", "/nowhere/dfg.h", "--size", "8"}, 4, "/nowhere/dfg.h");
    EXPECT_TRUE(files_in(folder.path()).empty());
}

// Charlie's albedo exceeds 1 at grazing angles.
TEST(DfgVerb, SaysWhatAPngClips) {
    const TemporaryFolder folder;
    const Outcome outcome =
        run({"dfg", "-o", (folder / "dfg.png").string(), "--size", "16", "--channels", "gltf"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_NE(outcome.err.find("are clipped"), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.err.find("flux"), std::string::npos);
}

}  // namespace
}  // namespace mirrorball
