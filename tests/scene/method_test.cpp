#include <gtest/gtest.h>

#include <mirrorball/error.h>
#include <mirrorball/scene.h>

namespace mirrorball {
namespace {

TEST(Method, NameAndParseAreInverse) {
    for (const Method method : all_methods()) EXPECT_EQ(parse_method(name(method)), method);
}

TEST(Method, UnknownNameIsRefusedWithTheNamesThereAre) {
    try {
        (void)parse_method("cubic");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), Errc::usage);
        EXPECT_NE(std::string(error.what()).find("dual-paraboloid"), std::string::npos);
    }
}

}  // namespace
}  // namespace mirrorball
