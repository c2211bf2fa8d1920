// TIFF through libtiff: integers of 8 and 16 bits, floats of 16, 32 and 64; strips and tiles;
// samples together or in planes.
//
// libtiff calls back for every access to the file. No exception may pass through it, so callbacks
// keep theirs and report a failure, and whoever called libtiff throws them on.
#include <half.h>
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>

#include <fmt/format.h>

#include <mirrorball/error.h>

#include "codec.h"
#include "orientation.h"
#include "unorm.h"

namespace mirrorball::detail {
namespace {

// A file behind libtiff's callbacks: one to read, or one to write.
struct Handle {
    InputFile* input = nullptr;
    OutputFile* output = nullptr;
    std::uint64_t position = 0;
    std::exception_ptr exception;
    std::string message;  // the first of libtiff's own

    [[nodiscard]] std::uint64_t size() const {
        return input != nullptr ? input->size() : output->size();
    }
    [[noreturn]] void fail(const char* what) const {
        if (exception) std::rethrow_exception(exception);
        const std::string text = fmt::format("{} ({})", what, message);
        if (input != nullptr) input->fail(text);
        output->fail(text);
    }
};

template <class F>
tmsize_t kept_from_throwing(thandle_t client, const F& access) {
    auto* handle = static_cast<Handle*>(client);
    try {
        const std::size_t count = access(*handle);
        handle->position += count;
        return static_cast<tmsize_t>(count);
    } catch (...) {
        handle->exception = std::current_exception();
        return -1;
    }
}

tmsize_t on_read(thandle_t client, void* out, tmsize_t count) {
    return kept_from_throwing(client, [&](Handle& handle) -> std::size_t {
        const std::span bytes(static_cast<std::byte*>(out), static_cast<std::size_t>(count));
        if (handle.position >= handle.size()) return 0;
        if (handle.output != nullptr) {
            handle.output->seek(handle.position);
            return handle.output->read_back(bytes);
        }
        handle.input->seek(handle.position);
        return handle.input->read_some(bytes);
    });
}

tmsize_t on_write(thandle_t client, void* bytes, tmsize_t count) {
    return kept_from_throwing(client, [&](Handle& handle) -> std::size_t {
        if (handle.output == nullptr) return 0;
        const auto size = static_cast<std::size_t>(count);
        handle.output->seek(handle.position);
        handle.output->write(std::span(static_cast<const std::byte*>(bytes), size));
        return size;
    });
}

toff_t on_seek(thandle_t client, toff_t offset, int whence) {
    auto* handle = static_cast<Handle*>(client);
    const std::uint64_t base = whence == SEEK_SET   ? 0
                               : whence == SEEK_CUR ? handle->position
                                                    : handle->size();
    return handle->position = base + offset;
}

int on_close(thandle_t) {
    return 0;
}
toff_t on_size(thandle_t client) {
    return static_cast<Handle*>(client)->size();
}

int on_error(TIFF*, void* client, const char*, const char* format, va_list arguments) {
    std::array<char, 300> text{};
    std::vsnprintf(text.data(), text.size(), format, arguments);
    auto* handle = static_cast<Handle*>(client);
    if (handle->message.empty()) handle->message = text.data();
    return 1;  // handled: nothing is printed
}

int on_warning(TIFF*, void*, const char*, const char*, va_list) {
    return 1;
}

using TiffPointer = std::unique_ptr<TIFF, decltype(&TIFFClose)>;

TiffPointer open_tiff(Handle& handle, const std::string& name, const char* mode) {
    // Against tables that a broken directory claims; pictures are read in pieces of ours.
    constexpr tmsize_t kLargestAllocation = tmsize_t{1} << 30;
    const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(
        TIFFOpenOptionsAlloc(), &TIFFOpenOptionsFree);
    if (options == nullptr) throw std::bad_alloc();
    TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), kLargestAllocation);
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), on_error, &handle);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), on_warning, &handle);
    return {TIFFClientOpenExt(name.c_str(), mode, &handle, on_read, on_write, on_seek, on_close,
                              on_size, nullptr, nullptr, options.get()),
            &TIFFClose};
}

// Reading -----------------------------------------------------------------------------------------

enum class SampleType { unorm8, unorm16, float16, float32, float64 };

// How many bytes one byte of a file can stand for at best, by compression scheme.
std::uint64_t largest_expansion(int compression) {
    switch (compression) {
        case COMPRESSION_NONE:
            return 1;
        case COMPRESSION_PACKBITS:
            return 64;
        case COMPRESSION_DEFLATE:
        case COMPRESSION_ADOBE_DEFLATE:
            return 1032;
        case COMPRESSION_LZW:
            return 4096;  // a code of 9 bits or more for a string of that length
        default:
            return 65536;  // Zstandard: a block of 128 KiB in 4 bytes
    }
}

class TiffReader {
  public:
    explicit TiffReader(InputFile& file)
        : file_(file),
          handle_{&file, nullptr, 0, nullptr, {}},
          tiff_(open_tiff(handle_, file.name(), "rm")) {
        if (tiff_ == nullptr) handle_.fail("is a broken TIFF file");
    }

    FileContents read(const ReadOptions& options) {
        read_directory();
        choose_sample_type();
        check_sizes(options);
        Image stored(width_, height_, channels_);
        switch (type_) {
            case SampleType::unorm8:
                read_integers<std::uint8_t>(stored, options.transfer);
                break;
            case SampleType::unorm16:
                read_integers<std::uint16_t>(stored, options.transfer);
                break;
            case SampleType::float16:
                read_samples<std::uint16_t>(stored, [](std::uint16_t bits, bool) {
                    half value;
                    value.setBits(bits);
                    return static_cast<float>(value);
                });
                break;
            case SampleType::float32:
                read_samples<float>(stored, [](float value, bool) { return value; });
                break;
            case SampleType::float64:
                read_samples<double>(stored,
                                     [](double value, bool) { return static_cast<float>(value); });
                break;
        }

        FileContents contents;
        contents.stored = type_ == SampleType::unorm8    ? TexelFormat::unorm8
                          : type_ == SampleType::unorm16 ? TexelFormat::unorm16
                          : type_ == SampleType::float16 ? TexelFormat::rgba16f
                                                         : TexelFormat::rgba32f;
        if (type_ == SampleType::unorm8 || type_ == SampleType::unorm16)
            contents.notes.push_back(transfer_note(options.transfer, bits_));
        const Orientation orientation = tiff_orientation(field(TIFFTAG_ORIENTATION));
        if (!orientation.upright())
            contents.notes.push_back("was turned upright by its orientation");
        contents.levels.emplace_back().push_back(oriented(std::move(stored), orientation));
        return contents;
    }

  private:
    // A tag of 16 bits, or its default.
    [[nodiscard]] int field(std::uint32_t tag) const {
        std::uint16_t value = 0;
        TIFFGetFieldDefaulted(tiff_.get(), tag, &value);
        return value;
    }

    [[noreturn]] void fail_unsupported(const std::string& what) const {
        throw Error(Errc::unsupported, fmt::format("{}: {}", file_.name(), what));
    }

    void read_directory() {
        std::uint32_t width = 0, height = 0;
        TIFFGetField(tiff_.get(), TIFFTAG_IMAGEWIDTH, &width);
        TIFFGetField(tiff_.get(), TIFFTAG_IMAGELENGTH, &height);
        check_claim(file_, width, height, 1, 1, 0, {});
        width_ = static_cast<int>(width);
        height_ = static_cast<int>(height);

        compression_ = field(TIFFTAG_COMPRESSION);
        if (TIFFIsCODECConfigured(static_cast<std::uint16_t>(compression_)) == 0)
            fail_unsupported(fmt::format(
                "is compressed by TIFF scheme {}, which is not in this build", compression_));
        std::uint16_t photometric = PHOTOMETRIC_MINISBLACK;
        TIFFGetField(tiff_.get(), TIFFTAG_PHOTOMETRIC, &photometric);
        if (photometric == PHOTOMETRIC_YCBCR && compression_ == COMPRESSION_JPEG) {
            TIFFSetField(tiff_.get(), TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
            photometric = PHOTOMETRIC_RGB;
        }
        if (photometric != PHOTOMETRIC_MINISBLACK && photometric != PHOTOMETRIC_MINISWHITE &&
            photometric != PHOTOMETRIC_RGB)
            fail_unsupported(
                fmt::format("has TIFF colours of kind {} (grey or RGB expected)", photometric));
        white_is_zero_ = photometric == PHOTOMETRIC_MINISWHITE;

        channels_ = field(TIFFTAG_SAMPLESPERPIXEL);
        const int fewest = photometric == PHOTOMETRIC_RGB ? 3 : 1;
        if (channels_ < fewest || channels_ > 4)
            fail_unsupported(fmt::format("has {} channels ({} to 4 expected)", channels_, fewest));
        separate_planes_ = field(TIFFTAG_PLANARCONFIG) == PLANARCONFIG_SEPARATE;
    }

    void choose_sample_type() {
        bits_ = field(TIFFTAG_BITSPERSAMPLE);
        const int format = field(TIFFTAG_SAMPLEFORMAT);
        const bool integer = format == SAMPLEFORMAT_UINT || format == SAMPLEFORMAT_VOID;
        const bool real = format == SAMPLEFORMAT_IEEEFP;
        if (integer && bits_ == 8)
            type_ = SampleType::unorm8;
        else if (integer && bits_ == 16)
            type_ = SampleType::unorm16;
        else if (real && bits_ == 16)
            type_ = SampleType::float16;
        else if (real && bits_ == 32)
            type_ = SampleType::float32;
        else if (real && bits_ == 64)
            type_ = SampleType::float64;
        else
            fail_unsupported(
                fmt::format("has samples of {} bits, TIFF sample format {} (unsigned "
                            "integers of 8 or 16 bits or floats of 16, 32 or 64 expected)",
                            bits_, format));
    }

    void check_sizes(const ReadOptions& options) {
        const std::uint64_t bytes =
            static_cast<std::uint64_t>(width_) * height_ * channels_ * bits_ / 8;
        const std::uint64_t least = bytes / largest_expansion(compression_);
        if (least > file_.size())
            file_.fail(
                fmt::format("is truncated: {} x {} texels need at least {} bytes, and it has {}",
                            width_, height_, least, file_.size()));
        check_claim(file_, width_, height_, channels_, 1, 0, options);
    }

    template <class T>
    void read_integers(Image& image, Transfer transfer) {
        const UnormDecoder<T> decoder(transfer);
        read_samples<T>(image, [&](T code, bool is_alpha) {
            return decoder.value(white_is_zero_ && !is_alpha ? static_cast<T>(~code) : code,
                                 is_alpha);
        });
    }

    // decode(sample, is_alpha) makes a value of a sample of type T.
    template <class T, class Decode>
    void read_samples(Image& image, const Decode& decode) {
        const int plane_count = separate_planes_ ? channels_ : 1;
        for (int plane = 0; plane < plane_count; ++plane) {
            if (TIFFIsTiled(tiff_.get()) != 0)
                read_tiles<T>(image, plane, decode);
            else
                read_scanlines<T>(image, plane, decode);
        }
    }

    [[nodiscard]] int samples_together() const { return separate_planes_ ? 1 : channels_; }

    template <class T, class Decode>
    void read_scanlines(Image& image, int plane, const Decode& decode) {
        std::vector<T> samples(static_cast<std::size_t>(width_) * samples_together());
        if (TIFFScanlineSize64(tiff_.get()) != samples.size() * sizeof(T))
            handle_.fail("has rows of another size than its width");
        for (int y = 0; y < height_; ++y) {
            if (TIFFReadScanline(tiff_.get(), samples.data(), y,
                                 static_cast<std::uint16_t>(plane)) < 0)
                handle_.fail("is a broken TIFF file");
            convert<T>(samples, plane, image.at(0, y), decode);
        }
    }

    template <class T, class Decode>
    void read_tiles(Image& image, int plane, const Decode& decode) {
        std::uint32_t tile_width = 0, tile_height = 0;
        TIFFGetField(tiff_.get(), TIFFTAG_TILEWIDTH, &tile_width);
        TIFFGetField(tiff_.get(), TIFFTAG_TILELENGTH, &tile_height);
        constexpr std::uint64_t kLargestSide = 1 << 20, kLargestTile = 1 << 28;
        const std::uint64_t row_size = std::uint64_t{tile_width} * samples_together();
        const std::uint64_t tile_bytes = row_size * tile_height * sizeof(T);
        if (tile_width == 0 || tile_width > kLargestSide || tile_height == 0 ||
            tile_height > kLargestSide || tile_bytes > kLargestTile ||
            tile_bytes != TIFFTileSize64(tiff_.get()))
            file_.fail(fmt::format("has tiles of {} x {} texels (at most {} bytes expected)",
                                   tile_width, tile_height, kLargestTile));

        std::vector<T> samples(tile_bytes / sizeof(T));
        const std::uint32_t width = width_, height = height_;
        for (std::uint32_t top = 0; top < height; top += tile_height)
            for (std::uint32_t left = 0; left < width; left += tile_width) {
                if (TIFFReadTile(tiff_.get(), samples.data(), left, top, 0,
                                 static_cast<std::uint16_t>(plane)) < 0)
                    handle_.fail("is a broken TIFF file");
                const std::size_t used =
                    std::size_t{std::min(tile_width, width - left)} * samples_together();
                for (std::uint32_t y = 0; y < std::min(tile_height, height - top); ++y)
                    convert<T>(std::span(samples).subspan(y * row_size, used), plane,
                               image.at(static_cast<int>(left), static_cast<int>(top + y)), decode);
            }
    }

    // A piece of a row; `out` is the first channel of its first texel.
    template <class T, class Decode>
    void convert(std::span<const T> samples, int plane, float* out, const Decode& decode) const {
        const int alpha = has_alpha(channels_) ? channels_ - 1 : channels_;
        if (separate_planes_) {
            for (std::size_t i = 0; i < samples.size(); ++i)
                out[i * channels_ + plane] = decode(samples[i], plane == alpha);
        } else {
            for (std::size_t i = 0; i < samples.size(); ++i)
                out[i] = decode(samples[i], static_cast<int>(i % channels_) == alpha);
        }
    }

    InputFile& file_;
    Handle handle_;
    TiffPointer tiff_;
    int width_ = 0, height_ = 0, channels_ = 0, bits_ = 0, compression_ = 0;
    bool separate_planes_ = false, white_is_zero_ = false;
    SampleType type_ = SampleType::unorm8;
};

// Writing -----------------------------------------------------------------------------------------

class TiffWriter {
  public:
    TiffWriter(OutputFile& file, const Image& image, const WriteOptions& options)
        : handle_{nullptr, &file, 0, nullptr, {}},
          image_(image),
          format_(options.format),
          transfer_(options.transfer),
          tiff_(open_tiff(handle_, file.name(), needs_64_bits() ? "w8" : "w")) {
        if (tiff_ == nullptr) handle_.fail("cannot be written");
        set_fields(options.compress.value_or(true));
    }

    void write() {
        switch (format_) {
            case TexelFormat::unorm8:
                write_integers<std::uint8_t>();
                break;
            case TexelFormat::unorm16:
                write_integers<std::uint16_t>();
                break;
            case TexelFormat::rgba16f:
                write_floats<half>([](float value) { return half(value); });
                break;
            default:
                write_floats<float>([](float value) { return value; });
                break;
        }
        // Closing writes too, but has no way to tell whether that went well.
        if (TIFFFlush(tiff_.get()) == 0) handle_.fail("cannot be written");
        tiff_.reset();
        if (handle_.exception) std::rethrow_exception(handle_.exception);
    }

  private:
    [[nodiscard]] int bytes_per_sample() const {
        return format_ == TexelFormat::unorm8 ? 1 : format_ == TexelFormat::rgba32f ? 4 : 2;
    }

    // Offsets of plain TIFF have 32 bits; deflate can add a little to what it cannot shrink.
    [[nodiscard]] bool needs_64_bits() const {
        const double bytes = static_cast<double>(image_.values().size()) * bytes_per_sample();
        return bytes > 0.9 * 4294967296.0;
    }

    void set_fields(bool compress) {
        TIFF* tiff = tiff_.get();
        const int channels = image_.channels(), width = image_.width();
        const bool real = format_ == TexelFormat::rgba32f || format_ == TexelFormat::rgba16f;
        TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width);
        TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, image_.height());
        TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, channels);
        TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 8 * bytes_per_sample());
        TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, real ? SAMPLEFORMAT_IEEEFP : SAMPLEFORMAT_UINT);
        TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
        TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC,
                     channels < 3 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB);
        TIFFSetField(tiff, TIFFTAG_SOFTWARE, "mirrorball");
        if (has_alpha(channels)) {
            const std::uint16_t kind = EXTRASAMPLE_UNASSALPHA;
            TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &kind);
        }
        if (compress) {
            TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
            TIFFSetField(tiff, TIFFTAG_PREDICTOR,
                         real ? PREDICTOR_FLOATINGPOINT : PREDICTOR_HORIZONTAL);
            // Beyond this, pictures become a few percent smaller in several times the time.
            TIFFSetField(tiff, TIFFTAG_ZIPQUALITY, 4);
        }
        constexpr int kStripBytes = 1 << 18;  // long enough to compress, short enough to hold
        const int row_bytes = width * channels * bytes_per_sample();
        TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, std::max(1, kStripBytes / row_bytes));
    }

    void write_row(void* samples) {
        if (TIFFWriteScanline(tiff_.get(), samples, next_row_++, 0) < 0)
            handle_.fail("cannot be written");
    }

    template <class T>
    void write_integers() {
        encode_rows<T>(image_, transfer_, [&](std::span<T> codes) { write_row(codes.data()); });
    }

    template <class T, class Encode>
    void write_floats(const Encode& encode) {
        std::vector<T> samples(image_.row(0).size());
        for (int y = 0; y < image_.height(); ++y) {
            std::transform(image_.row(y).begin(), image_.row(y).end(), samples.begin(), encode);
            write_row(samples.data());
        }
    }

    Handle handle_;
    const Image& image_;
    TexelFormat format_;
    Transfer transfer_;
    TiffPointer tiff_;
    std::uint32_t next_row_ = 0;
};

bool recognises(std::span<const std::byte> head) {
    if (head.size() < 4) return false;
    const std::string_view text(reinterpret_cast<const char*>(head.data()), 4);
    using namespace std::string_view_literals;
    return text == "II*\0"sv || text == "MM\0*"sv || text == "II+\0"sv || text == "MM\0+"sv;
}

FileContents read(InputFile& file, const ReadOptions& options) {
    return TiffReader(file).read(options);
}

void write(OutputFile& file, const ContentsView& contents, const WriteOptions& options) {
    TiffWriter(file, contents.levels.front().front(), options).write();
}

}  // namespace

const Codec kTiff{
    "TIFF",
    {".tif", ".tiff"},
    {TexelFormat::rgba32f, TexelFormat::rgba16f, TexelFormat::unorm16, TexelFormat::unorm8},
    recognises,
    read,
    write};

}  // namespace mirrorball::detail
