// Ctrl-C, SIGTERM and SIGHUP.
//
// The signals are blocked in every thread and taken by one that only waits for them, so what
// follows is ordinary code and not a signal handler. The first sets a flag that progress callbacks
// see: the work throws Error(Errc::cancelled) and unwinds, which removes what it had begun to
// write. If it has not ended after a second, or a second signal comes, the waiting thread removes
// the temporary files itself and ends the program.
#pragma once

#include <filesystem>

namespace mirrorball::cli {

inline constexpr int kInterruptedExitCode = 130;

/// Called once, before any other thread is started.
void watch_for_interrupts();
[[nodiscard]] bool interrupted();
/// From here on only a second signal cuts the program's end short.
void note_end_of_work();

/// A folder that is removed with all that is in it when this goes, or when the program is stopped.
class TemporaryFolder {
  public:
    /// Makes a hidden folder beside `target`. \throws Error(Errc::cannot_write)
    explicit TemporaryFolder(const std::filesystem::path& target);
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

    /// Moves everything in it to `target`, file by file over older ones, and is not interrupted by
    /// signals meanwhile. \throws Error(Errc::cannot_write)
    void move_to(const std::filesystem::path& target);

  private:
    std::filesystem::path path_;
};

}  // namespace mirrorball::cli
