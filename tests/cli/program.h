// The real program, run as a shell would run it.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "support.h"

extern char** environ;

namespace mirrorball {

inline std::string contents(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

inline void write_contents(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

/// Every file under a folder with its bytes, hidden ones too.
inline std::map<std::string, std::string> files_in(const std::filesystem::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const std::string name = entry.path().lexically_relative(folder).string();
        files[name] = entry.is_regular_file() ? contents(entry.path()) : "";
    }
    return files;
}

struct Outcome {
    int code;  ///< the exit code; 128 + signal if one ended it
    std::string out, err;
};

/// A started program; its output goes to files, so that it never waits for a reader.
class Program {
  public:
    explicit Program(const std::vector<std::string>& command, const std::string& stdout_path = "")
        : out_(stdout_path.empty() ? (folder_ / "out").string() : stdout_path) {
        std::vector<char*> arguments;
        for (const std::string& word : command)
            arguments.push_back(const_cast<char*>(word.c_str()));
        arguments.push_back(nullptr);

        posix_spawn_file_actions_t files;
        posix_spawn_file_actions_init(&files);
        posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&files, 1, out_.c_str(), O_WRONLY | O_CREAT, 0644);
        posix_spawn_file_actions_addopen(&files, 2, (folder_ / "err").c_str(), O_WRONLY | O_CREAT,
                                         0644);
        // Whoever runs the tests in the background may have turned SIGINT off.
        posix_spawnattr_t attributes;
        posix_spawnattr_init(&attributes);
        sigset_t usual;
        sigemptyset(&usual);
        sigaddset(&usual, SIGINT);
        posix_spawnattr_setsigdefault(&attributes, &usual);
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
        const int error =
            posix_spawn(&process_, arguments[0], &files, &attributes, arguments.data(), environ);
        posix_spawnattr_destroy(&attributes);
        posix_spawn_file_actions_destroy(&files);
        EXPECT_EQ(error, 0) << command[0];
    }

    void send(int signal) const { kill(process_, signal); }
    [[nodiscard]] bool running() const {
        siginfo_t info{};
        waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT);
        return info.si_pid == 0;
    }

    Outcome wait() {
        int status = 0;
        waitpid(process_, &status, 0);
        const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        return {code, out_.starts_with("/dev") ? "" : contents(out_), contents(folder_ / "err")};
    }

  private:
    TemporaryFolder folder_;
    std::string out_;
    pid_t process_ = 0;
};

inline std::vector<std::string> command(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), MIRRORBALL_PROGRAM);
    return arguments;
}

inline Outcome run(const std::vector<std::string>& arguments, const std::string& stdout_path = "") {
    return Program(command(arguments), stdout_path).wait();
}

/// Exit code and a part of the message; nothing on stdout.
inline void expect_refused(const std::vector<std::string>& arguments, int code,
                           const std::string& message) {
    const Outcome outcome = run(arguments);
    std::string line;
    for (const std::string& argument : arguments) line += argument + " ";
    EXPECT_EQ(outcome.code, code) << line << "\n" << outcome.err;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << line << "\n" << outcome.err;
    EXPECT_EQ(outcome.err.compare(0, 12, "mirrorball: "), 0) << outcome.err;
    EXPECT_EQ(outcome.out, "") << line;
}

}  // namespace mirrorball
