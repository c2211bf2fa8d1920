// PFM as other programs write it, and broken.
#include <gtest/gtest.h>

#include <bit>
#include <cstring>

#include "io/codec.h"
#include "io_test_support.h"

namespace mirrorball::detail {
namespace {

std::string floats(std::initializer_list<float> values, bool big_endian = false) {
    std::string bytes;
    for (const float value : values) {
        auto bits = std::bit_cast<std::uint32_t>(value);
        for (int i = 0; i < 4; ++i)
            bytes.push_back(static_cast<char>(bits >> (big_endian ? 24 - 8 * i : 8 * i)));
    }
    return bytes;
}

FileContents decode(const std::string& file) {
    InputFile input("test.pfm", std::as_bytes(std::span(file)));
    return read_contents(input, {});
}

TEST(Pfm, TheBottomRowComesFirst) {
    for (const bool big_endian : {false, true}) {
        const std::string file = std::string("Pf\n2 2\n") + (big_endian ? "1.0\n" : "-1.0\n") +
                                 floats({3, 4, 1, 2}, big_endian);
        const Image image = decode(file).levels[0][0];
        ASSERT_EQ(image.channels(), 1);
        for (int i = 0; i < 4; ++i) EXPECT_EQ(image.at(i % 2, i / 2)[0], i + 1);
    }
}

TEST(Pfm, DataMayBeginWithABlank) {
    // 0x0a0a2020 is a float like any other; exactly one space ends the header.
    const std::string file = "PF 1 1 -1\n" + std::string("  \n\n  \n\n  \n\n");
    float expected = 0;
    std::memcpy(&expected, "  \n\n", 4);
    EXPECT_EQ(decode(file).levels[0][0].at(0, 0)[2], expected);
}

TEST(Pfm, AScaleIsNotedAndNotApplied) {
    const FileContents contents = decode("Pf\n1 1\n-2.5\n" + floats({1}));
    EXPECT_EQ(contents.levels[0][0].at(0, 0)[0], 1);
    ASSERT_EQ(contents.notes.size(), 1u);
    EXPECT_NE(contents.notes[0].find("2.5"), std::string::npos);
}

TEST(Pfm, BrokenFilesAreRefused) {
    const auto refused = [](const std::string& file, std::initializer_list<std::string> words) {
        expect_error([&] { (void)decode(file); }, Errc::cannot_read, words);
    };
    refused("PF\n", {"test.pfm", "truncated", "header"});
    refused("PF\nx 2\n-1\n", {"width 'x'", "no number"});
    refused("PF\n2 y\n-1\n", {"height 'y'"});
    refused("PF\n2 2\nz\n", {"scale 'z'"});
    refused("PF\n1 1\n0\n" + floats({1, 2, 3}), {"scale"});
    refused("PF\n1 1\ninf\n" + floats({1, 2, 3}), {"scale"});
    refused("PF\n1 1\nnan\n" + floats({1, 2, 3}), {"scale"});
    refused("PF\n0 1\n-1\n", {"claims 0 x 1"});
    refused("PF\n1 -1\n-1\n", {"claims 1 x -1"});
    refused("PF\n1 1\n-1\n" + floats({1, 2}), {"truncated", "12 bytes"});
    refused("PF\n" + std::string(1000, ' '), {"no number among"});
    refused("PF\n" + std::string(1000, '1'), {"no number among"});
}

}  // namespace
}  // namespace mirrorball::detail
