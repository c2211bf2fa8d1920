// Deflate is a sequence of blocks of symbols: bytes as they are, or "so many bytes from so far
// back". Symbols are canonical Huffman codes, which follow from their lengths alone: shorter codes
// first, equal lengths in the order of symbols. So decoding walks down the lengths and needs, of
// each length, the first code and where its symbols begin; nine bits at once go by a table.
#include "inflate.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

namespace mirrorball::detail {
namespace {

struct Broken {};

constexpr int kLongestCode = 15;

// Bits, from the lowest of each byte.
class Bits {
  public:
    explicit Bits(std::span<const std::byte> bytes) : bytes_(bytes) {}

    /// The next `count` bits, 0 to 24; zeros beyond the end, which take() does not allow.
    std::uint32_t look(int count) {
        while (held_ < count) {
            const std::uint64_t byte =
                next_ < bytes_.size() ? std::to_integer<std::uint64_t>(bytes_[next_]) : 0;
            bits_ |= byte << held_;
            held_ += 8;
            ++next_;
        }
        return static_cast<std::uint32_t>(bits_ & ((std::uint64_t{1} << count) - 1));
    }
    void drop(int count) {
        bits_ >>= count;
        held_ -= count;
        if (next_ > bytes_.size() && 8 * (next_ - bytes_.size()) > static_cast<unsigned>(held_))
            throw Broken();
    }
    std::uint32_t take(int count) {
        const std::uint32_t value = look(count);
        drop(count);
        return value;
    }
    /// Whole bytes from the next byte on.
    std::span<const std::byte> bytes(std::size_t count) {
        next_ -= static_cast<std::size_t>(held_ / 8);
        bits_ = 0;
        held_ = 0;
        if (next_ > bytes_.size() || count > bytes_.size() - next_) throw Broken();
        next_ += count;
        return bytes_.subspan(next_ - count, count);
    }

  private:
    std::span<const std::byte> bytes_;
    std::size_t next_ = 0;
    std::uint64_t bits_ = 0;
    int held_ = 0;
};

class Code {
  public:
    explicit Code(std::span<const std::uint8_t> lengths) {
        for (const std::uint8_t length : lengths) ++counts_[length];
        counts_[0] = 0;
        int left = 1;  // codes of this length that shorter ones have not taken
        for (int length = 1; length <= kLongestCode; ++length) {
            left = 2 * left - counts_[length];
            if (left < 0) throw Broken();
        }
        std::array<int, kLongestCode + 2> offsets{}, codes{};
        for (int length = 1; length <= kLongestCode; ++length) {
            offsets[length + 1] = offsets[length] + counts_[length];
            codes[length + 1] = (codes[length] + counts_[length]) << 1;
        }
        for (std::size_t symbol = 0; symbol < lengths.size(); ++symbol) {
            const int length = lengths[symbol];
            if (length == 0) continue;
            symbols_[offsets[length]++] = static_cast<std::uint16_t>(symbol);
            if (length <= kQuickBits) enter(codes[length]++, length, symbol);
        }
    }

    int decode(Bits& bits) const {
        const Entry entry = quick_[bits.look(kQuickBits)];
        if (entry.length > 0) {
            bits.drop(entry.length);
            return entry.symbol;
        }
        return decode_bit_by_bit(bits);
    }

  private:
    static constexpr int kQuickBits = 9;
    struct Entry {
        std::uint16_t symbol = 0;
        std::uint8_t length = 0;
    };

    // Codes are written from their highest bit, bits read from the lowest.
    void enter(int code, int length, std::size_t symbol) {
        unsigned reversed = 0;
        for (int i = 0; i < length; ++i) reversed |= ((code >> i) & 1u) << (length - 1 - i);
        for (unsigned i = reversed; i < quick_.size(); i += 1u << length)
            quick_[i] = {static_cast<std::uint16_t>(symbol), static_cast<std::uint8_t>(length)};
    }

    int decode_bit_by_bit(Bits& bits) const {
        int code = 0, first = 0, offset = 0;
        for (int length = 1; length <= kLongestCode; ++length) {
            code |= static_cast<int>(bits.take(1));
            const int count = counts_[length];
            if (code - first < count) return symbols_[offset + code - first];
            offset += count;
            first = (first + count) << 1;
            code <<= 1;
        }
        throw Broken();
    }

    std::array<int, 16> counts_{};
    std::array<std::uint16_t, 288> symbols_{};
    std::array<Entry, 1 << kQuickBits> quick_{};
};

struct Output {
    std::span<std::byte> bytes;
    std::size_t count = 0;

    void put(std::byte byte) {
        if (count == bytes.size()) throw Broken();
        bytes[count++] = byte;
    }
    void put(std::span<const std::byte> more) {
        if (more.size() > bytes.size() - count) throw Broken();
        std::copy(more.begin(), more.end(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
        count += more.size();
    }
    // One by one: what is repeated may reach into itself.
    void repeat(std::size_t distance, std::size_t length) {
        if (distance > count || length > bytes.size() - count) throw Broken();
        for (std::size_t i = 0; i < length; ++i, ++count) bytes[count] = bytes[count - distance];
    }
};

// The symbols for lengths and distances say a base and how many bits are to be added to it. Beyond
// the first few both grow by a power of two every `steps` symbols.
struct Range {
    int base, bits;
};

Range length_range(int symbol) {
    if (symbol < 8) return {3 + symbol, 0};
    if (symbol == 28) return {258, 0};
    const int bits = symbol / 4 - 1;
    return {3 + ((4 + symbol % 4) << bits), bits};
}

Range distance_range(int symbol) {
    if (symbol < 4) return {1 + symbol, 0};
    const int bits = symbol / 2 - 1;
    return {1 + ((2 + symbol % 2) << bits), bits};
}

void unpack_symbols(Bits& bits, const Code& symbols, const Code& distances, Output& out) {
    constexpr int kEnd = 256, kLengthSymbols = 29, kDistanceSymbols = 30;
    for (;;) {
        const int symbol = symbols.decode(bits);
        if (symbol < kEnd) {
            out.put(static_cast<std::byte>(symbol));
            continue;
        }
        if (symbol == kEnd) return;
        if (symbol - kEnd - 1 >= kLengthSymbols) throw Broken();
        const Range length = length_range(symbol - kEnd - 1);
        const std::size_t count = length.base + bits.take(length.bits);
        const int far = distances.decode(bits);
        if (far >= kDistanceSymbols) throw Broken();
        const Range distance = distance_range(far);
        out.repeat(distance.base + bits.take(distance.bits), count);
    }
}

void unpack_stored(Bits& bits, Output& out) {
    const std::span<const std::byte> head = bits.bytes(4);
    const auto word = [&](std::size_t i) {
        return std::to_integer<unsigned>(head[i]) | std::to_integer<unsigned>(head[i + 1]) << 8;
    };
    if (word(0) != (~word(2) & 0xffffu)) throw Broken();
    out.put(bits.bytes(word(0)));
}

void unpack_with_fixed_codes(Bits& bits, Output& out) {
    std::array<std::uint8_t, 288> lengths;
    std::fill(lengths.begin(), lengths.end(), std::uint8_t{8});
    std::fill(lengths.begin() + 144, lengths.begin() + 256, std::uint8_t{9});
    std::fill(lengths.begin() + 256, lengths.begin() + 280, std::uint8_t{7});
    std::array<std::uint8_t, 30> distance_lengths;
    distance_lengths.fill(5);
    unpack_symbols(bits, Code(lengths), Code(distance_lengths), out);
}

// The codes' lengths come first, run-length coded and in a Huffman code themselves.
void unpack_with_own_codes(Bits& bits, Output& out) {
    constexpr std::array<int, 19> kOrder = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                            11, 4,  12, 3, 13, 2, 14, 1, 15};
    constexpr int kRepeat = 16, kZeros = 17;
    const std::size_t symbol_count = 257 + bits.take(5), distance_count = 1 + bits.take(5);
    const std::size_t order_count = 4 + bits.take(4);
    if (symbol_count > 286 || distance_count > 30) throw Broken();
    std::array<std::uint8_t, 19> order_lengths{};
    for (std::size_t i = 0; i < order_count; ++i)
        order_lengths[kOrder[i]] = static_cast<std::uint8_t>(bits.take(3));
    const Code order(order_lengths);

    std::array<std::uint8_t, 286 + 30> lengths{};
    const std::size_t total = symbol_count + distance_count;
    for (std::size_t i = 0; i < total;) {
        const int symbol = order.decode(bits);
        if (symbol < kRepeat) {
            lengths[i++] = static_cast<std::uint8_t>(symbol);
            continue;
        }
        if (symbol == kRepeat && i == 0) throw Broken();
        const std::uint8_t repeated = symbol == kRepeat ? lengths[i - 1] : std::uint8_t{0};
        const std::size_t count = symbol == kRepeat  ? 3 + bits.take(2)
                                  : symbol == kZeros ? 3 + bits.take(3)
                                                     : 11 + bits.take(7);
        if (count > total - i) throw Broken();
        std::fill_n(lengths.begin() + static_cast<std::ptrdiff_t>(i), count, repeated);
        i += count;
    }
    const std::span<const std::uint8_t> all(lengths);
    unpack_symbols(bits, Code(all.first(symbol_count)),
                   Code(all.subspan(symbol_count, distance_count)), out);
}

void unpack_blocks(Bits& bits, Output& out) {
    for (bool last = false; !last;) {
        last = bits.take(1) == 1;
        switch (bits.take(2)) {
            case 0:
                unpack_stored(bits, out);
                break;
            case 1:
                unpack_with_fixed_codes(bits, out);
                break;
            case 2:
                unpack_with_own_codes(bits, out);
                break;
            default:
                throw Broken();
        }
    }
}

std::uint32_t adler32(std::span<const std::byte> bytes) {
    constexpr std::uint32_t kPrime = 65521;
    constexpr std::size_t kWithoutOverflow = 5552;
    std::uint32_t a = 1, b = 0;
    while (!bytes.empty()) {
        const auto some = bytes.first(std::min(bytes.size(), kWithoutOverflow));
        for (const std::byte byte : some) {
            a += std::to_integer<std::uint32_t>(byte);
            b += a;
        }
        a %= kPrime;
        b %= kPrime;
        bytes = bytes.subspan(some.size());
    }
    return b << 16 | a;
}

}  // namespace

std::optional<std::size_t> unpack_zlib(std::span<const std::byte> packed,
                                       std::span<std::byte> out) {
    constexpr unsigned kDeflate = 8, kHasDictionary = 0x20;
    if (packed.size() < 2) return std::nullopt;
    const auto method = std::to_integer<unsigned>(packed[0]);
    const auto flags = std::to_integer<unsigned>(packed[1]);
    if ((method & 0xf) != kDeflate || (method * 256 + flags) % 31 != 0 || flags & kHasDictionary)
        return std::nullopt;
    try {
        Bits bits(packed.subspan(2));
        Output output{out};
        unpack_blocks(bits, output);
        std::uint32_t sum = 0;
        for (const std::byte byte : bits.bytes(4)) sum = sum << 8 | std::to_integer<unsigned>(byte);
        if (sum != adler32(out.first(output.count))) return std::nullopt;
        return output.count;
    } catch (const Broken&) {
        return std::nullopt;
    }
}

}  // namespace mirrorball::detail
