#include "interrupt.h"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <system_error>
#include <thread>

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <mirrorball/error.h>

#include "io/file.h"

namespace mirrorball::cli {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr std::chrono::seconds kPatience{1};

std::atomic<bool> interrupt_seen = false;
std::atomic<bool> work_has_ended = false;
// Guards the folder there is, and is held while it moves: a stop in between would leave half of it.
std::mutex folder_mutex;
const TemporaryFolder* current_folder = nullptr;

// Those that the caller has not turned off: nohup ignores SIGHUP, a shell SIGINT in the background.
sigset_t signals_to_watch() {
    sigset_t signals;
    sigemptyset(&signals);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction action {};
        sigaction(number, nullptr, &action);
        if (action.sa_handler != SIG_IGN) sigaddset(&signals, number);
    }
    return signals;
}

[[noreturn]] void end_now() {
    detail::remove_temporary_files();
    const std::lock_guard lock(folder_mutex);
    // The work still goes on and may put a file in while the folder is being emptied; once the
    // folder is gone it cannot.
    std::error_code error;
    for (int attempt = 0; current_folder != nullptr && attempt < 100; ++attempt) {
        fs::remove_all(current_folder->path(), error);
        if (!error) break;
    }
    static constexpr char kMessage[] = "mirrorball: interrupted\n";
    if (write(STDERR_FILENO, kMessage, sizeof kMessage - 1) < 0) _exit(kInterruptedExitCode);
    _exit(kInterruptedExitCode);
}

// Until a second signal or the end of patience. A program that was stopped and goes on, or that a
// debugger or the leak sanitizer looked into, wakes early: that is neither.
void wait_for_the_work(const sigset_t& signals) {
    using std::chrono::nanoseconds, std::chrono::steady_clock;
    const auto deadline = steady_clock::now() + kPatience;
    for (nanoseconds left = kPatience; left.count() > 0; left = deadline - steady_clock::now()) {
        const timespec time{.tv_sec = left / 1s, .tv_nsec = (left % 1s).count()};
        if (sigtimedwait(&signals, nullptr, &time) >= 0) return;
    }
    // What is left then is the program's own end, however slow.
    int number = 0;
    if (work_has_ended) sigwait(&signals, &number);
}

void watch(sigset_t signals) {
    int number = 0;
    sigwait(&signals, &number);
    interrupt_seen = true;
    wait_for_the_work(signals);
    end_now();
}

[[noreturn]] void fail(const fs::path& path, const std::string& reason) {
    throw Error(Errc::cannot_write, fmt::format("{}: {}", path.string(), reason));
}

// A folder that mkdtemp() made is its owner's alone; a baked one is like any other.
void give_usual_permissions(const fs::path& folder) {
    const mode_t mask = umask(0);
    umask(mask);
    if (chmod(folder.c_str(), 0777 & ~mask) != 0) fail(folder, std::strerror(errno));
}

// The folder's contents over those of `target`, its own folders likewise.
void move_contents(const fs::path& folder, const fs::path& target) {
    for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
        const fs::path place = target / entry.path().filename();
        if (entry.is_directory() && fs::is_directory(place)) {
            move_contents(entry.path(), place);
        } else {
            fs::rename(entry.path(), place);
        }
    }
}

}  // namespace

void watch_for_interrupts() {
    const sigset_t signals = signals_to_watch();
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    std::thread(watch, signals).detach();
    // A file beyond the shell's limit is to fail with a reason, as a full disk does.
    signal(SIGXFSZ, SIG_IGN);
}

bool interrupted() {
    return interrupt_seen;
}

void note_end_of_work() {
    work_has_ended = true;
}

TemporaryFolder::TemporaryFolder(const fs::path& target) {
    std::error_code ignored;
    if (fs::exists(target, ignored) && !fs::is_directory(target, ignored)) {
        fail(target, "is a file; expected a folder or a name for a new one");
    }
    fs::path name = target.lexically_normal();
    if (!name.has_filename()) name = name.parent_path();  // "out/" is "out"
    const fs::path parent = name.has_parent_path() ? name.parent_path() : fs::path(".");
    std::string pattern = (parent / fmt::format(".{}.XXXXXX", name.filename().string())).string();

    const std::lock_guard lock(folder_mutex);
    if (mkdtemp(pattern.data()) == nullptr) fail(parent, std::strerror(errno));
    path_ = pattern;
    current_folder = this;
}

TemporaryFolder::~TemporaryFolder() {
    const std::lock_guard lock(folder_mutex);
    current_folder = nullptr;
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

void TemporaryFolder::move_to(const fs::path& target) {
    const std::lock_guard lock(folder_mutex);
    try {
        give_usual_permissions(path_);
        if (fs::exists(target)) {
            move_contents(path_, target);
        } else {
            fs::rename(path_, target);
        }
    } catch (const fs::filesystem_error& error) {
        fail(target, error.code().message());
    }
}

}  // namespace mirrorball::cli
