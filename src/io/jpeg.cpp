// JPEG through libjpeg-turbo, read only: its loss would show in light that is made from it.
//
// libjpeg reports errors by longjmp; see png.cpp for how no C++ object is jumped over.
#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <exception>

#include <fmt/format.h>

// After <cstdio>, whose FILE they need.
#include <jpeglib.h>

#include <jerror.h>

#include "codec.h"
#include "orientation.h"
#include "unorm.h"

namespace mirrorball::detail {
namespace {

// libjpeg hands out a pointer to its first member, `base`; we find ours around it.
struct ErrorManager {
    jpeg_error_mgr base;
    std::jmp_buf jump;
    std::exception_ptr exception;
    std::array<char, JMSG_LENGTH_MAX> message{};
};

struct Source {
    jpeg_source_mgr base;
    InputFile* file;
    std::array<JOCTET, 65536> buffer;
};

[[noreturn]] void on_error(j_common_ptr jpeg) {
    auto* manager = reinterpret_cast<ErrorManager*>(jpeg->err);
    (*jpeg->err->format_message)(jpeg, manager->message.data());
    std::longjmp(manager->jump, 1);
}

// libjpeg goes on after broken data and paints grey. Only what leaves the picture whole is let
// pass.
void on_message(j_common_ptr jpeg, int level) {
    constexpr int kHarmless[] = {JWRN_ADOBE_XFORM, JWRN_EXTRANEOUS_DATA, JWRN_JFIF_MAJOR,
                                 JWRN_TOO_MUCH_DATA};
    const int code = jpeg->err->msg_code;
    if (level < 0 &&
        std::find(std::begin(kHarmless), std::end(kHarmless), code) == std::end(kHarmless))
        on_error(jpeg);
}

void on_start(j_decompress_ptr) {}
void on_end(j_decompress_ptr) {}

boolean on_fill(j_decompress_ptr jpeg) {
    auto* source = reinterpret_cast<Source*>(jpeg->src);
    auto* manager = reinterpret_cast<ErrorManager*>(jpeg->err);
    std::size_t count = 0;
    try {
        count = source->file->read_some(std::as_writable_bytes(std::span(source->buffer)));
    } catch (...) {
        manager->exception = std::current_exception();
    }
    if (manager->exception || count == 0) ERREXIT(jpeg, JERR_INPUT_EOF);
    source->base.next_input_byte = source->buffer.data();
    source->base.bytes_in_buffer = count;
    return TRUE;
}

void on_skip(j_decompress_ptr jpeg, long count) {
    jpeg_source_mgr* source = jpeg->src;
    while (count > static_cast<long>(source->bytes_in_buffer)) {
        count -= static_cast<long>(source->bytes_in_buffer);
        on_fill(jpeg);
    }
    if (count <= 0) return;
    source->next_input_byte += count;
    source->bytes_in_buffer -= static_cast<std::size_t>(count);
}

// A progressive file can list scans that cost time and add nothing; encoders make about ten.
void on_progress(j_common_ptr jpeg) {
    constexpr int kMostScans = 500;
    if (reinterpret_cast<j_decompress_ptr>(jpeg)->input_scan_number > kMostScans)
        ERREXITS(jpeg, JERR_BAD_PROGRESSION, "");
}

// The orientation number in an EXIF block (APP1), 1 where it states none: a TIFF header, then a
// directory of 12-byte entries, of which tag 0x0112 is the one.
int exif_orientation(std::span<const JOCTET> block) {
    constexpr std::string_view kMagic("Exif\0\0", 6);
    if (block.size() < 14 || std::memcmp(block.data(), kMagic.data(), kMagic.size()) != 0) return 1;
    const std::span<const JOCTET> tiff = block.subspan(kMagic.size());
    const bool big_endian = tiff[0] == 'M';
    const auto number = [&](std::size_t at, int bytes) {
        std::uint32_t value = 0;
        for (int i = 0; i < bytes; ++i)
            value |= std::uint32_t{tiff[at + i]} << 8 * (big_endian ? bytes - 1 - i : i);
        return value;
    };
    const std::size_t directory = number(4, 4);
    if (directory > tiff.size() - 2) return 1;
    const std::size_t entry_count = number(directory, 2);
    for (std::size_t i = 0; i < entry_count; ++i) {
        const std::size_t entry = directory + 2 + 12 * i;
        if (entry + 12 > tiff.size()) break;
        if (number(entry, 2) == 0x0112) return static_cast<int>(number(entry + 8, 2));
    }
    return 1;
}

class JpegReader {
  public:
    explicit JpegReader(InputFile& file) : file_(file) {
        jpeg_.err = jpeg_std_error(&errors_.base);
        errors_.base.error_exit = on_error;
        errors_.base.emit_message = on_message;
        source_.file = &file;
        source_.base = {};
        source_.base.init_source = on_start;
        source_.base.fill_input_buffer = on_fill;
        source_.base.skip_input_data = on_skip;
        source_.base.resync_to_restart = jpeg_resync_to_restart;
        source_.base.term_source = on_end;
        progress_.progress_monitor = on_progress;
        call([&] {
            jpeg_create_decompress(&jpeg_);
            jpeg_.src = &source_.base;
            jpeg_.progress = &progress_;
            jpeg_save_markers(&jpeg_, JPEG_APP0 + 1, 0xffff);
        });
    }
    ~JpegReader() { jpeg_destroy_decompress(&jpeg_); }
    JpegReader(const JpegReader&) = delete;
    JpegReader& operator=(const JpegReader&) = delete;

    FileContents read(const ReadOptions& options) {
        call([&] { jpeg_read_header(&jpeg_, TRUE); });
        choose_colours();
        const int orientation = find_orientation();
        const std::int64_t width = jpeg_.image_width, height = jpeg_.image_height;
        // A block is at most 32 x 32 texels (8 x 8, sampled at a quarter), and takes one bit or
        // more.
        const auto least = static_cast<std::uint64_t>(width * height / 1024 / 8);
        const int channels = is_grey_ ? 1 : 3;
        check_claim(file_, width, height, channels, 1, 0, options);
        if (least > file_.size())
            file_.fail(fmt::format("is truncated: {} x {} texels need at least {} bytes, not {}",
                                   width, height, least, file_.size()));

        Image stored(static_cast<int>(width), static_cast<int>(height), channels);
        read_rows(stored, options.transfer);

        FileContents contents;
        contents.stored = TexelFormat::unorm8;
        contents.notes.push_back(transfer_note(options.transfer, 8));
        if (is_cmyk_) contents.notes.push_back("CMYK inks were made RGB without a colour profile");
        if (orientation != 1)
            contents.notes.push_back(
                fmt::format("was turned upright by its EXIF orientation ({})", orientation));
        contents.levels.emplace_back().push_back(
            oriented(std::move(stored), tiff_orientation(orientation)));
        return contents;
    }

  private:
    template <class F>
    void call(const F& calls) {
        if (setjmp(errors_.jump) == 0) {
            calls();
            return;
        }
        if (errors_.exception) std::rethrow_exception(errors_.exception);
        file_.fail(fmt::format("is a broken JPEG file ({})", errors_.message.data()));
    }

    void choose_colours() {
        is_grey_ = jpeg_.jpeg_color_space == JCS_GRAYSCALE;
        is_cmyk_ = jpeg_.jpeg_color_space == JCS_CMYK || jpeg_.jpeg_color_space == JCS_YCCK;
        jpeg_.out_color_space = is_grey_ ? JCS_GRAYSCALE : is_cmyk_ ? JCS_CMYK : JCS_RGB;
    }

    void read_rows(Image& image, Transfer transfer) {
        const UnormDecoder<JSAMPLE> decoder(transfer);
        std::vector<JSAMPLE> samples(static_cast<std::size_t>(image.width()) * (is_cmyk_ ? 4 : 3));
        JSAMPROW row = samples.data();
        call([&] { jpeg_start_decompress(&jpeg_); });
        for (int y = 0; y < image.height(); ++y) {
            call([&] { jpeg_read_scanlines(&jpeg_, &row, 1); });
            if (is_cmyk_) make_rgb(samples);
            decoder.decode(std::span<const JSAMPLE>(samples).first(image.row(y).size()),
                           image.channels(), image.row(y));
        }
        call([&] { jpeg_finish_decompress(&jpeg_); });
    }

    // Four bytes a texel become three, in place: what the inks let through, times what black does.
    void make_rgb(std::span<JSAMPLE> samples) const {
        // Adobe's files hold inks upside down, 0 for full; theirs are nearly all there are.
        const auto passed = [&](int ink) { return jpeg_.saw_Adobe_marker ? ink : 255 - ink; };
        for (std::size_t i = 0; i < samples.size() / 4; ++i) {
            const int black = passed(samples[4 * i + 3]);
            for (std::size_t c = 0; c < 3; ++c)
                samples[3 * i + c] =
                    static_cast<JSAMPLE>((passed(samples[4 * i + c]) * black + 127) / 255);
        }
    }

    // Before the picture is decoded: libjpeg drops the markers when it is done.
    int find_orientation() const {
        for (auto* marker = jpeg_.marker_list; marker != nullptr; marker = marker->next) {
            const int number = exif_orientation({marker->data, marker->data_length});
            if (!tiff_orientation(number).upright()) return number;
        }
        return 1;
    }

    InputFile& file_;
    ErrorManager errors_;
    Source source_;
    jpeg_progress_mgr progress_{};
    jpeg_decompress_struct jpeg_{};
    bool is_grey_ = false, is_cmyk_ = false;
};

bool recognises(std::span<const std::byte> head) {
    return head.size() >= 3 && head[0] == std::byte{0xff} && head[1] == std::byte{0xd8} &&
           head[2] == std::byte{0xff};
}

FileContents read(InputFile& file, const ReadOptions& options) {
    return JpegReader(file).read(options);
}

}  // namespace

const Codec kJpeg{"JPEG", {".jpg", ".jpeg"}, {}, recognises, read, nullptr};

}  // namespace mirrorball::detail
