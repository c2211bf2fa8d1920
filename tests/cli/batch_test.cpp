// Several inputs by one command: names of the results, what is refused before work begins, and what
// becomes of the others when one fails. And --tolerance with the errors that it leads to.
#include <nlohmann/json.hpp>

#include "program.h"

namespace mirrorball {
namespace {

using Json = nlohmann::json;

class Batch : public testing::Test {
  protected:
    void SetUp() override {
        must({"sky", "sunset", "-o", file("a.hdr"), "--size", "64", "--quiet"});
        must({"sky", "noon", "-o", file("b.exr"), "--size", "64", "--quiet"});
        write_contents(file("broken.hdr"), "certainly not a picture");
    }
    std::string file(const std::string& name) { return (folder_ / name).string(); }
    void must(const std::vector<std::string>& arguments) {
        const Outcome outcome = run(arguments);
        ASSERT_EQ(outcome.code, 0) << arguments[0] << ": " << outcome.err;
    }
    /// A small chain of two levels.
    std::vector<std::string> prefilter(std::vector<std::string> more) {
        std::vector<std::string> all = {"prefilter", "--lobe", "ggx:0.3,0.6", "--size", "16"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    std::vector<std::string> bake(std::vector<std::string> more) {
        // The same wherever the page for browsers is built or not.
        std::vector<std::string> all = {
            "bake", "--no-viewer",        "--size", "16", "--diffuse-size", "8", "--phong",
            "10",   "--environment-size", "16"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    /// Refused with nothing read or written.
    void expect_nothing(const std::vector<std::string>& arguments, int code,
                        const std::string& message) {
        const auto before = files_in(folder_.path());
        expect_refused(arguments, code, message);
        EXPECT_EQ(files_in(folder_.path()), before);
    }

    TemporaryFolder folder_;
};

TEST_F(Batch, ResultsHaveTheirInputsNames) {
    std::filesystem::create_directory(folder_ / "room");
    must({"convert", file("a.hdr"), "-o", file("room/%s.exr"), "--to", "cube"});
    must({"convert", file("a.hdr"), "-o", file("hall_%s.exr"), "--to", "cube"});
    must(prefilter({file("a.hdr"), file("b.exr"), file("room/%s.exr"), file("hall_%s.exr"),
                    "builtin:white", "-o", file("out/")}));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_ / "out"), {}), 5);
    for (const char* name : {"a", "b", "room", "hall", "white"}) {
        EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / (std::string(name) + ".ktx2")))
            << name;
    }
    must(prefilter({file("a.hdr"), "-o", file("out"), "--ending", ".dds"}));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "out/a.dds"));
}

// Shared plans change nothing: a batch and single runs give the same bytes, whatever the order of
// shapes.
TEST_F(Batch, GivesWhatSingleRunsGive) {
    must({"sky", "studio", "-o", file("small.hdr"), "--size", "32"});
    const std::vector<std::string> names = {"a.hdr", "small.hdr", "b.exr"};
    std::vector<std::string> all = prefilter({"-o", file("out/")});
    for (const std::string& name : names) all.push_back(file(name));
    must(all);
    for (const std::string& name : names) {
        must(prefilter({file(name), "-o", file("one.ktx2")}));
        const std::string stem = name.substr(0, name.find('.'));
        EXPECT_TRUE(contents(file("one.ktx2")) == contents(file("out/" + stem + ".ktx2"))) << name;
    }
}

TEST_F(Batch, OneBrokenInputDoesNotHoldUpTheOthers) {
    for (const bool baked : {false, true}) {
        const std::vector<std::string> inputs = {file("a.hdr"), file("broken.hdr"),
                                                 file("missing.hdr"), file("b.exr"), "-o"};
        auto arguments = baked ? bake(inputs) : prefilter(inputs);
        arguments.push_back(file(baked ? "baked" : "out/"));
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 3);
        EXPECT_NE(outcome.err.find("broken.hdr: "), std::string::npos) << outcome.err;
        EXPECT_NE(outcome.err.find("missing.hdr: "), std::string::npos) << outcome.err;
        EXPECT_NE(outcome.err.find("2 of 4 inputs failed"), std::string::npos) << outcome.err;
        const std::string folder = baked ? "baked" : "out";
        const std::string ending = baked ? "/specular.ktx2" : ".ktx2";
        EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_ / folder), {}), 2);
        for (const std::string name : {"/a", "/b"}) must({"info", file(folder + name + ending)});
    }
}

TEST_F(Batch, JsonIsOneObjectOfAllResults) {
    for (const bool baked : {false, true}) {
        const std::vector<std::string> inputs = {file("a.hdr"), file("broken.hdr"), "--json", "-o"};
        auto arguments = baked ? bake(inputs) : prefilter(inputs);
        arguments.push_back(file(baked ? "baked" : "out/"));
        const Json json = Json::parse(run(arguments).out);
        ASSERT_EQ(json["results"].size(), 1u);
        ASSERT_EQ(json["failures"].size(), 1u);
        EXPECT_EQ(json["failures"][0]["input"], file("broken.hdr"));
    }
}

TEST_F(Batch, NothingIsLeftWhereAllFail) {
    const auto before = files_in(folder_.path());
    EXPECT_EQ(run(prefilter({file("broken.hdr"), file("missing.hdr"), "-o", file("new/")})).code,
              3);
    EXPECT_EQ(run(bake({file("broken.hdr"), file("missing.hdr"), "-o", file("new")})).code, 3);
    EXPECT_EQ(run(prefilter({file("broken.hdr"), "-o", file("new/")})).code, 3);
    EXPECT_EQ(files_in(folder_.path()), before);
}

TEST_F(Batch, NamesThatCollideAreRefusedBeforeWorkBegins) {
    std::filesystem::create_directory(folder_ / "other");
    std::filesystem::copy(file("a.hdr"), file("other/a.hdr"));
    const std::string same = file("other/../a.hdr");
    expect_nothing(prefilter({file("a.hdr"), file("other/a.hdr"), "-o", file("out/")}), 2,
                   "would both become");
    expect_nothing(prefilter({file("a.hdr"), same, "-o", file("out/")}), 2, "would both become");
    expect_nothing(bake({file("a.hdr"), file("other/a.hdr"), "-o", file("out")}), 2,
                   "would both become");
    expect_nothing({"prefilter", "--lobe", "diffuse", file("a.hdr"), file("b.exr"), "-o",
                    folder_.path().string(), "--ending", ".hdr"},
                   2, "would replace the input");
}

TEST_F(Batch, PlacesThatCannotHoldResultsAreRefusedBeforeWorkBegins) {
    const std::string a = file("a.hdr"), b = file("b.exr");
    expect_nothing(prefilter({a, b, "-o", file("out.ktx2")}), 2, "ends in a slash");
    expect_nothing(prefilter({a, b, "-o", file("broken.hdr/")}), 4, "is a file");
    expect_nothing(bake({a, b, "-o", file("broken.hdr")}), 4, "is a file");
    expect_nothing(prefilter({a, b, "-o", file("no/where/")}), 4, "no");
    expect_nothing(bake({a, b, "-o", file("no/where")}), 4, "no");
    expect_nothing(prefilter({a, b, "-o", file("out/"), "--ending", ".xyz"}), 2, ".xyz");
    expect_nothing(prefilter({a, b, "-o", file("out/"), "--ending", ".hdr"}), 2, "holds one");
    expect_nothing(prefilter({a, "-o", file("one.ktx2"), "--ending", ".dds"}), 2, "--ending");
    expect_nothing(prefilter({a, b, "-o", file("out/"), "--format", "unorm8"}), 2, "--format");
    if (geteuid() == 0) GTEST_SKIP() << "root writes to any folder";
    std::filesystem::create_directory(folder_ / "shut");
    std::filesystem::permissions(
        folder_ / "shut", std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
    expect_nothing(prefilter({a, b, "-o", file("shut/")}), 4, "shut");
    expect_nothing(bake({a, b, "-o", file("shut")}), 4, "shut");
}

// A limit on the size of files stands for a full disk: each input fails, and each is told.
TEST_F(Batch, AFullDiskIsToldOfEachInput) {
    const auto before = files_in(folder_.path());
    std::vector<std::string> words = {"/bin/bash", "-c", "ulimit -f 1; exec \"$0\" \"$@\""};
    for (const std::string& word :
         command(prefilter({file("a.hdr"), file("b.exr"), "-o", file("out/")}))) {
        words.push_back(word);
    }
    const Outcome outcome = Program(words).wait();
    EXPECT_EQ(outcome.code, 4) << outcome.err;
    EXPECT_NE(outcome.err.find("a.ktx2"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("b.ktx2"), std::string::npos) << outcome.err;
    EXPECT_EQ(files_in(folder_.path()), before);
}

TEST_F(Batch, ToleranceHasARange) {
    for (const char* tolerance : {"0", "1", "abc", "nan", "-1", "", "0.11", "1e-4x"}) {
        expect_nothing(prefilter({file("a.hdr"), "-o", file("x.ktx2"), "--tolerance", tolerance}),
                       2, "--tolerance");
        expect_nothing(bake({file("a.hdr"), "-o", file("x"), "--tolerance", tolerance}), 2,
                       "--tolerance");
    }
    expect_nothing(
        prefilter({file("a.hdr"), "-o", file("x.ktx2"), "--tolerance", "0.1", "--reference"}), 2,
        "--reference");
}

// Against the reference, in 32-bit floats, so that nothing else adds to the error. That it is
// within the tolerance is a law; the estimate is of its size, to a factor of two here (how sharp it
// is, is for tests/prefilter to say).
TEST_F(Batch, ToleranceIsKeptAndTheEstimateIsOfTheErrorsSize) {
    const auto chain = [&](const std::string& name, std::vector<std::string> more) {
        auto arguments =
            prefilter({file("a.hdr"), "-o", file(name), "--json", "--format", "rgba32f"});
        arguments.insert(arguments.end(), more.begin(), more.end());
        return Json::parse(run(arguments).out);
    };
    EXPECT_FALSE(chain("truth.ktx2", {"--reference"}).contains("estimated_errors"));
    for (const double tolerance : {1e-2, 1e-4}) {
        const Json made = chain("fast.ktx2", {"--tolerance", std::to_string(tolerance)});
        const Json difference = Json::parse(
            run({"compare", file("fast.ktx2"), file("truth.ktx2"), "--level", "all", "--json"})
                .out);
        ASSERT_EQ(made["estimated_errors"].size(), 2u);
        for (int level = 0; level < 2; ++level) {
            const double error = difference["levels"][level]["relative_rmse"];
            EXPECT_LE(error, tolerance);
            EXPECT_GE(2 * made["estimated_errors"][level].get<double>() + 1e-6, error);
        }
    }
}

TEST_F(Batch, BakeTellsTheErrorsThatItEstimates) {
    must(bake({file("a.hdr"), "-o", file("out"), "--tolerance", "1e-3"}));
    const Json facts = Json::parse(contents(folder_ / "out/bake.json"));
    EXPECT_EQ(facts["options"]["tolerance"], 1e-3);
    for (const Json& map : facts["maps"]) {
        for (const Json& level : map["level_facts"]) {
            if (map["file"] == "environment.ktx2") {
                EXPECT_TRUE(level["estimated_error"].is_null());
            } else {
                const double error = level["estimated_error"];
                EXPECT_GE(error, 0);
                EXPECT_LE(error, 1e-2);
            }
        }
    }
    EXPECT_NE(contents(folder_ / "out/index.html").find("Estimated error"), std::string::npos);
}

// 2048 x 1024 texels take 24 MiB.
TEST_F(Batch, AMapLargerThanMemoryIsReduced) {
    must({"sky", "white", "-o", file("large.hdr"), "--size", "2048"});
    for (const bool baked : {false, true}) {
        const std::vector<std::string> inputs = {file("large.hdr"), "--memory", "30M", "-o"};
        auto arguments = baked ? bake(inputs) : prefilter(inputs);
        arguments.push_back(file(baked ? "baked" : "out.ktx2"));
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_NE(outcome.err.find("2048 x 1024 texels were averaged"), std::string::npos)
            << outcome.err;
    }
}

}  // namespace
}  // namespace mirrorball
