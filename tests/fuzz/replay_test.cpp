// The fuzzers' seeds and all that they ever broke a decoder with, once more in every run of the
// tests.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "decode.h"

namespace mirrorball::detail {
namespace {

namespace fs = std::filesystem;

// Gives each input's name and bytes to use(name, bytes); the count of inputs.
template <class F>
int for_each_input(const std::string& kind, const F& use) {
    int count = 0;
    const fs::path folder = fs::path(MIRRORBALL_SOURCE_DIR) / "tests/fuzz" / kind;
    if (!fs::exists(folder)) return count;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        if (!entry.is_regular_file() || entry.path().filename().string().starts_with(".")) continue;
        std::ifstream in(entry.path(), std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(in), {}};
        use(entry.path(), std::as_bytes(std::span(bytes)));
        ++count;
    }
    return count;
}

// Every decoder gets every input: what one refuses at its first byte costs nothing.
void decode_by_all(std::span<const std::byte> bytes) {
    for (const Codec* codec : codecs()) decode_or_refuse(*codec, bytes);
    read_brdf_or_refuse(bytes);
}

TEST(FuzzReplay, SeedsDecode) {
    const int count =
        for_each_input("seeds", [](const fs::path& name, std::span<const std::byte> bytes) {
            const bool decoded =
                std::any_of(codecs().begin(), codecs().end(),
                            [&](const Codec* codec) { return !decode_or_refuse(*codec, bytes); }) ||
                !read_brdf_or_refuse(bytes);
            EXPECT_TRUE(decoded) << name << " reaches nothing behind the first check";
        });
    EXPECT_GT(count, 0) << "no seeds in tests/fuzz/seeds";
}

TEST(FuzzReplay, SeedsCutAnywhereAreSurvived) {
    for_each_input("seeds", [](const fs::path&, std::span<const std::byte> bytes) {
        for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 256)
            decode_by_all(bytes.first(size));
    });
}

TEST(FuzzReplay, OldCrashesStayMended) {
    for_each_input("crashes", [](const fs::path& name, std::span<const std::byte> bytes) {
        const auto begin = std::chrono::steady_clock::now();
        decode_by_all(bytes);
        EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5)) << name;
    });
}

}  // namespace
}  // namespace mirrorball::detail
