// What the tests of KTX2, DDS and OpenEXR share: contents to write, bytes in memory, damage.
#pragma once

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <mirrorball/error.h>

#include "io/codec.h"
#include "io/packed.h"
#include "support.h"

namespace mirrorball {

using Bytes = std::vector<std::byte>;

/// Values of which every texel format but the 8- and 16-bit ones holds each exactly: whole eighths
/// below 4. No two faces, levels or places near each other are alike.
inline Image exact_image(int width, int height, int channels, int face, int level) {
    Image image(width, height, channels);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c)
                image.at(x, y)[c] =
                    c == 3 ? 0.5f
                           : static_cast<float>(
                                 (7 * x + 13 * y + 11 * c + 5 * face + 3 * level + x * y) % 32) /
                                 8;
    return image;
}

inline FileContents exact_contents(int face_count, int width, int height, int level_count,
                                   int channels = 3) {
    FileContents contents;
    for (int level = 0; level < level_count; ++level) {
        auto& faces = contents.levels.emplace_back();
        for (int face = 0; face < face_count; ++face)
            faces.push_back(exact_image(detail::level_size(width, level),
                                        detail::level_size(height, level), channels, face, level));
    }
    if (face_count == 6) contents.projection = Projection::cube;
    return contents;
}

inline Bytes file_bytes(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    Bytes bytes(text.size());
    std::memcpy(bytes.data(), text.data(), text.size());
    return bytes;
}

inline Bytes written(const detail::Codec& codec, const FileContents& contents,
                     WriteOptions options = {}) {
    if (options.format == TexelFormat::automatic) options.format = codec.texel_formats.front();
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / "file";
    detail::OutputFile file(path);
    codec.write(file, contents, options);
    file.commit();
    return file_bytes(path);
}

/// With a limit, so that no damaged header can make a test use much memory.
inline FileContents read_back(const detail::Codec& codec, std::span<const std::byte> bytes,
                              Transfer transfer = Transfer::automatic) {
    detail::InputFile file("bytes", bytes);
    ReadOptions options;
    options.transfer = transfer;
    options.memory_limit = 64 << 20;
    return codec.read(file, options);
}

inline void expect_same_bits(const FileContents& a, const FileContents& b) {
    ASSERT_EQ(a.levels.size(), b.levels.size());
    for (std::size_t level = 0; level < a.levels.size(); ++level) {
        ASSERT_EQ(a.levels[level].size(), b.levels[level].size());
        for (std::size_t face = 0; face < a.levels[level].size(); ++face) {
            const Image &p = a.levels[level][face], &q = b.levels[level][face];
            ASSERT_EQ(p.width(), q.width());
            ASSERT_EQ(p.height(), q.height());
            ASSERT_EQ(p.channels(), q.channels());
            EXPECT_EQ(std::memcmp(p.values().data(), q.values().data(), p.values().size_bytes()), 0)
                << "level " << level << " face " << face;
        }
    }
}

/// The message of the refusal, or "" and a failure.
inline std::string refusal(const detail::Codec& codec, std::span<const std::byte> bytes) {
    try {
        static_cast<void>(read_back(codec, bytes));
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), Errc::cannot_read);
        return error.what();
    }
    ADD_FAILURE() << "was read";
    return {};
}

inline std::string write_refusal(const detail::Codec& codec, const FileContents& contents) {
    try {
        static_cast<void>(written(codec, contents));
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), Errc::cannot_write);
        return error.what();
    }
    ADD_FAILURE() << "was written";
    return {};
}

/// Every length shorter than the whole is refused.
inline void expect_truncations_refused(const detail::Codec& codec, const Bytes& bytes) {
    for (std::size_t length = 0; length < bytes.size(); ++length)
        EXPECT_THROW(static_cast<void>(read_back(codec, std::span(bytes).first(length))), Error)
            << "the first " << length << " of " << bytes.size() << " bytes";
}

/// Each byte in turn set to 0, 1, 0x7f and 0xff: an Error, or contents that hold together.
inline void expect_damage_survived(const detail::Codec& codec, const Bytes& bytes) {
    for (std::size_t i = 0; i < bytes.size(); ++i)
        for (const int value : {0, 1, 0x7f, 0xff}) {
            Bytes damaged = bytes;
            damaged[i] = std::byte(value);
            try {
                const FileContents contents = read_back(codec, damaged);
                ASSERT_FALSE(contents.levels.empty());
                for (const auto& faces : contents.levels) ASSERT_FALSE(faces.empty());
            } catch (const Error& error) {
                EXPECT_EQ(error.code(), Errc::cannot_read);
            }
        }
}

template <class T>
T value_at(const Bytes& bytes, std::size_t offset) {
    T value{};
    if (offset + sizeof(T) > bytes.size())
        ADD_FAILURE() << offset << " is past the end";
    else
        std::memcpy(&value, bytes.data() + offset, sizeof(T));
    return value;
}

inline std::uint32_t u32(const Bytes& bytes, std::size_t offset) {
    return value_at<std::uint32_t>(bytes, offset);
}
inline std::uint64_t u64(const Bytes& bytes, std::size_t offset) {
    return value_at<std::uint64_t>(bytes, offset);
}

inline Bytes with_u32(Bytes bytes, std::size_t offset, std::uint32_t value) {
    std::memcpy(bytes.data() + offset, &value, sizeof value);
    return bytes;
}

/// Whether a program is there to check against.
inline bool has_program(const std::string& name) {
    return std::system(("command -v " + name + " >/dev/null 2>&1").c_str()) == 0;
}

/// What a command prints.
inline std::string output_of(const std::string& command) {
    std::string text;
    FILE* pipe = popen((command + " 2>&1").c_str(), "r");
    if (pipe == nullptr) return text;
    std::array<char, 4096> buffer;
    while (const std::size_t count = fread(buffer.data(), 1, buffer.size(), pipe))
        text.append(buffer.data(), count);
    pclose(pipe);
    return text;
}

}  // namespace mirrorball
