#include "hdr.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

#include "codec.h"
#include "core/bits.h"
#include "core/numbers.h"
#include "core/parallel.h"
#include "row_source.h"

namespace mirrorball::detail {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

// Run-length coding by component is for these lengths only: its marker holds 15 bits.
constexpr int kShortestForRuns = 8, kLongestForRuns = 32767;

bool length_allows_runs(int length) {
    return length >= kShortestForRuns && length <= kLongestForRuns;
}

bool begins_runs(const Rgbe& texel) {
    return texel[0] == 2 && texel[1] == 2 && texel[2] < 128;
}

// In the older coding a texel with these mantissas repeats the one before, e times.
bool is_repeat(const Rgbe& texel) {
    return texel[0] == 1 && texel[1] == 1 && texel[2] == 1;
}

// Powers of two by exponent byte, each a float without rounding, subnormal ones included.
const std::array<float, 256>& scales() {
    static const auto kTable = [] {
        std::array<float, 256> table{};
        for (int e = 1; e < 256; ++e) table[e] = std::ldexp(1.0f, e - 136);
        return table;
    }();
    return kTable;
}

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(" \t");
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

std::vector<std::string_view> words(std::string_view text) {
    std::vector<std::string_view> result;
    while (!(text = trimmed(text)).empty()) {
        const std::size_t end = std::min(text.find_first_of(" \t"), text.size());
        result.push_back(text.substr(0, end));
        text.remove_prefix(end);
    }
    return result;
}

template <class T>
std::optional<T> number(std::string_view text) {
    T value{};
    const auto [end, error] = from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

// All planes of a scanline, from runs that end where they should.
void expand_runs(const std::uint8_t* from, std::span<std::uint8_t> planes) {
    for (std::size_t x = 0; x < planes.size();) {
        const std::uint8_t code = *from++;
        if (code > 128) {
            std::memset(&planes[x], *from++, code - 128u);
            x += code - 128u;
        } else {
            std::memcpy(&planes[x], from, code);
            from += code;
            x += code;
        }
    }
}

// Linear Rec. 709 from XYZ with a white of D65, IEC 61966-2-1.
void rgb_from_xyz(std::span<float> texels) {
    for (std::size_t i = 0; i < texels.size(); i += 3) {
        const double x = texels[i], y = texels[i + 1], z = texels[i + 2];
        texels[i] = static_cast<float>(3.2404542 * x - 1.5371385 * y - 0.4985314 * z);
        texels[i + 1] = static_cast<float>(-0.9692660 * x + 1.8760108 * y + 0.0415560 * z);
        texels[i + 2] = static_cast<float>(0.0556434 * x - 0.2040259 * y + 1.0572252 * z);
    }
}

// Exponents are taken from and put into the bits of doubles: every positive float is a normal
// double, and frexp and ldexp would be most of the time that writing takes.
Rgbe encode(const float* rgb) {
    const double largest = std::max({rgb[0], rgb[1], rgb[2]});
    // largest < 2^exponent, by at most a factor of 2
    int exponent = static_cast<int>(bit_cast<std::uint64_t>(largest) >> 52) - 1022;
    if (exponent < -127) return {0, 0, 0, 0};
    const auto power_of_two = [](int e) {
        return bit_cast<double>(static_cast<std::uint64_t>(e + 1023) << 52);
    };
    // Rounding may carry the largest mantissa to 256, which belongs to the next exponent.
    if (largest * power_of_two(8 - exponent) >= 255.5) ++exponent;

    // In double, where adding a half to a float is exact.
    const double scale = power_of_two(8 - exponent);
    Rgbe texel;
    for (int c = 0; c < 3; ++c) texel[c] = static_cast<std::uint8_t>(rgb[c] * scale + 0.5);
    texel[3] = static_cast<std::uint8_t>(exponent + 128);
    return texel;
}

}  // namespace

// HdrReader ---------------------------------------------------------------------------------------

HdrReader::HdrReader(InputFile& file) : file_(file) {
    read_header();
    read_resolution();
    check_length_of_file();
    for (int c = 0; c < 3; ++c) divisor_[c] = static_cast<float>(exposure_ * colour_correction_[c]);
    for (const float divisor : divisor_)
        if (!std::isnormal(divisor))
            file_.fail("header's EXPOSURE and COLORCORR multiply to what is out of range");
    if (divisor_ != std::array<float, 3>{1, 1, 1})
        notes_.push_back(
            fmt::format("values divided by its EXPOSURE and COLORCORR, {:.6g} {:.6g} {:.6g}",
                        divisor_[0], divisor_[1], divisor_[2]));
}

void HdrReader::read_header() {
    const std::string magic = read_line();
    if (!magic.starts_with("#?RADIANCE") && !magic.starts_with("#?RGBE"))
        file_.fail("does not begin with #?RADIANCE or #?RGBE");
    constexpr int kMostLines = 10000;
    for (int i = 0; i < kMostLines; ++i) {
        const std::string line = read_line();
        if (line.empty()) return;
        if (line.front() != '#') read_variable(line);
    }
    file_.fail(fmt::format("has a header of over {} lines", kMostLines));
}

void HdrReader::read_variable(std::string_view line) {
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) return;  // a command that made the picture
    const std::string_view key = trimmed(line.substr(0, equals));
    const std::string_view value = trimmed(line.substr(equals + 1));

    const auto factors = [&](std::size_t count) {
        const std::vector<std::string_view> texts = words(value);
        std::vector<double> result;
        for (const std::string_view text : texts)
            if (const auto v = number<double>(text); v && *v > 0 && std::isfinite(*v))
                result.push_back(*v);
        if (texts.size() != count || result.size() != count)
            file_.fail(fmt::format("header says {}={} ({} positive number{} expected)", key,
                                   value.substr(0, 80), count, count == 1 ? "" : "s"));
        return result;
    };
    if (key == "FORMAT") {
        if (value != "32-bit_rle_rgbe" && value != "32-bit_rle_xyze")
            file_.fail(
                fmt::format("header says FORMAT={} (32-bit_rle_rgbe or 32-bit_rle_xyze expected)",
                            value.substr(0, 80)));
        is_xyz_ = value == "32-bit_rle_xyze";
        if (is_xyz_)
            notes_.push_back("XYZ values were made linear RGB with Rec. 709 primaries, white D65");
    } else if (key == "EXPOSURE") {
        exposure_ *= factors(1)[0];  // each program that changed the picture adds its own line
    } else if (key == "COLORCORR") {
        const std::vector<double> correction = factors(3);
        for (int c = 0; c < 3; ++c) colour_correction_[c] *= correction[c];
    } else {
        if (key == "PRIMARIES" && value.find_first_of("123456789") != std::string_view::npos)
            notes_.push_back(fmt::format("states PRIMARIES={}, which are not converted", value));
        metadata_.emplace(key, value);
    }
}

void HdrReader::read_resolution() {
    const std::string line = read_line();
    const std::vector<std::string_view> parts = words(line);
    const auto is_axis = [](std::string_view text) {
        return text == "+X" || text == "-X" || text == "+Y" || text == "-Y";
    };
    if (parts.size() != 4 || !is_axis(parts[0]) || !is_axis(parts[2]) || parts[0][1] == parts[2][1])
        file_.fail(
            fmt::format("has the size '{}' (such as -Y 512 +X 1024 expected)", line.substr(0, 80)));
    const auto count = number<std::int64_t>(parts[1]);
    const auto length = number<std::int64_t>(parts[3]);
    if (!count || !length)
        file_.fail(fmt::format("has the size '{}', which is no pair of whole numbers",
                               line.substr(0, 80)));

    orientation_.transposed = parts[0][1] == 'X';
    for (const std::string_view axis : {parts[0], parts[2]}) {
        orientation_.flipped_x |= axis == "-X";
        orientation_.flipped_y |= axis == "+Y";  // Y counts upward in this format
    }
    // The sides only; what the texels take is known when the first scanline is seen.
    check_claim(file_, *length, *count, 3, 1, 0, {});
    scanline_count_ = static_cast<int>(*count);
    length_ = static_cast<int>(*length);
}

// No writer mixes the codings, so the first scanline tells the least that all of them take.
void HdrReader::check_length_of_file() const {
    const std::uint64_t start = file_.position();
    std::uint64_t least =
        4;  // the older coding: a texel, then repeats, whose digits are of base 256
    for (std::int64_t left = length_ - 1; left > 0; left /= 256) least += 4;

    Rgbe first{};
    file_.read_some(std::as_writable_bytes(std::span(first)));
    file_.seek(start);
    if (length_allows_runs(length_) && begins_runs(first))
        least = 4 + 4 * 2 * ((static_cast<std::uint64_t>(length_) + 126) / 127);
    check_claim(file_, length_, scanline_count_, 3, 1,
                least * static_cast<std::uint64_t>(scanline_count_), {});
}

// Without its end; "\r\n" ends a line too, as editors leave it.
std::string HdrReader::read_line() {
    constexpr std::size_t kLongestLine = 65536;
    std::string line;
    for (;;) {
        if (file_.remaining() == 0) file_.fail("is truncated: ends within its header");
        const char c = static_cast<char>(file_.read_byte());
        if (c == '\n') break;
        if (line.size() == kLongestLine)
            file_.fail(fmt::format("has a line of over {} bytes in its header", kLongestLine));
        line.push_back(c);
    }
    if (line.ends_with('\r')) line.pop_back();
    return line;
}

// Where a run ends is known as soon as its count is, so that a first walk through the file, which
// is quick, finds where each scanline begins; then they are decoded independently.
void HdrReader::read_scanlines(std::span<float> rgb) {
    const std::size_t row_size = std::size_t{3} * length_;
    const std::size_t count = rgb.size() / row_size;
    gathered_.clear();
    bytes_.clear();
    for (std::size_t i = 0; i < count; ++i) gather_scanline();

    parallel_for(static_cast<std::int64_t>(count), [&](std::int64_t i) {
        const std::span<float> row = rgb.subspan(i * row_size, row_size);
        const std::uint8_t* bytes = &bytes_[gathered_[i].begin];
        if (!gathered_[i].in_runs) return convert({bytes, std::size_t{4} * length_}, row);
        thread_local std::vector<std::uint8_t> planes;
        planes.resize(std::size_t{4} * length_);
        expand_runs(bytes, planes);
        convert(planes, row);
    });
}

std::uint64_t HdrReader::bytes_held(int count) const {
    // runs of one texel take two bytes of every plane
    return std::uint64_t{8} * length_ * (count + std::uint64_t{1});
}

void HdrReader::gather_scanline() {
    const std::size_t planes_size = std::size_t{4} * length_;
    const std::size_t begin = bytes_.size();
    std::optional<Rgbe> first;
    if (length_allows_runs(length_)) {
        first = read_texel();
        if (begins_runs(*first)) {
            if (const int stated = (*first)[2] * 256 + (*first)[3]; stated != length_)
                file_.fail(fmt::format("has a scanline of {} texels before byte {} ({} expected)",
                                       stated, file_.position(), length_));
            if (gather_runs_unread()) {
                gathered_.push_back({begin, true});
                return;
            }
        }
    }
    gathered_.push_back({begin, false});
    bytes_.resize(begin + planes_size);
    const std::span<std::uint8_t> planes = std::span(bytes_).subspan(begin);
    if (first && begins_runs(*first))
        read_runs(planes);
    else
        read_texels(first, planes);
}

// Takes a scanline's runs as they are. False, and nothing is taken, if one does not end where it
// should or the file does before; read_runs() finds out which.
bool HdrReader::gather_runs_unread() {
    const std::span<const std::byte> ahead =
        file_.look_ahead(std::size_t{8} * length_);  // the most that a scanline can take
    std::size_t at = 0;
    for (int c = 0; c < 4; ++c) {
        for (std::size_t left = length_; left > 0;) {
            if (at >= ahead.size()) return false;
            const auto code = static_cast<std::size_t>(ahead[at]);
            const std::size_t count = code > 128 ? code - 128 : code;
            if (count == 0 || count > left) return false;
            at += code > 128 ? 2 : 1 + count;
            left -= count;
        }
    }
    if (at > ahead.size()) return false;
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(ahead.data());
    bytes_.insert(bytes_.end(), bytes, bytes + at);
    file_.seek(file_.position() + at);
    return true;
}

void HdrReader::convert(std::span<const std::uint8_t> planes, std::span<float> rgb) const {
    const std::array<float, 256>& scale = scales();
    const std::uint8_t *red = planes.data(), *green = red + length_, *blue = green + length_,
                       *exponents = blue + length_;
    for (int x = 0; x < length_; ++x) {
        const float s = scale[exponents[x]];
        float* texel = &rgb[std::size_t{3} * x];
        texel[0] = red[x] * s, texel[1] = green[x] * s, texel[2] = blue[x] * s;
    }
    if (divisor_ != std::array<float, 3>{1, 1, 1})
        for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] /= divisor_[i % 3];
    if (is_xyz_) rgb_from_xyz(rgb);
}

Rgbe HdrReader::read_texel() {
    Rgbe texel;
    file_.read(std::as_writable_bytes(std::span(texel)));
    return texel;
}

// Each component on its own: a count over 128 repeats the next byte, one up to 128 copies bytes.
void HdrReader::read_runs(std::span<std::uint8_t> planes) {
    for (int c = 0; c < 4; ++c) {
        const std::span<std::uint8_t> plane =
            planes.subspan(static_cast<std::size_t>(c) * length_, length_);
        for (std::size_t x = 0; x < plane.size();) {
            const auto code = static_cast<std::size_t>(file_.read_byte());
            const std::size_t count = code > 128 ? code - 128 : code;
            if (count == 0 || count > plane.size() - x)
                file_.fail(
                    fmt::format("has a run of {} texels before byte {} where {} are left in "
                                "the scanline",
                                count, file_.position(), plane.size() - x));
            if (code > 128)
                std::memset(&plane[x], static_cast<int>(file_.read_byte()), count);
            else
                file_.read(std::as_writable_bytes(plane.subspan(x, count)));
            x += count;
        }
    }
}

// Plain texels, and among them the older coding's repeats; repeats in a row are digits, lowest
// first.
void HdrReader::read_texels(std::optional<Rgbe> first, std::span<std::uint8_t> planes) {
    Rgbe last{};
    int shift = 0;
    for (int x = 0; x < length_;) {
        const Rgbe texel = first ? *first : read_texel();
        first.reset();
        std::int64_t count = 1;
        if (is_repeat(texel)) {
            count = shift <= 24 ? std::int64_t{texel[3]} << shift : length_;  // too many
            shift += 8;
            if (x == 0 || count > length_ - x)
                file_.fail(
                    fmt::format("repeats a texel {} times before byte {} where {} are left in "
                                "the scanline{}",
                                count, file_.position(), length_ - x,
                                x == 0 ? " and there is none to repeat" : ""));
        } else {
            last = texel;
            shift = 0;
        }
        for (int c = 0; c < 4; ++c)
            std::memset(&planes[static_cast<std::size_t>(c) * length_] + x, last[c],
                        static_cast<std::size_t>(count));
        x += static_cast<int>(count);
    }
}

// HdrWriter ---------------------------------------------------------------------------------------

HdrWriter::HdrWriter(OutputFile& file, int width, int height, const Metadata& metadata)
    : file_(file),
      width_(width),
      planes_(std::size_t{4} * width) {
    file_.write("#?RADIANCE\n");
    for (const auto& [key, value] : metadata)
        if (key.starts_with("mirrorball.") && value.find_first_of("\r\n") == std::string::npos)
            file_.write(fmt::format("{}={}\n", key, value));
    file_.write(
        fmt::format("SOFTWARE=mirrorball\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", height, width));
}

void HdrWriter::write_row(std::span<const float> rgb) {
    encoded_.clear();
    if (length_allows_runs(width_)) {
        for (int x = 0; x < width_; ++x) {
            const Rgbe texel = encode(&rgb[std::size_t{3} * x]);
            for (int c = 0; c < 4; ++c)
                planes_[static_cast<std::size_t>(c) * width_ + x] = texel[c];
        }
        for (const int byte : {2, 2, width_ >> 8, width_ & 255})
            encoded_.push_back(static_cast<std::byte>(byte));
        for (int c = 0; c < 4; ++c)
            append_runs(std::span(planes_).subspan(static_cast<std::size_t>(c) * width_, width_));
    } else {
        // Plain texels. None is taken for a repeat: its largest mantissa is at least 128, or all
        // are 0.
        for (int x = 0; x < width_; ++x)
            for (const std::uint8_t byte : encode(&rgb[std::size_t{3} * x]))
                encoded_.push_back(static_cast<std::byte>(byte));
    }
    file_.write(encoded_);
}

void HdrWriter::append_runs(std::span<const std::uint8_t> plane) {
    // A run takes two bytes and splits the copied bytes around it, which costs one more.
    constexpr std::size_t kShortestRun = 4, kLongestRun = 127, kLongestCopy = 128;
    const auto run_length = [&](std::size_t at) {
        std::size_t end = at + 1;
        while (end < plane.size() && end - at < kLongestRun && plane[end] == plane[at]) ++end;
        return end - at;
    };
    const auto append_copies = [&](std::size_t begin, std::size_t end) {
        while (begin < end) {
            const std::size_t count = std::min(end - begin, kLongestCopy);
            encoded_.push_back(static_cast<std::byte>(count));
            const auto bytes = std::as_bytes(plane.subspan(begin, count));
            encoded_.insert(encoded_.end(), bytes.begin(), bytes.end());
            begin += count;
        }
    };
    std::size_t copied_from = 0;
    for (std::size_t x = 0; x < plane.size();) {
        const std::size_t run = run_length(x);
        if (run >= kShortestRun) {
            append_copies(copied_from, x);
            encoded_.push_back(static_cast<std::byte>(128 + run));
            encoded_.push_back(static_cast<std::byte>(plane[x]));
            copied_from = x + run;
        }
        x += run;
    }
    append_copies(copied_from, plane.size());
}

// The codec ---------------------------------------------------------------------------------------

namespace {

bool recognises(std::span<const std::byte> head) {
    const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
    return text.starts_with("#?RADIANCE") || text.starts_with("#?RGBE");
}

// Enough for every thread to have some, few enough to stay in its cache.
constexpr int kScanlinesAtOnce = 64;

FileContents read(InputFile& file, const ReadOptions& options) {
    HdrReader reader(file);
    check_claim(file, reader.length(), reader.scanline_count(), 3, 1, 0, options);
    Image image(reader.length(), reader.scanline_count(), 3);
    for (int y = 0; y < image.height(); y += kScanlinesAtOnce) {
        const int count = std::min(kScanlinesAtOnce, image.height() - y);
        reader.read_scanlines({image.at(0, y), image.row(y).size() * count});
    }

    FileContents contents;
    contents.stored = TexelFormat::rgbe8;
    contents.metadata = reader.metadata();
    contents.notes = reader.notes();
    contents.levels.emplace_back().push_back(oriented(std::move(image), reader.orientation()));
    return contents;
}

class HdrRows : public RowSource {
  public:
    explicit HdrRows(InputFile& file) : reader_(file) {
        header.width = reader_.length();
        header.height = reader_.scanline_count();
        header.stored = TexelFormat::rgbe8;
        header.metadata = reader_.metadata();
        header.notes = reader_.notes();
    }
    [[nodiscard]] Orientation orientation() const { return reader_.orientation(); }

    void read(int, std::span<float> values) override {
        reader_.read_scanlines(values);
        if (!reader_.orientation().flipped_x) return;
        const std::size_t row_size = std::size_t{3} * header.width;
        for (std::size_t begin = 0; begin < values.size(); begin += row_size)
            for (std::size_t a = begin, b = begin + row_size - 3; a < b; a += 3, b -= 3)
                std::swap_ranges(&values[a], &values[a] + 3, &values[b]);
    }
    [[nodiscard]] int rows_at_once() const override { return kScanlinesAtOnce; }
    [[nodiscard]] std::uint64_t bytes_held() const override {
        return reader_.bytes_held(kScanlinesAtOnce);
    }

  private:
    HdrReader reader_;
};

std::unique_ptr<RowSource> open_rows(InputFile& file, const ReadOptions&, std::string& obstacle) {
    auto rows = std::make_unique<HdrRows>(file);
    if (!rows->orientation().transposed && !rows->orientation().flipped_y) return rows;
    obstacle = "its scanlines do not run from the top to the bottom";
    return nullptr;
}

// One and two channels are grey, and grey with alpha; alpha is dropped, which the format has not.
void write(OutputFile& file, const ContentsView& contents, const WriteOptions&) {
    const Image& image = contents.levels.front().front();
    const int channels = image.channels();
    HdrWriter writer(file, image.width(), image.height(), contents.metadata);
    std::vector<float> rgb(std::size_t{3} * image.width());
    for (int y = 0; y < image.height(); ++y) {
        for (int x = 0; x < image.width(); ++x)
            for (int c = 0; c < 3; ++c)
                rgb[std::size_t{3} * x + c] = image.at(x, y)[channels < 3 ? 0 : c];
        writer.write_row(rgb);
    }
}

}  // namespace

const Codec kHdr{"Radiance HDR",
                 {".hdr", ".rgbe", ".pic"},
                 {TexelFormat::rgbe8},
                 recognises,
                 read,
                 write,
                 false,
                 false,
                 open_rows};

}  // namespace mirrorball::detail
