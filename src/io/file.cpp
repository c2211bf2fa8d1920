// Files as the system gives them, with its reasons put into words.
//
// How a file is replaced: the new one is written beside it, synced, and renamed over it, which the
// system does in one step. On Linux a file can be written without having a name at all (O_TMPFILE),
// so that not even a killed process leaves anything; it gets a name for the moment between link and
// rename. File systems without that get a hidden name from the start. Names in use are listed in an
// array that a signal handler can go through.
#include "file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstring>
#include <random>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include <mirrorball/error.h>

namespace mirrorball::detail {
namespace {

constexpr std::size_t kBufferSize = std::size_t{256} * 1024;

std::string reason(int error_number) {
    return std::generic_category().message(error_number);
}

// Temporary names ---------------------------------------------------------------------------------

// A slot's path is written while it is `taken` and read only while it is `listed`.
enum SlotState : int { kFree, kTaken, kListed };
struct Slot {
    std::atomic<int> state{kFree};
    char path[PATH_MAX] = {};
};
// More files than are ever written at once: a map's faces are written one after another.
constinit std::array<Slot, 32> temporary_names;
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler reads these");

// The slot; -1 if all are in use or the path is too long, then only the destructor cleans up.
int list_temporary(const std::filesystem::path& path) {
    const std::string& text = path.native();
    if (text.size() >= PATH_MAX) return -1;
    for (std::size_t i = 0; i < temporary_names.size(); ++i) {
        Slot& slot = temporary_names[i];
        int expected = kFree;
        if (!slot.state.compare_exchange_strong(expected, kTaken)) continue;
        std::memcpy(slot.path, text.c_str(), text.size() + 1);
        slot.state.store(kListed);
        return static_cast<int>(i);
    }
    return -1;
}

void unlist_temporary(int slot) noexcept {
    if (slot >= 0) temporary_names[slot].state.store(kFree);
}

// ".sky.hdr.1234-0-9f0c2b7d61e85a34": hidden, and no other process or call makes the same.
std::filesystem::path temporary_name_for(const std::filesystem::path& target) {
    static std::atomic<unsigned> counter{0};
    std::random_device random;
    const std::uint64_t number = std::uint64_t{random()} << 32 | random();
    // A name may have 255 bytes; 60 of them are enough to tell a person what this was.
    const std::string stem = target.filename().string().substr(0, 60);
    const std::string name =
        fmt::format(".{}.{}-{}-{:016x}", stem, getpid(), counter.fetch_add(1), number);
    // Absolute, so that a change of the working folder does not lose it.
    return std::filesystem::absolute(target).parent_path() / name;
}

// Targets -----------------------------------------------------------------------------------------

// Where writing through symbolic links ends up, whether or not that exists yet.
std::filesystem::path follow_links(std::filesystem::path path) {
    constexpr int kLongestChain = 40;  // the kernel's own limit
    std::error_code ignored;
    for (int i = 0; i < kLongestChain && std::filesystem::is_symlink(path, ignored); ++i) {
        const std::filesystem::path next = std::filesystem::read_symlink(path, ignored);
        path = path.parent_path() / next;  // `next` alone where it is absolute
    }
    return path;
}

std::filesystem::path folder_of(const std::filesystem::path& path) {
    return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

std::string path_of_descriptor(int descriptor) {
    return fmt::format("/proc/self/fd/{}", descriptor);
}

// A file in `folder` that has no name; -1 where the system cannot make one that can be named later.
int open_nameless(const std::filesystem::path& folder) {
    const int descriptor = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
    if (descriptor < 0) return -1;
    if (access(path_of_descriptor(descriptor).c_str(), F_OK) == 0) return descriptor;
    close(descriptor);
    return -1;
}

// All of `bytes` at `offset`, or to a stream where `offset` is negative. Whether it went well;
// errno.
bool write_fully(int descriptor, std::span<const std::byte> bytes, off_t offset) {
    while (!bytes.empty()) {
        const ssize_t count = offset < 0 ? ::write(descriptor, bytes.data(), bytes.size())
                                         : pwrite(descriptor, bytes.data(), bytes.size(), offset);
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return false;
        bytes = bytes.subspan(static_cast<std::size_t>(count));
        if (offset >= 0) offset += count;
    }
    return true;
}

// Lets the disk begin with what commit() will wait for, while the rest is made. Only a hint.
void begin_to_sync([[maybe_unused]] int descriptor, [[maybe_unused]] std::uint64_t offset,
                   [[maybe_unused]] std::uint64_t size) {
#if defined(SYNC_FILE_RANGE_WRITE) && !defined(__EMSCRIPTEN__)
    sync_file_range(descriptor, static_cast<off64_t>(offset), static_cast<off64_t>(size),
                    SYNC_FILE_RANGE_WRITE);
#endif
}

// The count of bytes read, fewer than asked for only at the end of the file; -1 and errno.
ssize_t read_fully(int descriptor, std::span<std::byte> out, std::uint64_t offset) {
    std::size_t done = 0;
    while (done < out.size()) {
        const ssize_t count = pread(descriptor, out.data() + done, out.size() - done,
                                    static_cast<off_t>(offset + done));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return -1;
        if (count == 0) break;
        done += static_cast<std::size_t>(count);
    }
    return static_cast<ssize_t>(done);
}

}  // namespace

void remove_temporary_files() noexcept {
    const int errno_before = errno;  // a handler must not change it under the code it interrupts
    for (Slot& slot : temporary_names)
        if (slot.state.load() == kListed) unlink(slot.path);
    errno = errno_before;
}

// InputFile ---------------------------------------------------------------------------------------

InputFile::InputFile(const std::filesystem::path& path) : name_(path.string()) {
    // O_NONBLOCK, or opening a pipe would wait for its writer before it can be refused.
    descriptor_ = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor_ < 0) fail(fmt::format("cannot be opened ({})", reason(errno)));

    struct stat status {};
    const bool known = fstat(descriptor_, &status) == 0;
    if (!known || !S_ISREG(status.st_mode)) {
        const int error_number = errno;
        close(descriptor_);
        if (!known) fail(fmt::format("cannot be examined ({})", reason(error_number)));
        if (S_ISDIR(status.st_mode)) fail("is a folder, where a file was expected");
        fail("is a device or a pipe, where a regular file was expected");
    }
    size_ = static_cast<std::uint64_t>(status.st_size);
}

InputFile::InputFile(std::string name, std::span<const std::byte> bytes)
    : name_(std::move(name)),
      size_(bytes.size()),
      memory_(bytes) {}

InputFile::~InputFile() {
    if (descriptor_ >= 0) close(descriptor_);
}

void InputFile::seek(std::uint64_t position) {
    if (position > size_)
        fail(fmt::format("is truncated: refers to byte {}, but has {}", position, size_));
    position_ = position;
}

void InputFile::read(std::span<std::byte> out) {
    const std::uint64_t before = position_;
    const std::size_t count = read_some(out);
    if (count < out.size())
        fail(
            fmt::format("is truncated: ends at byte {}, in the middle of {} bytes that begin at {}",
                        size_, out.size(), before));
}

std::size_t InputFile::read_some(std::span<std::byte> out) {
    const std::size_t wanted = std::min<std::uint64_t>(out.size(), remaining());
    std::size_t done = 0;
    while (done < wanted) {
        const bool buffered =
            position_ >= memory_start_ && position_ - memory_start_ < memory_.size();
        if (!buffered) fill();
        const std::span<const std::byte> there =
            memory_.subspan(static_cast<std::size_t>(position_ - memory_start_));
        const std::size_t count = std::min(there.size(), wanted - done);
        std::memcpy(out.data() + done, there.data(), count);
        done += count;
        position_ += count;
    }
    return done;
}

std::span<const std::byte> InputFile::look_ahead(std::size_t count) {
    const std::size_t wanted = std::min<std::uint64_t>(count, remaining());
    const bool begins_there =
        position_ >= memory_start_ && position_ - memory_start_ <= memory_.size();
    const bool there = begins_there && memory_.size() - (position_ - memory_start_) >= wanted;
    if (!there) fill(wanted);
    return memory_.subspan(static_cast<std::size_t>(position_ - memory_start_), wanted);
}

std::unique_ptr<InputFile> InputFile::another() const {
    int descriptor = -1;
    if (descriptor_ >= 0) {
        descriptor = fcntl(descriptor_, F_DUPFD_CLOEXEC, 0);
        if (descriptor < 0) fail(fmt::format("cannot be opened ({})", reason(errno)));
    }
    return std::unique_ptr<InputFile>(new InputFile(*this, descriptor));
}

InputFile::InputFile(const InputFile& other, int descriptor)
    : name_(other.name_),
      descriptor_(descriptor),
      size_(other.size_),
      memory_(descriptor < 0 ? other.memory_ : std::span<const std::byte>()) {}

// Makes memory_ the part of the file that begins at position_, of `least` bytes or more.
void InputFile::fill(std::size_t least) {
    const std::size_t usual = std::min<std::uint64_t>(kBufferSize, size_);
    if (buffer_.size() < std::max(usual, least)) buffer_.resize(std::max(usual, least));
    const ssize_t count = read_fully(descriptor_, buffer_, position_);
    if (count < 0) fail(fmt::format("cannot be read ({})", reason(errno)));
    if (count < static_cast<ssize_t>(least))
        fail(fmt::format("became shorter than {} bytes while it was read", size_));
    memory_ = std::span<const std::byte>(buffer_).first(static_cast<std::size_t>(count));
    memory_start_ = position_;
    tell(static_cast<double>(position_ + memory_.size()) / static_cast<double>(size_));
}

void InputFile::tell(double share) {
    told_ = std::clamp(share, told_, 1.0);
    if (progress_ && !progress_(told_)) throw Error(Errc::cancelled, "cancelled");
}

void InputFile::fail(const std::string& what) const {
    throw Error(Errc::cannot_read, name_ + ": " + what);
}

// OutputFile --------------------------------------------------------------------------------------

OutputFile::OutputFile(const std::filesystem::path& path) : name_(path.string()) {
    struct stat status {};
    const bool exists = stat(path.c_str(), &status) == 0;
    if (!exists && errno != ENOENT) fail(fmt::format("cannot be written ({})", reason(errno)));
    if (exists && S_ISDIR(status.st_mode)) fail("is a folder, where a file was expected");
    // Renaming over a file asks for no right to write to it. People who took that right away from
    // themselves meant it.
    if (exists && access(path.c_str(), W_OK) != 0)
        fail(fmt::format("cannot be written ({})", reason(errno)));

    target_is_regular_ = !exists || S_ISREG(status.st_mode);
    if (target_is_regular_) {
        target_ = follow_links(path);
        open_beside_target();
    } else {
        target_ = path;
        open_staging();
    }
    try {
        buffer_.reserve(kBufferSize);
    } catch (...) {
        close_and_remove();
        throw;
    }
}

OutputFile::~OutputFile() {
    close_and_remove();
}

void OutputFile::open_beside_target() {
    const std::filesystem::path folder = folder_of(target_);
    struct stat status {};
    if (stat(folder.c_str(), &status) != 0)
        fail(fmt::format("cannot be written: folder {} ({})", folder.string(), reason(errno)));
    if (!S_ISDIR(status.st_mode))
        fail(fmt::format("cannot be written: {} is not a folder", folder.string()));

    descriptor_ = open_nameless(folder);
    if (descriptor_ >= 0) return;

    temporary_ = temporary_name_for(target_);
    temporary_slot_ = list_temporary(temporary_);
    descriptor_ = open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0) {
        const int error_number = errno;
        unlist_temporary(temporary_slot_);
        fail(fmt::format("cannot be written: folder {} ({})", folder.string(),
                         reason(error_number)));
    }
}

// For targets that cannot be seeked in: a file in the folder for temporary ones, unlinked at once.
void OutputFile::open_staging() {
    std::error_code ignored;
    const std::filesystem::path folder = std::filesystem::temp_directory_path(ignored);
    descriptor_ = open_nameless(folder);
    if (descriptor_ >= 0) return;
    const std::filesystem::path staging = temporary_name_for(folder / "staging");
    descriptor_ = open(staging.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (descriptor_ < 0) fail_with_reason("needs a temporary file, which cannot be made");
    unlink(staging.c_str());
}

void OutputFile::write(std::span<const std::byte> bytes) {
    if (buffer_.size() + bytes.size() > kBufferSize) flush();
    if (bytes.size() > kBufferSize) {
        if (!write_fully(descriptor_, bytes, static_cast<off_t>(position_)))
            fail_with_reason("cannot be written");
        begin_to_sync(descriptor_, position_, bytes.size());
    } else {
        buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
    }
    position_ += bytes.size();
    size_ = std::max(size_, position_);
}

void OutputFile::write(std::string_view text) {
    write(std::as_bytes(std::span(text.data(), text.size())));
}

void OutputFile::flush() {
    const std::uint64_t start = position_ - buffer_.size();
    if (!write_fully(descriptor_, buffer_, static_cast<off_t>(start)))
        fail_with_reason("cannot be written");
    buffer_.clear();
}

void OutputFile::seek(std::uint64_t position) {
    if (position == position_) return;
    flush();
    position_ = position;
}

std::size_t OutputFile::read_back(std::span<std::byte> out) {
    flush();
    const ssize_t count = read_fully(descriptor_, out, position_);
    if (count < 0) fail_with_reason("cannot be read back");
    position_ += static_cast<std::uint64_t>(count);
    return static_cast<std::size_t>(count);
}

void OutputFile::commit() {
    flush();
    if (target_is_regular_) {
        keep_permissions();
        // Not before this do full disks and quotas of network file systems show.
        if (fsync(descriptor_) != 0) fail_with_reason("cannot be written");
        rename_over_target();
    } else {
        copy_to_target();
    }
    const int descriptor = descriptor_;
    descriptor_ = -1;
    if (close(descriptor) != 0) fail_with_reason("cannot be written");
}

void OutputFile::keep_permissions() {
    struct stat status {};
    if (stat(target_.c_str(), &status) == 0) fchmod(descriptor_, status.st_mode & 0777);
}

void OutputFile::rename_over_target() {
    if (temporary_.empty()) {
        const std::filesystem::path name = temporary_name_for(target_);
        temporary_slot_ = list_temporary(name);
        if (linkat(AT_FDCWD, path_of_descriptor(descriptor_).c_str(), AT_FDCWD, name.c_str(),
                   AT_SYMLINK_FOLLOW) != 0)
            fail_with_reason("cannot be written");
        temporary_ = name;
    }
    if (rename(temporary_.c_str(), target_.c_str()) != 0) fail_with_reason("cannot be replaced");
    temporary_.clear();
    unlist_temporary(std::exchange(temporary_slot_, -1));

    // The rename itself reaches the disk with its folder. The file is there whether or not this
    // works.
    const int folder = open(folder_of(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0) return;
    fsync(folder);
    close(folder);
}

void OutputFile::copy_to_target() {
    const int out = open(target_.c_str(), O_WRONLY | O_CLOEXEC);
    if (out < 0) fail_with_reason("cannot be opened");
    buffer_.resize(kBufferSize);
    bool good = true;
    for (std::uint64_t offset = 0; good && offset < size_;) {
        const ssize_t count = read_fully(descriptor_, buffer_, offset);
        good = count > 0 &&
               write_fully(out, std::span(buffer_).first(static_cast<std::size_t>(count)), -1);
        offset += static_cast<std::uint64_t>(std::max<ssize_t>(count, 0));
    }
    const int error_number = errno;
    buffer_.clear();
    const bool closed = close(out) == 0;
    if (good && closed) return;
    errno = good ? errno : error_number;
    fail_with_reason("cannot be written");
}

void OutputFile::close_and_remove() noexcept {
    if (!temporary_.empty()) unlink(temporary_.c_str());
    unlist_temporary(std::exchange(temporary_slot_, -1));
    if (descriptor_ >= 0) close(std::exchange(descriptor_, -1));
}

void OutputFile::fail(const std::string& what) const {
    throw Error(Errc::cannot_write, name_ + ": " + what);
}

void OutputFile::fail_with_reason(const char* what) const {
    fail(fmt::format("{} ({})", what, reason(errno)));
}

}  // namespace mirrorball::detail
