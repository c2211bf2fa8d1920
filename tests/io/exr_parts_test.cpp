// One part of an OpenEXR file as a file of its own: OpenEXR's library must find in it what it finds
// in the whole, and no damage may lead beyond the bytes there are.
#include "io/exr_parts.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "container_support.h"
#include "exr_support.h"

namespace mirrorball {
namespace {

using detail::kExr;

Bytes cut(const Bytes& bytes, std::size_t part) {
    const detail::InputFile file("bytes", bytes);
    return checked_part(file, bytes, detail::parse_exr_headers(file, bytes), part);
}

std::vector<MadePart> three_parts() {
    return {{exact_image(8, 40, 1, 0, 0), {"Z"}},
            {exact_image(8, 40, 3, 1, 0), {"R", "G", "B"}, true, Imf::RLE_COMPRESSION},
            {exact_image(8, 40, 4, 2, 0), {"R", "G", "B", "A"}, false, Imf::PIZ_COMPRESSION}};
}

TEST(ExrParts, HeadersSayWhatThereIs) {
    const Bytes bytes = made_parts(three_parts());
    const detail::InputFile file("bytes", bytes);
    const detail::ExrParts parts = detail::parse_exr_headers(file, bytes);
    ASSERT_EQ(parts.parts.size(), 3u);
    EXPECT_EQ(parts.parts[0].channels, std::vector<std::string>{"Z"});
    EXPECT_EQ(parts.parts[1].channels, (std::vector<std::string>{"B", "G", "R"}));
    EXPECT_EQ(parts.parts[2].compression(), "PIZ");
    EXPECT_TRUE(parts.parts[1].is_tiled);
    EXPECT_FALSE(parts.parts[2].is_tiled || parts.parts[2].is_deep);
}

TEST(ExrParts, AloneTheyHoldWhatTheyDidTogether) {
    const std::vector<MadePart> parts = three_parts();
    const Bytes bytes = made_parts(parts);
    for (std::size_t i = 1; i < parts.size(); ++i) {
        const FileContents alone = read_back(kExr, cut(bytes, i));
        EXPECT_TRUE(alone.notes.empty());
        EXPECT_TRUE(alone.metadata.empty()) << "the header of the whole has it";
        ASSERT_EQ(alone.levels.size(), parts[i].has_levels ? 4u : 1u);
        FileContents first = plain(alone.levels[0][0]);
        expect_same_bits(first, plain(parts[i].image));
    }
}

TEST(ExrParts, CountsOfChunksAreHeldAgainstThePicture) {
    Bytes bytes = made_parts(three_parts());
    const std::string name = "chunkCount";
    const auto as_byte = [](char c) { return std::byte(c); };
    std::vector<std::byte> wanted(name.size());
    std::transform(name.begin(), name.end(), wanted.begin(), as_byte);
    const auto last = std::find_end(bytes.begin(), bytes.end(), wanted.begin(), wanted.end());
    ASSERT_NE(last, bytes.end());
    std::byte& count = last[static_cast<std::ptrdiff_t>(name.size() + sizeof "int" + 1 + 4)];
    ASSERT_EQ(count, std::byte{2}) << "40 lines by PIZ, 32 in a chunk";
    count = std::byte{3};
    try {
        static_cast<void>(cut(bytes, 2));
        ADD_FAILURE() << "was taken";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("has 3 chunks, expected 2"), std::string::npos)
            << error.what();
    }
}

TEST(ExrParts, NoDamageLeadsBeyondTheBytes) {
    const Bytes bytes = made_parts(
        {{exact_image(3, 2, 1, 0, 0), {"Z"}}, {exact_image(3, 2, 3, 0, 0), {"R", "G", "B"}}});
    for (std::size_t length = 0; length < bytes.size(); ++length) {
        const Bytes shorter(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length));
        EXPECT_THROW(static_cast<void>(cut(shorter, 1)), Error) << length;
    }
    for (std::size_t i = 0; i < bytes.size(); ++i)
        for (const int value : {0, 1, 0x7f, 0xff}) {
            Bytes damaged = bytes;
            damaged[i] = std::byte(value);
            try {
                const detail::InputFile file("bytes", damaged);
                const detail::ExrParts parts = detail::parse_exr_headers(file, damaged);
                if (!parts.is_multipart || parts.parts.size() != 2 || parts.parts[1].is_deep)
                    continue;
                EXPECT_LE(checked_part(file, damaged, parts, 1).size(), 2 * damaged.size());
            } catch (const Error& error) {
                EXPECT_EQ(error.code(), Errc::cannot_read);
            }
        }
}

}  // namespace
}  // namespace mirrorball
