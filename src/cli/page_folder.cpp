#include "page_folder.h"

#include <system_error>

#include <unistd.h>

namespace mirrorball::cli {

namespace fs = std::filesystem;

std::optional<fs::path> page_folder_with(std::string_view file) {
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    for (const char* place : {"../share/mirrorball/page", "../web/page"}) {
        const fs::path folder = program.parent_path() / place;
        const fs::path path = folder / file;
        if (fs::is_regular_file(path, error) && access(path.c_str(), R_OK) == 0) return folder;
    }
    return std::nullopt;
}

}  // namespace mirrorball::cli
