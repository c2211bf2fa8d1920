// A panorama read a few rows at a time, so that it can be larger than memory.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <mirrorball/io.h>

namespace mirrorball {

/// Gives the rows of a file's equirect map from the top, with the texels, notes and errors that
/// read_map() has for it. Radiance HDR, PFM and OpenEXR files are decoded as the rows are asked
/// for; what cannot be (streams() tells) is read whole at once.
///
///     RowReader reader("sky.exr");
///     std::vector<float> rows(reader.rows_at_once() * reader.row_size());
///     while (const int count = reader.read(rows)) use(std::span(rows).first(count * row_size));
///
/// A file with levels is read as if it had level 0 only.
class RowReader {
  public:
    /// options.memory_limit is for what this holds.
    /// \throws Error as read_map() does, and Error(Errc::usage) for any other projection
    explicit RowReader(const std::string& source, const MapReadOptions& options = {});
    ~RowReader();
    RowReader(RowReader&&) noexcept;
    RowReader& operator=(RowReader&&) noexcept;

    [[nodiscard]] int width() const;
    [[nodiscard]] int height() const;
    [[nodiscard]] const Axes& axes() const;
    [[nodiscard]] const std::optional<Lobe>& lobe() const;
    [[nodiscard]] const std::string& format() const;
    [[nodiscard]] TexelFormat stored() const;
    [[nodiscard]] const Metadata& metadata() const;
    /// What was told about the texels is complete when all rows are read.
    [[nodiscard]] const std::vector<std::string>& notes() const;

    /// Floats in a row: three a texel.
    [[nodiscard]] std::size_t row_size() const;
    /// How many rows are quickest asked for together: they are decoded on all threads.
    [[nodiscard]] int rows_at_once() const;
    /// Bytes that this holds at its peak, beside the rows that the caller has.
    [[nodiscard]] std::uint64_t bytes_held() const;
    /// Whether rows are decoded as they are asked for.
    [[nodiscard]] bool streams() const;

    /// The number of the row that read() gives next.
    [[nodiscard]] int next_row() const;

    /// Fills as many rows as fit, fewer at the bottom; returns how many, 0 when there are no more.
    /// Texels that are no number are repaired if that was asked for, holes of up to 256 rows; else
    /// the error counts all in the file. \pre rows.size() >= row_size()
    int read(std::span<float> rows);

  private:
    class State;
    explicit RowReader(std::unique_ptr<State> state);
    friend std::optional<RowReader> open_if_larger(const std::string&, const MapReadOptions&,
                                                   std::uint64_t);
    std::unique_ptr<State> state_;
};

/// A reader for what read_map() had better not read: an equirect map of more than `most_bytes`
/// whose file can be read row by row. None for all else, what read_map() refuses included.
[[nodiscard]] std::optional<RowReader> open_if_larger(const std::string& source,
                                                      const MapReadOptions& options,
                                                      std::uint64_t most_bytes);

/// What statistics() says of the whole map, to rounding. Reads all rows, of which none may have
/// been read.
[[nodiscard]] LevelStatistics statistics(RowReader& rows);

/// The map made `factor` times smaller: each texel the mean of those under it, by exact solid
/// angle. Holds little more than the result. Reads all rows, of which none may have been read.
/// \throws Error(Errc::usage) unless factor is at least 1 and divides the height
[[nodiscard]] EnvironmentMap reduced(RowReader& rows, int factor);
/// The least factor that makes a map of at most `most_bytes`, what reduced() holds beside it
/// counted in; none if no factor does.
[[nodiscard]] std::optional<int> factor_to_fit(const RowReader& rows, std::uint64_t most_bytes);

}  // namespace mirrorball
