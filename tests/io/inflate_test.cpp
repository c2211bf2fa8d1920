// Our unpacking of zlib's format, against zlib itself.
#include "io/inflate.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <random>
#include <string>
#include <vector>

namespace mirrorball::detail {
namespace {

using Bytes = std::vector<std::byte>;

// The strategies and efforts between them make all three kinds of blocks.
Bytes packed(const Bytes& bytes, int effort, int strategy) {
    z_stream stream{};
    EXPECT_EQ(deflateInit2(&stream, effort, Z_DEFLATED, 15, 8, strategy), Z_OK);
    Bytes out(deflateBound(&stream, bytes.size()));
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

// From constant to noise: long repeats, text-like bytes, and what does not pack.
std::vector<Bytes> samples() {
    std::mt19937 random(1);
    std::vector<Bytes> all = {{}, {std::byte{7}}, Bytes(100'000, std::byte{42})};
    for (const unsigned range : {3u, 20u, 200u, 256u}) {
        Bytes bytes;
        for (int i = 0; i < 70'000; ++i) {
            const bool repeats = i > 300 && random() % 50 == 0;
            for (auto k = random() % 40; repeats && k > 0; --k)
                bytes.push_back(bytes[bytes.size() - 1 - random() % 300]);
            bytes.push_back(static_cast<std::byte>(random() % range));
        }
        all.push_back(std::move(bytes));
    }
    return all;
}

// Of the sample of twenty values.
Bytes beginning(std::size_t count) {
    Bytes bytes = samples()[4];
    bytes.resize(count);
    return bytes;
}

TEST(Inflate, GivesBackWhatZlibPacked) {
    for (const Bytes& bytes : samples()) {
        for (const int effort : {0, 1, 6, 9}) {
            for (const int strategy : {Z_DEFAULT_STRATEGY, Z_HUFFMAN_ONLY, Z_RLE, Z_FIXED}) {
                const Bytes small = packed(bytes, effort, strategy);
                Bytes out(bytes.size() + 3);
                ASSERT_EQ(unpack_zlib(small, out), bytes.size()) << effort << " " << strategy;
                out.resize(bytes.size());
                EXPECT_EQ(out, bytes);
            }
        }
    }
}

TEST(Inflate, RefusesWhatHasNoRoom) {
    const Bytes bytes = samples().back();
    const Bytes small = packed(bytes, 6, Z_DEFAULT_STRATEGY);
    Bytes out(bytes.size() - 1);
    EXPECT_FALSE(unpack_zlib(small, out));
}

TEST(Inflate, RefusesEveryBeginningOfAFile) {
    const Bytes bytes = beginning(500);
    const Bytes small = packed(bytes, 6, Z_DEFAULT_STRATEGY);
    Bytes out(bytes.size());
    for (std::size_t length = 0; length < small.size(); ++length)
        EXPECT_FALSE(unpack_zlib(std::span(small).first(length), out)) << length;
}

// The checksum finds each of them, unless the stream is broken before.
TEST(Inflate, RefusesEveryFlippedBitOrGivesTheSame) {
    const Bytes bytes = beginning(300);
    const Bytes small = packed(bytes, 9, Z_DEFAULT_STRATEGY);
    for (std::size_t bit = 0; bit < 8 * small.size(); ++bit) {
        Bytes broken = small;
        broken[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
        Bytes out(2 * bytes.size());
        const auto count = unpack_zlib(broken, out);
        if (!count) continue;
        out.resize(*count);
        EXPECT_EQ(out, bytes) << bit;
    }
}

}  // namespace
}  // namespace mirrorball::detail
