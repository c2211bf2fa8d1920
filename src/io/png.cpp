// PNG through libpng, 8 and 16 bits; palettes, grey and transparency come out as channels.
//
// libpng reports errors by longjmp. So that no C++ object is jumped over, its functions are called
// only inside guarded(), from lambdas that own nothing, and callbacks keep C++ exceptions for
// later.
#include <png.h>

#include <array>
#include <cmath>
#include <csetjmp>
#include <cstring>
#include <exception>

#include <fmt/format.h>

#include "codec.h"
#include "unorm.h"

namespace mirrorball::detail {
namespace {

// What went wrong: an exception out of one of our callbacks, or libpng's own words.
struct Failure {
    std::exception_ptr exception;
    std::array<char, 200> message{};
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
    auto* failure = static_cast<Failure*>(png_get_error_ptr(png));
    std::strncpy(failure->message.data(), message, failure->message.size() - 1);
    png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

// Runs calls of libpng. Whether they went well.
template <class F>
bool guarded(png_structp png, const F& calls) {
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    calls();
    return true;
}

// Runs our code inside a callback of libpng.
template <class F>
void kept_from_jumping(png_structp png, const F& code) {
    auto* failure = static_cast<Failure*>(png_get_error_ptr(png));
    try {
        code();
        return;
    } catch (...) {
        failure->exception = std::current_exception();
    }
    png_error(png, "callback failed");
}

void on_read(png_structp png, png_bytep out, std::size_t count) {
    auto* file = static_cast<InputFile*>(png_get_io_ptr(png));
    kept_from_jumping(png, [&] { file->read(std::as_writable_bytes(std::span(out, count))); });
}

void on_write(png_structp png, png_bytep bytes, std::size_t count) {
    auto* file = static_cast<OutputFile*>(png_get_io_ptr(png));
    kept_from_jumping(png, [&] { file->write(std::as_bytes(std::span(bytes, count))); });
}

void on_flush(png_structp) {}

class PngReader {
  public:
    explicit PngReader(InputFile& file) : file_(file) {
        png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &failure_, on_error, on_warning);
        info_ = png_ != nullptr ? png_create_info_struct(png_) : nullptr;
        if (info_ == nullptr) {
            png_destroy_read_struct(&png_, nullptr, nullptr);
            throw std::bad_alloc();
        }
        png_set_read_fn(png_, &file_, on_read);
        png_set_user_limits(png_, PNG_UINT_31_MAX,
                            PNG_UINT_31_MAX);  // check_claim() has words for it
    }
    ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;

    FileContents read(const ReadOptions& options) {
        call([&] { png_read_info(png_, info_); });
        check_size();
        add_colour_notes();
        prepare_samples();
        check_claim(file_, width_, height_, channels_, 1, 0, options);
        contents_.notes.push_back(transfer_note(options.transfer, bits_));
        contents_.stored = bits_ == 16 ? TexelFormat::unorm16 : TexelFormat::unorm8;
        Image image = bits_ == 16 ? read_rows<std::uint16_t>(options.transfer)
                                  : read_rows<std::uint8_t>(options.transfer);
        call([&] { png_read_end(png_, nullptr); });
        contents_.levels.emplace_back().push_back(std::move(image));
        return std::move(contents_);
    }

  private:
    template <class F>
    void call(const F& calls) {
        if (guarded(png_, calls)) return;
        if (failure_.exception) std::rethrow_exception(failure_.exception);
        file_.fail(fmt::format("is a broken PNG file ({})", failure_.message.data()));
    }

    void check_size() {
        width_ = png_get_image_width(png_, info_);
        height_ = png_get_image_height(png_, info_);
        check_claim(file_, width_, height_, 1, 1, 0, {});  // sides first: products may overflow
        // Deflate makes 1032 bytes out of one at best.
        const std::uint64_t row_bytes = 1 + png_get_rowbytes(png_, info_);
        const std::uint64_t least = row_bytes * static_cast<std::uint64_t>(height_) / 1032;
        check_claim(file_, width_, height_, 1, 1, least, {});
    }

    void add_colour_notes() {
        int srgb_intent = 0;
        if (png_get_sRGB(png_, info_, &srgb_intent) != 0) return;
        if (png_get_valid(png_, info_, PNG_INFO_iCCP) != 0)
            contents_.notes.push_back("has an ICC colour profile, which is not applied");
        double gamma = 0;
        if (png_get_gAMA(png_, info_, &gamma) != 0 && std::abs(gamma - 1 / 2.2) > 1e-3)
            contents_.notes.push_back(
                fmt::format("states a gamma of {:.5f}, which is not applied", gamma));
        if (png_get_valid(png_, info_, PNG_INFO_cHRM) != 0)
            contents_.notes.push_back("states its own primaries, which are not converted");
    }

    // After this, samples are 8 or 16 bits in this machine's order, 1 to 4 per texel.
    void prepare_samples() {
        call([&] {
            png_set_palette_to_rgb(png_);
            if (png_get_color_type(png_, info_) == PNG_COLOR_TYPE_GRAY)
                png_set_expand_gray_1_2_4_to_8(png_);
            if (png_get_valid(png_, info_, PNG_INFO_tRNS) != 0) png_set_tRNS_to_alpha(png_);
            if (png_get_bit_depth(png_, info_) == 16) png_set_swap(png_);
            pass_count_ = png_set_interlace_handling(png_);
            png_read_update_info(png_, info_);
            channels_ = png_get_channels(png_, info_);
            bits_ = png_get_bit_depth(png_, info_);
        });
    }

    template <class T>
    Image read_rows(Transfer transfer) {
        const UnormDecoder<T> decoder(transfer);
        Image image(static_cast<int>(width_), static_cast<int>(height_), channels_);
        // An interlaced picture is complete only after its last pass, so all its samples are kept.
        const std::size_t row_size = static_cast<std::size_t>(width_) * channels_;
        std::vector<T> samples(pass_count_ > 1 ? row_size * height_ : row_size);
        const auto row_of = [&](int y) {
            return std::span(samples).subspan(pass_count_ > 1 ? row_size * y : 0, row_size);
        };
        for (int pass = 0; pass < pass_count_; ++pass)
            for (int y = 0; y < image.height(); ++y) {
                auto* row = reinterpret_cast<png_bytep>(row_of(y).data());
                call([&] { png_read_row(png_, row, nullptr); });
                if (pass + 1 == pass_count_) decoder.decode(row_of(y), channels_, image.row(y));
            }
        return image;
    }

    InputFile& file_;
    Failure failure_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    std::int64_t width_ = 0, height_ = 0;
    int channels_ = 0, bits_ = 0, pass_count_ = 1;
    FileContents contents_;
};

class PngWriter {
  public:
    explicit PngWriter(OutputFile& file) : file_(file) {
        png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, &failure_, on_error, on_warning);
        info_ = png_ != nullptr ? png_create_info_struct(png_) : nullptr;
        if (info_ == nullptr) {
            png_destroy_write_struct(&png_, nullptr);
            throw std::bad_alloc();
        }
        png_set_write_fn(png_, &file_, on_write, on_flush);
        png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    }
    ~PngWriter() { png_destroy_write_struct(&png_, &info_); }
    PngWriter(const PngWriter&) = delete;
    PngWriter& operator=(const PngWriter&) = delete;

    template <class T>
    void write(const Image& image, const WriteOptions& options) {
        constexpr int kColourTypes[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA,
                                        PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGB_ALPHA};
        call([&] {
            png_set_IHDR(png_, info_, image.width(), image.height(), 8 * sizeof(T),
                         kColourTypes[image.channels() - 1], PNG_INTERLACE_NONE,
                         PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
            if (options.transfer != Transfer::linear)
                png_set_sRGB_gAMA_and_cHRM(png_, info_, PNG_sRGB_INTENT_RELATIVE);
            if (!options.compress.value_or(true)) png_set_compression_level(png_, 0);
            png_write_info(png_, info_);
            if (sizeof(T) == 2) png_set_swap(png_);
        });
        encode_rows<T>(image, options.transfer, [&](std::span<T> codes) {
            auto* row = reinterpret_cast<png_bytep>(codes.data());
            call([&] { png_write_row(png_, row); });
        });
        call([&] { png_write_end(png_, info_); });
    }

  private:
    template <class F>
    void call(const F& calls) {
        if (guarded(png_, calls)) return;
        if (failure_.exception) std::rethrow_exception(failure_.exception);
        file_.fail(fmt::format("cannot be written ({})", failure_.message.data()));
    }

    OutputFile& file_;
    Failure failure_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
};

bool recognises(std::span<const std::byte> head) {
    constexpr unsigned char kSignature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    return head.size() >= sizeof kSignature &&
           std::memcmp(head.data(), kSignature, sizeof kSignature) == 0;
}

FileContents read(InputFile& file, const ReadOptions& options) {
    return PngReader(file).read(options);
}

void write(OutputFile& file, const ContentsView& contents, const WriteOptions& options) {
    const Image& image = contents.levels.front().front();
    PngWriter writer(file);
    if (options.format == TexelFormat::unorm16)
        writer.write<std::uint16_t>(image, options);
    else
        writer.write<std::uint8_t>(image, options);
}

}  // namespace

const Codec kPng{"PNG",      {".png"}, {TexelFormat::unorm8, TexelFormat::unorm16},
                 recognises, read,     write};

}  // namespace mirrorball::detail
