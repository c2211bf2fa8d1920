// Bytes from and to files, the one place that knows about disks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <mirrorball/progress.h>

namespace mirrorball::detail {

/// A file to read: sequentially or anywhere in it. Also stands for bytes in memory, so that
/// decoders can be fuzzed. Every failure throws Error(Errc::cannot_read) with the name and the
/// system's reason.
class InputFile {
  public:
    explicit InputFile(const std::filesystem::path& path);
    /// \pre bytes outlive this
    InputFile(std::string name, std::span<const std::byte> bytes);
    ~InputFile();
    InputFile(const InputFile&) = delete;
    InputFile& operator=(const InputFile&) = delete;

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] std::uint64_t size() const { return size_; }
    [[nodiscard]] std::uint64_t position() const { return position_; }
    [[nodiscard]] std::uint64_t remaining() const { return size_ - position_; }

    void seek(std::uint64_t position);
    /// All of `out`, or an error that says where the file ended.
    void read(std::span<std::byte> out);
    /// From now on, `progress` is told the share of the file that has been read.
    void report_to(Progress progress) { progress_ = std::move(progress); }
    /// For decoders that read otherwise than through this. A smaller share than before is passed
    /// over. \throws Error(Errc::cancelled) if that was asked for
    void tell(double share);
    /// As many bytes as there are; the count.
    std::size_t read_some(std::span<std::byte> out);

    /// The next `count` bytes without passing over them, fewer at the end of the file. Valid until
    /// anything else is read.
    std::span<const std::byte> look_ahead(std::size_t count);
    /// The same file, at its beginning, to be read by another thread.
    [[nodiscard]] std::unique_ptr<InputFile> another() const;

    /// The next byte; inline, because run-length decoders ask for one at a time.
    std::byte read_byte() {
        const std::uint64_t offset = position_ - memory_start_;  // wraps where before the buffer
        if (offset >= memory_.size()) return read_value<std::byte>();
        ++position_;
        return memory_[offset];
    }

    template <class T>
    T read_value() {
        T value;
        read(std::as_writable_bytes(std::span<T>(&value, 1)));
        return value;
    }

    /// Throws Error(Errc::cannot_read): "NAME: WHAT".
    [[noreturn]] void fail(const std::string& what) const;

  private:
    InputFile(const InputFile& other, int descriptor);
    void fill(std::size_t least = 1);

    std::string name_;
    int descriptor_ = -1;
    std::uint64_t size_ = 0, position_ = 0;
    std::span<const std::byte> memory_;  // the whole, or the buffered part
    std::uint64_t memory_start_ = 0;     // of `memory_` in the file
    std::vector<std::byte> buffer_;
    Progress progress_;
    double told_ = 0;  // the last of what it was told
};

/// Removes what OutputFiles that are still open have on disk under a temporary name. For handlers
/// of signals that end the program: calls nothing but unlink(), takes no lock, allocates nothing.
void remove_temporary_files() noexcept;

/// A file to write. Where the system can, it has no name before commit(), else a hidden temporary
/// one beside its target. commit() syncs it and renames it over the target; without commit()
/// nothing is left. A target that is a symbolic link stays one: what it points to is replaced. A
/// target that is no regular file (a device, a pipe) gets all bytes at commit(), in order, whatever
/// was seeked. Every failure throws Error(Errc::cannot_write) and leaves the target as it was.
class OutputFile {
  public:
    explicit OutputFile(const std::filesystem::path& path);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] std::uint64_t position() const { return position_; }
    [[nodiscard]] std::uint64_t size() const { return size_; }

    void write(std::span<const std::byte> bytes);
    void write(std::string_view text);
    template <class T>
    void write_value(const T& value) {
        write(std::as_bytes(std::span<const T>(&value, 1)));
    }
    /// What is written so far may be overwritten, as some formats do with their tables of offsets.
    void seek(std::uint64_t position);
    /// Reads back what was written (libtiff needs it). The count of bytes there were.
    std::size_t read_back(std::span<std::byte> out);

    /// Afterwards the target is the new file. Called once.
    void commit();

    /// Throws Error(Errc::cannot_write): "NAME: WHAT".
    [[noreturn]] void fail(const std::string& what) const;

  private:
    void open_beside_target();
    void open_staging();
    void flush();
    void keep_permissions();
    void rename_over_target();
    void copy_to_target();
    void close_and_remove() noexcept;
    [[noreturn]] void fail_with_reason(const char* what) const;

    std::string name_;
    std::filesystem::path target_;     // name_ with symbolic links followed
    std::filesystem::path temporary_;  // empty while the file has no name
    int temporary_slot_ = -1;          // of temporary_ in the list for remove_temporary_files()
    bool target_is_regular_ = true;
    int descriptor_ = -1;
    std::uint64_t position_ = 0, size_ = 0;
    std::vector<std::byte> buffer_;  // not yet written; it lies just before position_
};

}  // namespace mirrorball::detail
