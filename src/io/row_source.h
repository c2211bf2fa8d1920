// One picture of a file, from its top row down, as its format gives it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <mirrorball/io.h>

namespace mirrorball::detail {

class RowSource {
  public:
    /// As FileContents, but for the texels.
    struct Header {
        int width = 0, height = 0, channels = 3;
        TexelFormat stored = TexelFormat::automatic;
        Metadata metadata;
        std::vector<std::string> notes;
    };
    Header header;

    virtual ~RowSource() = default;
    RowSource(const RowSource&) = delete;
    RowSource& operator=(const RowSource&) = delete;

    /// The next `count` rows, channels interleaved. \throws Error(Errc::cannot_read)
    /// \pre values.size() == count * width * channels, and as many rows are left
    virtual void read(int count, std::span<float> values) = 0;
    /// That are quickly read together.
    [[nodiscard]] virtual int rows_at_once() const = 0;
    /// By this itself, beside the rows that it is asked for.
    [[nodiscard]] virtual std::uint64_t bytes_held() const = 0;

  protected:
    RowSource() = default;
};

}  // namespace mirrorball::detail
