#include <iostream>

#include <gtest/gtest.h>
#include <mirrorball/gl/context.h>

namespace mirrorball::gl {
namespace {

TEST(Context, GivesEachOfTheThreeKinds) {
    for (const Api api : {Api::core, Api::es, Api::compatibility}) {
        const Context context(api);
        EXPECT_FALSE(driver().version.empty());
        EXPECT_EQ(driver().es, api == Api::es);
        // What all these tests are run on.
        std::cout << driver().vendor << ", " << driver().renderer << ", " << driver().version
                  << "\n";
    }
}

}  // namespace
}  // namespace mirrorball::gl
