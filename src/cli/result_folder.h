// The folder that several results go to: made for them if its own folder is there.
#pragma once

#include <filesystem>
#include <string>

namespace mirrorball::cli {

/// "out/" -> "out"
[[nodiscard]] std::filesystem::path without_slash(const std::string& folder);

/// Finds out what would fail at the end of long work. \throws Error(Errc::cannot_write) if the
/// folder is a file, or it, or the one that it is to be made in, cannot be written to
void check_result_folder(const std::string& folder);

/// Makes the folder where it is not there; one that was made and got no results is removed again.
class ResultFolder {
  public:
    /// Of no name: does nothing. \throws Error(Errc::cannot_write)
    explicit ResultFolder(const std::string& folder);
    ~ResultFolder();
    ResultFolder(const ResultFolder&) = delete;
    ResultFolder& operator=(const ResultFolder&) = delete;

  private:
    std::filesystem::path path_;
    bool made_ = false;
};

}  // namespace mirrorball::cli
