// Small maps of which every value is known, and a way to look at errors.
#pragma once

#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <mirrorball/environment_map.h>
#include <mirrorball/error.h>

namespace mirrorball {

/// A different value in every channel of every texel, all of them whole numbers from 1 up that a
/// half and an RGBE hold exactly (below 2048 and 256) as long as there are no more of them.
inline Image numbered_image(int width, int height, float first = 1, int channels = 3) {
    Image image(width, height, channels);
    float value = first;
    for (float& v : image.values()) v = value++;
    return image;
}

inline EnvironmentMap numbered_map(Projection projection, int size) {
    EnvironmentMap map = make_environment_map(projection, size);
    float value = 1;
    for (Image& face : map.levels[0].faces) {
        for (float& v : face.values()) v = value++;
    }
    return map;
}

inline void expect_equal(const Image& a, const Image& b) {
    ASSERT_EQ(a.width(), b.width());
    ASSERT_EQ(a.height(), b.height());
    ASSERT_EQ(a.channels(), b.channels());
    for (int y = 0; y < a.height(); ++y) {
        for (int x = 0; x < a.width(); ++x) {
            for (int c = 0; c < a.channels(); ++c) {
                ASSERT_EQ(a.at(x, y)[c], b.at(x, y)[c]) << "at " << x << ", " << y << ", " << c;
            }
        }
    }
}

/// That f() throws an Error of this code whose message holds each of these words.
template <class F>
void expect_error(F&& f, Errc code, std::initializer_list<std::string> words) {
    try {
        f();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), code) << error.what();
        for (const std::string& word : words) {
            EXPECT_NE(std::string(error.what()).find(word), std::string::npos)
                << '"' << word << "\" is not in: " << error.what();
        }
        return;
    }
    ADD_FAILURE() << "no error";
}

}  // namespace mirrorball
