// PFM, the portable float map: three lines of text, then plain floats, bottom row first.
//
//     PF           or Pf for one channel
//     1024 512     width, height
//     -1.0         its sign tells the byte order (negative: little endian), its size is a scale
//     that
//                  nothing agrees on how to apply, so values are taken as they are
#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "codec.h"
#include "core/bits.h"
#include "core/numbers.h"
#include "row_source.h"

namespace mirrorball::detail {
namespace {

static_assert(std::endian::native == std::endian::little, "the byte order written below");

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

bool recognises(std::span<const std::byte> head) {
    if (head.size() < 3 || head[0] != std::byte{'P'}) return false;
    const bool known = head[1] == std::byte{'F'} || head[1] == std::byte{'f'};
    return known && is_space(static_cast<char>(head[2]));
}

// Skips space before the word, and takes exactly one space after it: data may begin with any byte.
std::string read_word(InputFile& file) {
    constexpr std::size_t kLongest = 64;
    std::string word;
    for (std::size_t i = 0; i < kLongest; ++i) {
        if (file.remaining() == 0) file.fail("is truncated: ends within its header");
        const char c = static_cast<char>(file.read_byte());
        if (!is_space(c))
            word.push_back(c);
        else if (!word.empty())
            return word;
    }
    file.fail(fmt::format("has no number among {} bytes of its header", kLongest));
}

template <class T>
T read_number(InputFile& file, const char* what) {
    const std::string word = read_word(file);
    T value{};
    const char* end = word.data() + word.size();
    const auto [stop, error] = from_chars(word.data(), end, value);
    if (error != std::errc{} || stop != end)
        file.fail(fmt::format("has the {} '{}', which is no number", what, word));
    return value;
}

void reverse_bytes(std::span<float> values) {
    for (float& value : values)
        value = bit_cast<float>(__builtin_bswap32(bit_cast<std::uint32_t>(value)));
}

struct PfmHeader {
    int width, height, channels;
    double scale;
    std::uint64_t begin;  // of the texels
};

PfmHeader read_header(InputFile& file, const ReadOptions& options) {
    const int channels = read_word(file) == "PF" ? 3 : 1;
    const auto width = read_number<std::int64_t>(file, "width");
    const auto height = read_number<std::int64_t>(file, "height");
    const auto scale = read_number<double>(file, "scale");
    if (scale == 0 || !std::isfinite(scale))
        file.fail("has a scale that is zero or infinite (-1.0 or 1.0 expected)");

    check_claim(file, width, height, channels, 1, 0,
                options);  // sides first: products may overflow
    const std::uint64_t bytes =
        static_cast<std::uint64_t>(width) * height * channels * sizeof(float);
    check_claim(file, width, height, channels, 1, bytes, options);
    return {static_cast<int>(width), static_cast<int>(height), channels, scale, file.position()};
}

std::vector<std::string> notes_on(const PfmHeader& header) {
    if (std::abs(header.scale) == 1) return {};
    return {fmt::format("states a scale of {:g}, which is not applied", header.scale)};
}

FileContents read(InputFile& file, const ReadOptions& options) {
    const PfmHeader header = read_header(file, options);
    Image image(header.width, header.height, header.channels);
    for (int y = image.height() - 1; y >= 0; --y) {
        file.read(std::as_writable_bytes(image.row(y)));
        if (header.scale > 0) reverse_bytes(image.row(y));
    }
    FileContents contents;
    contents.stored = TexelFormat::rgba32f;
    contents.levels.emplace_back().push_back(std::move(image));
    contents.notes = notes_on(header);
    return contents;
}

// The bottom row is first in the file, but where each begins is known.
class PfmRows : public RowSource {
  public:
    PfmRows(InputFile& file, const PfmHeader& of_file) : file_(file), of_file_(of_file) {
        header.width = of_file.width;
        header.height = of_file.height;
        header.channels = of_file.channels;
        header.stored = TexelFormat::rgba32f;
        header.notes = notes_on(of_file);
    }

    void read(int count, std::span<float> values) override {
        const std::size_t row_size = values.size() / count;
        done_ += count;
        const auto below = static_cast<std::uint64_t>(header.height - done_);
        file_.seek(of_file_.begin + below * row_size * sizeof(float));
        file_.read(std::as_writable_bytes(values));
        for (int a = 0, b = count - 1; a < b; ++a, --b)
            std::swap_ranges(&values[a * row_size], &values[a * row_size] + row_size,
                             &values[b * row_size]);
        if (of_file_.scale > 0) reverse_bytes(values);
    }
    [[nodiscard]] int rows_at_once() const override { return 16; }
    [[nodiscard]] std::uint64_t bytes_held() const override { return 0; }

  private:
    InputFile& file_;
    PfmHeader of_file_;
    int done_ = 0;
};

std::unique_ptr<RowSource> open_rows(InputFile& file, const ReadOptions&, std::string&) {
    return std::make_unique<PfmRows>(file, read_header(file, {}));
}

// Alpha is dropped, which the format has not.
void write(OutputFile& file, const ContentsView& contents, const WriteOptions&) {
    const Image& image = contents.levels.front().front();
    const int channels = image.channels();
    const int kept = channels < 3 ? 1 : 3;
    file.write(
        fmt::format("{}\n{} {}\n-1.0\n", kept == 3 ? "PF" : "Pf", image.width(), image.height()));
    std::vector<float> row(static_cast<std::size_t>(image.width()) * kept);
    for (int y = image.height() - 1; y >= 0; --y) {
        for (int x = 0; x < image.width(); ++x)
            std::copy_n(image.at(x, y), kept, &row[static_cast<std::size_t>(x) * kept]);
        file.write(std::as_bytes(std::span<const float>(row)));
    }
}

}  // namespace

const Codec kPfm{"PFM", {".pfm"}, {TexelFormat::rgba32f}, recognises, read, write, false,
                 false, open_rows};

}  // namespace mirrorball::detail
