// Radiance HDR, scanline by scanline, so that a panorama can be larger than memory.
//
// A file is a text header, a line with the sizes and the order of the scanlines, and the scanlines.
// A texel is three mantissas m of 8 bits and one exponent e that they share:
//
//     value = m 2^(e - 136),   and black where e = 0
//
// That is how most programs read it, OpenImageIO among them. Radiance itself takes (m + 1/2), the
// middle of what was truncated; writers that round, as ours does, would come out too bright by it.
// Ward 1991, "Real Pixels"; Ward, "Radiance File Formats" (the manual's filefmts.pdf).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <mirrorball/io.h>

#include "file.h"
#include "orientation.h"

namespace mirrorball::detail {

/// Reads the header, checks what it claims against the file, then gives scanlines in their order.
/// Decoding a broken file throws Error(Errc::cannot_read); nothing is allocated but one scanline.
class HdrReader {
  public:
    /// `file` stands at its beginning and outlives this. The memory limit is not looked at here.
    explicit HdrReader(InputFile& file);

    [[nodiscard]] int scanline_count() const { return scanline_count_; }
    /// Texels in a scanline.
    [[nodiscard]] int length() const { return length_; }
    /// Of the picture whose rows are the scanlines; nearly always it is upright.
    [[nodiscard]] Orientation orientation() const { return orientation_; }

    /// The next scanlines, three values per texel: scene-linear RGB, exposure divided out. Many at
    /// once are decoded by all threads.
    /// \pre rgb.size() is a multiple of 3 * length(), and as many scanlines are left to read
    void read_scanlines(std::span<float> rgb);

    /// Bytes held while `count` scanlines are read at once, at most.
    [[nodiscard]] std::uint64_t bytes_held(int count) const;

    [[nodiscard]] const Metadata& metadata() const { return metadata_; }
    [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

  private:
    void read_header();
    void read_variable(std::string_view line);
    void read_resolution();
    void check_length_of_file() const;
    std::string read_line();
    std::array<std::uint8_t, 4> read_texel();
    // Of one scanline, behind those gathered before.
    void gather_scanline();
    bool gather_runs_unread();
    void read_runs(std::span<std::uint8_t> planes);
    void read_texels(std::optional<std::array<std::uint8_t, 4>> first,
                     std::span<std::uint8_t> planes);
    void convert(std::span<const std::uint8_t> planes, std::span<float> rgb) const;

    InputFile& file_;
    int length_ = 0, scanline_count_ = 0;
    Orientation orientation_;
    bool is_xyz_ = false;
    double exposure_ = 1;
    std::array<double, 3> colour_correction_{1, 1, 1};
    std::array<float, 3> divisor_{1, 1, 1};  // the product of both

    // Scanlines on their way: as runs, or decoded to planes (all red, green, blue, all exponents).
    struct Gathered {
        std::size_t begin;
        bool in_runs;
    };
    std::vector<Gathered> gathered_;
    std::vector<std::uint8_t> bytes_;
    Metadata metadata_;
    std::vector<std::string> notes_;
};

/// Writes the header at once, then rows from the top.
class HdrWriter {
  public:
    /// `file` outlives this. Metadata whose keys begin with "mirrorball." go into the header.
    HdrWriter(OutputFile& file, int width, int height, const Metadata& metadata = {});

    /// Rounds to the nearest that the format holds; what is below 2^-128 becomes black.
    /// \pre rgb.size() == 3 * width; values are within [0, largest_value(TexelFormat::rgbe8)]
    void write_row(std::span<const float> rgb);

  private:
    void append_runs(std::span<const std::uint8_t> plane);

    OutputFile& file_;
    int width_;
    std::vector<std::uint8_t> planes_;
    std::vector<std::byte> encoded_;
};

}  // namespace mirrorball::detail
