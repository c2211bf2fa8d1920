// The table of projections, and their plots.
#include <mirrorball/projection.h>

#include <nlohmann/json.hpp>

#include "program.h"

namespace mirrorball {
namespace {

using Json = nlohmann::json;

Json facts(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "projections");
    arguments.insert(arguments.end(), {"--size", "128", "--json"});
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return Json::parse(outcome.out)["projections"];
}

TEST(ProjectionsVerb, OneIsItsRowOfTheTable) {
    const Json all = facts({});
    ASSERT_EQ(all.size(), kProjectionCount);
    EXPECT_EQ(facts({"octahedral"}), Json::array({all[5]}));
    EXPECT_EQ(all[5]["projection"], "octahedral");
    EXPECT_EQ(all[5]["seams"], 4);
    const Outcome outcome = run({"projections", "cube"});
    EXPECT_NE(outcome.out.find("cube "), std::string::npos) << outcome.out;
    EXPECT_EQ(outcome.out.find("equirect "), std::string::npos) << outcome.out;
}

// Well formed, whatever the projection: every element closes itself or is closed.
TEST(ProjectionsVerb, EachHasAPlot) {
    const TemporaryFolder folder;
    for (std::size_t i = 0; i < kProjectionCount; ++i) {
        const std::string projection(name(static_cast<Projection>(i)));
        const std::string file = (folder / (projection + ".svg")).string();
        const Outcome outcome = run({"projections", projection, "--size", "64", "--plot", file});
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        const std::string svg = contents(file);
        EXPECT_EQ(svg.find("<svg "), 0u);
        EXPECT_EQ(svg.find("nan"), std::string::npos) << projection;
        EXPECT_EQ(svg.find("inf"), std::string::npos) << projection;
        std::size_t opened = 0, closed = 0;
        for (std::size_t k = 0; k + 1 < svg.size(); ++k) {
            if (svg[k] == '<' && svg[k + 1] != '/') ++opened;
            if ((svg[k] == '/' && svg[k + 1] == '>') || (svg[k] == '<' && svg[k + 1] == '/'))
                ++closed;
        }
        EXPECT_EQ(opened, closed) << projection;
        EXPECT_GT(opened, 50u) << projection;
    }
}

TEST(ProjectionsVerb, MistakesAreNamed) {
    expect_refused({"projections", "spher"}, 2, "sphere");
    expect_refused({"projections", "--plot", "all.svg"}, 2, "--plot draws one projection");
    expect_refused({"projections", "cube", "--plot", "cube.png"}, 2, "cube.png: plots are .svg");
    expect_refused({"projections", "--size", "1"}, 2, "--size");
}

}  // namespace
}  // namespace mirrorball
