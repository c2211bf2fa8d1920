// The names of a map's faces, where each face is a file of its own.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <mirrorball/io.h>

namespace mirrorball::detail {

/// Does `%s` stand for a face in this name?
[[nodiscard]] bool is_face_pattern(std::string_view name);

/// The files of one map, in the order of its faces.
struct FaceFiles {
    Projection projection;  ///< cube or dual_paraboloid
    std::vector<std::filesystem::path> files;
    std::string note;  ///< which names were found; empty where there was nothing to find
};

/// Looks which of the naming schemes has all its files, of those that belong to `projection` if it
/// is given. \throws Error(Errc::cannot_read) naming a file that is missing, or the schemes there
/// are
[[nodiscard]] FaceFiles find_face_files(const std::string& pattern,
                                        std::optional<Projection> projection);

/// Six names or two, separated by commas. \throws Error(Errc::usage) for another number of them
[[nodiscard]] FaceFiles split_face_list(const std::string& list);

/// The files to write, in the order of the faces: px nx py ny pz nz, or front back.
/// \throws Error(Errc::usage) for a projection of one face
[[nodiscard]] std::vector<std::filesystem::path> face_targets(const std::string& pattern,
                                                              Projection projection);

}  // namespace mirrorball::detail
