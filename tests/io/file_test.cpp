// Files are replaced whole or not at all, and what the system says reaches the user.
#include "io/file.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <thread>

#include "io_test_support.h"
#include "support.h"

namespace mirrorball::detail {
namespace {

namespace fs = std::filesystem;

void put(const fs::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

std::string get(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

std::size_t entry_count(const fs::path& folder) {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

std::span<const std::byte> bytes_of(const std::string& text) {
    return std::as_bytes(std::span(text));
}

// Larger than any buffer, and different everywhere.
std::string long_text(std::size_t size) {
    std::string text(size, '\0');
    for (std::size_t i = 0; i < size; ++i) text[i] = static_cast<char>(i * 2654435761u >> 13);
    return text;
}

TEST(InputFile, ReadsAnywhereInFilesLargerThanItsBuffer) {
    const TemporaryFolder folder;
    const std::string text = long_text(1'000'003);
    put(folder / "a", text);
    InputFile file(folder / "a");
    EXPECT_EQ(file.size(), text.size());
    for (const std::size_t at : {0ul, 999'999ul, 262'140ul, 5ul, 262'144ul, 524'288ul}) {
        std::string part(std::min<std::size_t>(300'000, text.size() - at), '\0');
        file.seek(at);
        file.read(std::as_writable_bytes(std::span(part)));
        EXPECT_TRUE(part == text.substr(at, part.size())) << at;
        EXPECT_EQ(file.position(), at + part.size());
    }
    file.seek(262'143);  // bytes across the end of the buffer, one at a time
    for (std::size_t i = 262'143; i < 262'150; ++i)
        EXPECT_EQ(static_cast<char>(file.read_byte()), text[i]);
}

TEST(InputFile, BytesInMemoryAreAFile) {
    const std::string text = "0123456789";
    InputFile file("memory", bytes_of(text));
    file.seek(8);
    EXPECT_EQ(static_cast<char>(file.read_byte()), '8');
    std::array<std::byte, 4> out;
    EXPECT_EQ(file.read_some(out), 1u);
    EXPECT_EQ(file.remaining(), 0u);
    expect_error([&] { (void)file.read_byte(); }, Errc::cannot_read, {"memory", "truncated", "10"});
    expect_error([&] { file.seek(11); }, Errc::cannot_read, {"memory", "truncated"});
}

TEST(InputFile, RefusesWhatIsNoRegularFile) {
    const TemporaryFolder folder;
    const fs::path pipe = folder / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    expect_error([&] { InputFile(folder / "none"); }, Errc::cannot_read,
                 {"none", "No such file or directory"});
    expect_error([&] { InputFile{folder.path()}; }, Errc::cannot_read, {"is a folder"});
    expect_error([&] { InputFile{pipe}; }, Errc::cannot_read, {"a device or a pipe"});
    expect_error([&] { InputFile("/dev/null"); }, Errc::cannot_read, {"a device or a pipe"});
}

TEST(OutputFile, IsTheTargetOnlyAfterCommit) {
    const TemporaryFolder folder;
    const fs::path target = folder / "a";
    put(target, "old");
    const std::string text = long_text(700'001);
    {
        OutputFile file(target);
        for (std::size_t i = 0; i < text.size(); i += 1013)
            file.write(std::string_view(text).substr(i, 1013));
        EXPECT_EQ(get(target), "old");
        file.commit();
        EXPECT_EQ(file.size(), text.size());
    }
    EXPECT_TRUE(get(target) == text);
    EXPECT_EQ(entry_count(folder.path()), 1u);
}

TEST(OutputFile, WithoutCommitNothingIsLeft) {
    const TemporaryFolder folder;
    put(folder / "old", "old");
    {
        OutputFile old_one(folder / "old");
        OutputFile new_one(folder / "new");
        old_one.write(long_text(600'000));
        new_one.write("half");
    }
    EXPECT_EQ(get(folder / "old"), "old");
    EXPECT_EQ(entry_count(folder.path()), 1u);
}

TEST(OutputFile, OverwritesAndReadsBackWhatItWrote) {
    const TemporaryFolder folder;
    OutputFile file(folder / "a");
    file.write("....middle");
    file.write(long_text(300'000));
    file.seek(0);
    file.write("head");
    EXPECT_EQ(file.position(), 4u);
    std::array<char, 6> middle;
    EXPECT_EQ(file.read_back(std::as_writable_bytes(std::span(middle))), 6u);
    EXPECT_EQ(std::string(middle.begin(), middle.end()), "middle");
    file.seek(file.size());
    file.write("end");
    file.commit();
    EXPECT_TRUE(get(folder / "a") == "headmiddle" + long_text(300'000) + "end");
}

TEST(OutputFile, KeepsPermissionsAndGivesNewFilesTheUsualOnes) {
    const TemporaryFolder folder;
    put(folder / "old", "old");
    ASSERT_EQ(chmod((folder / "old").c_str(), 0640), 0);
    const mode_t mask = umask(0027);
    for (const char* name : {"old", "new"}) {
        OutputFile file(folder / name);
        file.commit();
    }
    umask(mask);
    struct stat status {};
    ASSERT_EQ(stat((folder / "old").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0640u);
    ASSERT_EQ(stat((folder / "new").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0640u);  // 0666 less the mask
}

TEST(OutputFile, WritesThroughSymbolicLinks) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "sub");
    put(folder / "sub/real", "old");
    fs::create_symlink("sub/real", folder / "link");
    fs::create_symlink("sub/missing", folder / "dangling");
    for (const char* name : {"link", "dangling"}) {
        OutputFile file(folder / name);
        file.write("new");
        file.commit();
        EXPECT_TRUE(fs::is_symlink(folder / name));
    }
    EXPECT_EQ(get(folder / "sub/real"), "new");
    EXPECT_EQ(get(folder / "sub/missing"), "new");
}

TEST(OutputFile, RefusesTargetsThatCannotBe) {
    const TemporaryFolder folder;
    put(folder / "file", "");
    fs::create_symlink("loop", folder / "loop");
    expect_error([&] { OutputFile{folder.path()}; }, Errc::cannot_write, {"is a folder"});
    expect_error([&] { OutputFile(folder / "none/a"); }, Errc::cannot_write,
                 {"none/a", "No such file or directory"});
    expect_error([&] { OutputFile(folder / "file/a"); }, Errc::cannot_write, {"Not a directory"});
    expect_error([&] { OutputFile(folder / "loop"); }, Errc::cannot_write,
                 {"loop", "symbolic links"});
    EXPECT_EQ(entry_count(folder.path()), 2u);
}

TEST(OutputFile, RefusesTargetsThatAreWriteProtected) {
    if (geteuid() == 0) GTEST_SKIP() << "root may write to every file";
    const TemporaryFolder folder;
    put(folder / "file", "old");
    ASSERT_EQ(chmod((folder / "file").c_str(), 0444), 0);
    expect_error([&] { OutputFile(folder / "file"); }, Errc::cannot_write, {"Permission denied"});
    ASSERT_EQ(chmod(folder.path().c_str(), 0555), 0);
    expect_error([&] { OutputFile(folder / "new"); }, Errc::cannot_write, {"Permission denied"});
    ASSERT_EQ(chmod(folder.path().c_str(), 0755), 0);
}

TEST(OutputFile, DevicesAndPipesGetAllBytesInOrder) {
    const TemporaryFolder folder;
    const fs::path pipe = folder / "pipe";
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    std::string received;
    std::thread reader([&] { received = get(pipe); });
    {
        OutputFile file(pipe);
        file.write("____ball");
        file.write(long_text(300'000));
        file.seek(0);
        file.write("mirr");
        file.commit();
    }
    reader.join();
    EXPECT_TRUE(received == "mirrball" + long_text(300'000));
    EXPECT_EQ(entry_count(folder.path()), 1u);

    OutputFile null("/dev/null");
    null.write("gone");
    null.commit();
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(OutputFile, AFullDeviceIsAnErrorWithTheReason) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full here";
    OutputFile file("/dev/full");
    file.write("text");
    expect_error([&] { file.commit(); }, Errc::cannot_write,
                 {"/dev/full", "No space left on device"});
}

// A limit on the size of files stands for the full disk: write() fails half-way in the same manner.
TEST(OutputFile, AFullDiskLeavesTheOldFile) {
    const TemporaryFolder folder;
    const fs::path target = folder / "a";
    put(target, "old");
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    const auto handler = signal(SIGXFSZ, SIG_IGN);
    const rlimit small{500'000, before.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    const auto write_much = [&] {
        OutputFile file(target);
        file.write(long_text(400'000));
        file.write(long_text(400'000));
        file.commit();
    };
    expect_error(write_much, Errc::cannot_write, {"File too large"});
    setrlimit(RLIMIT_FSIZE, &before);
    signal(SIGXFSZ, handler);
    EXPECT_EQ(get(target), "old");
    EXPECT_EQ(entry_count(folder.path()), 1u);
}

TEST(OutputFile, KilledProcessesLeaveNothing) {
    const TemporaryFolder folder;
    put(folder / "a", "old");
    for (const int signal_number : {SIGTERM, SIGKILL}) {
        const pid_t child = fork();
        if (child == 0) {
            signal(SIGTERM, [](int) {
                remove_temporary_files();
                _exit(1);
            });
            OutputFile file(folder / "a");
            file.write("new");
            raise(signal_number);
            _exit(0);
        }
        int status = 0;
        ASSERT_EQ(waitpid(child, &status, 0), child);
        ASSERT_TRUE(WIFSIGNALED(status) || WEXITSTATUS(status) == 1);
        EXPECT_EQ(get(folder / "a"), "old");
        // A file system without nameless files cannot help SIGKILL.
        if (signal_number == SIGTERM) {
            EXPECT_EQ(entry_count(folder.path()), 1u);
        }
    }
}

}  // namespace
}  // namespace mirrorball::detail
