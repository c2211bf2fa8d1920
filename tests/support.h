// What tests of files share: a folder that goes away, and the panoramas that lie beside the
// repository.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>

namespace mirrorball {

/// A new empty folder, removed with all that is in it.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string pattern =
            (std::filesystem::temp_directory_path() / "mirrorball-test-XXXXXX").string();
        path_ = mkdtemp(pattern.data());
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
        return path_ / name;
    }

  private:
    std::filesystem::path path_;
};

/// A file of the shared folder: $MIRRORBALL_SHARED, or `shared` beside the repository.
inline std::optional<std::filesystem::path> shared_file(const std::string& name) {
    const char* folder = std::getenv("MIRRORBALL_SHARED");
    const std::filesystem::path base =
        folder != nullptr ? std::filesystem::path(folder)
                          : std::filesystem::path(MIRRORBALL_SOURCE_DIR).parent_path() / "shared";
    std::error_code ignored;
    if (!std::filesystem::exists(base / name, ignored)) return std::nullopt;
    return base / name;
}

}  // namespace mirrorball
