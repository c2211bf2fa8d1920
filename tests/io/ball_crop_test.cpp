#include "io/ball_crop.h"

#include <cmath>
#include <limits>

#include "io_test_support.h"

namespace mirrorball::detail {
namespace {

TEST(BallCrop, CopiesPixelsWhereTheCircleLiesOnThem) {
    const Image picture = numbered_image(12, 10);
    const Image square = crop_to_circle(picture, {6, 5, 3});
    ASSERT_EQ(square.width(), 6);
    for (int y = 0; y < 6; ++y) {
        for (int x = 0; x < 6; ++x) EXPECT_EQ(square.rgb(x, y), picture.rgb(x + 3, y + 2));
    }
}

TEST(BallCrop, IsExactBetweenPixelsOfARamp) {
    // Linear interpolation has nothing to lose on a linear picture: the value at a point is the
    // point.
    Image picture(40, 30, 2);
    for (int y = 0; y < 30; ++y) {
        for (int x = 0; x < 40; ++x) {
            picture.at(x, y)[0] = float(x) + 0.5f;
            picture.at(x, y)[1] = float(y) + 0.5f;
        }
    }
    const CropCircle circle{17.3, 14.6, 9.2};
    const Image square = crop_to_circle(picture, circle);
    ASSERT_EQ(square.width(), 18);
    for (int y = 0; y < 18; ++y) {
        for (int x = 0; x < 18; ++x) {
            // rounding of floats of about 30
            EXPECT_NEAR(square.at(x, y)[0], 17.3 - 9.2 + (x + 0.5) * 18.4 / 18, 1e-5);
            EXPECT_NEAR(square.at(x, y)[1], 14.6 - 9.2 + (y + 0.5) * 18.4 / 18, 1e-5);
        }
    }
}

TEST(BallCrop, DoesNotSpreadWhatIsNoNumberOverPixelsItDoesNotTouch) {
    Image picture(4, 4, 1);
    *picture.at(3, 1) = std::numeric_limits<float>::quiet_NaN();
    const Image square = crop_to_circle(picture, {1.5, 1.5, 1.5});
    for (const float value : square.values()) EXPECT_EQ(value, 0);
}

TEST(BallCrop, MayMissThePictureByAPixelAndNoMore) {
    EXPECT_NO_THROW(check_crop("ball.hdr", 100, 80, {40, 40, 40}));
    EXPECT_NO_THROW(check_crop("ball.hdr", 100, 80, {40, 40, 41}));
    for (const CropCircle& circle :
         {CropCircle{40, 40, 41.5}, CropCircle{38, 40, 40}, CropCircle{62, 40, 40},
          CropCircle{50, 1e9, 3}, CropCircle{50, 40, 1e300}}) {
        expect_error([&] { check_crop("ball.hdr", 100, 80, circle); }, Errc::usage,
                     {"ball.hdr", "leaves the picture", "100 x 80"});
    }
    const double nan = std::numeric_limits<double>::quiet_NaN();
    expect_error([&] { check_crop("ball.hdr", 100, 80, {40, 40, 0}); }, Errc::usage, {"radius"});
    expect_error([&] { check_crop("ball.hdr", 100, 80, {40, 40, nan}); }, Errc::usage, {"radius"});
    expect_error([&] { check_crop("ball.hdr", 100, 80, {nan, 40, 10}); }, Errc::usage, {"leaves"});

    // over the border, the border's pixels go on
    Image picture(4, 4, 1);
    for (float& value : picture.values()) value = 7;
    const Image square = crop_to_circle(picture, {2, 2, 3});
    EXPECT_EQ(square.width(), 6);
    for (const float value : square.values()) EXPECT_EQ(value, 7);
}

}  // namespace
}  // namespace mirrorball::detail
