#include "result_folder.h"

#include <cerrno>
#include <cstring>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include <mirrorball/error.h>

namespace mirrorball::cli {

namespace fs = std::filesystem;

fs::path without_slash(const std::string& folder) {
    const fs::path path(folder);
    return path.has_filename() || !path.has_relative_path() ? path : path.parent_path();
}

void check_result_folder(const std::string& folder) {
    const fs::path path = without_slash(folder);
    std::error_code ignored;
    const bool there = fs::exists(path, ignored);
    if (there && !fs::is_directory(path, ignored)) {
        throw Error(Errc::cannot_write,
                    fmt::format("{}: is a file; expected a folder for the results", path.string()));
    }
    const fs::path parent = path.has_parent_path() ? path.parent_path() : fs::path(".");
    const fs::path& changed = there ? path : parent;
    if (access(changed.c_str(), W_OK | X_OK) != 0) {
        throw Error(Errc::cannot_write,
                    fmt::format("{}: {}", changed.string(), std::strerror(errno)));
    }
}

ResultFolder::ResultFolder(const std::string& folder) : path_(without_slash(folder)) {
    if (path_.empty()) return;
    std::error_code error;
    made_ = fs::create_directory(path_, error);
    if (error) {
        throw Error(Errc::cannot_write, fmt::format("{}: {}", path_.string(), error.message()));
    }
}

ResultFolder::~ResultFolder() {
    std::error_code ignored;
    if (made_) fs::remove(path_, ignored);  // which leaves a folder that holds anything
}

}  // namespace mirrorball::cli
